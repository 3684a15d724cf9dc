#include "overlay/light_paths.h"

#include <algorithm>
#include <cmath>

#include "shaders/shared/ramp.h"

namespace lucerna::overlay {

using namespace shared;

namespace {

constexpr uint32_t k_paths = 512, k_paths_for_one = 8192;  // the latter to find one lamp's paths among all
constexpr uint32_t k_round = 0xfffffffeu;                  // differs from rounds of samples and of the pilot
constexpr float k_least_part = 1e-3f;                      // lower end of the ramp
constexpr size_t k_most_lines = 256;

/// Position of an entry of the light table, or the direction of its light.
void place(const upload::FlatScene& flat, uint32_t entry, AimedPair& pair) {
  const vec4* texels = flat.lights.data() + size_t{k_light_texels} * entry;
  switch (flat.entries[entry].kind) {
    case k_light_triangle:
      pair.from = (vec3(texels[0]) + vec3(texels[1]) + vec3(texels[2])) / 3.0f;
      pair.light = "shining surface";
      break;
    case k_light_point:
    case k_light_spot:
    case k_light_sphere:
    case k_light_rectangle:
    case k_light_disk:
    case k_light_tube:
    case k_light_profile:
    case k_light_projector:
      pair.from = vec3(texels[0]);
      pair.light = flat.lamp_name(flat.entries[entry].index);
      break;
    case k_light_directional:
      pair.along = vec3(texels[2]);
      pair.light = flat.lamp_name(flat.entries[entry].index);
      break;
    default:
      pair.light = "environment";
  }
}

}  // namespace

vec3 aim_ink(double share) {
  return ramp_color(k_ramp_viridis, std::lerp(0.15f, 1.0f, ramp_position(float(share), k_least_part, 1, 1)));
}

std::vector<AimedPair> aimed_pairs(const upload::FlatScene& flat, const transport::LightSource& lights) {
  std::vector<AimedPair> pairs;
  const uint32_t casters = lights.table().casters;
  for (uint32_t g = 0; g < lights.groups().size(); ++g) {
    const std::vector<uint32_t>& members = lights.groups()[g];
    AimedPair of_group;
    if (members[0] >= flat.entries.size())
      of_group.light = "sky";
    else
      place(flat, members[0], of_group);
    if (members.size() > 1 && of_group.from) {
      vec3 sum(0);
      size_t placed = 0;
      for (const uint32_t m : members) {
        AimedPair one;
        if (m < flat.entries.size()) place(flat, m, one);
        if (one.from) sum += *one.from, ++placed;
      }
      of_group.from = sum / float(placed);
      of_group.light = of_group.light == "shining surface" ? fmt::format("{} triangles", members.size())
                                                           : fmt::format("{} lights", members.size());
    }
    for (uint32_t c = 0; c < casters; ++c) {
      AimedPair pair = of_group;
      pair.box = c, pair.share = lights.shares()[1 + size_t{g} * casters + c];
      pairs.push_back(std::move(pair));
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const AimedPair& a, const AimedPair& b) { return a.share > b.share; });
  return pairs;
}

LightPathsPainter::LightPathsPainter(gpu::Device& device, gpu::ShaderCompiler& compiler,
                                     const gpu::Defines& scene_defines, const paths::Automaton& automaton)
    : device_(device),
      compiler_(compiler),
      scene_defines_(scene_defines),
      automaton_(automaton),
      painter_(device, compiler) {}

uint32_t LightPathsPainter::draw(const Canvas& canvas, const upload::FlatScene& flat,
                                 const transport::LightSource& lights, transport::LightRound round,
                                 uint32_t lamp, const Frame& picture, uint32_t enabled) {
  if (lights.power() <= 0 || canvas.wavefront.slots() == 0) return 0;
  LightPathsView view{0, k_all_lights, flat.core_radius, 0};
  for (uint32_t i = 0; lamp > 0 && i < flat.entries.size(); ++i) {
    const upload::LightEntry& e = flat.entries[i];
    const bool is_lamp = e.kind != k_light_triangle && e.kind != k_light_environment;
    if (is_lamp && e.index == lamp - 1) view.light = i;
  }
  if (lamp > 0 && view.light == k_all_lights) return 0;  // switched off or missing
  if (!emitter_) {
    emitter_.emplace(device_, compiler_, scene_defines_, automaton_);
    vertex_ = gpu::Kernel(device_, compiler_, "overlay/light_paths.comp", scene_defines_);
    block_ = gpu::Buffer(device_, {.name = "light paths that are drawn", .bytes = sizeof view});
  }
  round.number = k_round;
  round.paths = std::min(lamp > 0 ? k_paths_for_one : k_paths, canvas.wavefront.slots());
  view.step = transport::LightEmitter::stratum_step(round.paths);
  block_.write(&view, sizeof view);
  const uint32_t count = round.paths * k_drawn_events;
  gpu::make_room(device_, segments_,
                 {.name = "light paths", .bytes = uint64_t{count} * sizeof(OverlaySegment)});
  const transport::LightVertexWork work{
      .vertex = &vertex_, .stage = "light paths that are drawn", .bind = [&](gpu::Resources& r) {
        r.set("LightPathsBlock", block_);
        r.set("OverlaySegments", segments_);
      }};
  bool complete = false;
  canvas.wavefront.uncounted([&] {
    canvas.stream().fill(segments_, 0);
    complete = emitter_->trace(canvas.wavefront, lights, round, 0, round.paths, work, picture, enabled,
                               canvas.cancel);
  });
  if (!complete) return 0;
  painter_.draw(canvas, {.points = {}, .segments = {&segments_, count}, .discs = {}}, {.dimmed = true});
  return round.paths;
}

void LightPathsPainter::draw_aim(const Canvas& canvas, const upload::FlatScene& flat,
                                 const transport::LightSource& lights, std::span<const Box> boxes) {
  const std::vector<AimedPair> pairs = aimed_pairs(flat, lights);
  std::vector<double> by_box(boxes.size(), 0);
  for (const AimedPair& pair : pairs) by_box[pair.box] += pair.share;
  std::vector<OverlaySegment> segments;
  const auto line = [&](const vec3& from, const vec3& to, const vec3& ink, float width, float alpha,
                        uint32_t rank) {
    segments.push_back({.from = from,
                        .to = to,
                        .half_width = width,
                        .edge_width = 0.6f,
                        .color = ink,
                        .alpha = alpha,
                        .strength = 1,
                        .slack = flat.core_radius,
                        .rank = rank});
  };
  for (size_t c = 0; c < boxes.size(); ++c)
    for (uint32_t edge = 0; edge < 12; ++edge) {
      // Parallel to one axis, at one of four corners in the other two.
      const int axis = int(edge / 4), u = (axis + 1) % 3, v = (axis + 2) % 3;
      vec3 from = boxes[c].lo, to = from;
      from[u] = to[u] = (edge & 1u) != 0 ? boxes[c].hi[u] : boxes[c].lo[u];
      from[v] = to[v] = (edge & 2u) != 0 ? boxes[c].hi[v] : boxes[c].lo[v];
      to[axis] = boxes[c].hi[axis];
      line(from, to, aim_ink(by_box[c]), 0.9f, 1, k_rank_most);
    }
  for (size_t i = 0; i < std::min(pairs.size(), k_most_lines); ++i) {
    const AimedPair& pair = pairs[i];
    const vec3 to = boxes[pair.box].centre();
    const float alpha = std::clamp(0.2f + 0.8f * float(std::sqrt(pair.share)), 0.0f, 1.0f);
    if (pair.from) line(*pair.from, to, aim_ink(pair.share), 0.5f, alpha, k_rank_least);
    if (pair.along)
      line(to - 2 * flat.core_radius * *pair.along, to, aim_ink(pair.share), 0.5f, alpha, k_rank_least);
  }
  painter_.draw(canvas, {}, segments, {}, {.dimmed = true});
}

}  // namespace lucerna::overlay
