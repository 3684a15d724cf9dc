#include "solvers/lookup/octree.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <limits>

namespace lucerna::lookup {

namespace {

constexpr const char* k_stage = "octree";

/// Usual and maximum number of invocations of the kernels that process runs.
uint32_t wanted_for(const gpu::Device& device) { return device.info().is_cpu ? 1024 : 16384; }
uint32_t runs_for(const gpu::Device& device) { return device.info().is_cpu ? 4096 : 16384; }
uint32_t group_for(const gpu::Device& device) { return device.info().is_cpu ? 8 : 64; }

/// Levels by which leaves may be split. Counts must fit into 32 bits: all spheres in all cells of their leaf,
/// and the leaf's mark.
uint32_t most_split(const shared::OctreeHeader& header) {
  uint32_t levels = shared::k_octree_most_split;
  while (((uint64_t{1} << 3 * levels) + 1) * header.references > std::numeric_limits<uint32_t>::max())
    --levels;
  return levels;
}

/// Codes of cells lie above those of leaves, and a reference needs a bit for that.
uint64_t codes(const shared::OctreeHeader& header) {
  return (uint64_t{1} << 3 * header.level) + header.split_cells;
}

}  // namespace

Octree::Octree(gpu::Device& device, gpu::ShaderCompiler& compiler, const OctreeOptions& options)
    : options_(options),
      groups_(runs_for(device) / group_for(device)),
      prefix_sum_(device, compiler),
      sorter_(device, compiler, sort::Keys::bits32) {
  const uint32_t most = most_references(device);
  if (options.references > most)
    throw_error("octree", "{} references; buffers hold {} here", options.references, most);
  if (options.spheres > k_most_spheres)
    throw_error("octree", "{} spheres; it counts {} at most", options.spheres, k_most_spheres);
  const uint64_t runs = runs_for(device);
  const gpu::Defines defines{{"LUCERNA_OCTREE_GROUP", std::to_string(group_for(device)) + "u"},
                             {"LUCERNA_OCTREE_WANTED", std::to_string(wanted_for(device)) + "u"},
                             {"LUCERNA_OCTREE_RUNS", std::to_string(runs) + "u"},
                             {"LUCERNA_OCTREE_SINGLE", options.single_reference ? "1" : "0"},
                             {"LUCERNA_OCTREE_DISCS", options.discs ? "1" : "0"}};
  const std::pair<gpu::Kernel*, const char*> kernels[] = {{&bounds_, "bounds"},
                                                          {&grid_, "grid"},
                                                          {&levels_, "levels"},
                                                          {&choose_, "choose"},
                                                          {&count_, "count"},
                                                          {&write_, "write"},
                                                          {&heads_, "heads"},
                                                          {&leaves_, "leaves"},
                                                          {&clear_, "clear"},
                                                          {&insert_, "insert"},
                                                          {&expand_, "expand"},
                                                          {&copy_, "copy"},
                                                          {&crowd_, "crowd"},
                                                          {&split_count_, "split_count"},
                                                          {&split_write_, "split_write"}};
  for (const auto& [kernel, name] : kernels)
    *kernel = gpu::Kernel(device, compiler, std::string("lookup/") + name + ".comp", defines);

  const auto buffer = [&](const char* name, uint64_t bytes) {
    return gpu::Buffer(
        device, {.name = std::string("octree ") + name, .bytes = (bytes + 15) / 16 * 16, .texel = true});
  };
  const uint64_t references = std::max(options.references, 1u), slots = std::bit_ceil(references + 1);
  header_buffer_ = buffer("header", sizeof(shared::OctreeHeader));
  run_bounds_ = buffer("bounds of runs", runs * 3 * sizeof(vec4));
  run_needs_ = buffer("needs of runs", runs * (shared::k_octree_levels + 1) * sizeof(uint32_t));
  run_leaves_ = buffer("leaves of runs", runs * sizeof(uint32_t));
  sphere_references_ = buffer("references of spheres", uint64_t(options.spheres) * sizeof(uint32_t));
  for (gpu::Buffer& pairs : pairs_) pairs = buffer("references", references * sizeof(shared::SortPair));
  slot_leaves_ = buffer("leaves of slots", slots * sizeof(uint32_t));
  slots_ = buffer("slots", slots * sizeof(uvec4));
  copies_ = buffer("copies", options.copies ? references * sizeof(vec4) : 0);
  splits_ = buffer("splits", (options.crowd > 0 ? references : 1) * sizeof(uint32_t));
  leaf_cells_ = buffer("cells of leaves", (options.crowd > 0 ? references : 1) * sizeof(uint32_t));
  unused_ = buffer("unused count", sizeof(uint32_t));
  references_ = &pairs_[0];
  // Before the first build: no cells, and a table of free slots.
  header_.inverse_leaf = 1, header_.slots = 2, header_.slot_shift = 31;
  header_buffer_.write(&header_, sizeof(header_));
  const uvec4 free[2] = {{shared::k_octree_no_leaf, 0, 0, 0}, {shared::k_octree_no_leaf, 0, 0, 0}};
  slots_.write(free, sizeof(free));
}

/// Context of one build: its stream, resources and push constants.
struct Octree::Work {
  gpu::Stream& stream;
  gpu::Resources resources{};
  shared::OctreePush push{};

