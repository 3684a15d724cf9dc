#include "solvers/irradiance_cache/placement.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <numeric>
#include <set>
#include <unordered_map>

#include "sort/prefix_sum.h"
#include "sort/radix_sort.h"

namespace lucerna::irradiance_cache {

using namespace shared;

namespace {

constexpr const char* k_stage = "placement";
/// Choosings at most: the first leaves what clusters that were cut for their number could not see of each
/// other.
constexpr uint32_t k_rounds = 6;

uint64_t mix(uint64_t x) {  // splitmix64's finalizer
  x ^= x >> 30, x *= 0xbf58476d1ce4e5b9ull;
  x ^= x >> 27, x *= 0x94d049bb133111ebull;
  return x ^ x >> 31;
}

Place place_of(const vec4& place, const vec4& facing, uint32_t medium) {
  const auto bits = std::bit_cast<uint32_t>(facing.w);
  return {.position = vec3(place),
          .normal = vec3(facing),
          .facet = bits & ((1u << k_place_origin_shift) - 1),
          .origin = bits >> k_place_origin_shift,
          .medium = medium,
          .reach = place.w};
}

/// When there are more than `most`: whole ranks (the first of every cluster, the second, ...) while they fit,
/// and of the next one evenly over the clusters. `having`: by cluster; returns how many of each.
std::vector<size_t> share_out(const std::vector<size_t>& having, size_t most) {
  std::vector<size_t> quota(having.size(), 0);
  for (size_t left = most, rank = 0; left > 0; ++rank) {
    std::vector<size_t> asking;
    for (size_t c = 0; c < having.size(); ++c)
      if (having[c] > rank) asking.push_back(c);
    const size_t fitting = std::min(left, asking.size());
    for (size_t k = 0; k < fitting; ++k) ++quota[asking[k * asking.size() / fitting]];
    left -= fitting;
    if (fitting == 0 || fitting < asking.size()) break;
  }
  return quota;
}

}  // namespace

struct Placement::Impl {
  gpu::Device& device;
  sort::PrefixSum prefix_sum;
  sort::RadixSort sorter;
  gpu::Kernel asks, collect_paths, collect_screen, bounds, grid, keys, heads, starts, choose, chosen, keep;
  gpu::Buffer places, facings, media;  // of the candidates
  gpu::Buffer asked, taken, before;    // while they are collected
  gpu::Buffer entries[3], head_flags, head_sums, cluster_starts, ranks;
  gpu::Buffer grid_buffer, run_bounds, total, count;
  gpu::Resources resources;
  uint32_t size = 0;
  // Of the last choice:
  const gpu::Buffer* sorted = nullptr;
  std::vector<uint32_t> first_starts, picks;  // clusters begin there; source indices, in Morton order

  Impl(gpu::Device& d, gpu::ShaderCompiler& compiler)
      : device(d), prefix_sum(d, compiler), sorter(d, compiler, sort::Keys::bits64) {
    const auto kernel = [&](const char* name, const gpu::Defines& defines = {}) {
      return gpu::Kernel(device, compiler, std::string("irradiance_cache/") + name + ".comp", defines);
    };
    asks = kernel("asks"), collect_paths = kernel("collect", {{"LUCERNA_FROM_SCREEN", "0"}});
    collect_screen = kernel("collect", {{"LUCERNA_FROM_SCREEN", "1"}});
    bounds = kernel("place_bounds"), grid = kernel("place_grid"), keys = kernel("place_keys");
    heads = kernel("place_heads"), starts = kernel("place_starts"), choose = kernel("place_choose");
    chosen = kernel("place_chosen"), keep = kernel("place_keep");
    const auto small = [&](const char* name, uint64_t bytes, gpu::Memory memory) {
      return gpu::Buffer(device, {.name = name, .bytes = bytes, .memory = memory, .texel = true});
    };
    asked = small("candidates asked", 16, gpu::Memory::host);
    total = small("candidates' sum", 16, gpu::Memory::host);
    count = small("candidates' count", 16, gpu::Memory::host);
    grid_buffer = small("candidates' grid", 32, gpu::Memory::device);
    run_bounds = small("candidates' bounds", k_bounds_runs * 32, gpu::Memory::device);
  }

