#include "solvers/irradiance_cache/placement.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "sort/prefix_sum.h"
#include "sort/radix_sort.h"

namespace lucerna::irradiance_cache {

using namespace shared;

namespace {

constexpr const char* k_placing = "placement";
/// Maximum number of rounds of choosing. The first cuts clusters by size, and clusters cut apart cannot see
/// each other's candidates.
constexpr uint32_t k_rounds = 6;

Place place_of(const vec4& place, const vec4& facing, uint32_t medium) {
  const auto bits = std::bit_cast<uint32_t>(facing.w);
  return {.position = vec3(place),
          .normal = vec3(facing),
          .facet = bits & ((1u << k_place_origin_shift) - 1),
          .origin = bits >> k_place_origin_shift,
          .medium = medium,
          .reach = place.w};
}

/// Limits the choice to `most`: whole ranks (the first of every cluster, the second, ...) while they fit; the
/// next rank is spread evenly over the clusters. `having`: places by cluster; returns how many of each to
/// keep.
std::vector<size_t> share_out(const std::vector<size_t>& having, size_t most) {
  std::vector<size_t> quota(having.size(), 0);
  for (size_t left = most, rank = 0; left > 0; ++rank) {
    std::vector<size_t> wanting;
    for (size_t c = 0; c < having.size(); ++c)
      if (having[c] > rank) wanting.push_back(c);
    const size_t fitting = std::min(left, wanting.size());
    for (size_t k = 0; k < fitting; ++k) ++quota[wanting[k * wanting.size() / fitting]];
    left -= fitting;
    if (fitting == 0 || fitting < wanting.size()) break;
  }
  return quota;
}

gpu::Kernel kernel_of(gpu::Device& device, gpu::ShaderCompiler& compiler, const char* name,
                      const gpu::Defines& defines = {}) {
  return gpu::Kernel(device, compiler, std::string("irradiance_cache/") + name + ".comp", defines);
}

gpu::Buffer small_buffer(gpu::Device& device, const char* name, uint64_t bytes,
                         gpu::Memory memory = gpu::Memory::host) {
  return gpu::Buffer(device, {.name = name, .bytes = bytes, .memory = memory, .texel = true});
}

/// Prefix sums of flags, and their total.
struct Sums {
  sort::PrefixSum prefix_sum;
  gpu::Buffer total;

  Sums(gpu::Device& device, gpu::ShaderCompiler& compiler)
      : prefix_sum(device, compiler), total(small_buffer(device, "candidates' sum", 16)) {}
  void encode(gpu::Stream& stream, const gpu::Buffer& flags, const gpu::Buffer& before, uint32_t count) {
    prefix_sum.encode(stream, flags, before, {.most = count}, &total, 0, k_placing);
  }
  /// Valid once the stream has run.
  uint32_t sum() const { return *static_cast<const uint32_t*>(total.mapped()); }
};

/// The first `size` entries of each list are candidates, in order of collection.
struct Candidates {
  gpu::Device& device;
  gpu::Buffer places, facings, media;
  uint32_t size = 0;

  /// Makes room for that many; existing ones stay.
  void reserve(gpu::Stream& stream, uint32_t candidates) {
    for (auto [buffer, name, each] : {std::tuple{&places, "candidates", sizeof(vec4)},
                                      {&facings, "candidates' normals", sizeof(vec4)},
                                      {&media, "candidates' media", sizeof(uint32_t)}}) {
      const uint64_t bytes = (uint64_t{candidates} * each + 15) / 16 * 16;
      if (*buffer && buffer->bytes() >= bytes) continue;
      const uint64_t limit = device.info().limits.max_storage_buffer / 16 * 16;
      gpu::Buffer larger(device,
                         {.name = name, .bytes = std::max(bytes, std::min(2 * bytes, limit)), .texel = true});
      if (size > 0) {
        stream.copy(*buffer, larger, size * each);
        stream.run();
      }
      *buffer = std::move(larger);
    }
  }
  void add(gpu::Stream& stream, std::span<const Place> list) {
    reserve(stream, size + uint32_t(list.size()));
    std::vector<vec4> where, facing;
    std::vector<uint32_t> medium;
    for (const Place& c : list) {
      where.emplace_back(c.position, c.reach);
      facing.emplace_back(c.normal, std::bit_cast<float>(c.facet | c.origin << k_place_origin_shift));
      medium.push_back(c.medium);
    }
    places.write(std::span<const vec4>(where), size);
    facings.write(std::span<const vec4>(facing), size);
    media.write(std::span<const uint32_t>(medium), size);
    size += uint32_t(list.size());
  }
  std::vector<Place> read() const {
    std::vector<vec4> where(size), facing(size);
    std::vector<uint32_t> medium(size);
    places.read(where.data(), size * sizeof(vec4));
    facings.read(facing.data(), size * sizeof(vec4));
    media.read(medium.data(), size * sizeof(uint32_t));
    std::vector<Place> all;
    for (uint32_t i = 0; i < size; ++i) all.push_back(place_of(where[i], facing[i], medium[i]));
    return all;
  }
};

/// Appends candidates.
struct Collector {
  gpu::Device& device;
  gpu::Kernel count_candidates, from_paths, from_screen;
  gpu::Buffer counts;         // of each block, by origin
  gpu::Buffer taken, before;  // per slot, or per point of the picture
  gpu::Resources resources;

