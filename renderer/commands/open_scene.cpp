#include "commands/open_scene.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <tuple>

#include "base/error.h"
#include "commands/refusal.h"
#include "commands/text.h"
#include "plan/choose.h"
#include "plan/views.h"
#include "solvers/registry.h"

namespace lucerna::commands {

using solvers::SolverInfo;

std::vector<uint64_t> OpenScene::refresh() {
  // The state after the snapshot: a picture's scene is then never newer than the one held here.
  snapshot = session.snapshot();
  session::State state = session.state();
  scene = std::move(state.scene), loaded = std::move(state.loaded), known_ = std::move(state.settings),
  id_ = state.scene_id;
  std::vector<uint64_t> refused = take_refused();
  drop_executed();
  return refused;
}

std::vector<uint64_t> OpenScene::take_refused() {
  std::vector<uint64_t> numbers;
  if (!snapshot || !snapshot->refused) return numbers;
  for (; refused_seen_ < snapshot->refused->size(); ++refused_seen_) {
    const uint64_t number = (*snapshot->refused)[refused_seen_];
    numbers.push_back(number);
    if (number == loaded_by_) load_failed_ = true;
    // A file that cannot be read lights nothing.
    if (std::erase_if(sources_sent_, [&](const auto& sent) { return sent.first == number; }) > 0)
      source_ = sources_sent_.empty() ? source_in_force_ : sources_sent_.back().second;
    for (const SentObjects& sent : objects_sent_)
      if (sent.number == number) take_back(objects_, sent.before, sent.after);
  }
  return numbers;
}

void OpenScene::drop_executed() {
  // Scene and settings were read after the snapshot: they include what it counts.
  const auto over = [&](uint64_t sent) { return snapshot && snapshot->commands >= sent; };
  std::erase_if(pending_, [&](const auto& entry) { return over(entry.second.sent); });
  if (pending_lights_ && (!scene || over(pending_lights_->sent))) pending_lights_.reset();
  std::erase_if(pending_materials_, [&](const auto& entry) {
    return !scene || entry.first >= scene->materials.size() || over(entry.second.sent);
  });
  std::erase_if(sources_sent_, [&](const auto& sent) {
    if (over(sent.first)) source_in_force_ = sent.second;
    return over(sent.first);
  });
  if (pending_environment_ && (!scene || over(pending_environment_->sent))) pending_environment_.reset();
  std::erase_if(objects_sent_, [&](const SentObjects& sent) { return over(sent.number); });
}

void OpenScene::begin_scene() {
  pending_lights_.reset(), pending_materials_.clear(), pending_environment_.reset();
  own_environment_ = {scene->environment.scale, scene->environment.rotation};
  dark_.clear(), sources_sent_.clear();
  objects_.clear(), objects_sent_.clear(), boxes_.clear();
  areas_.clear(), areas_in_ = {};
  for (uint32_t i = 0; i < scene->materials.size(); ++i)
    if (const vec3 off = scene->materials[i].off_emission; off != vec3(0)) dark_[i] = off;
  source_ = source_in_force_ = {};
  next_light_id_ = scene::k_first_added;
  solo_ = -1;
}

void OpenScene::load(const std::string& file, bool outside, bool choose) {
  load_failed_ = false;
  session.load(file, outside, choose);
  loaded_by_ = session.commands();
}

void OpenScene::follow_load(bool shown) {
  if (!snapshot || snapshot->commands < loaded_by_ || snapshot->scene_id != id_) return;
  const bool no_picture = snapshot->paused && snapshot->rgba.empty();  // drawing it has failed
  if (shown || no_picture) loaded_by_ = 0;
}

Document OpenScene::document() const {
  Document d;
  d.settings = known_.all();
  for (const auto& [key, edit] : pending_) d.settings[key] = edit.value;
  d.lights = lights();
  if (scene)
    for (uint32_t i = 0; i < scene->materials.size(); ++i) {
      d.materials.push_back(material_state(i));
      d.materials.back().emission = emission(i), d.materials.back().emits = emits(i);
    }
  d.objects = objects_;
  std::tie(d.environment_scale, d.environment_rotation) = environment();
  d.environment_file = source_.file;
  d.sky = source_.sky;
  d.solo = solo_;
  d.shown_before = shown_before_;
  return d;
}

const std::string& OpenScene::setting(const std::string& key) const {
  const auto found = pending_.find(key);
  return found != pending_.end() ? found->second.value : known_.text(key);
}

double OpenScene::setting_real(const std::string& key) const {
  double value = 0;
  read_number(setting(key), value);
  return value;
}

const std::vector<scene::Light>& OpenScene::lights() const {
  static const std::vector<scene::Light> none;
  return pending_lights_ ? pending_lights_->value : scene ? scene->lights : none;
}

Document::Material OpenScene::material_state(uint32_t index) const {
  const auto found = pending_materials_.find(index);
  if (found != pending_materials_.end()) return found->second.value;
  Document::Material m(scene->materials.at(index));
  m.textures = textures(index);
  return m;
}

scene::TextureSources OpenScene::textures(uint32_t index) const {
  const auto found = pending_materials_.find(index);
  if (found != pending_materials_.end()) return found->second.value.textures;
  return loaded ? scene::texture_sources(*loaded, *scene, index) : scene::TextureSources();
}

scene::Material OpenScene::material(uint32_t index) const {
  scene::Material m = scene->materials.at(index);
  const auto found = pending_materials_.find(index);
  if (found == pending_materials_.end()) return m;
  static_cast<scene::MaterialFactors&>(m) = found->second.value;
  if (!loaded) return m;
  for (uint32_t s = 0; s < std::size(scene::k_texture_slots); ++s) {
    const scene::TextureSource& source = scene::source_of(found->second.value.textures, s);
    scene::TextureUse& use = m.*scene::k_texture_slots[s].use;
    use = scene::use_of(*loaded, index, s, source);
    // The file is not read yet: some texture stands for it.
    if (source.kind == scene::TextureSource::Kind::file && !use) use.texture = 0;
  }
  return m;
}

scene::ObjectPlace OpenScene::loaded_place(uint32_t index) const {
  return {.hidden = loaded->instances.at(index).hidden};
}

scene::ObjectPlace OpenScene::object(uint32_t index) const {
  const auto found = objects_.find(index);
  return found != objects_.end() ? found->second : loaded_place(index);
}

const Box& OpenScene::object_box(uint32_t index) const {
  const scene::Id mesh = loaded->instances.at(index).mesh;
  const auto [place, fresh] = boxes_.try_emplace(mesh);
  if (fresh && mesh < loaded->meshes.size()) place->second = scene::box_of(loaded->meshes[mesh]);
  return place->second;
}

mat4 OpenScene::object_matrix(uint32_t index, const scene::ObjectPlace& place) const {
  scene::Instance instance = loaded->instances.at(index);
  scene::check_range(place, instance.name);
  instance.to_world = scene::placed(instance.to_world, object_box(index), place);
  scene::check_range(instance, object_box(index));
  return instance.to_world;
}

mat4 OpenScene::object_matrix(uint32_t index) const {
  return scene::placed(loaded->instances.at(index).to_world, object_box(index), object(index));
}

vec3 OpenScene::emission(uint32_t index) const {
  const auto found = dark_.find(index);
  return found != dark_.end() ? found->second : material(index).emission;
}

double OpenScene::emitting_area(uint32_t index) const {
  if (!areas_in_.shares_with(scene->instances)) areas_.clear(), areas_in_ = scene->instances;
  const auto [place, fresh] = areas_.try_emplace(index);
  if (fresh) place->second = scene::emitting_area(*scene, index);
  return place->second;
}

double OpenScene::emission_factor(uint32_t index, scene::LightUnit unit) const {
  const char* word = info_of(unit).word;
  if (unit != scene::LightUnit::nit && scene->materials.at(index).emission_texture)
    throw Error("", fmt::format("{}: a texture multiplies the emission; give nits", word));
  const auto factor = scene::unit_factor(unit == scene::LightUnit::nit ? 1 : emitting_area(index), unit);
  if (!factor) throw Error("", fmt::format("{}: a surface has lm, watts or nits", word));
  if (!(*factor > 0)) throw Error("", fmt::format("{}: no surface has this material; give nits", word));
  return *factor;
}

std::pair<float, float> OpenScene::environment() const {
  if (pending_environment_) return {pending_environment_->value.scale, pending_environment_->value.rotation};
  if (scene) return {scene->environment.scale, scene->environment.rotation};
  return {1, 0};
}

const plan::SceneFacts* OpenScene::facts() {
  if (facts_of_ != scene) facts_ = scene ? plan::facts_of(*scene) : plan::SceneFacts{}, facts_of_ = scene;
  return scene ? &facts_ : nullptr;
}

const scene::LightGroups& OpenScene::light_groups() {
  const std::string& text = setting("relight.groups");
  if (groups_of_ == scene && text == groups_by_) return groups_;
  std::vector<scene::LightGroupRule> rules;
  try {
    rules = scene::parse_group_rules(text);
  } catch (const Error&) {  // the session says so
  }
  if (!scene)
    groups_ = {};
  else if (groups_of_)
    groups_ = scene::group_lights(*scene, rules, *groups_of_, groups_);
  else
    groups_ = scene::group_lights(*scene, rules);
  groups_of_ = scene, groups_by_ = text;
  return groups_;
}

scene::LightMix OpenScene::light_mix() const {
  try {
    return scene::parse_mix(setting("relight.mix"));
  } catch (const Error&) {
    return {};
  }
}

scene::MixPresets OpenScene::mix_presets() const {
  try {
    return scene::parse_presets(setting("relight.presets"));
  } catch (const Error&) {
    return {};
  }
}

bool OpenScene::uses(const SolverInfo& solver) const {
  for (size_t c = 0; c < solver.serves.size(); ++c) {
    const std::string& value = setting(std::string("components.") + session::k_component_names[c]);
    const bool chosen = value == plan::k_auto && snapshot;
    if (solver.serves[c] && solvers::chooses(chosen ? snapshot->components[c].solver : value, solver.name))
      return true;
  }
  return false;
}

const solvers::Report* OpenScene::report(const SolverInfo& solver) const {
  if (!snapshot) return nullptr;
  for (const auto& report : snapshot->reports)
    if (report->solver == solver.name) return report.get();
  return nullptr;
}

const solvers::Report* OpenScene::waiting() const {
  if (!snapshot) return nullptr;
  for (const auto& report : snapshot->reports)
    if (report->waits) return report.get();
  return nullptr;
}

void OpenScene::needs_scene() const {
  if (!scene) throw Error("", "no scene is open");
  if (loading()) throw Error("", "a scene is being loaded; wait until it is shown (in a script: wait_scene)");
}

void OpenScene::needs_solver(const SolverInfo& solver) const {
  needs_scene();
  if (uses(solver)) return;
  const auto first = solver.serves.begin() + (solver.primary_part.empty() ? 0 : 1);
  const auto served = size_t(std::find(first, solver.serves.end(), true) - solver.serves.begin());
  throw Error(
      "", fmt::format("no component takes its light from the {}; set components.{} {}", solver.name,
                      session::k_component_names[std::min(served, solver.serves.size() - 1)], solver.name));
}

void OpenScene::needs_lookup() const {
  needs_scene();
  // Views of no solver have something to show everywhere.
  for (const solvers::ViewInfo& view : plan::views())
    if (view.inspects_pointer && setting(view.option) == "true") return;
  const SolverInfo* missing = nullptr;
  for (const SolverInfo* solver : solvers::registered()) {
    if (!solver->looked_up) continue;
    if (uses(*solver)) return;
    if (!missing) missing = solver;
  }
  if (!missing) throw Error("", "no solver is looked up");
  needs_solver(*missing);
}

uint32_t OpenScene::light_index(const std::string& which) const {
  needs_scene();
  return index_of("light", which, names_of(lights()));
}

uint32_t OpenScene::material_index(const std::string& which) const {
  needs_scene();
  return index_of("material", which, names_of(scene->materials));
}

uint32_t OpenScene::object_index(const std::string& which) const {
  needs_scene();
  return index_of("object", which, names_of(scene->instances));
}

void OpenScene::begin_edit(Document from) { working_ = std::move(from), named_.clear(); }

Document& OpenScene::edit() {
  assert(working_ && "only commands marked undoable change the document");
  return *working_;
}

scene::ObjectPlace OpenScene::edited_object(uint32_t index) {
  const auto found = edit().objects.find(index);
  return found != edit().objects.end() ? found->second : loaded_place(index);
}

void OpenScene::put_object(uint32_t index, const scene::ObjectPlace& place) {
  object_matrix(index, place);
  if (place == loaded_place(index))
    edit().objects.erase(index);
  else
    edit().objects[index] = place;
}

void OpenScene::set_by_name(const std::string& key, const std::string& value) {
  edit().settings[key] = value, named_.push_back(key);
}

Document OpenScene::end_edit() {
  Document after = std::move(*working_);
  working_.reset();
  return after;
}

void OpenScene::note_dark(uint32_t material, const Document::Material& value) {
  if (value.emits)
    dark_.erase(material);
  else
    dark_[material] = value.emission;
}

bool OpenScene::send_strengths(const Document& before, const Document& after) {
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
    edit.lights.emplace_back(i, after.lights[i]);
    rest.lights[i].intensity = before.lights[i].intensity, rest.lights[i].enabled = before.lights[i].enabled;
  }
  for (uint32_t i = 0; i < rest.materials.size(); ++i) {
    if (rest.materials[i] == before.materials[i]) continue;
    edit.materials.emplace_back(i, material(i));
    edit.materials.back().second.emission = after.materials[i].in_scene().emission;
    rest.materials[i].emission = before.materials[i].emission;
    rest.materials[i].emits = before.materials[i].emits;
  }
  if (rest.environment_scale != before.environment_scale) edit.environment_scale = rest.environment_scale;
  rest.environment_scale = before.environment_scale;
  if (rest != before) return false;
  session.set_lights(edit, id_);
  const uint64_t sent = session.commands();
  pending_[key] = {edit.mix, sent};
  if (!edit.lights.empty()) pending_lights_ = {after.lights, sent};
  for (const auto& [i, m] : edit.materials) {
    pending_materials_[i] = {after.materials[i].in_scene(), sent};
    note_dark(i, after.materials[i]);
  }
  pending_environment_ = {{after.environment_scale, after.environment_rotation}, sent};
  return true;
}

