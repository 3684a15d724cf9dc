#include "commands/navigation.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/file.h"
#include "base/future.h"
#include "base/log.h"
#include "commands/text.h"
#include "scene/core.h"
#include "scene/lamp.h"
#include "scene/range.h"

namespace lucerna::commands {

const char* kind_name(Kind kind) {
  static const char* names[] = {"none", "material", "object", "light"};
  return names[static_cast<size_t>(kind)];
}

void Navigation::begin_scene(std::shared_ptr<const scene::Scene> scene, const session::Snapshot& picture) {
  view_scene = picture.scene_id;
  core = scene::core_bounds(*scene);
  view = make_viewpoint(picture.camera, core);
  speed = walking_speed(view->extent);
  selection = {};
  walking = false;
  scene_camera = -1;
  for (size_t i = 0; i < scene->cameras.size(); ++i)
    if (same_view(scene->cameras[i], picture.camera)) scene_camera = static_cast<int>(i);
  // In another thread: it takes a second for a large scene. A running one is not waited for.
  probe_.reset();
  std::erase_if(retired_, [](auto& f) { return is_ready(f); });
  if (probing_.valid()) retired_.push_back(std::move(probing_));
  to_probe_ = std::move(scene);
  probe_next();
}

void Navigation::probe_next() {
  probed_ = std::exchange(to_probe_, nullptr);
  probing_ = std::async(std::launch::async, [s = probed_, before = probe_] {
    return before ? std::make_shared<const session::Probe>(s, *before)
                  : std::make_shared<const session::Probe>(s);
  });
}

void Navigation::follow_objects(std::shared_ptr<const scene::Scene> scene) {
  if (!probed_ || !scene) return;
  to_probe_ = scene->instances.shares_with(probed_->instances) ? nullptr : std::move(scene);
  probe();
}

bool Navigation::follow(const session::Snapshot& picture) {
  if (view && !same_view(picture.camera, view->camera)) {
    view = make_viewpoint(picture.camera, core);
    scene_camera = -1;
  }
  const std::pair now_shown(picture.width, picture.height);
  aspect = static_cast<float>(now_shown.first) / static_cast<float>(std::max(1u, now_shown.second));
  if (size_.first == 0 || size_ == now_shown) return false;
  size_ = now_shown;
  return true;
}

void Navigation::set_size(uint32_t width, uint32_t height) {
  if (size_ == std::pair(width, height)) return;
  size_ = {width, height};
  session_.set_size(width, height);
  aspect = static_cast<float>(width) / static_cast<float>(std::max(1u, height));
}

void Navigation::take_view(const Viewpoint& to, int camera) {
  scene::Camera checked = to.camera;
  checked.name.clear();  // a view that has been moved is no camera of the scene
  scene::check_range(checked);
  if (!std::isfinite(to.distance)) throw Error("camera", "what it looks at is not a finite distance away");
  const bool same = view && same_view(view->camera, to.camera);
  view = to;
  scene_camera = camera;
  if (same) return;
  session_.set_camera(to.camera, view_scene);
  ++moves_;
}

void Navigation::needs_view() const {
  if (!view) throw Error("", "there is no picture yet; wait_scene first");
}

std::string Navigation::place_line(const Viewpoint& v) {
  const vec3 eye = eye_of(v.camera), target = pivot_of(v), up = up_of(v.camera);
  std::string line =
      fmt::format("camera.place {} {} {}", vector_text(eye), vector_text(target), vector_text(up));
  if (v.camera.orthographic) line += " height=" + number_text(2 * v.camera.ymag);
  return line;
}

const session::Probe* Navigation::probe(bool wait) {
  while (probing_.valid() && (wait || is_ready(probing_))) {
    try {
      probe_ = probing_.get();
    } catch (const std::exception& error) {
      log::warning("walls will not stop the camera: {}", error.what());
    }
    if (to_probe_) probe_next();
  }
  if (!probing_.valid() && to_probe_) {
    probe_next();
    if (wait) return probe(wait);
  }
  return probe_.get();
}

Look Navigation::look_at(std::function<bool(const session::Picked&)> wanted) {
  probe();
  return [rays = probe_, wanted = std::move(wanted)](const vec3& origin, const vec3& direction,
                                                     float limit) -> std::optional<Obstacle> {
    if (!rays) return std::nullopt;
    const auto hit = rays->nearest(origin, direction, limit, wanted);
    if (!hit) return std::nullopt;
    return Obstacle{hit->distance, hit->normal};
  };
}

Look Navigation::look() { return look_at({}); }

void Navigation::follow_lights(const std::vector<scene::Light>& before,
                               const std::vector<scene::Light>& after) {
  if (selection.kind != Kind::light || before.size() == after.size()) return;
  if (selection.index >= before.size()) return;  // a new light, which the command has selected
  const scene::Id id = before[selection.index].id;
  for (uint32_t i = 0; i < after.size(); ++i)
    if (after[i].id == id) {
      selection.index = i;
      return;
    }
  selection = {};
}

Look Navigation::look_past_selection() {
  return look_at([chosen = selection](const session::Picked& p) {
    return !(chosen.kind == Kind::instance && p.instance == chosen.index) &&
           !(chosen.kind == Kind::material && p.material == chosen.index);
  });
}

namespace {

/// Key of a scene's bookmarks: its file, the same from any folder.
std::string bookmarks_key(const scene::Scene& scene) {
  return scene.file.empty() ? "" : absolute_path(scene.file).string();
}

}  // namespace

const Navigation::Bookmarks& Navigation::bookmarks_of(const scene::Scene* scene) const {
  static const Bookmarks none;
  if (!scene) return none;
  const auto found = bookmarks.find(bookmarks_key(*scene));
  return found == bookmarks.end() ? none : found->second;
}

Navigation::Bookmarks& Navigation::bookmarks_of(const scene::Scene& scene) {
  return bookmarks[bookmarks_key(scene)];
}

Box selection_bounds(const scene::Scene* scene, const std::vector<scene::Light>& lights,
                     const Selection& selection, const Box& core) {
  Box box;
  if (!scene) return box;
  const auto add = [&](const scene::Instance& instance, auto&& wanted) {
    if (instance.mesh >= scene->meshes.size() || (instance.hidden && selection.kind == Kind::material))
      return;
    for (const scene::Primitive& primitive : scene->meshes[instance.mesh].primitives)
      if (wanted(primitive))
        for (const vec3& p : primitive.positions) box.grow(vec3(instance.to_world * vec4(p, 1)));
  };
  switch (selection.kind) {
    case Kind::none:
      return core;
    case Kind::material:
      for (const scene::Instance& instance : scene->instances)
        add(instance, [&](const scene::Primitive& p) { return p.material == selection.index; });
      break;
    case Kind::instance:
      if (selection.index < scene->instances.size())
        add(scene->instances[selection.index], [](const scene::Primitive&) { return true; });
      break;
    case Kind::light:
      if (selection.index < lights.size() && lights[selection.index].kind != scene::LightKind::directional) {
        const vec2 half = half_size(lights[selection.index]);
        const float reach = std::max({0.05f * std::max(core.radius(), 1e-3f), 2 * half.x, 2 * half.y});
        box.grow(lights[selection.index].position - vec3(reach));
        box.grow(lights[selection.index].position + vec3(reach));
      }
      break;
  }
  return box.empty() ? core : box;
}

std::string selection_name(const scene::Scene* scene, const std::vector<scene::Light>& lights,
                           const Selection& selection) {
  if (!scene) return "";
  switch (selection.kind) {
    case Kind::material:
      return scene->materials[selection.index].name;
    case Kind::instance:
      return scene->instances[selection.index].name;
    case Kind::light:
      return selection.index < lights.size() ? lights[selection.index].name : "";
    case Kind::none:
      break;
  }
  return "";
}

}  // namespace lucerna::commands
