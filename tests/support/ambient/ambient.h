#pragma once
// A solver unknown to the program, for tests of how solvers are added: tertiary light is the constant
// radiance `ambient.radiance`. It has an option, a view, a command, a file, a report, a hook and figures, and
// needs no change of the program's files.
#include <algorithm>
#include <array>
#include <sstream>

#include "base/file.h"
#include "overlay/painter.h"
#include "shaders/shared/ramp.h"
#include "solvers/capabilities.h"

namespace lucerna::test {

inline const solvers::SolverInfo& ambient_info() {
  using namespace solvers;
  static const SolverInfo info{
      .name = "ambient",
      .label = "Ambient",
      .title = "the ambient light",
      .help = "Ambient light: tertiary light is the same everywhere.",
      .serves = {false, false, true, false},
      .looked_up = true,
      .options = {real_option("ambient.radiance", "0.5", 0, 1000, "W/(m2 sr)",
                              "Ambient light: its radiance, from every direction.", "Radiance"),
                  without_restart(choice_option("overlay.ambient", "off", {"off", "small", "large"}, "",
                                                "Shows a point in the middle of the picture.", "Middle"))},
      .changes = {{scene::Change::camera, k_invalidates_nothing, "it is the same everywhere"},
                  {"film.", k_invalidates_nothing, "how it is shown"}},
      .views = {{.option = "overlay.ambient", .label = "Middle", .shortcut = 'M', .inspects_pointer = true}},
      .commands = {{.name = "double",
                    .label = "Double",
                    .help = "Doubles the light.",
                    .shortcut = 'Y',
                    .until_still = true}},
      .file = FileInfo{.extension = ".ambient", .content = "the ambient radiance", .fits = "of any scene"},
  };
  return info;
}

inline constexpr vec3 k_ambient_ink{1, 0.25f, 0.8f};

inline solvers::Routing ambient_routing(const solvers::Task& task) {
  return {
      .lookups = paths::lookup_routes(task.automaton, task.enabled, task.own), .fallback = 0, .gather = {}};
}

class AmbientSolver final : public solvers::Solver,
                            public solvers::Kernels,
                            public solvers::Views,
                            public solvers::Commands,
                            public solvers::Persistence,
                            public solvers::Statistics {
 public:
  AmbientSolver(gpu::Device& device, gpu::ShaderCompiler& compiler, const solvers::Task& task)
      : painter_(device, compiler),
        routes_(ambient_routing(task).lookups),
        block_(device, {.name = "ambient light", .bytes = sizeof(Block)}) {
    set_radiance(float(task.settings.real("ambient.radiance")));
  }

  const solvers::SolverInfo& info() const override { return ambient_info(); }
  std::string hook() const override {
    return std::string(LUCERNA_SOURCE_DIR) + "/tests/support/ambient/vertex_hook.glsl";
  }
  void bind(gpu::Resources& resources) const override { resources.set("AmbientBlock", block_); }
  bool serves(const solvers::Task& task) const override {
    return ambient_routing(task).lookups.component == routes_.component;
  }
  void begin(const solvers::Picture&, solvers::Invalidation invalidated) override {
    begun_ += invalidated.any();
  }
  void look_at(std::optional<vec2> place) override { looked_at_ = place; }
  void command(const std::string& name) override {
    if (name == "double") set_radiance(2 * radiance_);
  }
  void save(const std::string& file, const solvers::Picture&, const solvers::Provenance&) const override {
    write_file(file, fmt::format("{}\n", radiance_));
  }
  void load(const std::string& file, transport::Wavefront&, const solvers::Picture&,
            const solvers::Provenance&) override {
    std::istringstream text(read_file(file));
    float radiance = 0;
    if (!(text >> radiance)) throw Error(file, "is not a radiance");
    set_radiance(radiance);
  }
  void draw(const overlay::Canvas& canvas, const solvers::Picture& picture) override {
    if (picture.task.settings.text("overlay.ambient") == "off") return;
    const vec3 middle = picture.camera.to_world * vec4(0, 0, -0.01f, 1);
    const shared::OverlayPoint point{
        .position = middle,
        .half_width = picture.task.settings.text("overlay.ambient") == "small" ? 4.0f : 8.0f,
        .color = k_ambient_ink,
        .alpha = 1,
        .edge_width = 0,
        .rank = shared::k_rank_most};
    painter_.draw(canvas, {&point, 1}, {}, {});
  }
  std::shared_ptr<const solvers::Report> report(const overlay::Canvas&, const solvers::Picture&,
                                                bool) override {
    auto report = std::make_shared<solvers::Report>();
    report->solver = info().name;
    report->state = "constant";
    report->looked_at = looked_at_;
    report->sections.push_back(
        {.title = "Ambient light",
         .note = "",
         .items = {solvers::ValueRow{"Radiance", fmt::format("{:g}", radiance_), "From every direction."}}});
    return report;
  }
  nlohmann::ordered_json statistics(const overlay::Canvas&, const solvers::Picture&) override {
    return {{"radiance", radiance_}, {"begun", begun_}};
  }
  std::map<std::string, double> figures() const override { return {{"begun", double(begun_)}}; }

 private:
  /// As in vertex_hook.glsl.
  struct Block {
    std::array<uint32_t, shared::k_automaton_states> component;
    float radiance;
  };
  void set_radiance(float radiance) {
    Block block;
    block.component.fill(shared::k_component_count);
    for (size_t s = 0; s < routes_.component.size(); ++s)
      block.component[s] = std::min<uint32_t>(routes_.component[s][2], shared::k_component_count);
    block.radiance = radiance_ = radiance;
    block_.write(&block, sizeof block);
  }

  overlay::Painter painter_;
  paths::LookupRoutes routes_;
  gpu::Buffer block_;
  float radiance_ = 0;
  std::optional<vec2> looked_at_;
  uint32_t begun_ = 0;  ///< pictures that invalidated its work
};

/// The number of instances created.
inline int& ambient_made() {
  static int count = 0;
  return count;
}

inline const solvers::SolverType& ambient_type() {
  static const solvers::SolverType type{
      .info = ambient_info(),
      .routing = ambient_routing,
      .make = [](gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t,
                 const solvers::Task& task) -> std::unique_ptr<solvers::Solver> {
        ++ambient_made();
        return std::make_unique<AmbientSolver>(device, compiler, task);
      }};
  return type;
}

}  // namespace lucerna::test
