#include "transport/hit_shading.h"

#include <algorithm>

namespace lucerna::transport {

using namespace shared;

HitShading::HitShading(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t slots,
                       gpu::Defines defines, const Features& features, const HitClassRules& rules)
    : device_(device),
      compiler_(compiler),
      slots_(slots),
      defines_(std::move(defines)),
      features_(features),
      rules_(rules) {}

void HitShading::set_features(const Features& features) {
  if (features == features_) return;
  features_ = features;
  shaded_ = 0, hits_ = {};
  counting_ = chosen_ = ready_ = false;
  classes_ = {};
  compiling_ = {};
  kernels_.clear();
}

void HitShading::bind(size_t parity, const gpu::Resources& resources) {
  if (!rules_.enabled) return;
  from_[parity] = within_[parity] = resources;
  if (!queue_) return;
  from_[parity].set("ClassQueue", queue_);
  within_[parity].set("Queue", queue_);
}

void HitShading::begin_run(gpu::Stream& stream) {
  if (!rules_.enabled || ready_) return;
  if (!chosen_) {
    counting_ = shaded_ >= rules_.count_after;
    if (counting_ && !counts_)
      counts_ = gpu::Kernel(device_, compiler_, "transport/classes.comp", {{"LUCERNA_COUNT_KINDS", "1"}});
    return;
  }
  if (shaded_ < rules_.switch_after || classes_.classes.empty()) return;
  kernels_ = compiling_.get();
  queue_ = gpu::Buffer(device_, {.name = "queue by class", .bytes = uint64_t(slots_) * k_hit_classes * 4});
  for (size_t k = 0; k < 2; ++k) bind(k, gpu::Resources(from_[k]));
  // Drivers that compile at the first dispatch do so here.
  stream.dispatch(sorts_, from_[0], ClassesPush{}, 1);
  for (const gpu::Kernel& kernel : kernels_) stream.dispatch(kernel, within_[0], TransportPush{}, 1);
  stream.run();
  stream.take_times();
  ready_ = true;
}

void HitShading::count(gpu::Stream& stream, size_t parity, uint32_t hits, bool use_queue) {
  if (!counting_) return;
  stream.dispatch(counts_, from_[parity], ClassesPush{hits, use_queue ? 1u : 0u, 0, {}, 0, 0},
                  gpu::groups_for(hits, 64), "sort hits");
}

void HitShading::end_run(uint64_t hits, const uint32_t* counters) {
  shaded_ += hits;
  if (!counting_) return;
  counting_ = false;
  for (uint32_t kind = 0; kind < k_hit_kinds; ++kind) hits_[kind] += counters[k_counter_kinds + kind];
  choose();
}

void HitShading::choose() {
  classes_ = choose_hit_classes(features_, hits_);
  packed_ = packed(classes_);
  dark_ = dark_kinds(features_, defines_);
  chosen_ = true;
  if (classes_.classes.empty()) return;
  sorts_ = gpu::Kernel(device_, compiler_, "transport/classes.comp");
  std::vector<gpu::Defines> defines;
  for (const HitClass& hits : classes_.classes) defines.push_back(defines_of(hits, defines_));
  compiling_ =
      std::async(std::launch::async, [&device = device_, &compiler = compiler_, all = std::move(defines)] {
        std::vector<gpu::Kernel> kernels;
        for (const gpu::Defines& d : all) kernels.emplace_back(device, compiler, "transport/shade.comp", d);
        return kernels;
      });
}

void HitShading::sort(gpu::Stream& stream, size_t parity, uint32_t hits, bool use_queue,
                      const gpu::Buffer& counters) {
  stream.fill(counters, 0, 4 * k_counter_classes, 4 * k_hit_classes);
  stream.dispatch(sorts_, from_[parity],
                  ClassesPush{hits,
                              use_queue ? 1u : 0u,
                              slots_,
                              {packed_[0], packed_[1], packed_[2], packed_[3]},
                              dark_.diffuse,
                              dark_.all},
                  gpu::groups_for(hits, 64), "sort hits");
}

void HitShading::shade(gpu::Stream& stream, size_t parity, const gpu::Kernel& all, const uint32_t* counters) {
  std::array<uint32_t, k_hit_classes> hits;
  std::copy_n(counters + k_counter_classes, k_hit_classes, hits.begin());
  // Few of a class go with those of none.
  for (uint32_t c = 1; c < k_hit_classes; ++c)
    if (hits[c] > 0 && hits[c] < rules_.least_of_class) {
      stream.copy(queue_, queue_, uint64_t{hits[c]} * 4, uint64_t{c} * slots_ * 4, uint64_t{hits[0]} * 4);
      hits[0] += hits[c], hits[c] = 0;
    }
  for (uint32_t c = 0; c < k_hit_classes; ++c)
    if (hits[c] > 0)
      stream.dispatch(c == 0 ? all : kernels_[c - 1], within_[parity],
                      TransportPush{hits[c], 1, c * slots_, 0}, gpu::groups_for(hits[c], 64), "shade");
}

}  // namespace lucerna::transport
