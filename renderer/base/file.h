#pragma once
#include <filesystem>
#include <string>

namespace lucerna {

/// Writes a file whole or not at all: under a temporary name in its folder, flushed to disk, then renamed.
/// Throws Error located at `file`; what was there before then stays.
void write_file(const std::filesystem::path& file, const std::string& bytes);
/// Throws Error located at `file` when it cannot be read.
std::string read_file(const std::filesystem::path& file);
/// Throws Error located at `file` when it plainly could not be written: its folder is missing or closed, or
/// the name is a folder's. For long work, before it begins.
void check_writable(const std::filesystem::path& file);

}  // namespace lucerna
