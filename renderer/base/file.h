#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "base/output_file.h"

namespace lucerna {

/// Writes a file completely or not at all (see OutputFile for links, pipes and devices). On failure throws
/// Error located at `file`; the old file stays.
void write_file(const std::filesystem::path& file, std::string_view bytes);
/// Reads a whole file. Throws Error located at `file`.
std::string read_file(const std::filesystem::path& file);
/// True if the file, or the folder, exists; symbolic links are followed. False if this cannot be determined.
bool file_exists(const std::filesystem::path& file);
bool is_folder(const std::filesystem::path& path);
/// True unless it is a folder, a pipe or a device (reading from these may block forever).
bool is_plain_file(const std::filesystem::path& file);
/// The absolute path, without "." and "..". If the working folder no longer exists, a relative path stays as
/// it is.
std::filesystem::path absolute_path(const std::filesystem::path& path);

}  // namespace lucerna