  void run(const gpu::Kernel& kernel, uint32_t groups) {
    // Kernels without push constants get none.
    stream.dispatch(kernel, resources, &push, kernel.push_constant_bytes(), groups, k_stage);
  }
};

const shared::OctreeHeader& Octree::build(gpu::Stream& stream, const gpu::Buffer& spheres,
                                          const sort::Count& count, const Discs* discs) {
  assert(options_.discs == (discs != nullptr));
  if (count.most > options_.spheres || spheres.bytes() / sizeof(vec4) < count.most)
    throw_error("octree", "{} spheres were given; it was made for {}, and '{}' has room for {}", count.most,
                options_.spheres, spheres.name(), spheres.bytes() / sizeof(vec4));
  Work work{stream};
  bind_spheres(work, spheres, count, discs);
  write_references(work, count);
  const sort::Count written{work.push.capacity, &header_buffer_, offsetof(shared::OctreeHeader, references)};
  references_ = &sorter_.encode(stream, pairs_[0], pairs_[1], written, 3 * header_.level, k_stage);
  if (options_.crowd > 0 && header_.overflow == 0) work.push.most_split = most_split(header_);
  cut_into_leaves(work);
  if (work.push.most_split > 0) split_crowded(work, written);
  if (options_.copies) work.run(copy_, groups_);
  stream.run();
  const uint32_t split = header_.split;
  header_buffer_.read(&header_, sizeof(header_));
  header_.split = split;
  header_.references = std::min(header_.references, header_.capacity);
  return header_;
}

void Octree::bind_spheres(Work& work, const gpu::Buffer& spheres, const sort::Count& count,
                          const Discs* discs) const {
  gpu::Resources& r = work.resources;
  r.set("spheres", spheres);
  r.set("SphereCount", count.buffer ? *count.buffer : unused_);
  r.set("OctreeHeaders", header_buffer_);
  r.set("RunBounds", run_bounds_);
  r.set("RunNeeds", run_needs_);
  r.set("RunLeaves", run_leaves_);
  r.set("SphereReferences", sphere_references_);
  r.set("sphere_places", sphere_references_);
  r.set("References", pairs_[0]);
  r.set("SlotLeaves", slot_leaves_);
  r.set("slot_leaf_texels", slot_leaves_);
  r.set("Slots", slots_);
  r.set("Copies", copies_);
  r.set("LeafSplits", splits_);
  r.set("LeafCells", leaf_cells_);
  r.set("SplitReferences", splits_);
  r.set("split_places", splits_);
  r.set("octree_slots", slots_);
  if (discs) r.set("disc_normals", discs->normals);
  work.push = {count.most,
               count.buffer ? uint32_t(count.offset / 4) : shared::k_sort_count_here,
               std::max(options_.references, 1u),
               uint32_t(slots_.bytes() / sizeof(uvec4)),
               std::max(options_.crowd > 0 ? options_.references / 2 : options_.references, 1u),
               0,
               options_.crowd,
               options_.leaf_scale,
               discs ? discs->stride : 0,
               discs ? discs->at : 0,
               discs ? discs->thickness : 0,
               core_.empty() ? vec3(1) : core_.lo,
               core_.empty() ? vec3(-1) : core_.hi};
}

/// Chooses the leaf level by the available memory, and writes a reference for each leaf that a sphere
/// overlaps, in sphere order.
void Octree::write_references(Work& work, const sort::Count& count) {
  work.run(bounds_, groups_);
  work.run(grid_, 1);
  work.run(levels_, groups_);
  work.run(choose_, 1);
  const uint32_t sphere_groups = gpu::groups_for(count.most, 64);
  work.run(count_, sphere_groups);
  prefix_sum_.encode(work.stream, sphere_references_, sphere_references_, count, &header_buffer_,
                     offsetof(shared::OctreeHeader, references), k_stage);
  work.run(write_, sphere_groups);
  work.stream.run();
  header_buffer_.read(&header_, sizeof(header_));
}

/// Makes leaves from the sorted references, and the hash table.
void Octree::cut_into_leaves(Work& work) {
  // The sort's spare buffer has room for one leaf per reference, which is enough.
  const gpu::Buffer& leaves = references_ == &pairs_[0] ? pairs_[1] : pairs_[0];
  work.resources.set("octree_references", *references_);
  work.resources.set("Leaves", leaves);
  work.resources.set("leaf_texels", leaves);
  work.run(heads_, groups_);
  prefix_sum_.encode(work.stream, run_leaves_, run_leaves_, {.most = uint32_t(run_leaves_.bytes() / 4)},
                     &header_buffer_, offsetof(shared::OctreeHeader, leaves), k_stage);
  work.run(leaves_, groups_);
  work.run(clear_, groups_);
  work.run(insert_, groups_);
  if (work.push.most_split == 0) work.run(expand_, groups_);
}

/// Splits leaves with many spheres into cells, by fewer levels if memory does not suffice for all references.
void Octree::split_crowded(Work& work, const sort::Count& written) {
  gpu::Stream& stream = work.stream;
  const uint32_t groups = gpu::groups_for(header_.references, 64);
  shared::OctreeHeader now;
  for (; work.push.most_split > 0; --work.push.most_split) {
    work.run(crowd_, groups);  // there are no more leaves than references
    prefix_sum_.encode(stream, leaf_cells_, leaf_cells_,
                       {header_.references, &header_buffer_, offsetof(shared::OctreeHeader, leaves)},
                       &header_buffer_, offsetof(shared::OctreeHeader, split_cells), k_stage);
    work.run(expand_, groups_);
    work.run(split_count_, groups);
    prefix_sum_.encode(stream, splits_, splits_, {.most = header_.references}, &header_buffer_,
                       offsetof(shared::OctreeHeader, split_references), k_stage);
    stream.run();
    header_buffer_.read(&now, sizeof(now));
    if (now.split_references <= header_.capacity && codes(now) <= shared::k_octree_split) break;
  }
  header_.split = work.push.most_split;
  work.push.most_split = 0;
  if (header_.split == 0) {  // memory does not suffice for any level
    work.run(expand_, groups_);
    return;
  }
  if (now.split_references == header_.references) return;  // no leaf is crowded
  const bool second = references_ == &pairs_[0];
  work.resources.set("References", pairs_[second]);
  work.run(split_write_, groups);
  stream.run();
  header_.references = now.split_references;
  header_buffer_.write(&header_.references, sizeof(uint32_t), offsetof(shared::OctreeHeader, references));
  references_ = &sorter_.encode(stream, pairs_[second], pairs_[!second], written,
                                uint32_t(std::bit_width(codes(now) - 1)), k_stage);
  cut_into_leaves(work);
}

void Octree::bind(gpu::Resources& resources) const {
  resources.set("OctreeHeaders", header_buffer_);
  resources.set("octree_slots", slots_);
  resources.set("octree_references", *references_);
  resources.set("octree_copies", copies_);
}

uint32_t Octree::most_references(const gpu::Device& device) {
  // The table of slots is the largest buffer: a power of two above the number of references.
  const uint64_t slots = std::bit_floor(device.info().limits.max_storage_buffer / sizeof(uvec4));
  return uint32_t(std::min<uint64_t>(slots, 1u << 27) - 1);
}

uint64_t Octree::bytes() const {
  uint64_t sum = 0;
  for (const gpu::Buffer* b :
       {&header_buffer_, &run_bounds_, &run_needs_, &run_leaves_, &sphere_references_, &pairs_[0], &pairs_[1],
        &slot_leaves_, &slots_, &copies_, &splits_, &leaf_cells_})
    sum += b->bytes();
  return sum;
}

}  // namespace lucerna::lookup