  /// Room for that many candidates; what there is stays.
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

  /// All candidates, in the order in which they were collected.
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

  uint32_t sum() const { return *static_cast<const uint32_t*>(total.mapped()); }

  /// Appends what `flags` mark, by a kernel that reads them.
  uint32_t append(gpu::Stream& stream, const gpu::Kernel& kernel, const gpu::Buffer& flags,
                  CollectPush push) {
    gpu::make_texel_room(device, before, "candidates before", uint64_t{push.count} * 4);
    prefix_sum.encode(stream, flags, before, {.most = push.count}, &total, 0, k_stage);
    stream.run();
    const uint32_t added = sum();
    if (added == 0) return 0;
    reserve(stream, size + added);
    push.to = size;
    resources.set("Taken", flags);
    resources.set("TakenBefore", before);
    resources.set("Places", places);
    resources.set("Facings", facings);
    resources.set("Media", media);
    stream.dispatch(kernel, resources, push, gpu::groups_for(push.count, 64), k_stage);
    stream.run();
    size += added;
    return added;
  }

  static CollectPush push_of(const ReachOptions& r, uint32_t count) {
    CollectPush push{};
    push.count = count;
    push.parallel = r.parallel;
    push.spacing = r.spacing, push.spacing_beyond = r.spacing_beyond;
    push.spacing_of_distance = r.spacing_of_distance;
    push.eye = r.eye;
    return push;
  }
};

Placement::Placement(gpu::Device& device, gpu::ShaderCompiler& compiler)
    : impl_(std::make_unique<Impl>(device, compiler)) {}
Placement::~Placement() = default;

void Placement::clear() {
  impl_->size = 0;
  impl_->sorted = nullptr;
  impl_->first_starts.clear(), impl_->picks.clear();
}

uint32_t Placement::size() const { return impl_->size; }

uint64_t Placement::bytes() const {
  const Impl& p = *impl_;
  uint64_t sum = 0;
  for (const gpu::Buffer* b :
       {&p.places, &p.facings, &p.media, &p.taken, &p.before, &p.entries[0], &p.entries[1], &p.entries[2],
        &p.head_flags, &p.head_sums, &p.cluster_starts, &p.ranks})
    sum += *b ? b->bytes() : 0;
  return sum;
}

std::array<uint32_t, 3> Placement::collect(gpu::Stream& stream, const gpu::Buffer& candidates, uint32_t slots,
                                           uint32_t samples, bool screen_too, const ReachOptions& reach) {
  Impl& p = *impl_;
  if (slots == 0) return {};
  CollectPush push = Impl::push_of(reach, slots);
  push.samples = samples;
  push.screen_too = screen_too;
  gpu::make_texel_room(p.device, p.taken, "slots that ask", uint64_t{slots} * 4);
  p.resources.set("candidate_texels", candidates);
  p.resources.set("Taken", p.taken);
  p.resources.set("Asked", p.asked);
  stream.fill(p.asked, 0);
  stream.dispatch(p.asks, p.resources, push, gpu::groups_for(slots, 64), k_stage);
  p.append(stream, p.collect_paths, p.taken, push);
  const auto* asked = static_cast<const uint32_t*>(p.asked.mapped());
  return {asked[0], asked[1], asked[2]};
}

uint32_t Placement::collect(gpu::Stream& stream, const Screen& screen, const ReachOptions& reach) {
  Impl& p = *impl_;
  if (screen.points == 0) return 0;
  CollectPush push = Impl::push_of(reach, screen.points);
  push.cell = screen.cell, push.pixel = screen.pixel;
  p.resources.set("surface_texels", screen.surfaces);
  p.resources.set("TakenLevels", screen.levels);
  return p.append(stream, p.collect_screen, screen.taken, push);
}

void Placement::add(gpu::Stream& stream, std::span<const Place> list) {
  Impl& p = *impl_;
  p.reserve(stream, p.size + uint32_t(list.size()));
  std::vector<vec4> places, facings;
  std::vector<uint32_t> media;
  for (const Place& c : list) {
    places.emplace_back(c.position, c.reach);
    facings.emplace_back(c.normal, std::bit_cast<float>(c.facet | c.origin << k_place_origin_shift));
    media.push_back(c.medium);
  }
  p.places.write(std::span<const vec4>(places), p.size);
  p.facings.write(std::span<const vec4>(facings), p.size);
  p.media.write(std::span<const uint32_t>(media), p.size);
  p.size += uint32_t(list.size());
}

std::vector<Place> Placement::choose(gpu::Stream& stream, const ChoiceOptions& o) {
  Impl& p = *impl_;
  p.picks.clear(), p.first_starts.clear();
  p.sorted = nullptr;
  if (p.size == 0 || o.most == 0) return {};
  uint32_t n = p.size;
  for (gpu::Buffer& e : p.entries)
    gpu::make_texel_room(p.device, e, "candidates' keys", uint64_t{n} * sizeof(SortEntry64));
  for (auto [buffer, name] : {std::pair{&p.head_flags, "heads of clusters"},
                              {&p.head_sums, "heads' sums"},
                              {&p.cluster_starts, "clusters"},
                              {&p.ranks, "candidates' ranks"}})
    gpu::make_texel_room(p.device, *buffer, name, uint64_t{n} * 4);
  gpu::Resources& r = p.resources;
  r.set("Grid", p.grid_buffer);
  r.set("place_texels", p.places);
  r.set("facing_texels", p.facings);
  r.set("RunBounds", p.run_bounds);
  r.set("run_bound_texels", p.run_bounds);
  r.set("Entries", p.entries[0]);
  r.set("Heads", p.head_flags);
  r.set("HeadsBefore", p.head_sums);
  r.set("Starts", p.cluster_starts);
  r.set("Ranks", p.ranks);
  r.set("Total", p.count);
  ChoosePush push{n, o.seed, o.normal_tolerance};
  const auto run = [&](const gpu::Kernel& kernel, uint32_t items) {
    push.count = &kernel == &p.choose ? items : n;
    stream.dispatch(kernel, r, &push, kernel.push_constant_bytes(), gpu::groups_for(items, 64), k_stage);
  };
  run(p.bounds, k_bounds_runs);
  run(p.grid, 1);
  run(p.keys, n);
  p.sorted = &p.sorter.encode(stream, p.entries[0], p.entries[1], {.most = n}, 3 * k_morton_bits, k_stage);
  const gpu::Buffer* from = p.sorted;
  const gpu::Buffer& spare = from == &p.entries[0] ? p.entries[1] : p.entries[0];
  uint32_t clusters = 0;
  for (uint32_t round = 0;; ++round) {
    p.count.write(&n, sizeof n);
    r.set("entry_texels", *from);
    run(p.heads, n);
    p.prefix_sum.encode(stream, p.head_flags, p.head_sums, {.most = n}, &p.total, 0, k_stage);
    run(p.starts, n);
    stream.run();
    clusters = p.sum();
    if (round == 0) {
      p.first_starts.resize(clusters);
      p.cluster_starts.read(p.first_starts.data(), clusters * sizeof(uint32_t));
    }
    run(p.choose, clusters);
    run(p.chosen, n);
    p.prefix_sum.encode(stream, p.head_flags, p.head_sums, {.most = n}, &p.total, 0, k_stage);
    stream.run();
    if (p.sum() == n || round + 1 == k_rounds) break;
    const gpu::Buffer& to = from == &spare ? p.entries[2] : spare;
    r.set("Kept", to);
    run(p.keep, n);
    stream.run();
    n = p.sum();
    from = &to;
  }

  std::vector<SortEntry64> entries(n);
  std::vector<uint32_t> ranks(n), starts(clusters + 1, n);
  from->read(entries.data(), n * sizeof(SortEntry64));
  p.ranks.read(ranks.data(), n * sizeof(uint32_t));
  p.cluster_starts.read(starts.data(), clusters * sizeof(uint32_t));
  std::vector<size_t> having(clusters, 0);
  for (uint32_t c = 0; c < clusters; ++c)
    for (uint32_t i = starts[c]; i < starts[c + 1]; ++i) having[c] += ranks[i] > 0;
  const std::vector<size_t> quota = share_out(having, o.most);
  for (uint32_t c = 0; c < clusters; ++c)
    for (uint32_t i = starts[c]; i < starts[c + 1]; ++i)
      if (ranks[i] > 0 && ranks[i] <= quota[c]) p.picks.push_back(entries[i].value);
  const std::vector<Place> collected = p.read();
  std::vector<Place> all;
  for (const uint32_t i : p.picks) all.push_back(collected[i]);
  return all;
}

Choice Placement::choice() const {
  const Impl& p = *impl_;
  Choice all;
  if (p.size == 0) return all;
  std::vector<Place> collected = p.read();
  if (!p.sorted) {
    all.candidates = std::move(collected);
    return all;
  }
  std::vector<SortEntry64> entries(p.size);
  p.sorted->read(entries.data(), p.size * sizeof(SortEntry64));
  std::vector<uint32_t> rank_of(p.size);
  for (uint32_t i = 0, cluster = 0; i < p.size; ++i) {
    const uint32_t source = entries[i].value;
    rank_of[source] = i;
    all.candidates.push_back(collected[source]);
    if (cluster + 1 < p.first_starts.size() && i == p.first_starts[cluster + 1]) ++cluster;
    all.cluster.push_back(cluster);
  }
  for (const uint32_t pick : p.picks) all.chosen.push_back(rank_of[pick]);
  return all;
}

uint32_t Placement::clusters() const { return uint32_t(impl_->first_starts.size()); }

std::vector<uint32_t> thin_out(std::span<const Place> places, std::span<const float> radii,
                               std::span<const float> off_planes, const ThinningOptions& o) {
  std::vector<uint32_t> order(places.size()), kept;
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return radii[a] > radii[b]; });
  // Grids of those kept, one for each power of two of what they cover: cells are as wide as that at most, so
  // that whatever covers a point is centred in its cell or one of the 26 around it.
  struct Cell {
    int level;
    int64_t x, y, z;
    bool operator==(const Cell&) const = default;
  };
  struct Hash {
    size_t operator()(const Cell& c) const {
      return mix(mix(mix(mix(uint64_t(c.level)) + uint64_t(c.x)) + uint64_t(c.y)) + uint64_t(c.z));
    }
  };
  std::unordered_map<Cell, std::vector<uint32_t>, Hash> grid;
  std::set<int> levels;
  const auto cell_at = [](const vec3& p, int level) {
    const auto along = [&](float x) {
      return static_cast<int64_t>(std::floor(std::ldexp(double(x), -level)));
    };
    return Cell{level, along(p.x), along(p.y), along(p.z)};
  };
  const auto covers = [&](uint32_t k, const Place& p) {
    const vec3 away = p.position - places[k].position;
    const float covered = o.share * radii[k];
    const float turned = std::max(0.0f, 1 - dot(p.normal, places[k].normal));
    return p.medium == places[k].medium && dot(away, away) <= covered * covered &&
           turned <= o.share * o.share * o.normal_tolerance &&
           std::abs(dot(away, p.normal + places[k].normal)) <= 2 * off_planes[k];
  };
  for (const uint32_t i : order) {
    const Place& p = places[i];
    bool covered = false;
    for (const int level : levels) {
      const Cell at = cell_at(p.position, level);
      for (int n = 0; n < 27 && !covered; ++n) {
        const auto found = grid.find({level, at.x + n % 3 - 1, at.y + n / 3 % 3 - 1, at.z + n / 9 - 1});
        covered = found != grid.end() && std::any_of(found->second.begin(), found->second.end(),
                                                     [&](uint32_t k) { return covers(k, p); });
      }
      if (covered) break;
    }
    if (covered) continue;
    kept.push_back(i);
    const float reach = o.share * radii[i];
    if (!(reach > 0) || !std::isfinite(reach)) continue;
    const int level = static_cast<int>(std::ceil(std::log2(reach)));
    levels.insert(level);
    grid[cell_at(p.position, level)].push_back(i);
  }
  std::sort(kept.begin(), kept.end());
  return kept;
}

}  // namespace lucerna::irradiance_cache
