#include "state.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/timer.h"

namespace lucerna::ui {
namespace {

/// How long an edit is shown although the session says otherwise; then the session was right (it refused it).
constexpr double k_patience = 2.0;

const Timer& clock() {
  static const Timer timer;
  return timer;
}

}  // namespace

LogInbox::LogInbox() {
  clock();
  token_ = log::add_listener([this](log::Level level, const std::string& text) {
    std::lock_guard lock(mutex_);
    lines_.push_back({level, clock().seconds(), text});
  });
}

LogInbox::~LogInbox() { log::remove_listener(token_); }

std::vector<LogLine> LogInbox::take() {
  std::lock_guard lock(mutex_);
  return std::exchange(lines_, {});
}

void SettingsView::refresh(double now) {
  now_ = now;
  known_ = session_.settings();
  std::erase_if(pending_, [&](const auto& entry) {
    return known_.text(entry.first) == entry.second.value || now - entry.second.since > k_patience;
  });
}

void SettingsView::set(const std::string& key, const std::string& value) {
  if (text(key) == value) return;
  pending_[key] = {value, now_};
  session_.set(key, value);
}

const std::string& SettingsView::text(const std::string& key) const {
  const auto found = pending_.find(key);
  return found != pending_.end() ? found->second.value : known_.text(key);
}

double SettingsView::real(const std::string& key) const {
  const std::string& t = text(key);
  double value = 0;
  std::from_chars(t.data(), t.data() + t.size(), value);
  return value;
}

double Ui::time() { return clock().seconds(); }

scene::Light Ui::light(uint32_t index) const {
  const auto found = light_edits.find(index);
  return found != light_edits.end() ? found->second.light : scene->lights[index];
}

void Ui::edit_light(uint32_t index, const scene::Light& light) {
  light_edits[index] = {light, now};
  session.set_light(index, light);
}

void Ui::edit_environment(float scale, float rotation) {
  environment_edit = EnvironmentEdit{scale, rotation, now};
  session.set_environment(scale, rotation);
}

void Ui::drop_taken_edits() {
  if (!scene) return light_edits.clear(), environment_edit.reset();
  std::erase_if(light_edits, [&](const auto& entry) {
    const auto& [index, edit] = entry;
    if (index >= scene->lights.size() || now - edit.since > k_patience) return true;
    const scene::Light& known = scene->lights[index];
    return known.intensity == edit.light.intensity && known.enabled == edit.light.enabled;
  });
  if (environment_edit) {
    const bool taken = scene->environment.scale == environment_edit->scale &&
                       scene->environment.rotation == environment_edit->rotation;
    if (taken || now - environment_edit->since > k_patience) environment_edit.reset();
  }
}

void Ui::moved() {
  camera_moved = true;
  scene_camera = -1;
  wake();
}

void Ui::take_camera(int index) {
  if (!scene || index < 0 || index >= static_cast<int>(scene->cameras.size())) return;
  view = make_viewpoint(scene->cameras[static_cast<size_t>(index)], bounds);
  moved();
  scene_camera = index;
  flight = {};
}

void Ui::follow_scene() {
  if (!snapshot || !scene || snapshot->scene_id == view_scene || snapshot->rgba.empty()) return;
  view_scene = snapshot->scene_id;
  bounds = scene::bounds(*scene);
  view = make_viewpoint(snapshot->camera, bounds);
  speed = walking_speed(view->extent);
  flight = {};
  selection = {};
  light_edits.clear(), light_colours.clear(), environment_edit.reset();
  scene_camera = -1;
  for (size_t i = 0; i < scene->cameras.size(); ++i)
    if (same_view(scene->cameras[i], snapshot->camera)) scene_camera = static_cast<int>(i);
  camera_moved = false;
  if (!scene->file.empty()) {
    std::erase(recent, scene->file);
    recent.insert(recent.begin(), scene->file);
    if (recent.size() > 8) recent.resize(8);
  }
}

Box Ui::selection_bounds() const {
  Box box;
  if (!scene) return box;
  const auto add = [&](const scene::Instance& instance, auto&& wanted) {
    if (instance.mesh >= scene->meshes.size()) return;
    for (const scene::Primitive& primitive : scene->meshes[instance.mesh].primitives)
      if (wanted(primitive))
        for (const vec3& p : primitive.positions) box.grow(vec3(instance.to_world * vec4(p, 1)));
  };
  switch (selection.kind) {
    case Kind::none:
      return bounds;
    case Kind::material:
      for (const scene::Instance& instance : scene->instances)
        add(instance, [&](const scene::Primitive& p) { return p.material == selection.index; });
      break;
    case Kind::instance:
      if (selection.index < scene->instances.size())
        add(scene->instances[selection.index], [](const scene::Primitive&) { return true; });
      break;
    case Kind::light:
      if (selection.index < scene->lights.size() &&
          scene->lights[selection.index].kind != scene::LightKind::directional) {
        const float reach = 0.05f * std::max(bounds.radius(), 1e-3f);
        box.grow(scene->lights[selection.index].position - vec3(reach));
        box.grow(scene->lights[selection.index].position + vec3(reach));
      }
      break;
  }
  return box.empty() ? bounds : box;
}

std::string Ui::selection_name() const {
  if (!scene) return "";
  switch (selection.kind) {
    case Kind::material:
      return scene->materials[selection.index].name;
    case Kind::instance:
      return scene->instances[selection.index].name;
    case Kind::light:
      return scene->lights[selection.index].name;
    case Kind::none:
      break;
  }
  return "";
}

void Ui::frame_selection() {
  if (!view) return;
  frame(*view, selection_bounds(), picture.height() > 0 ? picture.width() / picture.height() : 1.5f);
  moved();
}

void Ui::toggle_solo(int component) {
  const auto key = [](int c) {
    return std::string("show.") + session::k_component_names[static_cast<size_t>(c)];
  };
  if (solo < 0)
    for (int c = 0; c < session::k_components; ++c)
      shown_before[static_cast<size_t>(c)] = settings.boolean(key(c));
  const bool leaving = solo == component;
  solo = leaving ? -1 : component;
  for (int c = 0; c < session::k_components; ++c) {
    const bool shown = leaving ? shown_before[static_cast<size_t>(c)] : c == component;
    settings.set(key(c), shown ? "true" : "false");
  }
  if (!leaving) settings.set("film.layer", "beauty");
}

void Ui::toggle_show(int component) {
  const std::string key = std::string("show.") + session::k_component_names[static_cast<size_t>(component)];
  solo = -1;
  settings.set(key, settings.boolean(key) ? "false" : "true");
}

void Ui::open_scene(const std::string& file) {
  if (file.empty()) return;
  errors.clear();
  log::info("opening {}", file);
  session.load(file);
}

void Ui::save_picture(const std::string& file) {
  if (file.empty()) return;
  session.save(file);
}

void Ui::fail(const std::string& message) {
  if (errors.empty() || errors.back() != message) errors.push_back(message);
  if (errors.size() > 3) errors.erase(errors.begin());
  wake();
}

}  // namespace lucerna::ui
