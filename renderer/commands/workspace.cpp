#include "commands/workspace.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <tuple>

#include "base/error.h"
#include "base/file.h"
#include "base/log.h"
#include "commands/refusal.h"
#include "commands/session_saves.h"
#include "scene/core.h"
#include "scene/range.h"

namespace lucerna::commands {
namespace {

/// As the scene knows it.
Document::Material seen(Document::Material m) {
  if (!m.emits) m.emission = vec3(0);
  m.emits = true;
  return m;
}

}  // namespace

Document::Light Document::of(const scene::Light& l) {
  return {l.intensity, l.enabled, l.position, l.direction, l.inner_cone, l.outer_cone};
}

void Document::Light::put(scene::Light& light) const {
  light.intensity = intensity, light.enabled = enabled;
  light.position = position, light.direction = direction;
  light.inner_cone = inner_cone, light.outer_cone = outer_cone;
}

Document::Material Document::of(const scene::Material& m) {
  return {vec3(m.base_color), m.roughness, m.metallic, m.emission, true};
}

const char* kind_name(Kind kind) {
  static const char* names[] = {"none", "material", "object", "light"};
  return names[static_cast<size_t>(kind)];
}

Workspace::Workspace(session::Session& s) : session(s) {
  add_document_commands();
  add_camera_commands();
  add_selection_commands();
  add_interior_commands();
  add_bookmark_commands();
  add_exposure_commands();
  add_mix_commands();
  add_scene_commands();
  add_render_commands();
  add_script_commands();
  add_wait_commands();
  add_inspect_commands();
  add_solver_commands();
}

void Workspace::refresh(double time) {
  now = time;
  // The state after the snapshot: a picture's scene is then never newer than the one held here.
  snapshot = session.snapshot();
  session::State state = session.state();
  scene = std::move(state.scene), known_ = std::move(state.settings), scene_id_ = state.scene_id;
  drop_refused();
  drop_taken();
  follow_scene();
  follow_picture();
  if (snapshot && snapshot->commands >= opened_by_ && snapshot->scene_id == scene_id_) {
    const bool no_picture = snapshot->paused && snapshot->rgba.empty();  // drawing it has failed
    if (view_scene == scene_id_ || no_picture) opened_by_ = 0;
  }
  take_measure();
  take_written();
}

void Workspace::take_written() {
  std::erase_if(writing_, [&](const Writing& w) {
    if (w.saved.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
    if (!failed(w.saved)) written(w.name);
    return true;
  });
}

void Workspace::drop_refused() {
  if (!snapshot || !snapshot->refused) return;
  for (; refused_seen_ < snapshot->refused->size(); ++refused_seen_) {
    const uint64_t number = (*snapshot->refused)[refused_seen_];
    if (number == opened_by_) open_failed_ = true;
    // A file that cannot be read lights nothing.
    if (std::erase_if(environments_sent_, [&](const auto& sent) { return sent.first == number; }) > 0)
      environment_file_ =
          environments_sent_.empty() ? environment_in_force_ : environments_sent_.back().second;
    std::vector<Step> gone;
    for (std::vector<Step>* steps : {&undo_, &redo_})
      std::erase_if(*steps, [&](Step& step) {
        const bool refused = step.sent.refuse(number);
        if (refused && !step.move) gone.push_back(step);
        return refused;
      });
    // Steps that were made before the refusal was known hold the change, too.
    for (const Step& refused : gone)
      for (std::vector<Step>* steps : {&undo_, &redo_})
        for (Step& step : *steps)
          for (Document* d : {&step.before, &step.after})
            if (!step.move) take_back(*d, refused.before, refused.after);
    std::erase_if(recorded_, [&](Recorded& entry) { return entry.sent.refuse(number); });
  }
}

void Workspace::drop_taken() {
  // Scene and settings were read after the snapshot: they include what it counts.
  const auto over = [&](uint64_t sent) { return snapshot && snapshot->commands >= sent; };
  std::erase_if(pending_, [&](const auto& entry) { return over(entry.second.sent); });
  std::erase_if(pending_lights_, [&](const auto& entry) {
    return !scene || entry.first >= scene->lights.size() || over(entry.second.sent);
  });
  std::erase_if(pending_materials_, [&](const auto& entry) {
    return !scene || entry.first >= scene->materials.size() || over(entry.second.sent);
  });
  std::erase_if(environments_sent_, [&](const auto& sent) {
    if (over(sent.first)) environment_in_force_ = sent.second;
    return over(sent.first);
  });
  if (pending_environment_ && (!scene || over(pending_environment_->sent))) pending_environment_.reset();
}

void Workspace::follow_scene() {
  if (!snapshot || !scene || snapshot->scene_id == view_scene || snapshot->rgba.empty()) return;
  if (snapshot->scene_id != scene_id_) return;  // the next one is there already, without a picture
  view_scene = snapshot->scene_id;
  core = scene::core_bounds(*scene);
  view = make_viewpoint(snapshot->camera, core);
  speed = walking_speed(view->extent);
  selection = {};
  pending_lights_.clear(), pending_materials_.clear(), pending_environment_.reset();
  own_environment_ = {scene->environment.scale, scene->environment.rotation};
  undo_.clear(), redo_.clear();
  dark_.clear(), environment_file_.clear(), environment_in_force_.clear(), environments_sent_.clear();
  walking = false;
  // In another thread: it takes a second for a large scene. A running one is not waited for.
  probe_.reset();
  std::erase_if(retired_,
                [](auto& f) { return f.wait_for(std::chrono::seconds(0)) == std::future_status::ready; });
  if (probing_.valid()) retired_.push_back(std::move(probing_));
  probing_ =
      std::async(std::launch::async, [s = scene] { return std::make_shared<const session::Probe>(s); });
  measuring_.reset();
  const bool sets_exposure = std::any_of(scene->settings.begin(), scene->settings.end(),
                                         [](const auto& setting) { return setting.first == "film.ev"; });
  exposure_due_ = sets_exposure || std::exchange(exposure_given_, false) ? 0 : view_scene;
  solo_ = -1;
  scene_camera = -1;
  for (size_t i = 0; i < scene->cameras.size(); ++i)
    if (same_view(scene->cameras[i], snapshot->camera)) scene_camera = static_cast<int>(i);
  if (loading()) recorded_.push_back({"wait_scene", "wait_scene"});
  scene_changed();
}

void Workspace::follow_picture() {
  if (!up_to_date() || snapshot->rgba.empty() || snapshot->scene_id != view_scene) return;
  if (view && !same_view(snapshot->camera, view->camera)) {
    view = make_viewpoint(snapshot->camera, core);
    scene_camera = -1;
  }
  const std::pair now_shown(snapshot->width, snapshot->height);
  aspect = static_cast<float>(now_shown.first) / static_cast<float>(std::max(1u, now_shown.second));
  if (size_.first != 0 && size_ != now_shown) {
    size_ = now_shown;
    size_refused(now_shown.first, now_shown.second);
  }
}

void Workspace::set_size(uint32_t width, uint32_t height) {
  if (size_ == std::pair(width, height)) return;
  size_ = {width, height};
  session.set_size(width, height);
  aspect = static_cast<float>(width) / static_cast<float>(std::max(1u, height));
}

Document Workspace::document() const {
  Document d;
  d.settings = known_.all();
  for (const auto& [key, edit] : pending_) d.settings[key] = edit.value;
  if (scene)
    for (uint32_t i = 0; i < scene->lights.size(); ++i) d.lights.push_back(Document::of(light(i)));
  if (scene)
    for (uint32_t i = 0; i < scene->materials.size(); ++i) {
      d.materials.push_back(Document::of(material(i)));
      d.materials.back().emission = emission(i), d.materials.back().emits = emits(i);
    }
  std::tie(d.environment_scale, d.environment_rotation) = environment_();
  d.environment_file = environment_file_;
  d.solo = solo_;
  d.shown_before = shown_before_;
  return d;
}

const std::string& Workspace::setting(const std::string& key) const {
  const auto found = pending_.find(key);
  return found != pending_.end() ? found->second.value : known_.text(key);
}

double Workspace::setting_real(const std::string& key) const {
  double value = 0;
  read_number(setting(key), value);
  return value;
}

scene::Light Workspace::light(uint32_t index) const {
  scene::Light light = scene->lights.at(index);
  if (const auto found = pending_lights_.find(index); found != pending_lights_.end())
    found->second.value.put(light);
  return light;
}

scene::Material Workspace::material(uint32_t index) const {
  scene::Material m = scene->materials.at(index);
  if (const auto found = pending_materials_.find(index); found != pending_materials_.end()) {
    const Document::Material& edit = found->second.value;
    m.base_color = vec4(edit.color, m.base_color.w);
    m.roughness = edit.roughness, m.metallic = edit.metallic, m.emission = edit.emission;
  }
  return m;
}

vec3 Workspace::emission(uint32_t index) const {
  const auto found = dark_.find(index);
  return found != dark_.end() ? found->second : material(index).emission;
}

std::pair<float, float> Workspace::environment_() const {
  if (pending_environment_) return {pending_environment_->scale, pending_environment_->rotation};
  if (scene) return {scene->environment.scale, scene->environment.rotation};
  return {1, 0};
}

Document& Workspace::edit() {
  assert(working_ && "only commands marked undoable change the document");
  return *working_;
}

bool Workspace::send_lights(const Document& before, const Document& after) {
  static const std::string key = "relight.mix";
  // All the rest, with the lights as they were.
  Document rest = after;
  rest.settings[key] = before.settings.at(key);
  if (!scene || rest == before || rest.settings != before.settings || loading()) return false;
  session::LightsEdit edit{
      .lights = {}, .materials = {}, .environment_scale = {}, .mix = after.settings.at(key)};
  if (rest.lights.size() != before.lights.size() || rest.materials.size() != before.materials.size())
    return false;
  for (uint32_t i = 0; i < rest.lights.size(); ++i) {
    if (rest.lights[i] == before.lights[i]) continue;
    edit.lights.emplace_back(i, light(i));
    after.lights[i].put(edit.lights.back().second);
    rest.lights[i].intensity = before.lights[i].intensity, rest.lights[i].enabled = before.lights[i].enabled;
  }
  for (uint32_t i = 0; i < rest.materials.size(); ++i) {
    if (rest.materials[i] == before.materials[i]) continue;
    edit.materials.emplace_back(i, material(i));
    edit.materials.back().second.emission = seen(after.materials[i]).emission;
    rest.materials[i].emission = before.materials[i].emission;
    rest.materials[i].emits = before.materials[i].emits;
  }
  if (rest.environment_scale != before.environment_scale) edit.environment_scale = rest.environment_scale;
  rest.environment_scale = before.environment_scale;
  if (rest != before) return false;
  session.set_lights(edit, scene_id_);
  const uint64_t sent = session.commands();
  pending_[key] = {edit.mix, sent};
  for (const auto& [i, l] : edit.lights) pending_lights_[i] = {after.lights[i], sent};
  for (const auto& [i, m] : edit.materials) {
    pending_materials_[i] = {seen(after.materials[i]), sent};
    if (after.materials[i].emits)
      dark_.erase(i);
    else
      dark_[i] = after.materials[i].emission;
  }
  pending_environment_ = PendingEnvironment{after.environment_scale, after.environment_rotation, sent};
  return true;
}

void Workspace::send(const Document& before, const Document& after) {
  if (before.settings.at("relight.mix") != after.settings.at("relight.mix") && send_lights(before, after))
    return;
  for (const auto& [key, value] : after.settings) {
    const auto old = before.settings.find(key);
    // Settings given on the command line apply to the next scene, whatever it sets.
    const bool named = std::find(touched_.begin(), touched_.end(), key) != touched_.end();
    if (!(named && loading()) && old != before.settings.end() && old->second == value) continue;
    session.set(key, value, named ? session::k_any_scene : scene_id_);
    pending_[key] = {value, session.commands()};
  }
  if (scene)
    for (uint32_t i = 0; i < std::min(after.lights.size(), scene->lights.size()); ++i) {
      if (i < before.lights.size() && before.lights[i] == after.lights[i]) continue;
      pending_lights_[i] = {after.lights[i], 0};
      session.set_light(i, light(i), scene_id_);
      pending_lights_[i].sent = session.commands();
    }
  if (scene)
    for (uint32_t i = 0; i < std::min(after.materials.size(), scene->materials.size()); ++i) {
      if (i < before.materials.size() && before.materials[i] == after.materials[i]) continue;
      if (after.materials[i].emits)
        dark_.erase(i);
      else
        dark_[i] = after.materials[i].emission;
      if (i < before.materials.size() && seen(before.materials[i]) == seen(after.materials[i])) continue;
      pending_materials_[i] = {seen(after.materials[i]), 0};
      session.set_material(i, material(i), scene_id_);
      pending_materials_[i].sent = session.commands();
    }
  const bool other_file = before.environment_file != after.environment_file;
  if (other_file || before.environment_scale != after.environment_scale ||
      before.environment_rotation != after.environment_rotation) {
    const float scale = after.environment_scale, rotation = after.environment_rotation;
    if (other_file)
      session.set_environment_file(after.environment_file, scale, rotation, scene_id_);
    else
      session.set_environment(scale, rotation, scene_id_);
    pending_environment_ = PendingEnvironment{scale, rotation, session.commands()};
    if (other_file) {
      environment_file_ = after.environment_file;
      environments_sent_.emplace_back(session.commands(), environment_file_);
    }
  }
  solo_ = after.solo;
  shown_before_ = after.shown_before;
}

const session::Probe* Workspace::probe(bool wait) {
  if (probing_.valid() && (wait || probing_.wait_for(std::chrono::seconds(0)) == std::future_status::ready)) {
    try {
      probe_ = probing_.get();
    } catch (const std::exception& error) {
      log::warning("walls will not stop the camera: {}", error.what());
    }
  }
  return probe_.get();
}

Look Workspace::look_at(std::function<bool(const session::Picked&)> wanted) {
  probe();
  return [rays = probe_, wanted = std::move(wanted)](const vec3& origin, const vec3& direction,
                                                     float limit) -> std::optional<Obstacle> {
    if (!rays) return std::nullopt;
    const auto hit = rays->nearest(origin, direction, limit, wanted);
    if (!hit) return std::nullopt;
    return Obstacle{hit->distance, hit->normal};
  };
}

Look Workspace::look() { return look_at({}); }

Look Workspace::look_past_selection() {
  return look_at([chosen = selection](const session::Picked& p) {
    return !(chosen.kind == Kind::instance && p.instance == chosen.index) &&
           !(chosen.kind == Kind::material && p.material == chosen.index);
  });
}

Box Workspace::selection_bounds() const {
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
      if (selection.index < scene->lights.size() &&
          scene->lights[selection.index].kind != scene::LightKind::directional) {
        const float reach = 0.05f * std::max(core.radius(), 1e-3f);
        box.grow(scene->lights[selection.index].position - vec3(reach));
        box.grow(scene->lights[selection.index].position + vec3(reach));
      }
      break;
  }
  return box.empty() ? core : box;
}

std::string Workspace::selection_name() const {
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

}  // namespace lucerna::commands
