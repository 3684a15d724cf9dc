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
#include "scene/core.h"
#include "scene/range.h"

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
  // The scene and the settings were taken after the snapshot: they hold what it counts.
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
    // Settings that are given by name act on the scene that comes, whatever it brings.
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

Line Workspace::run(const std::string& text, uint64_t gesture, const std::string& where) {
  const Line line = registry.parse(text, where);
  if (!line.command) return line;
  const uint64_t before = session.commands();
  carry_out(line, gesture, where);
  note_sent(before, text, line.command->moves);
  return line;
}

void Workspace::note_sent(uint64_t before, const std::string& line, bool moves) {
  constexpr size_t k_kept = 200;
  const uint64_t now_given = session.commands();
  if (now_given > before)
    given_by_.push_back({before + 1, now_given, line});
  else if (moves && !given_by_.empty() && given_by_.back().last == now_given)
    given_by_.back().line = line;  // the camera has taken the number of the one before
  if (given_by_.size() > k_kept) given_by_.pop_front();
}

std::string Workspace::line_of(uint64_t command) const {
  for (const GivenBy& given : given_by_)
    if (given.first <= command && command <= given.last) return given.line;
  return "";
}

void Workspace::carry_out(const Line& line, uint64_t gesture, const std::string& where) {
  const auto located = [&](auto&& act) {
    try {
      act();
    } catch (const std::exception& error) {
      working_.reset();
      const std::string what = error.what();
      const std::string head = line.command->name + ": ";
      throw Error(where, what.starts_with(head) ? what : head + what);
    }
  };
  const uint64_t first = session.commands(), moves = moves_;
  if (!line.command->undoable) {
    const std::optional<Viewpoint> view_before = view;
    const int camera_before = scene_camera;
    located([&] { line.command->run(line.arguments); });
    const Sent sent = sent_since(first, moves);
    if (line.command->moves && view_before) note_move(line, gesture, *view_before, camera_before, sent);
    record(line, gesture, sent);
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
  const Sent sent = sent_since(first, moves);
  if (merges)
    undo_.back().after = after, undo_.back().line = registry.print(line),
    undo_.back().sent.last = std::max(undo_.back().sent.last, sent.last);
  else if (after != now_seen)
    undo_.push_back({registry.print(line), target, gesture, now_seen, after, sent});
  else if (!asked)
    return;
  if (undo_.size() > k_steps) undo_.erase(undo_.begin());
  redo_.clear();
  record(line, gesture, sent);
}

Workspace::Sent Workspace::sent_since(uint64_t before, uint64_t moves) const {
  Sent sent{before + 1, session.commands()};
  // A camera may have taken the number of the one before.
  if (sent.last < sent.first && moves_ != moves) sent.first = sent.last;
  return sent;
}

void Workspace::note_move(const Line& line, uint64_t gesture, const Viewpoint& before, int camera_before,
                          const Sent& sent) {
  if (!view || (same_view(before.camera, view->camera) && before.distance == view->distance &&
                camera_before == scene_camera))
    return;
  const std::string target = registry.target(line);
  if (gesture != 0 && !undo_.empty() && undo_.back().gesture == gesture && undo_.back().move) {
    Step& step = undo_.back();
    step.move->after = *view, step.move->camera_after = scene_camera;
    step.line = registry.print(line), step.target = target;
    step.sent.last = std::max(step.sent.last, sent.last);
  } else {
    undo_.push_back({registry.print(line),
                     target,
                     gesture,
                     {},
                     {},
                     sent,
                     Step::Move{before, *view, camera_before, scene_camera}});
    if (undo_.size() > k_steps) undo_.erase(undo_.begin());
  }
  redo_.clear();
}

void Workspace::take_view(const Viewpoint& to, int camera) {
  scene::Camera checked = to.camera;
  checked.name.clear();  // a view that has been moved is no camera of the scene
  scene::check_range(checked);
  if (!std::isfinite(to.distance)) throw Error("camera", "what it looks at is not a finite distance away");
  const bool same = view && same_view(view->camera, to.camera);
  view = to;
  scene_camera = camera;
  if (same) return;
  session.set_camera(to.camera, view_scene);
  ++moves_;
}

void Workspace::undo() {
  if (undo_.empty()) throw Error("", "there is nothing to undo");
  Step step = std::move(undo_.back());
  undo_.pop_back();
  touched_.clear();
  if (step.move)
    take_view(step.move->before, step.move->camera_before);
  else
    send(document(), step.before);
  step.gesture = 0, step.sent = {};
  redo_.push_back(std::move(step));
}

void Workspace::redo() {
  if (redo_.empty()) throw Error("", "there is nothing to do again");
  const uint64_t first = session.commands(), moves = moves_;
  Step step = std::move(redo_.back());
  redo_.pop_back();
  touched_.clear();
  if (step.move)
    take_view(step.move->after, step.move->camera_after);
  else
    send(document(), step.after);
  step.sent = sent_since(first, moves);
  undo_.push_back(std::move(step));
}

void Workspace::record(const Line& line, uint64_t gesture, const Sent& sent) {
  if (!line.command->recorded) return;
  Recorded entry{line.command->name, registry.target(line), gesture, {}, sent};
  const bool writes = std::any_of(line.command->parameters.begin(), line.command->parameters.end(),
                                  [](const Parameter& p) { return p.writes; });
  if (writes) entry.saved = saved_;
  // Files are named so that the script works from any folder.
  for (const Parameter& p : line.command->parameters) {
    if (!line.arguments.has(p.name)) continue;
    std::string value = line.arguments.text(p.name);
    if (p.type == Type::file) value = absolute_path(value).string();
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
  if (is_plain_file(file) && !read_file(file).starts_with(k_script_head))
    throw Error(file, "is there already and no saved session: another name is needed");
  std::string text = k_script_head;
  for (const std::string& line : script()) text += line + '\n';
  write_file(file, text);
}

void Workspace::record_wait() {
  if (!up_to_date() || snapshot->samples == 0) return;
  if (!recorded_.empty() && recorded_.back().line.starts_with("wait_samples ")) recorded_.pop_back();
  Recorded wait{line("wait_samples", snapshot->samples, named("limit", 86400)), "wait_samples"};
  // A picture that rests has the samples that it had when it was stopped: the wait before that is for them.
  if (snapshot->paused) {
    const auto pause = std::find_if(recorded_.rbegin(), recorded_.rend(),
                                    [](const Recorded& entry) { return entry.line == "render.pause"; });
    if (pause != recorded_.rend() && std::next(pause) != recorded_.rend() &&
        std::next(pause)->target == "wait_samples")
      *std::next(pause) = wait;
  }
  // Who saves the same picture twice has waited once.
  const auto before = std::find_if(recorded_.rbegin(), recorded_.rend(), [](const Recorded& entry) {
    return !entry.line.starts_with("image.save ");
  });
  if (before == recorded_.rend() || before->line != wait.line) recorded_.push_back(std::move(wait));
}

bool Workspace::saved() const {
  if (saved_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
  if (failed(saved_)) throw Error("", "nothing was written");
  return true;
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
