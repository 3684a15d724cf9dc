#pragma once
// Where the sources and the program lie. Kept out of the compiler's command line, so that what one clone has
// compiled serves another. Included by the precompiled header of all tests.

namespace lucerna::test {

extern const char* const k_source_dir;
extern const char* const k_binary;

}  // namespace lucerna::test

#ifndef LUCERNA_SOURCE_DIR
#define LUCERNA_SOURCE_DIR ::lucerna::test::k_source_dir
#endif
#define LUCERNA_BINARY ::lucerna::test::k_binary
