#include "assets.h"

#include <algorithm>
#include <cstdlib>

namespace fs = std::filesystem;

namespace lucerna::ui {
namespace {

std::vector<GalleryScene> found_scenes() {
  std::vector<GalleryScene> scenes;
  std::error_code error;
  for (const fs::path& assets : asset_folders()) {
    for (fs::directory_iterator entry(assets / "thumbnails", error), end; !error && entry != end;
         entry.increment(error)) {
      if (entry->path().extension() != ".png") continue;
      const std::string name = entry->path().stem().string();
      const fs::path file = assets.parent_path() / "scenes" / name / (name + ".gltf");
      std::error_code ignored;
      if (fs::is_regular_file(file, ignored)) scenes.push_back({name, file, entry->path()});
    }
    if (!scenes.empty()) break;
  }
  std::sort(scenes.begin(), scenes.end(),
            [](const GalleryScene& a, const GalleryScene& b) { return a.name < b.name; });
  return scenes;
}

}  // namespace

std::vector<fs::path> asset_folders() {
  std::vector<fs::path> folders;
  if (const char* assets = std::getenv("LUCERNA_ASSETS"); assets && *assets) folders.push_back(assets);
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  if (!error) folders.push_back(self.parent_path().parent_path() / "share" / "lucerna" / "assets");
  folders.push_back(fs::path(LUCERNA_SOURCE_DIR) / "assets");
  return folders;
}

const std::vector<GalleryScene>& gallery() {
  static const std::vector<GalleryScene> scenes = found_scenes();
  return scenes;
}

}  // namespace lucerna::ui
