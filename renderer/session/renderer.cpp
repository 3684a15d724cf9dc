#include "session/renderer.h"

#include <algorithm>
#include <fstream>
#include <set>

#include "base/log.h"
#include "plan/plan.h"
#include "plan/traced_scene.h"
#include "scene/default_light.h"
#include "scene/io/load.h"
#include "scene/light_factor.h"
#include "scene/range.h"
#include "session/found_portals.h"
#include "shaders/shared/preview.h"

namespace lucerna::session {
namespace {

void check_region(const plan::Settings& settings) {
  schedule::parse_region(settings.text("sampling.region"), "sampling.region");
}

}  // namespace

Renderer::Renderer(const RendererOptions& options)
    : options_(options),
      device_(options.on
                  ? options.on
                  : std::make_shared<gpu::Device>(gpu::DeviceOptions{options.device, options.validation})),
      compiler_(std::make_unique<gpu::ShaderCompiler>(
          options.shaders.empty() ? gpu::ShaderCompiler::default_root() : options.shaders)),
      automaton_(paths::compile_components()),
      context_{*device_, *compiler_, automaton_, options.defines, options.interactive},
      sampling_(setup_, options.interactive),
      seconds_limit_(options.patience) {}

Renderer::~Renderer() = default;

void Renderer::load(const std::filesystem::path& file, const Progress& progress,
                    const std::vector<SettingChange>& changes, bool outside, bool choose) {
  progress_.rest();
  const Timer timer;
  scene::LoadOptions how = options_.scenes;
  how.outside |= outside;
  auto scene =
      std::make_shared<scene::Scene>(scene::load(file, how, [&](float fraction, const std::string& what) {
        return !progress || progress(0.6f * fraction, what);
      }));
  scene::add_default_light(*scene);
  for (const std::string& warning : scene->warnings) log::warning("{}", warning);
  set_scene(
      scene,
      [&](float fraction, const std::string& what) {
        return !progress || progress(0.6f + 0.4f * fraction, what);
      },
      changes, choose);
  for (std::string& line : plan::unreachable_light(setup_.engine->plan(), *scene)) {
    log::warning("{}", line);
    scene->warnings.push_back(std::move(line));
  }
  load_seconds_ = timer.seconds() - compile_seconds();
}

void Renderer::set_scene(std::shared_ptr<const scene::Scene> scene, const Progress& progress,
                         const std::vector<SettingChange>& changes, bool choose) {
  // A scene starts with the defaults and its settings; only those of the machine stay.
  plan::Settings settings;
  for (const char* key : {"tracer", "path.batch", "path.classes", "film.ocio"})
    settings.set(key, setup_.settings.text(key));
  const auto decides = [](const auto& setting) { return plan::decides_solvers(setting.first); };
  if (choose && std::ranges::none_of(scene->settings, decides) &&
      std::ranges::none_of(scene->own_settings, decides))
    plan::leave_choice(settings, "scene.open");
  for (const auto& [key, value] : scene->settings) settings.set(key, value, "settings.json");
  for (const auto& [key, value] : scene->own_settings)
    settings.set(key, value, scene->file + ": extras.lucerna.settings");
  for (const SettingChange& change : changes) settings.set(change.key, change.value, change.where);
  check_region(settings);
  std::shared_ptr<const OcioTable> ocio;
  try {
    ocio = output_.ocio_for(settings);
  } catch (const Error& e) {
    for (const SettingChange& change : changes)
      if (change.key == "film.ocio") throw;
    log::warning("{}; the picture is shown by its tone curve", e.what());
    settings.set("film.ocio", "");
  }
  const auto loaded = scene;
  Transaction::Target target(setup_);
  target.camera = scene::starting_camera(*scene, settings.text("camera"));
  target.scene = with_portals(std::move(scene), loaded->portals, settings.text("lights.portals"), progress);
  target.settings = std::move(settings);
  install(std::move(target), progress, scene::Change::shape);
  loaded_ = loaded;
  output_.set_ocio(std::move(ocio));
  overlays_.show_paths({});
}

void Renderer::install(Transaction::Target target, const Progress& progress, const scene::Changes& changes) {
  progress_.rest();
  scene::check_range(target.camera);
  plan::SceneFacts facts = plan::facts_of(*plan::traced_scene(target.scene, target.settings));
  plan::Plan plan = plan::make_plan(facts, target.settings);
  Transaction transaction(context_, setup_, std::move(target), std::move(plan));
  transaction.make_world(progress);
  report_progress(progress, 0.9f, "compiling kernels");
  transaction.build(changes);
  PictureOutput::WindowParts window_parts = output_.make_window_parts(false);
  commit(transaction);
  facts_ = std::move(facts), findings_.reset(), reviewed_ = false;
  output_.adopt(std::move(window_parts));
  notify_settings_changed();
  restart(changes);
}

const ByComponent<plan::Choice>& Renderer::choices() const {
  static const ByComponent<plan::Choice> none{};
  return setup_.engine ? setup_.engine->plan().choices : none;
}

void Renderer::commit(Transaction& transaction) {
  const std::vector<std::string> messages = new_messages(transaction.relight(), setup_.relight);
  if (transaction.has_films()) {
    // The former picture goes with its film, such as when a lamp is the second light group.
    const Transaction::Target& target = transaction.target();
    if (samples() > 0 && target.width == setup_.width && target.height == setup_.height)
      output_.keep_former(nullptr);
    output_.forget_filtered();
  }
  transaction.commit();
  for (const std::string& message : messages) log::warning("{}", message);
}

void Renderer::remix() {
  output_.mixed();
  mix_.change();
  if (!options_.interactive) mix_.settle();
}

void Renderer::reload_shaders() {
  if (!setup_.engine) return;
  Transaction transaction(context_, setup_, Transaction::Target(setup_), setup_.engine->plan());
  transaction.build(scene::Change::shaders, true);
  PictureOutput::WindowParts window_parts = output_.make_window_parts(true);
  commit(transaction);
  output_.adopt(std::move(window_parts));
  paths_.reset_kernels();
  notify_settings_changed();
  restart(scene::Change::shaders);
}

uint32_t Renderer::enabled_components() const { return setup_.engine ? setup_.engine->plan().enabled() : 0; }

namespace {

/// True if the picture before, times these factors, is a picture of the new light.
bool shows_light(const std::vector<vec3>& factors) {
  return std::all_of(factors.begin(), factors.end(), [](const vec3& f) {
    return std::max({f.x, f.y, f.z}) <= shared::k_preview_most_growth;
  });
}

/// Expected relative change of light by another sky, or by a growth that the former picture cannot show: so
/// large that older light is only used where there is no new light.
constexpr float k_other_light = 4;
/// Samples of a picture from which a return to its light shows it again.
constexpr uint32_t k_settled = 4;

}  // namespace

void Renderer::restart(const scene::Changes& changes, const std::optional<std::vector<vec3>>& factors,
                       bool other_sky) {
  if (!setup_.engine || !setup_.film) return;
  setup_.kept.note(changes.edits);
  pilot_.restart();
  setup_.engine->begin(picture_view(), changes, factors);
  transport::Wavefront& wavefront = setup_.engine->wavefront();
  const bool shown = factors && shows_light(*factors);
  const std::optional<vec3> factor = shown ? scene::common_factor(*factors) : std::nullopt;
  const bool by_group = shown && !factor && setup_.film->groups() == factors->size();
  bool known = factor || keeps_light(changes);
  const uint64_t shown_light = samples() >= k_settled ? former_light_.present() : 0;
  if (samples() > 0) {
    const bool taken = output_.keep_former(by_group ? &*factors : nullptr);
    known = known || (by_group && taken);
  }
  output_.forget_filtered();
  setup_.film->set_mix(setup_.relight.weights), setup_.coarse->set_mix(setup_.relight.weights);
  setup_.film->clear(wavefront.stream());
  setup_.coarse->clear(wavefront.stream());
  wavefront.reset_stats();
  mix_.restart();
  sampling_.restart();
  const bool unlike = !known && (other_sky || (factors && !shown));
  const uint64_t light = former_light_.begin(
      {setup_.world.lit, setup_.settings.all(), setup_.camera.lens, setup_.relight.weights});
  known = output_.restart(changes, factor.value_or(vec3(1)), known, unlike ? k_other_light : 0, shown_light,
                          light);
  if (changes.other_surfaces() || changes.edits.contains(scene::Change::shaders)) overlays_.forget_surfaces();
  begun_lens_ = setup_.camera.lens;
  previews_.restart(known);
  ++restarts_;
  lookups_.restart();
  progress_.restart();
  applied_ = setup_.settings.all();
}

bool Renderer::keeps_light(const scene::Changes& changes) const {
  const auto kept = [&](const std::string& key) {
    const auto before = applied_.find(key);
    return before != applied_.end() && session::keeps_light(key, before->second, setup_.settings.text(key));
  };
  // Through another lens, pixels mix the light of other surfaces.
  if (setup_.camera.lens != begun_lens_) return false;
  return std::all_of(changes.edits.begin(), changes.edits.end(),
                     [](scene::Change edit) {
                       return edit == scene::Change::camera || edit == scene::Change::size;
                     }) &&
         std::all_of(changes.settings.begin(), changes.settings.end(), kept);
}

film::ImageError Renderer::image_error() {
  mix_.settle();
  return progress_.estimate_error();
}

void Renderer::finish_ledger() {
  if (samples() >= 2) mix_.settle();
  progress_.note(true);
}

void Renderer::notify_settings_changed() {
  for (const auto& solver : setup_.engine->solvers()) {
    if (auto* observer = solvers::offered<solvers::SettingsObserver>(*solver))
      observer->on_settings_changed(setup_.settings, options_.interactive);
    if (auto* views = solvers::offered<solvers::Views>(*solver)) views->look_at(overlays_.mode().inspected);
  }
}

void Renderer::apply_settings() {
  if (!setup_.engine) return;
  // Until the commit the setup keeps its settings. Compared first, because a restart counts all as applied.
  Transaction::Target target(setup_);
  scene::Changes changes;
  for (const auto& [key, value] : target.settings.all())
    if (applied_[key] != value) {
      changes.settings.insert(key);
      setup_.settings.set(key, applied_[key]);
    }
  const auto changed = [&](const char* key) { return changes.settings.contains(key); };
  if (setup_.relight.separate && changes.settings == std::set<std::string>{"relight.mix"}) {
    Relight other = setup_.relight;
    session::remix(other, target.settings.text("relight.mix"));
    const std::vector<std::string> messages = new_messages(other, setup_.relight);
    setup_.relight = std::move(other);
    setup_.settings = std::move(target.settings);
    for (const std::string& message : messages) log::warning("{}", message);
    remix();
    applied_ = setup_.settings.all();
    return;
  }
  check_region(target.settings);
  const bool other_ocio = changed("film.ocio");
  std::shared_ptr<const OcioTable> ocio = other_ocio ? output_.ocio_for(target.settings) : nullptr;
  bool again = false, retarget = false;
  for (const std::string& key : changes.settings) {
    // The current schedule can apply these.
    const bool goal = key == "sampling.target_error" || key == "sampling.min_samples" ||
                      key == "sampling.max_samples" ||
                      (key == "sampling.tile" && (!sampling_.adaptive() || changed("sampling.mode")));
    if (goal)
      retarget = true;
    else if (key != "samples")
      again |= plan::find_option(key)->restarts;
  }
  if (changed("camera"))
    target.camera = scene::starting_camera(*target.scene, target.settings.text("camera"));
  scene::check_range(target.camera);
  if (changed("lights.portals"))
    target.scene = with_portals(target.scene, loaded_->portals, target.settings.text("lights.portals"));
  if (target.scene != setup_.world.scene || changed("tracer") || changed("path.batch") ||
      changed("path.classes") ||
      std::any_of(std::begin(plan::k_traced_scene_settings), std::end(plan::k_traced_scene_settings),
                  changed)) {
    install(std::move(target), {}, changes);
    if (other_ocio) output_.set_ocio(std::move(ocio));
    return;
  }
  again |= apply_plan(std::move(target), changes);
  if (other_ocio) output_.set_ocio(std::move(ocio));
  notify_settings_changed();
  setup_.kept.note(changes.edits);
  if (changed("samples") && !again) sampling_.change_samples();
  if (changed("sampling.region") && !again) {
    mix_.settle();
    sampling_.change(progress_);
    progress_.forget_errors();  // of other pixels
    progress_.note(true);
  } else if (changed("sampling.mode") && !again) {
    if (setup_.settings.text("sampling.mode") != "uniform") mix_.settle();
    sampling_.change(progress_);
  } else if (retarget && !again) {
    sampling_.retarget();
  }
  if (again)
    restart(changes);
  else if (setup_.relight.separate && changed("relight.mix"))
    remix();
  applied_ = setup_.settings.all();
}

bool Renderer::apply_plan(Transaction::Target target, scene::Changes& changes) {
  // A target error counts for more than patience.
  const bool aims = options_.patience && target.settings.text("sampling.mode") == "adaptive";
  plan::Plan plan = plan::make_plan(facts_, target.settings, findings_ ? &*findings_ : nullptr,
                                    aims ? std::nullopt : seconds_limit_);
  Transaction transaction(context_, setup_, std::move(target), std::move(plan));
  const plan::Settings& settings = transaction.target().settings;
  // If groups are not separate, a mix is an edit of all lamps.
  const bool relit = transaction.relit();
  if (relit)
    for (const scene::Change c : {scene::Change::lamp, scene::Change::environment, scene::Change::colour})
      changes.edits.insert(c);
  transaction.edit_world();
  const auto changed = [&](const char* key) { return changes.settings.contains(key); };
  bool new_engine = changed("sampling.coherent") || changed("film.background") ||
                    (changed("sampling.tile") && settings.boolean("sampling.coherent"));
  for (const std::string& key : changes.settings)
    if (const solvers::SolverInfo* owner = solvers::owner_of(key); owner && setup_.engine->find(owner->name))
      new_engine |= plan::find_option(key)->restarts;
  transaction.build(changes, new_engine);
  const bool rebuilt = transaction.has_engine();
  commit(transaction);
  return rebuilt || relit;
}

void Renderer::set_size(uint32_t width, uint32_t height) {
  if (width == setup_.width && height == setup_.height && setup_.film) return;
  film::check_size(device_->info(), width, height);
  if (setup_.engine) {
    Transaction::Target target(setup_);
    target.width = width, target.height = height;
    Transaction transaction(context_, setup_, std::move(target), setup_.engine->plan());
    transaction.edit_world();
    transaction.build(scene::Change::size);
    const bool rebuilt = transaction.has_engine();
    commit(transaction);
    if (rebuilt) notify_settings_changed();
  } else {
    setup_.width = width, setup_.height = height;
  }
  overlays_.retry();
  output_.retry_filter();
  restart(scene::Change::size);
}

void Renderer::set_camera(const scene::Camera& camera) {
  scene::check_range(camera);
  setup_.camera = camera;
  restart(scene::Change::camera);
}

void Renderer::choose_camera(const std::string& name) {
  set_camera(scene::find_camera(*setup_.world.scene, name));
}

void Renderer::solver_load(const std::string& name, const std::filesystem::path& file) {
  solvers_.load(name, file);
  restart(scene::Changes{});
}

double peak_host_mb() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind("VmHWM:", 0) == 0) return std::stod(line.substr(6)) / 1024;
  return 0;
}

}  // namespace lucerna::session
