#include "film/estimator.h"

namespace lucerna::film {

using namespace shared;

namespace {

gpu::Defines defines(bool lookup_errors, bool stopping_only) {
  gpu::Defines defines;
  if (lookup_errors) defines["LUCERNA_LOOKUP_ERRORS"] = "1";
  if (stopping_only) defines["LUCERNA_STOPPING_ONLY"] = "1";
  return defines;
}

}  // namespace

ErrorEstimator::ErrorEstimator(gpu::Device& device, gpu::ShaderCompiler& compiler, bool lookup_errors)
    : device_(device),
      compiler_(compiler),
      error_(device, compiler, "film/error.comp", defines(lookup_errors, false)),
      stopping_(device, compiler, "film/error.comp", defines(lookup_errors, true)) {}

void ErrorEstimator::record(gpu::Stream& stream, const gpu::Kernel& kernel, std::span<const WorkBlock> blocks,
                            const Film& film, const SeenRange& seen, const char* stage) {
  if (blocks.empty()) return;
  gpu::make_room(device_, blocks_,
                 {.name = "estimated blocks", .bytes = blocks.size_bytes(), .memory = gpu::Memory::host});
  blocks_.write(blocks);
  film.bind(resources_);
  resources_.set("WorkBlocks", blocks_);
  const auto count = static_cast<uint32_t>(blocks.size());
  const ErrorPush push{film.width(),
                       film.height(),
                       count,
                       seen.floor,
                       seen.white,
                       film.lookup_errors_complete(),
                       film.lookup_bias_known()};
  stream.dispatch(kernel, resources_, push, gpu::groups_for(count, 8), stage);
}

void ErrorEstimator::estimate(gpu::Stream& stream, const Film& film, const SeenRange& seen) {
  std::vector<WorkBlock> all;
  for (uint32_t b = 0; b < film.blocks(); ++b) all.push_back({b, 0});
  record(stream, error_, all, film, seen, "ledger");
  if (film.layers() > 0 && !layers_)
    layers_.emplace(device_, compiler_, "film/error.comp", gpu::Defines{{"LUCERNA_ERROR_LAYERS", "1"}});
  for (uint32_t first = 0; first < film.layers(); first += k_error_layers) {
    film.bind_layer_errors(resources_, first);
    record(stream, *layers_, all, film, seen, "ledger");
  }
}

void ErrorEstimator::estimate_stopping(gpu::Stream& stream, std::span<const WorkBlock> blocks,
                                       const Film& film, const SeenRange& seen) {
  record(stream, stopping_, blocks, film, seen, "stopping");
}

}  // namespace lucerna::film
