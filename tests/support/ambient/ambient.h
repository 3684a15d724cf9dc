#pragma once
// A solver unknown to the program, for tests of how solvers are added: tertiary light is the constant
// radiance `ambient.radiance`. It has an option, a view, a command, a file, a report, a hook and figures, and
// needs no change of the program's files.
#include <array>
#include <cstdio>

#include "base/file.h"
#include "overlay/painter.h"
#include "solvers/capabilities.h"

namespace lucerna::ambient {

using namespace solvers;

inline const SolverInfo& info() {
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
      .commands = {{"double", "Double", "Doubles the light.", 'Y', true}},
      .file = FileInfo{.extension = ".ambient", .content = "the ambient radiance", .fits = "of any scene"},
  };
  return info;
}

inline Routing routing(const Task& task) {
  Routing r;
  r.lookups = paths::lookup_routes(task.automaton, task.enabled, task.own);
  return r;
}

struct AmbientSolver final : Solver, Kernels, Views, Commands, Persistence, Statistics {
  static inline int made = 0;  ///< instances so far

  AmbientSolver(gpu::Device& device, gpu::ShaderCompiler& compiler, const Task& task)
      : painter_(device, compiler),
        routes_(routing(task).lookups),
        block_(device, {.name = "ambient light", .bytes = sizeof(Block)}) {
    ++made;
    set_radiance(float(task.settings.real("ambient.radiance")));
  }
  const SolverInfo& info() const override { return ambient::info(); }
  bool serves(const Task& task) const override {
    return routing(task).lookups.component == routes_.component;
  }
  void begin(const Picture&, Invalidation invalidated) override { begun_ += invalidated.any(); }
  std::shared_ptr<const Report> report(const overlay::Canvas&, const Picture&, bool) override {
    auto report = std::make_shared<Report>();
    report->solver = info().name, report->state = "constant", report->looked_at = looked_at_;
    report->sections.push_back({"Ambient light", "", {}});
    report->sections[0].items.push_back(
        ValueRow{"Radiance", fmt::format("{:g}", radiance_), "From every direction."});
    return report;
  }
  std::string hook() const override {
    return std::string(LUCERNA_SOURCE_DIR) + "/tests/support/ambient/vertex_hook.glsl";
  }
  void bind(gpu::Resources& resources) const override { resources.set("AmbientBlock", block_); }
  void look_at(std::optional<vec2> place) override { looked_at_ = place; }
  void draw(const overlay::Canvas& canvas, const Picture& picture) override {
    const std::string& shown = picture.task.settings.text("overlay.ambient");
    if (shown == "off") return;
    shared::OverlayPoint point{};
    point.position = picture.camera.to_world * vec4(0, 0, -0.01f, 1);
    point.half_width = shown == "small" ? 4.0f : 8.0f;
    point.color = {1, 0.25f, 0.8f}, point.alpha = 1, point.rank = shared::k_rank_most;
    painter_.draw(canvas, {&point, 1}, {}, {});
  }
  void command(const std::string& name) override {
    if (name == "double") set_radiance(2 * radiance_);
  }
  void save(const std::string& file, const Picture&, const Provenance&) const override {
    write_file(file, fmt::format("{}\n", radiance_));
  }
  void load(const std::string& file, transport::Wavefront&, const Picture&, const Provenance&) override {
    float radiance = 0;
    if (std::sscanf(read_file(file).c_str(), "%f", &radiance) != 1) throw Error(file, "is not a radiance");
    set_radiance(radiance);
  }
  nlohmann::ordered_json statistics(const overlay::Canvas&, const Picture&) override {
    return {{"radiance", radiance_}, {"begun", begun_}};
  }
  std::map<std::string, double> figures() const override { return {{"begun", double(begun_)}}; }

 private:
  /// As in vertex_hook.glsl. `component`: by state; paths::k_no_component: no lookup.
  struct Block {
    std::array<uint32_t, shared::k_automaton_states> component;
    float radiance;
  };
  void set_radiance(float radiance) {
    Block block;
    block.component.fill(paths::k_no_component);
    for (size_t s = 0; s < routes_.component.size(); ++s) block.component[s] = routes_.component[s][2];
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

inline std::unique_ptr<Solver> make(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t,
                                    const Task& task) {
  return std::make_unique<AmbientSolver>(device, compiler, task);
}

inline const SolverType& type() {
  static const SolverType type{info(), routing, make, nullptr, 0, nullptr};
  return type;
}

}  // namespace lucerna::ambient
