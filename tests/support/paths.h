#pragma once
// Paths of the sources and the program. Not on the compiler's command line, so clones share compiled files.
// Included by the precompiled header of all tests.

namespace lucerna::test {

extern const char* const k_source_dir;
extern const char* const k_binary;

}  // namespace lucerna::test

#ifndef LUCERNA_SOURCE_DIR
#define LUCERNA_SOURCE_DIR ::lucerna::test::k_source_dir
#endif
#define LUCERNA_BINARY ::lucerna::test::k_binary
