#include "transport/light_emitter.h"

#include <algorithm>

namespace lucerna::transport {

using namespace shared;

LightEmitter::LightEmitter(gpu::Device& device, gpu::ShaderCompiler& compiler,
                           const gpu::Defines& scene_defines, const paths::Automaton& automaton)
    : automaton_(paths::reverse(automaton)),
      emit_(device, compiler, "transport/emit.comp", scene_defines),
      counts_(device,
              {.name = "light paths", .bytes = 4 * k_light_path_counts, .memory = gpu::Memory::host}) {}

Frame LightEmitter::frame_of(const LightRound& round, const Frame& picture) const {
  Frame frame = picture;
  const std::vector<uint32_t> states = paths::pack(automaton_, round.parts, round.account);
  std::fill(std::begin(frame.automaton), std::end(frame.automaton), shared::k_component_none << 24);
  std::copy(states.begin(), states.end(), frame.automaton);
  return frame;
}

bool LightEmitter::trace(Wavefront& wavefront, const LightSource& lights, const LightRound& round,
                         uint32_t first, uint32_t count, const LightVertexWork& work, const Frame& picture,
                         uint32_t enabled, const std::function<bool()>& cancel) {
  uint32_t counts[k_light_path_counts] = {};
  counts_.write(counts, sizeof counts);
  const auto bind = [&](gpu::Resources& r) {
    lights.bind(r);
    r.set("LightPathCounts", counts_);
    work.bind(r);
  };
  gpu::Resources emitting;
  wavefront.bind_paths(emitting);
  bind(emitting);
  PathEnds ends;
  ends.begin = [&] {
    const EmitPush push{count, first, round.number, 1 / float(round.paths), stratum_step(round.paths)};
    wavefront.stream().dispatch(emit_, emitting, push, gpu::groups_for(count, 64), "light emission");
  };
  ends.vertex = work.vertex;
  ends.vertex_stage = work.stage;
  ends.bind_vertex = bind;
  ends.arrival = work.arrival;
  wavefront.set_frame(frame_of(round, picture), 1);
  struct Back {
    std::function<void()> go;
    ~Back() { go(); }
  } back{[&] { wavefront.set_frame(picture, enabled); }};
  if (!wavefront.run(count, ends, cancel)) return false;
  counts_.read(counts, sizeof counts);
  dark_ = counts[k_light_paths_dark], escaped_ = counts[k_light_paths_escaped];
  return true;
}

}  // namespace lucerna::transport