  Collector(gpu::Device& d, gpu::ShaderCompiler& compiler)
      : device(d),
        count_candidates(kernel_of(d, compiler, "count_candidates")),
        from_paths(kernel_of(d, compiler, "collect", {{"LUCERNA_FROM_SCREEN", "0"}})),
        from_screen(kernel_of(d, compiler, "collect", {{"LUCERNA_FROM_SCREEN", "1"}})) {}

  static CollectPush push_of(const ReachOptions& r, uint32_t count) {
    CollectPush push{};
    push.count = count;
    push.parallel = r.parallel;
    push.spacing = r.spacing, push.spacing_beyond = r.spacing_beyond;
    push.spacing_of_distance = r.spacing_of_distance;
    push.eye = r.eye;
    return push;
  }

  /// Collects the entries that `flags` mark, with a kernel that reads them. Returns their number.
  uint32_t append(gpu::Stream& stream, Sums& sums, Candidates& to, const gpu::Kernel& kernel,
                  const gpu::Buffer& flags, CollectPush push) {
    gpu::make_texel_room(device, before, "candidates before", uint64_t{push.count} * 4);
    sums.encode(stream, flags, before, push.count);
    stream.run();
    const uint32_t added = sums.sum();
    if (added == 0) return 0;
    to.reserve(stream, to.size + added);
    push.to = to.size;
    resources.set("Taken", flags);
    resources.set("TakenBefore", before);
    resources.set("Places", to.places);
    resources.set("Facings", to.facings);
    resources.set("Media", to.media);
    stream.dispatch(kernel, resources, push, gpu::groups_for(push.count, 64), k_placing);
    stream.run();
    to.size += added;
    return added;
  }
};

struct ChoosingKernels {
  gpu::Kernel bounds, grid, keys, heads, starts, choose, chosen, keep;

  ChoosingKernels(gpu::Device& d, gpu::ShaderCompiler& c)
      : bounds(kernel_of(d, c, "place_bounds")),
        grid(kernel_of(d, c, "place_grid")),
        keys(kernel_of(d, c, "place_keys")),
        heads(kernel_of(d, c, "place_heads")),
        starts(kernel_of(d, c, "place_starts")),
        choose(kernel_of(d, c, "place_choose")),
        chosen(kernel_of(d, c, "place_chosen")),
        keep(kernel_of(d, c, "place_keep")) {}
};

struct ChoosingBuffers {
  gpu::Buffer grid, run_bounds, count;
  gpu::Buffer entries[3];  // keys of the candidates, sorted; then those of the remaining ones, alternating
  gpu::Buffer head_flags, head_sums, cluster_starts, ranks;

  explicit ChoosingBuffers(gpu::Device& d)
      : grid(small_buffer(d, "candidates' grid", 32, gpu::Memory::device)),
        run_bounds(small_buffer(d, "candidates' bounds", k_bounds_runs * 32, gpu::Memory::device)),
        count(small_buffer(d, "candidates' count", 16)) {}

