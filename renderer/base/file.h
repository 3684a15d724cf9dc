#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "base/output_file.h"

namespace lucerna {

/// Writes a file whole or not at all (OutputFile, which see for links, pipes and devices). Throws Error
/// located at `file`; what was there before then stays.
void write_file(const std::filesystem::path& file, std::string_view bytes);
/// Throws Error located at `file` when it cannot be read.
std::string read_file(const std::filesystem::path& file);
/// Whether something has that name, behind links; of folders, whether it is one. False if that cannot be
/// found out.
bool file_exists(const std::filesystem::path& file);
bool is_folder(const std::filesystem::path& path);
/// Whether it is neither a folder nor a pipe or device, which may never answer a reader.
bool is_plain_file(const std::filesystem::path& file);
/// The path from the root, without "." and "..". Where the working folder is gone a relative path stays as it
/// is.
std::filesystem::path absolute_path(const std::filesystem::path& path);

}  // namespace lucerna