void OpenScene::send_lights(const std::vector<scene::Light>& before, const std::vector<scene::Light>& after) {
  if (!scene || before == after) return;
  const auto differs = [](const scene::Light& a, const scene::Light& b) {
    return a.id != b.id || a.name != b.name || a.group != b.group;
  };
  const bool other = before.size() != after.size() ||
                     !std::equal(before.begin(), before.end(), after.begin(), std::not_fn(differs));
  if (other) session.set_light_list(after, id_);
  for (uint32_t i = 0; i < after.size() && !other; ++i)
    if (before[i] != after[i]) session.set_light(i, after[i], id_);
  pending_lights_ = {after, session.commands()};
}

void OpenScene::restore(const Document& to) {
  named_.clear();
  send(document(), to);
}

void OpenScene::send(const Document& before, const Document& after) {
  if (before.settings.at("relight.mix") != after.settings.at("relight.mix") && send_strengths(before, after))
    return;
  for (const auto& [key, value] : after.settings) {
    const auto old = before.settings.find(key);
    // Settings given on the command line apply to the next scene, whatever it sets.
    const bool named = std::find(named_.begin(), named_.end(), key) != named_.end();
    if (!(named && loading()) && old != before.settings.end() && old->second == value) continue;
    session.set(key, value, named ? session::k_any_scene : id_);
    pending_[key] = {value, session.commands()};
  }
  send_lights(before.lights, after.lights);
  send_objects(before, after);
  if (scene)
    for (uint32_t i = 0; i < std::min(after.materials.size(), scene->materials.size()); ++i) {
      if (i < before.materials.size() && before.materials[i] == after.materials[i]) continue;
      note_dark(i, after.materials[i]);
      const Document::Material now_seen = after.materials[i].in_scene();
      if (i < before.materials.size() && before.materials[i].in_scene() == now_seen) continue;
      pending_materials_[i] = {now_seen, 0};
      session.set_material(i, material(i), now_seen.textures, id_);
      pending_materials_[i].sent = session.commands();
    }
  send_environment(before, after);
  solo_ = after.solo;
  shown_before_ = after.shown_before;
}

