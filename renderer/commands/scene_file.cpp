#include "commands/scene_file.h"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>
#include <tuple>

#include "base/error.h"
#include "base/file.h"
#include "base/future.h"
#include "base/log.h"
#include "commands/session_saves.h"

namespace lucerna::commands {

bool is_kept(const std::string& key) {
  constexpr std::array<std::string_view, 8> keys{"film.ev",       "film.background", "film.tone_curve",
                                                 "scene.variant", "effects.off",     "relight.groups",
                                                 "relight.mix",   "relight.presets"};
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

bool same_scene(const Document& a, const Document& b) {
  const auto values = [](const Document& d) {
    return std::tie(d.lights, d.materials, d.objects, d.environment_scale, d.environment_rotation,
                    d.environment_file, d.sky);
  };
  if (values(a) != values(b)) return false;
  return std::all_of(a.settings.begin(), a.settings.end(), [&](const auto& setting) {
    const auto other = b.settings.find(setting.first);
    return !is_kept(setting.first) || (other != b.settings.end() && other->second == setting.second);
  });
}

std::string SceneFile::file() const {
  if (!open_.scene) return "";
  return file_.empty() ? open_.scene->file : file_;
}

std::vector<std::pair<std::string, std::string>> SceneFile::kept_settings() const {
  std::set<std::string> named;
  for (const auto* list : {&open_.loaded->settings, &open_.loaded->own_settings})
    for (const auto& [key, value] : *list) named.insert(key);
  std::vector<std::pair<std::string, std::string>> kept;
  for (const auto& [key, value] : open_.document().settings) {
    const OptionInfo* option = plan::find_option(key);
    if (named.contains(key) || (is_kept(key) && option && value != option->fallback))
      kept.emplace_back(key, value);
  }
  return kept;
}

session::Saved SceneFile::save(const std::string& file, bool replace, std::vector<scene::Camera> cameras) {
  open_.needs_scene();
  scene::SaveRequest request;
  request.loaded = open_.loaded;
  request.edited = std::make_shared<const scene::Scene>(open_.edited_scene());
  for (uint32_t i = 0; i < open_.scene->materials.size(); ++i)
    if (scene::TextureSources textures = open_.textures(i); !textures.empty())
      request.textures[i] = std::move(textures);
  request.cameras = std::move(cameras);
  request.settings = kept_settings();
  request.file = absolute_path(file);
  request.replace = replace;
  if (const auto known = written_.find(request.file.string()); known != written_.end())
    request.written = known->second;
  auto result = std::make_shared<scene::SavedScene>();
  session::Saved saved = std::async(std::launch::async, [request = std::move(request), result] {
                           try {
                             *result = scene::save(request);
                           } catch (const std::exception& error) {
                             log::error("{}", error.what());
                             throw;
                           }
                           for (const std::string& note : result->notes) log::warning("{}", note);
                           log::info("scene saved as {}", request.file.string());
                         }).share();
  writing_.push_back({absolute_path(file).string(), history_.position(), saved, std::move(result)});
  return saved;
}

void SceneFile::follow() {
  std::erase_if(writing_, [&](const Writing& w) {
    if (!is_ready(w.saved)) return false;
    if (failed(w.saved)) return true;
    written_[w.file] = w.result->written;
    saved_at_ = w.position;
    file_ = w.file;
    return true;
  });
}

void SceneFile::begin_scene() {
  for (const Writing& w : std::exchange(writing_, {})) w.saved.wait();
  written_.clear(), file_.clear();
  note_clean();
}

}  // namespace lucerna::commands
