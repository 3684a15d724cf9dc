#include "transport/path_recorder.h"

#include <algorithm>
#include <cstring>

namespace lucerna::transport {

using namespace shared;

namespace {

constexpr uint32_t k_batch = 2048;                                                          // paths at once
static_assert(uint64_t{k_batch} * PathRecorder::k_events * sizeof(PathEvent) <= 20 << 20);  // bytes of events

}  // namespace

PathRecorder::PathRecorder(gpu::Device& device, gpu::ShaderCompiler& compiler,
                           const gpu::Defines& path_defines, uint32_t events_per_path)
    : device_(device),
      compiler_(compiler),
      path_defines_(path_defines),
      defines_(path_defines),
      events_per_path_(events_per_path) {
  defines_["LUCERNA_PATH_EVENTS"] = "1";
  shade_ = gpu::Kernel(device, compiler, "transport/shade.comp", defines_);
  shadow_ = gpu::Kernel(device, compiler, "transport/shadow.comp", defines_);
  block_ = gpu::Buffer(device, {.name = "recording of paths", .bytes = sizeof(PathEventFrame)});
}

const gpu::Kernel& PathRecorder::camera(const Frame& frame) {
  const bool lens = frame.lens_radius > 0, section = frame.section_normal != vec3(0);
  gpu::Kernel& kernel = cameras_[(lens ? 1 : 0) + (section ? 2 : 0)];
  if (kernel) return kernel;
  gpu::Defines defines = defines_;
  if (lens) defines["LUCERNA_THIN_LENS"] = "1";
  if (section) defines["LUCERNA_SECTION"] = "1";
  kernel = gpu::Kernel(device_, compiler_, "transport/camera.comp", defines);
  return kernel;
}

bool PathRecorder::record(Wavefront& wavefront, const Frame& frame, std::span<const PathChoice> choices,
                          float far, const std::function<void(const RecordedPath&)>& sink,
                          const std::function<bool()>& cancel) {
  const size_t batch = std::min<size_t>({choices.size(), k_batch, wavefront.slots()});
  if (batch == 0) return true;
  const gpu::Kernel& from = camera(frame);
  gpu::make_room(device_, choices_, {.name = "paths to record", .bytes = batch * sizeof(PathChoice)});
  gpu::make_room(
      device_, states_,
      {.name = "recorded paths", .bytes = batch * sizeof(PathEventState), .memory = gpu::Memory::host});
  gpu::make_room(device_, events_,
                 {.name = "events of paths",
                  .bytes = batch * events_per_path_ * sizeof(PathEvent),
                  .memory = gpu::Memory::host});
  const PathEventFrame block{events_per_path_, far};
  block_.write(&block, sizeof block);
  bool complete = true;
  wavefront.uncounted([&] {
    for (size_t first = 0; first < choices.size() && complete; first += batch)
      complete = record_batch(wavefront, from,
                              choices.subspan(first, std::min(batch, choices.size() - first)), sink, cancel);
  });
  return complete;
}

bool PathRecorder::record_batch(Wavefront& wavefront, const gpu::Kernel& camera,
                                std::span<const PathChoice> choices,
                                const std::function<void(const RecordedPath&)>& sink,
                                const std::function<bool()>& cancel) {
  const auto count = uint32_t(choices.size());
  choices_.write(choices);
  // Without a component to compute, nothing is traced.
  std::memset(states_.mapped(), 0, count * sizeof(PathEventState));
  const auto bind = [&](gpu::Resources& r) {
    r.set("PathEventBlock", block_);
    r.set("PathChoices", choices_);
    r.set("PathEventStates", states_);
    r.set("PathEvents", events_);
  };
  gpu::Resources starting;
  wavefront.bind_paths(starting);
  bind(starting);
  PathEnds ends;
  ends.begin = [&] {
    wavefront.stream().dispatch(camera, starting, TransportPush{count, 0, count, 0},
                                gpu::groups_for(count, 64), "camera");
  };
  ends.vertex = &shade_;
  ends.vertex_stage = "recorded paths";
  ends.bind_vertex = bind;
  ends.arrival = &shadow_;
  if (!wavefront.run(count, ends, cancel)) return false;
  const auto* states = static_cast<const PathEventState*>(states_.mapped());
  const auto* events = static_cast<const PathEvent*>(events_.mapped());
  for (uint32_t i = 0; i < count; ++i)
    sink({choices[i], {events + size_t{i} * events_per_path_, states[i].count}, states[i].lost});
  return true;
}

}  // namespace lucerna::transport
