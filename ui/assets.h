#pragma once
// Files that come with the program: fonts, and the scenes with their pictures.
#include <filesystem>
#include <string>
#include <vector>

namespace lucerna::ui {

/// Folders that may hold assets/, the first to be looked at first: $LUCERNA_ASSETS, the installed ones, the
/// source's.
std::vector<std::filesystem::path> asset_folders();

/// A scene of the program with its picture, a PNG.
struct GalleryScene {
  std::string name;
  std::filesystem::path file, picture;
};
/// Those that are there, by name; looked up once.
const std::vector<GalleryScene>& gallery();

}  // namespace lucerna::ui
