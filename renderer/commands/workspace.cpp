#include "commands/workspace.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <filesystem>
#include <tuple>

#include "base/error.h"
#include "base/file.h"
#include "base/log.h"

namespace lucerna::commands {
namespace {

constexpr size_t k_steps = 500;  // that can be undone
const std::string k_script_head =
    "# What was done in a session of Lucerna; lucerna --script FILE does it again.\n";

/// Whether a file that was to be written will never be.
bool failed(const session::Saved& saved) {
  if (!saved.valid() || saved.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
  try {
    saved.get();
    return false;
  } catch (const std::exception&) {
    return true;
  }
}

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
  // The scene after the snapshot: a picture's scene is then never newer than the one held here.
  snapshot = session.snapshot();
  scene = session.scene();
  known_ = session.settings();
  drop_taken();
  follow_scene();
  if (opening_ && snapshot && snapshot->commands >= opened_by_ && snapshot->scene_id == scene_at_open_) {
    opening_ = false, open_failed_ = true;
    forget_open();
  }
  take_measure();
}

void Workspace::drop_taken() {
  // The scene and the settings were taken after the snapshot: they hold what it counts.
  const auto over = [&](uint64_t sent) { return snapshot && snapshot->commands >= sent; };
  std::erase_if(pending_, [&](const auto& entry) { return over(entry.second.sent); });
  std::erase_if(pending_lights_, [&](const auto& entry) {
    return !scene || entry.first >= scene->lights.size() || over(entry.second.sent);
  });
  std::erase_if(pending_materials_, [&](const auto& entry) {
    return !scene || entry.first >= scene->materials.size() || over(entry.second.sent);
  });
  // A file that could not be read lights nothing.
  if (environment_sent_ != 0 && over(environment_sent_)) {
    environment_sent_ = 0;
    if (scene && !environment_file_.empty() && scene->environment.file != environment_file_)
      environment_file_.clear();
  }
  if (pending_environment_ && (!scene || over(pending_environment_->sent))) pending_environment_.reset();
}

void Workspace::follow_scene() {
  if (!snapshot || !scene || snapshot->scene_id == view_scene || snapshot->rgba.empty()) return;
  view_scene = snapshot->scene_id;
  bounds = scene::bounds(*scene);
  view = make_viewpoint(snapshot->camera, bounds);
  speed = walking_speed(view->extent);
  selection = {};
  pending_lights_.clear(), pending_materials_.clear(), pending_environment_.reset();
  undo_.clear(), redo_.clear();
  dark_.clear(), environment_file_.clear(), environment_sent_ = 0;
  walking = false;
  // Beside the window: it is a second's work in a large scene. One that is still at work is not waited for.
  probe_.reset();
  std::erase_if(retired_,
                [](auto& f) { return f.wait_for(std::chrono::seconds(0)) == std::future_status::ready; });
  if (probing_.valid()) retired_.push_back(std::move(probing_));
  probing_ =
      std::async(std::launch::async, [s = scene] { return std::make_shared<const session::Probe>(s); });
  measuring_.reset();
  const bool brings = std::any_of(scene->settings.begin(), scene->settings.end(),
                                  [](const auto& setting) { return setting.first == "film.ev"; });
  exposure_due_ = brings || std::exchange(exposure_given_, false) ? 0 : view_scene;
  solo_ = -1;
  scene_camera = -1;
  for (size_t i = 0; i < scene->cameras.size(); ++i)
    if (same_view(scene->cameras[i], snapshot->camera)) scene_camera = static_cast<int>(i);
  camera_moved = false;
  if (opening_ && snapshot->scene_id != scene_at_open_) {
    opening_ = false;
    recorded_.push_back({"wait_scene", "wait_scene"});
  }
  scene_changed();
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

void Workspace::send(const Document& before, const Document& after) {
  for (const auto& [key, value] : after.settings) {
    const auto old = before.settings.find(key);
    // While a scene is being loaded nobody knows what its settings will be: what was asked for is sent.
    const bool asked = loading() && std::find(touched_.begin(), touched_.end(), key) != touched_.end();
    if (!asked && old != before.settings.end() && old->second == value) continue;
    session.set(key, value);
    pending_[key] = {value, session.commands()};
  }
  if (scene)
    for (uint32_t i = 0; i < std::min(after.lights.size(), scene->lights.size()); ++i) {
      if (i < before.lights.size() && before.lights[i] == after.lights[i]) continue;
      pending_lights_[i] = {after.lights[i], 0};
      session.set_light(i, light(i));
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
      session.set_material(i, material(i));
      pending_materials_[i].sent = session.commands();
    }
  if (before.environment_file != after.environment_file) {
    environment_file_ = after.environment_file;
    session.set_environment_file(environment_file_);
    environment_sent_ = session.commands();
  }
  if (before.environment_scale != after.environment_scale ||
      before.environment_rotation != after.environment_rotation) {
    session.set_environment(after.environment_scale, after.environment_rotation);
    pending_environment_ =
        PendingEnvironment{after.environment_scale, after.environment_rotation, session.commands()};
  }
  solo_ = after.solo;
  shown_before_ = after.shown_before;
}

Line Workspace::run(const std::string& text, uint64_t gesture, const std::string& where) {
  const Line line = registry.parse(text, where);
  if (!line.command) return line;
  const uint64_t before = session.commands();
  carry_out(line, gesture, where);
  // The camera is sent a little later.
  if (session.commands() > before || line.command->moves) sent_line_ = text;
  return line;
}

void Workspace::carry_out(const Line& line, uint64_t gesture, const std::string& where) {
  const auto located = [&](auto&& act) {
    try {
      act();
    } catch (const Error& error) {
      working_.reset();
      const std::string what = error.what();
      const std::string head = line.command->name + ": ";
      throw Error(where, what.starts_with(head) ? what : head + what);
    }
  };
  if (!line.command->undoable) {
    const std::optional<Viewpoint> view_before = view;
    const int camera_before = scene_camera;
    located([&] { line.command->run(line.arguments); });
    if (line.command->moves && view_before) note_move(line, gesture, *view_before, camera_before);
    record(line, gesture);
    return;
  }
  const std::string target = registry.target(line);
  const bool merges = gesture != 0 && !undo_.empty() && undo_.back().gesture == gesture &&
                      undo_.back().target == target && !undo_.back().move;
  const Document now_seen = document();
  // A step of a drag starts from where the drag began, so that the last step alone gives the same.
  working_ = merges ? undo_.back().before : now_seen;
  touched_.clear();
  located([&] { line.command->run(line.arguments); });
  const Document after = std::move(*working_);
  working_.reset();
  send(now_seen, after);
  const bool asked = loading() && !touched_.empty();
  if (merges)
    undo_.back().after = after, undo_.back().line = registry.print(line);
  else if (after != now_seen)
    undo_.push_back({registry.print(line), target, gesture, now_seen, after});
  else if (!asked)
    return;
  if (undo_.size() > k_steps) undo_.erase(undo_.begin());
  redo_.clear();
  record(line, gesture);
}

void Workspace::note_move(const Line& line, uint64_t gesture, const Viewpoint& before, int camera_before) {
  if (!view || (same_view(before.camera, view->camera) && before.distance == view->distance &&
                camera_before == scene_camera))
    return;
  const std::string target = registry.target(line);
  if (gesture != 0 && !undo_.empty() && undo_.back().gesture == gesture && undo_.back().move) {
    Step& step = undo_.back();
    step.move->after = *view, step.move->camera_after = scene_camera;
    step.line = registry.print(line), step.target = target;
  } else {
    undo_.push_back({registry.print(line),
                     target,
                     gesture,
                     {},
                     {},
                     Step::Move{before, *view, camera_before, scene_camera}});
    if (undo_.size() > k_steps) undo_.erase(undo_.begin());
  }
  redo_.clear();
}

void Workspace::show(const Viewpoint& to, int camera) {
  view = to;
  moved();
  scene_camera = camera;
}

void Workspace::undo() {
  if (undo_.empty()) throw Error("", "there is nothing to undo");
  Step step = std::move(undo_.back());
  undo_.pop_back();
  touched_.clear();
  if (step.move)
    show(step.move->before, step.move->camera_before);
  else
    send(document(), step.before);
  step.gesture = 0;
  redo_.push_back(std::move(step));
}

void Workspace::redo() {
  if (redo_.empty()) throw Error("", "there is nothing to do again");
  Step step = std::move(redo_.back());
  redo_.pop_back();
  touched_.clear();
  if (step.move)
    show(step.move->after, step.move->camera_after);
  else
    send(document(), step.after);
  undo_.push_back(std::move(step));
}

void Workspace::record(const Line& line, uint64_t gesture) {
  if (!line.command->recorded) return;
  Recorded entry{line.command->name, registry.target(line), gesture};
  const bool writes = std::any_of(line.command->parameters.begin(), line.command->parameters.end(),
                                  [](const Parameter& p) { return p.writes; });
  if (writes) entry.saved = saved_;
  // Files are named so that the script works from any folder.
  for (const Parameter& p : line.command->parameters) {
    if (!line.arguments.has(p.name)) continue;
    std::string value = line.arguments.text(p.name);
    if (p.type == Type::file) value = std::filesystem::absolute(value).lexically_normal().string();
    entry.line += " " + (p.optional ? p.name + "=" : "") + quote(value);
  }
  if (gesture != 0 && !recorded_.empty() && recorded_.back().gesture == gesture &&
      recorded_.back().target == entry.target)
    recorded_.back() = std::move(entry);
  else
    recorded_.push_back(std::move(entry));
}

std::vector<std::string> Workspace::script() const {
  std::vector<std::string> lines;
  for (const Recorded& entry : recorded_)
    if (!failed(entry.saved)) lines.push_back(entry.line);
  return lines;
}

void Workspace::save_script(const std::string& file) const {
  if (std::error_code error;
      std::filesystem::exists(file, error) && !read_file(file).starts_with(k_script_head))
    throw Error(file, "is there already and no saved session: another name is needed");
  std::string text = k_script_head;
  for (const std::string& line : script()) text += line + '\n';
  write_file(file, text);
}

void Workspace::record_wait() {
  if (!up_to_date() || snapshot->samples == 0) return;
  if (!recorded_.empty() && recorded_.back().line.starts_with("wait_samples ")) recorded_.pop_back();
  Recorded wait{line("wait_samples", snapshot->samples, named("limit", 86400)), "wait_samples"};
  // Who saves the same picture twice has waited once.
  const auto before = std::find_if(recorded_.rbegin(), recorded_.rend(), [](const Recorded& entry) {
    return !entry.line.starts_with("image.save ");
  });
  if (before == recorded_.rend() || before->line != wait.line) recorded_.push_back(std::move(wait));
}

void Workspace::forget_open() {
  const auto last = std::find_if(recorded_.rbegin(), recorded_.rend(),
                                 [](const Recorded& entry) { return entry.line.starts_with("scene.open "); });
  if (last != recorded_.rend()) recorded_.erase(std::next(last).base());
}

bool Workspace::saved() const {
  if (saved_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
  if (failed(saved_)) throw Error("", "nothing was written");
  return true;
}

void Workspace::send_camera() {
  if (!camera_moved || !view) return;
  camera_moved = false;
  session.set_camera(view->camera);
}

void Workspace::moved() {
  camera_moved = true;
  scene_camera = -1;
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