  void make_room(gpu::Device& device, uint32_t candidates) {
    for (gpu::Buffer& e : entries)
      gpu::make_texel_room(device, e, "candidates' keys", uint64_t{candidates} * sizeof(SortEntry64));
    for (auto [buffer, name] : {std::pair{&head_flags, "heads of clusters"},
                                {&head_sums, "heads' sums"},
                                {&cluster_starts, "clusters"},
                                {&ranks, "candidates' ranks"}})
      gpu::make_texel_room(device, *buffer, name, uint64_t{candidates} * 4);
  }
  void bind(gpu::Resources& to, const Candidates& candidates) const {
    to.set("Grid", grid);
    to.set("place_texels", candidates.places);
    to.set("facing_texels", candidates.facings);
    to.set("RunBounds", run_bounds);
    to.set("run_bound_texels", run_bounds);
    to.set("Entries", entries[0]);
    to.set("Heads", head_flags);
    to.set("HeadsBefore", head_sums);
    to.set("Starts", cluster_starts);
    to.set("Ranks", ranks);
    to.set("Total", count);
  }
};

/// Clusters of the candidates that remain after the last round, and their entries.
struct Round {
  const gpu::Buffer* entries = nullptr;
  uint32_t left = 0, clusters = 0;
};

/// Sorts candidates, cuts them into clusters and draws from each.
struct Chooser {
  gpu::Device& device;
  sort::RadixSort sorter;
  ChoosingKernels kernels;
  ChoosingBuffers buffers;
  gpu::Resources resources;
  // State of the last choice:
  const gpu::Buffer* sorted = nullptr;
  std::vector<uint32_t> first_starts;  // where clusters begin
  std::vector<uint32_t> picks;         // source indices, in Morton order

  Chooser(gpu::Device& d, gpu::ShaderCompiler& compiler)
      : device(d), sorter(d, compiler, sort::Keys::bits64), kernels(d, compiler), buffers(d) {}

  void forget() {
    sorted = nullptr;
    first_starts.clear(), picks.clear();
  }

  /// Ranks all chosen ones of `n` > 0 candidates on the device.
  Round run(gpu::Stream& stream, Sums& sums, const Candidates& candidates, const ChoiceOptions& o) {
    uint32_t n = candidates.size;
    ChoosingBuffers& b = buffers;
    b.make_room(device, n);
    b.bind(resources, candidates);
    ChoosePush push{n, o.seed, o.normal_tolerance};
    const auto dispatch = [&](const gpu::Kernel& kernel, uint32_t items) {
      push.count = &kernel == &kernels.choose ? items : n;
      stream.dispatch(kernel, resources, &push, kernel.push_constant_bytes(), gpu::groups_for(items, 64),
                      k_placing);
    };
    dispatch(kernels.bounds, k_bounds_runs);
    dispatch(kernels.grid, 1);
    dispatch(kernels.keys, n);
    sorted = &sorter.encode(stream, b.entries[0], b.entries[1], {.most = n}, 3 * k_morton_bits, k_placing);
    const gpu::Buffer* from = sorted;
    const gpu::Buffer& spare = from == &b.entries[0] ? b.entries[1] : b.entries[0];
    for (uint32_t round = 0;; ++round) {
      b.count.write(&n, sizeof n);
      resources.set("entry_texels", *from);
      dispatch(kernels.heads, n);
      sums.encode(stream, b.head_flags, b.head_sums, n);
      dispatch(kernels.starts, n);
      stream.run();
      const uint32_t clusters = sums.sum();
      if (round == 0) {
        first_starts.resize(clusters);
        b.cluster_starts.read(first_starts.data(), clusters * sizeof(uint32_t));
      }
      dispatch(kernels.choose, clusters);
      dispatch(kernels.chosen, n);
      sums.encode(stream, b.head_flags, b.head_sums, n);
      stream.run();
      if (sums.sum() == n || round + 1 == k_rounds) return {from, n, clusters};
      const gpu::Buffer& to = from == &spare ? b.entries[2] : spare;
      resources.set("Kept", to);
      dispatch(kernels.keep, n);
      stream.run();
      n = sums.sum();
      from = &to;
    }
  }

  /// The ranked ones, at most `most`.
  void pick(const Round& last, size_t most) {
    const uint32_t n = last.left, clusters = last.clusters;
    std::vector<SortEntry64> entries(n);
    std::vector<uint32_t> ranks(n), starts(clusters + 1, n);
    last.entries->read(entries.data(), n * sizeof(SortEntry64));
    buffers.ranks.read(ranks.data(), n * sizeof(uint32_t));
    buffers.cluster_starts.read(starts.data(), clusters * sizeof(uint32_t));
    std::vector<size_t> having(clusters, 0);
    for (uint32_t c = 0; c < clusters; ++c)
      for (uint32_t i = starts[c]; i < starts[c + 1]; ++i) having[c] += ranks[i] > 0;
    const std::vector<size_t> quota = share_out(having, most);
    for (uint32_t c = 0; c < clusters; ++c)
      for (uint32_t i = starts[c]; i < starts[c + 1]; ++i)
        if (ranks[i] > 0 && ranks[i] <= quota[c]) picks.push_back(entries[i].value);
  }
};

}  // namespace

struct Placement::Impl {
  Sums sums;
  Candidates candidates;
  Collector collector;
  Chooser chooser;

