#include "support/paths.h"

namespace lucerna::test {

const char* const k_source_dir = LUCERNA_PATH_SOURCE;
const char* const k_binary = LUCERNA_PATH_BINARY;

}  // namespace lucerna::test
