#include "session/renderer.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/log.h"
#include "plan/plan.h"
#include "scene/default_light.h"
#include "scene/io/load.h"
#include "scene/light_factor.h"
#include "scene/range.h"
#include "session/found_portals.h"
#include "shaders/shared/film.h"

namespace lucerna::session {

Renderer::Renderer(const RendererOptions& options)
    : options_(options),
      device_(options.on
                  ? options.on
                  : std::make_shared<gpu::Device>(gpu::DeviceOptions{options.device, options.validation})),
      compiler_(std::make_unique<gpu::ShaderCompiler>(
          options.shaders.empty() ? gpu::ShaderCompiler::default_root() : options.shaders)),
      automaton_(paths::compile_components()),
      waits_for_overlay_(!options.interactive) {}

Renderer::~Renderer() = default;

void Renderer::load(const std::filesystem::path& file, const Progress& progress,
                    const std::vector<SettingChange>& changes) {
  rest();
  const Timer timer;
  auto scene = std::make_shared<scene::Scene>(scene::load(
      file, options_.scenes,
      [&](float fraction, const std::string& what) { return !progress || progress(0.6f * fraction, what); }));
  scene::add_default_light(*scene);
  for (const std::string& warning : scene->warnings) log::warning("{}", warning);
  set_scene(
      scene,
      [&](float fraction, const std::string& what) {
        return !progress || progress(0.6f + 0.4f * fraction, what);
      },
      changes);
  for (std::string& line : plan::unreachable_light(engine_->plan(), *scene)) {
    log::warning("{}", line);
    scene->warnings.push_back(std::move(line));
  }
  load_seconds_ = timer.seconds() - compile_seconds();
}

void Renderer::set_scene(std::shared_ptr<const scene::Scene> scene, const Progress& progress,
                         const std::vector<SettingChange>& changes) {
  // A scene starts with the defaults and its settings; only those of the machine stay.
  plan::Settings settings;
  for (const char* key : {"tracer", "path.batch", "path.classes"}) settings.set(key, settings_.text(key));
  for (const auto& [key, value] : scene->settings) settings.set(key, value, "settings.json");
  for (const SettingChange& change : changes) settings.set(change.key, change.value, change.where);
  scene::Camera camera = scene::starting_camera(*scene, settings.text("camera"));
  const auto loaded = scene;
  scene = with_portals(std::move(scene), loaded->portals, settings.text("lights.portals"), progress);
  install(std::move(scene), std::move(settings), camera, progress, scene::Change::shape);
  loaded_ = loaded;
}

void Renderer::install(std::shared_ptr<const scene::Scene> scene, plan::Settings settings,
                       scene::Camera camera, const Progress& progress, const scene::Changes& changes) {
  rest();
  // Everything that can fail happens before the old scene is released.
  scene::check_range(camera);
  const plan::Plan plan = plan::make_plan(settings);
  Relight relight = make_relight(plan, settings, scene, width_, height_);
  World world = make_world(*device_, std::move(scene), relight.lit, settings.text("tracer"),
                           wanted_separation(plan, settings, relight), progress);
  report_progress(progress, 0.9f, "compiling kernels");
  std::unique_ptr<Engine> engine = make_engine(world, plan, settings, changes);
  Films films =
      film_ && keeps(*film_, world.flat.effects) ? Films{} : make_films(width_, height_, world.flat.effects);
  if (films.picture) use(std::move(films));
  if (options_.interactive && !display_) display_ = std::make_unique<Display>(*device_, *compiler_);
  if (options_.interactive && !window_filter_)
    window_filter_ = std::make_unique<WindowFilter>(*device_, *compiler_);
  use(std::move(engine), changes);
  world_ = std::move(world);
  settings_ = std::move(settings);
  camera_ = std::move(camera);
  take(std::move(relight));
  notify_settings_changed();
  restart(changes);
}

Relight Renderer::make_relight(const plan::Plan& plan, const plan::Settings& settings,
                               std::shared_ptr<const scene::Scene> scene, uint32_t width,
                               uint32_t height) const {
  Relight relight = session::make_relight(plan, settings, std::move(scene), options_.interactive,
                                          uint64_t{width} * height, device_->info().memory_bytes, relight_);
  keep_written(relight, relight_);
  return relight;
}

upload::LightSeparation Renderer::wanted_separation(const plan::Plan& plan, const plan::Settings& settings,
                                                    const Relight& relight) const {
  float threshold = wanted_sun_threshold(automaton_, plan, settings);
  // With one group, the film's sums suffice.
  const bool several = relight.separate && relight.groups->groups.size() > 1;
  if (several && relight.groups->has_sun) threshold = scene::k_sun_threshold;
  return {threshold, several ? relight.groups : nullptr,
          !several || relight.kept == film::GroupStorage::by_component};
}

void Renderer::take(Relight relight) {
  for (const std::string& message : relight.messages)
    if (std::find(relight_.messages.begin(), relight_.messages.end(), message) == relight_.messages.end())
      log::warning("{}", message);
  relight_ = std::move(relight);
}

void Renderer::remix() {
  forget_filtered();
  film_->set_mix(relight_.weights), coarse_->set_mix(relight_.weights);
  if (display_) display_->mixed();
  // Dragging a slider changes one group; dragging over presets gives a sequence of mixes.
  constexpr double k_drag_seconds = 0.5;  // maximum time between these; the first is shown meanwhile
  mixed_.resize(relight_.weights.size(), vec3(1));
  size_t groups = 0;
  for (size_t g = 0; g < mixed_.size(); ++g)
    groups += std::exchange(mixed_[g], relight_.weights[g]) != relight_.weights[g];
  mix_dragged_ = groups <= 1 || since_mix_.seconds() < k_drag_seconds;
  since_mix_.restart();
  mix_pending_ = true;
  if (!options_.interactive) settle_mix();
}

void Renderer::settle_mix() {
  if (!std::exchange(mix_pending_, false) || stats().paths == 0) return;
  engine_->wavefront().uncounted([&] { engine_->wavefront().mix(*film_); });
  // Errors so far belong to another picture.
  ledger_.clear();
  if (samples() == 0) return;
  if (adaptive()) change_schedule();
  note_progress(true);
}

std::unique_ptr<Engine> Renderer::make_engine(const World& world, const plan::Plan& plan,
                                              const plan::Settings& settings,
                                              const scene::Changes& changes) const {
  const bool same_shaders = !changes.edits.contains(scene::Change::shaders);
  std::vector<Predecessor> predecessors;
  if (engine_)
    for (const auto& solver : engine_->solvers())
      predecessors.push_back({.solver = solver, .made_for = engine_->made_for(), .since = changes});
  for (Predecessor& kept : kept_.predecessors(settings, changes.edits))
    predecessors.push_back(std::move(kept));
  return std::make_unique<Engine>(*device_, *compiler_, automaton_, world, plan, settings, options_.defines,
                                  same_shaders ? engine_.get() : nullptr, predecessors);
}

void Renderer::use(std::unique_ptr<Engine> engine, const scene::Changes& changes) {
  if (engine_) kept_.replace(*engine_, *engine, changes.edits);
  engine_ = std::move(engine);
  // Kept data is optional: most of the memory is left to the picture.
  if (device_->allocated_bytes() > device_->info().memory_bytes / 2) kept_.clear();
}

void Renderer::use(Films films) {
  forget_filtered();
  film_ = std::move(films.picture), coarse_ = std::move(films.coarse);
}

void Renderer::reload_shaders() {
  if (!engine_) return;
  std::unique_ptr<Engine> engine = make_engine(world_, engine_->plan(), settings_, scene::Change::shaders);
  std::unique_ptr<Display> display;
  if (display_) display = std::make_unique<Display>(*device_, *compiler_);
  use(std::move(engine), scene::Change::shaders);
  display_ = std::move(display), shown_ = {};
  if (window_filter_) window_filter_->reset_kernels();
  notify_settings_changed();
  restart(scene::Change::shaders);
}

uint32_t Renderer::enabled_components() const { return engine_ ? engine_->plan().enabled() : 0; }

namespace {

film::GroupStorage kept_of(const upload::Effects& effects) {
  return effects.group_components ? film::GroupStorage::by_component : film::GroupStorage::compact;
}

}  // namespace

bool Renderer::keeps(const film::Film& film, const upload::Effects& effects) {
  return film.groups() == effects.light_groups &&
         (film.groups() == 1 || film.group_storage() == kept_of(effects));
}

Renderer::Films Renderer::make_films(uint32_t width, uint32_t height, const upload::Effects& effects) const {
  Films films;
  films.picture =
      std::make_unique<film::Film>(*device_, width, height, effects.light_groups, kept_of(effects));
  films.coarse = std::make_unique<film::Film>(*device_, std::max(1u, width / shared::k_coarse_step),
                                              std::max(1u, height / shared::k_coarse_step));
  return films;
}

void Renderer::restart(const scene::Changes& changes, const std::optional<std::vector<vec3>>& factors) {
  if (!engine_ || !film_) return;
  kept_.note(changes.edits);
  engine_->begin(picture_view(), changes, factors);
  transport::Wavefront& wavefront = engine_->wavefront();
  const std::optional<vec3> factor = factors ? scene::common_factor(*factors) : std::nullopt;
  const bool by_group = factors && !factor && film_->groups() == factors->size();
  bool known = factor || keeps_light(changes);
  if (display_ && samples() > 0) {
    // Groups with different factors are a new mix of the present picture.
    if (by_group) {
      std::vector<vec3> weights = relight_.weights;
      for (size_t g = 0; g < weights.size(); ++g) weights[g] *= (*factors)[g];
      film_->set_mix(weights);
      wavefront.mix(*film_);
    }
    const Filtered* filtered = shown_.filtered && !by_group ? window_filter_->result() : nullptr;
    // The root: of single pixels' bias about half is left in means over 3x3, as bench latency measures.
    const bool taken = display_->take(wavefront.stream(), filtered ? *filtered->film : *film_,
                                      filtered ? std::sqrt(filtered->error.over_noise) : 1);
    known = known || (by_group && taken);
  }
  forget_filtered();
  film_->set_mix(relight_.weights), coarse_->set_mix(relight_.weights);
  film_->clear(wavefront.stream());
  coarse_->clear(wavefront.stream());
  wavefront.reset_stats();
  mix_pending_ = false;
  start_schedule();
  if (display_) display_->restart(changes, factor.value_or(vec3(1)), known);
  if (sheet_ &&
      (changes.edits.contains(scene::Change::shape) || changes.edits.contains(scene::Change::shaders)))
    sheet_->forget();
  begun_lens_ = camera_.lens;
  draft_preparing_ = false;
  if (!known) path_pace_.reset();
  ++restarts_;
  weighed_at_ = 0;
  ledger_.clear();
  clock_.reset();
  render_s_ = prepared_s_ = 0;
  prepared_ = {};
  applied_ = settings_.all();
}

bool Renderer::keeps_light(const scene::Changes& changes) const {
  const auto kept = [&](const std::string& key) {
    const auto before = applied_.find(key);
    if (key.rfind("components.", 0) == 0)
      return before != applied_.end() && before->second != "off" && settings_.text(key) != "off";
    const OptionInfo* option = plan::find_option(key);
    return option && option->same_light;
  };
  // Through another lens, pixels mix the light of other surfaces.
  if (camera_.lens != begun_lens_) return false;
  return std::all_of(changes.edits.begin(), changes.edits.end(),
                     [](scene::Change edit) {
                       return edit == scene::Change::camera || edit == scene::Change::size;
                     }) &&
         std::all_of(changes.settings.begin(), changes.settings.end(), kept);
}

void Renderer::start_schedule() {
  seen_ = seen_range();
  if (settings_.text("sampling.mode") == "adaptive")
    sampling_.start(
        schedule::AdaptiveSchedule(film_->blocks_across(), film_->blocks_down(), adaptive_options()));
  else
    sampling_.start(schedule::UniformSchedule(film_->blocks(), uint32_t(settings_.integer("samples")),
                                              engine_->wavefront().slots(), engine_->in_rounds()));
}

void Renderer::change_schedule() {
  seen_ = seen_range();
  const std::vector<uint32_t> have = sampling_.counts();
  if (settings_.text("sampling.mode") == "adaptive") {
    std::vector<schedule::TileErrors> errors;
    image_error();
    for (const film::TileError& t : film::tile_errors(*film_, tile_side()))
      errors.push_back({float(t.relative), float(t.relative_records), float(t.relative_interpolation)});
    sampling_.start(schedule::AdaptiveSchedule(film_->blocks_across(), film_->blocks_down(),
                                               adaptive_options(), have, errors));
  } else {
    sampling_.start(schedule::UniformSchedule(have, uint32_t(settings_.integer("samples")),
                                              engine_->wavefront().slots(), engine_->in_rounds()));
  }
}

schedule::AdaptiveOptions Renderer::adaptive_options() const {
  return {
      .tile = tile_side(),
      .target_error = float(settings_.real("sampling.target_error")),
      .min_samples = uint32_t(settings_.integer("sampling.min_samples")),
      .max_samples = uint32_t(settings_.integer("sampling.max_samples")),
      .slots = engine_->wavefront().slots(),
      .one_sample = engine_->in_rounds(),
  };
}

film::SeenRange Renderer::seen_range() const {
  return film::seen_range(settings_.real("film.ev"), uint32_t(settings_.choice("film.tone_curve")));
}

uint32_t Renderer::tile_side() const { return uint32_t(std::stoul(settings_.text("sampling.tile"))); }

film::ImageError Renderer::image_error() {
  settle_mix();
  transport::Wavefront& wavefront = engine_->wavefront();
  engine_->estimator().estimate(wavefront.stream(), *film_, seen_range());
  wavefront.account_stages();
  return film::image_error(film_->errors());
}

bool Renderer::lookup_errors_known() const {
  return engine_ && samples() >= 2 && !engine_->owing_errors(*film_);
}

bool Renderer::lookup_bias_estimated() const {
  if (!engine_) return false;
  return std::all_of(engine_->solvers().begin(), engine_->solvers().end(), [](const auto& solver) {
    const auto* bias = solvers::offered<solvers::LookupBias>(*solver);
    return !bias || bias->estimates_bias();
  });
}

std::optional<double> Renderer::bias(size_t component) const {
  if (!engine_) return std::nullopt;
  // Paths compute all primary light if the scene has nothing of the part that another solver looks up.
  if (component == 0 && engine_->plan().solver[0] && !engine_->looks_up_direct_light()) return 0.0;
  return engine_->plan().bias(component);
}

std::vector<film::TileError> Renderer::tile_errors() const {
  const uint32_t side = tile_side();
  std::vector<film::TileError> tiles = film::tile_errors(*film_, side);
  film::mark_heavy_tails(tiles, (film_->width() + side - 1) / side, seen_range().floor);
  return tiles;
}

void Renderer::notify_settings_changed() {
  for (const auto& solver : engine_->solvers()) {
    if (auto* observer = solvers::offered<solvers::SettingsObserver>(*solver))
      observer->on_settings_changed(settings_, options_.interactive);
    if (auto* views = solvers::offered<solvers::Views>(*solver)) views->look_at(looked_at_);
  }
}

void Renderer::apply_settings() {
  if (!engine_) return;
  scene::Changes changes;  // first, because a restart counts all as applied
  for (const auto& [key, value] : settings_.all())
    if (applied_[key] != value) changes.settings.insert(key);
  const auto changed = [&](const char* key) { return changes.settings.contains(key); };
  if (relight_.separate && changes.settings == std::set<std::string>{"relight.mix"}) {
    try {
      Relight other = relight_;
      session::remix(other, settings_.text("relight.mix"));
      take(std::move(other));
    } catch (...) {
      settings_.set("relight.mix", applied_["relight.mix"]);
      throw;
    }
    remix();
    applied_ = settings_.all();
    return;
  }
  bool again = false, retarget = false, remixed = false;
  for (const std::string& key : changes.settings) {
    // The current schedule can apply these.
    const bool goal = key == "sampling.target_error" || key == "sampling.min_samples" ||
                      key == "sampling.max_samples" ||
                      (key == "sampling.tile" && (!adaptive() || changed("sampling.mode")));
    if (goal)
      retarget = true;
    else if (key != "samples")
      again |= plan::find_option(key)->restarts;
  }
  try {
    const scene::Camera camera =
        changed("camera") ? scene::starting_camera(*world_.scene, settings_.text("camera")) : camera_;
    scene::check_range(camera);
    std::shared_ptr<const scene::Scene> scene = world_.scene;
    if (changed("lights.portals"))
      scene = with_portals(scene, loaded_->portals, settings_.text("lights.portals"));
    if (scene != world_.scene || changed("tracer") || changed("path.batch") || changed("path.classes")) {
      install(std::move(scene), settings_, camera, {}, changes);
      return;
    }
    again |= apply_plan(changes);
    remixed = relight_.separate && changed("relight.mix");
    camera_ = camera;
  } catch (...) {
    for (const std::string& key : changes.settings) settings_.set(key, applied_[key]);
    throw;
  }
  notify_settings_changed();
  kept_.note(changes.edits);
  if (changed("samples") && !again) sampling_.uniform().set_samples(uint32_t(settings_.integer("samples")));
  if (changed("sampling.mode") && !again)
    change_schedule();
  else if (retarget && !again && adaptive())
    sampling_.adaptive()->retarget(adaptive_options());
  if (again)
    restart(changes);
  else if (remixed)
    remix();
  applied_ = settings_.all();
}

bool Renderer::apply_plan(scene::Changes& changes) {
  const plan::Plan plan = plan::make_plan(settings_);
  Relight relight = make_relight(plan, settings_, world_.scene, width_, height_);
  const upload::LightSeparation separation = wanted_separation(plan, settings_, relight);
  // If groups are not separate, a mix is an edit of all lamps.
  const bool relit = relight.baked != relight_.baked;
  if (relit)
    for (const scene::Change c : {scene::Change::lamp, scene::Change::environment, scene::Change::colour})
      changes.edits.insert(c);
  if (!relit) relight.lit = world_.lit;
  std::optional<WorldEdit> edit;
  if (relit || separation != upload::light_separation(world_.flat))
    edit.emplace(*device_, world_, world_.scene, relight.lit, separation, relit);
  const auto changed = [&](const char* key) { return changes.settings.contains(key); };
  bool rebuild = !engine_->serves(plan, settings_, world_) || changed("sampling.coherent") ||
                 changed("film.background") ||
                 (changed("sampling.tile") && settings_.boolean("sampling.coherent"));
  for (const std::string& key : changes.settings)
    if (const solvers::SolverInfo* owner = solvers::owner_of(key); owner && engine_->find(owner->name))
      rebuild |= plan::find_option(key)->restarts;
  Films films =
      keeps(*film_, world_.flat.effects) ? Films{} : make_films(width_, height_, world_.flat.effects);
  if (rebuild)
    use(make_engine(world_, plan, settings_, changes), changes);
  else
    engine_->set_plan(plan);
  if (films.picture) use(std::move(films));
  if (edit) edit->keep();
  if (edit && !rebuild) engine_->wavefront().rebind(*world_.device);
  take(std::move(relight));
  return rebuild || relit;
}

void Renderer::set_size(uint32_t width, uint32_t height) {
  if (width == width_ && height == height_ && film_) return;
  film::check_size(device_->info(), width, height);
  if (engine_) {
    // A larger picture may leave no memory for separate groups.
    Relight relight = make_relight(engine_->plan(), settings_, world_.scene, width, height);
    const upload::LightSeparation separation = wanted_separation(engine_->plan(), settings_, relight);
    std::optional<WorldEdit> edit;
    const bool relit = relight.baked != relight_.baked;
    if (!relit) relight.lit = world_.lit;
    if (relit || separation != upload::light_separation(world_.flat))
      edit.emplace(*device_, world_, world_.scene, relight.lit, separation, relit);
    Films films = make_films(width, height, world_.flat.effects);
    if (edit && !engine_->serves(engine_->plan(), settings_, world_)) {
      use(make_engine(world_, engine_->plan(), settings_, scene::Change::size), scene::Change::size);
      notify_settings_changed();
    } else if (edit) {
      engine_->wavefront().rebind(*world_.device);
    }
    if (edit) edit->keep();
    take(std::move(relight));
    use(std::move(films));
  }
  overlay_fails_ = false;
  if (window_filter_) window_filter_->retry();
  width_ = width, height_ = height;
  restart(scene::Change::size);
}

void Renderer::set_camera(const scene::Camera& camera) {
  scene::check_range(camera);
  camera_ = camera;
  restart(scene::Change::camera);
}

void Renderer::choose_camera(const std::string& name) { set_camera(scene::find_camera(*world_.scene, name)); }

}  // namespace lucerna::session