void OpenScene::send_objects(const Document& before, const Document& after) {
  if (!scene || before.objects == after.objects) return;
  const auto of = [&](const Objects& list, uint32_t index) {
    const auto found = list.find(index);
    return found == list.end() ? loaded_place(index) : found->second;
  };
  Objects all = before.objects;
  all.insert(after.objects.begin(), after.objects.end());
  std::vector<session::ObjectEdit> edits;
  for (const auto& [index, unused] : all)
    if (const scene::ObjectPlace place = of(after.objects, index); place != of(before.objects, index))
      edits.push_back({index, object_matrix(index, place), place.hidden});
  objects_ = after.objects;
  session.set_instances(edits, id_);
  objects_sent_.push_back({session.commands(), before.objects, after.objects});
}

void OpenScene::send_environment(const Document& before, const Document& after) {
  const bool other_file = before.environment_file != after.environment_file;
  const bool other_sky = before.sky != after.sky;
  if (!other_file && !other_sky && before.environment_scale == after.environment_scale &&
      before.environment_rotation == after.environment_rotation)
    return;
  const float scale = after.environment_scale, rotation = after.environment_rotation;
  if (other_sky && after.sky) {
    session.set_environment_sky(*after.sky, scale, id_);
    if (rotation != 0) session.set_environment(scale, rotation, id_);
  } else if (other_file || other_sky) {
    session.set_environment_file(after.environment_file, scale, rotation, id_);
  } else {
    session.set_environment(scale, rotation, id_);
  }
  pending_environment_ = {{scale, rotation}, session.commands()};
  if (!other_file && !other_sky) return;
  source_ = {after.environment_file, after.sky};
  sources_sent_.emplace_back(session.commands(), source_);
}

std::optional<scene::SkyModel> OpenScene::sky() const {
  if (source_.sky || !source_.file.empty() || !loaded) return source_.sky;
  return loaded->environment.sky;
}

scene::Scene OpenScene::edited_scene() const {
  scene::Scene edited = *scene;
  edited.lights = lights();
  for (uint32_t i = 0; i < edited.materials.size(); ++i) {
    edited.materials[i] = material(i);
    const auto off = dark_.find(i);
    edited.materials[i].off_emission = off != dark_.end() ? off->second : vec3(0);
  }
  // With edits on their way, and without those that the session alone has.
  edited.instances = loaded->instances;
  for (const auto& [index, place] : objects_) {
    scene::Instance& instance = edited.instances[index];
    instance.to_world = object_matrix(index), instance.hidden = place.hidden;
    instance.flipped = glm::determinant(glm::dmat3(instance.to_world)) < 0;
  }
  scene::Environment& e = edited.environment;
  e = loaded->environment;
  if (source_.sky || !source_.file.empty()) {
    e = {.file = source_.file, .given = true, .sky = source_.sky};
    e.image = scene::k_none - 1;  // none of the loaded ones
  }
  std::tie(e.scale, e.rotation) = environment();
  return edited;
}

}  // namespace lucerna::commands