  Impl(gpu::Device& device, gpu::ShaderCompiler& compiler)
      : sums(device, compiler),
        candidates{device, {}, {}, {}},
        collector(device, compiler),
        chooser(device, compiler) {}
};

Placement::Placement(gpu::Device& device, gpu::ShaderCompiler& compiler)
    : impl_(std::make_unique<Impl>(device, compiler)) {}
Placement::~Placement() = default;

void Placement::clear() {
  impl_->candidates.size = 0;
  impl_->chooser.forget();
}

uint32_t Placement::size() const { return impl_->candidates.size; }

uint64_t Placement::bytes() const {
  const Candidates& c = impl_->candidates;
  const Collector& collector = impl_->collector;
  const ChoosingBuffers& b = impl_->chooser.buffers;
  uint64_t sum = 0;
  for (const gpu::Buffer* buffer :
       {&c.places, &c.facings, &c.media, &collector.taken, &collector.before, &b.entries[0], &b.entries[1],
        &b.entries[2], &b.head_flags, &b.head_sums, &b.cluster_starts, &b.ranks})
    sum += *buffer ? buffer->bytes() : 0;
  return sum;
}

std::vector<std::array<uint32_t, 3>> Placement::collect(gpu::Stream& stream, const gpu::Buffer& candidates,
                                                        uint32_t slots, uint32_t samples, bool screen_too,
                                                        const ReachOptions& reach) {
  Collector& c = impl_->collector;
  if (slots == 0) return {};
  CollectPush push = Collector::push_of(reach, slots);
  push.samples = samples;
  push.screen_too = screen_too;
  std::vector<std::array<uint32_t, 3>> counts((slots + 64 * samples - 1) / (64 * samples));
  gpu::make_room(
      c.device, c.counts,
      {.name = "candidate counts", .bytes = counts.size() * sizeof counts[0], .memory = gpu::Memory::host});
  gpu::make_texel_room(c.device, c.taken, "slots with candidates", uint64_t{slots} * 4);
  c.resources.set("candidate_texels", candidates);
  c.resources.set("Taken", c.taken);
  c.resources.set("CandidateCounts", c.counts);
  stream.fill(c.counts, 0);
  stream.dispatch(c.count_candidates, c.resources, push, gpu::groups_for(slots, 64), k_placing);
  c.append(stream, impl_->sums, impl_->candidates, c.from_paths, c.taken, push);
  c.counts.read(counts.data(), counts.size() * sizeof counts[0]);
  return counts;
}

uint32_t Placement::collect(gpu::Stream& stream, const Screen& screen, const ReachOptions& reach) {
  Collector& c = impl_->collector;
  if (screen.points == 0) return 0;
  CollectPush push = Collector::push_of(reach, screen.points);
  push.cell = screen.cell, push.pixel = screen.pixel;
  c.resources.set("surface_texels", screen.surfaces);
  c.resources.set("TakenLevels", screen.levels);
  return c.append(stream, impl_->sums, impl_->candidates, c.from_screen, screen.taken, push);
}

void Placement::add(gpu::Stream& stream, std::span<const Place> list) { impl_->candidates.add(stream, list); }

std::vector<Place> Placement::choose(gpu::Stream& stream, const ChoiceOptions& o) {
  Chooser& c = impl_->chooser;
  c.forget();
  if (size() == 0 || o.most == 0) return {};
  c.pick(c.run(stream, impl_->sums, impl_->candidates, o), o.most);
  const std::vector<Place> collected = impl_->candidates.read();
  std::vector<Place> all;
  for (const uint32_t i : c.picks) all.push_back(collected[i]);
  return all;
}

Choice Placement::choice() const {
  const Chooser& c = impl_->chooser;
  Choice all;
  if (size() == 0) return all;
  std::vector<Place> collected = impl_->candidates.read();
  if (!c.sorted) {
    all.candidates = std::move(collected);
    return all;
  }
  std::vector<SortEntry64> entries(size());
  c.sorted->read(entries.data(), size() * sizeof(SortEntry64));
  std::vector<uint32_t> rank_of(size());
  for (uint32_t i = 0, cluster = 0; i < size(); ++i) {
    const uint32_t source = entries[i].value;
    rank_of[source] = i;
    all.candidates.push_back(collected[source]);
    if (cluster + 1 < c.first_starts.size() && i == c.first_starts[cluster + 1]) ++cluster;
    all.cluster.push_back(cluster);
  }
  for (const uint32_t pick : c.picks) all.chosen.push_back(rank_of[pick]);
  return all;
}

uint32_t Placement::clusters() const { return uint32_t(impl_->chooser.first_starts.size()); }

}  // namespace lucerna::irradiance_cache
