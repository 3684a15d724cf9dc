#pragma once
// Files that come with the program: fonts, scenes and their pictures.
#include <filesystem>
#include <string>
#include <vector>

namespace lucerna::ui {

/// Folders that may contain assets/, in order of preference: $LUCERNA_ASSETS, the installed folder, the
/// source's.
std::vector<std::filesystem::path> asset_folders();

/// One of the program's scenes with its picture, a PNG.
struct GalleryScene {
  std::string name;
  std::filesystem::path file, picture;
};
/// The existing ones by name; searched once.
const std::vector<GalleryScene>& gallery();

}  // namespace lucerna::ui
