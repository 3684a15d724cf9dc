#include "solvers/photons/photon_map.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "base/log.h"
#include "base/timer.h"

namespace lucerna::photons {

using namespace shared;

namespace {

constexpr uint32_t k_first_capacity = 65536;  // photons

template <class T>
std::vector<T> first(const gpu::Buffer& buffer, uint32_t count) {
  std::vector<T> values(count);
  if (count > 0) buffer.read(values.data(), count * sizeof(T));
  return values;
}

gpu::Buffer texels(gpu::Device& device, const char* name, uint64_t bytes) {
  return gpu::Buffer(device, {.name = name, .bytes = (bytes + 15) / 16 * 16, .texel = true});
}

}  // namespace

PhotonMap::PhotonMap(gpu::Device& device, gpu::ShaderCompiler& compiler, const gpu::Defines& scene_defines,
                     const paths::Automaton& automaton)
    : device_(device),
      compiler_(compiler),
      scene_defines_(scene_defines),
      emitter_(device, compiler, scene_defines, automaton),
      trace_(device, compiler, "photons/trace.comp", scene_defines),
      cells_(device, compiler),
      counts_(device, {.name = "photon counts", .bytes = 4 * k_photon_counts, .memory = gpu::Memory::host}),
      block_(device, {.name = "photon lookups", .bytes = sizeof(PhotonFrame)}),
      importance_(device, {.name = "importance", .bytes = 4 * k_photon_importance_entries}),
      lookups_(device, {.name = "lookups of caustics", .bytes = sizeof(PhotonLookup)}),
      radiances_(device, {.name = "radiances of photons", .bytes = 4}),
      on_(device, {.name = "surfaces of photons", .bytes = sizeof(PhotonSurface)}) {
  clear();
}

void PhotonMap::bind(gpu::Resources& resources) const {
  resources.set("photon_texels", cells_.photons());
  resources.set("photon_table", cells_.table());
  resources.set("PhotonBlock", block_);
  resources.set("PhotonImportance", importance_);
  resources.set("PhotonLookups", lookups_);
}

void PhotonMap::note_importance(transport::Wavefront& wavefront, const PhotonFrame& lookup, uint32_t pixels,
                                uint32_t vertices) {
  lookup_ = lookup;
  lookup_.lookups = noted_pixels_ = pixels, lookup_.vertices = vertices;
  if (const uint64_t bytes = uint64_t{pixels} * (1 + vertices) * sizeof(PhotonLookup);
      bytes > lookups_.bytes()) {
    gpu::make_room(device_, lookups_, {.name = "lookups of caustics", .bytes = bytes});
    wavefront.rebind_lookup();
  }
  lookup_.count = 0, lookup_.mask = 0, lookup_.importance_mask = k_photon_importance_entries - 1;
  noted_ = lookup;
  noted_.importance_counts = 0, noted_.stores_radiance = 0;
  noted_.unreachable_parts = 0, noted_.skips_unreachable = 0;
  write_lookup();
  wavefront.stream().fill(importance_, 0);
  wavefront.stream().fill(lookups_, 0);
  wavefront.account_stages();
  complete_ = tracing_ = false;
}

std::vector<PhotonLookup> PhotonMap::lookups() const { return first<PhotonLookup>(lookups_, noted_pixels_); }

std::vector<PhotonLookup> PhotonMap::reached() const {
  const std::vector<PhotonLookup> all = lookups_.read_all<PhotonLookup>();
  return {all.begin() + std::min<ptrdiff_t>(noted_pixels_, ptrdiff_t(all.size())), all.end()};
}

std::vector<PhotonContribution> PhotonMap::contributions(transport::Wavefront& wavefront,
                                                         const transport::LightSource& lights) {
  const uint32_t count = complete_ ? lookup_.count : 0;
  if (count == 0) return {};
  if (!contribution_kernel_)
    contribution_kernel_ = gpu::Kernel(device_, compiler_, "photons/contribution.comp", scene_defines_);
  const uint32_t at_once =
      std::min(count, uint32_t(std::min<uint64_t>(
                          device_.info().limits.max_storage_buffer / sizeof(PhotonContribution), ~0u)));
  gpu::make_room(device_, contributions_,
                 {.name = "contributions of photons",
                  .bytes = at_once * sizeof(PhotonContribution),
                  .memory = gpu::Memory::host});
  gpu::Resources r;
  wavefront.bind_paths(r);
  bind(r);
  lights.bind(r);
  r.set("photon_sorted", cells_.sorted());
  r.set("PhotonRadiances", radiances_);
  r.set("PhotonContributions", contributions_);
  std::vector<PhotonContribution> all;
  for (uint32_t first = 0; first < count; first += at_once) {
    const uint32_t n = std::min(at_once, count - first);
    wavefront.stream().dispatch(
        contribution_kernel_, r,
        PhotonContributionPush{n, transport::LightEmitter::stratum_step(figures_.paths), first},
        gpu::groups_for(n, 64), "photon map");
    wavefront.account_stages();
    const auto* found = static_cast<const PhotonContribution*>(contributions_.mapped());
    all.insert(all.end(), found, found + n);
  }
  return all;
}

void PhotonMap::clear() {
  lookup_ = {};
  std::fill(std::begin(lookup_.component), std::end(lookup_.component), k_photon_no_components);
  write_lookup();
  figures_ = {};
  complete_ = tracing_ = false;
  fits_ = ~0u;
}

void PhotonMap::write_lookup() {
  PhotonFrame all = lookup_;
  all.importance_eye = noted_.eye, all.importance_slope = noted_.slope, all.importance_base = noted_.base;
  all.importance_counts = noted_.importance_counts, all.stores_radiance = noted_.stores_radiance;
  all.stores_surface = noted_.stores_surface;
  all.unreachable_parts = noted_.unreachable_parts, all.skips_unreachable = noted_.skips_unreachable;
  // Before the first round: the radii by which photons are stored.
  if (all.most <= 0) all.most = noted_.most;
  if (notes_held_) all.importance_mask = 0, all.lookups = all.vertices = 0;
  block_.write(&all, sizeof all);
}

void PhotonMap::hold_notes(bool held) {
  if (std::exchange(notes_held_, held) != held && lookup_.importance_mask != 0) write_lookup();
}

void PhotonMap::store_by_importance(bool on) {
  noted_.importance_counts = on ? 1 : 0;
  write_lookup();
}

void PhotonMap::store_by_importance_of(const PhotonMap& other) {
  const PhotonFrame& n = other.noted_;
  noted_.eye = n.eye, noted_.slope = n.slope, noted_.base = n.base;
  noted_.most = n.most;
  noted_.importance_counts = n.importance_counts;
  importance_of_ = &other;
  write_lookup();
}

void PhotonMap::store_parts(uint32_t unreachable_parts, bool skips_unreachable) {
  const uint32_t skips = skips_unreachable ? 1 : 0;
  if (noted_.unreachable_parts == unreachable_parts && noted_.skips_unreachable == skips) return;
  noted_.unreachable_parts = unreachable_parts, noted_.skips_unreachable = skips;
  write_lookup();
}

void PhotonMap::store_radiance(bool on) {
  noted_.stores_radiance = on ? 1 : 0;
  write_lookup();
}

void PhotonMap::store_surface(bool on) {
  noted_.stores_surface = on ? 1 : 0;
  write_lookup();
}

std::vector<Photon> PhotonMap::photons() const { return first<Photon>(list_, figures_.photons); }
std::vector<uint32_t> PhotonMap::numbers() const { return first<uint32_t>(ids_, figures_.photons); }
std::vector<PhotonSurface> PhotonMap::surfaces() const {
  return first<PhotonSurface>(on_, noted_.stores_surface != 0 ? figures_.photons : 0);
}

uint64_t PhotonMap::bytes() const {
  uint64_t sum = cells_.bytes();
  for (const gpu::Buffer* b : {&list_, &ids_, &importance_, &lookups_, &radiances_, &on_})
    sum += *b ? b->bytes() : 0;
  return sum;
}

bool PhotonMap::trace(transport::Wavefront& wavefront, const transport::LightSource& lights,
                      const Round& round, const Frame& picture, uint32_t enabled,
                      const std::function<bool()>& cancel) {
  Round fitting = round;
  for (;;) {
    fitting.paths = std::min({round.paths, k_most_light_paths, fits_});
    if (!tracing_ || next_.round != fitting.number || next_.paths != fitting.paths) {
      next_ = {
          .round = fitting.number, .paths = fitting.paths, .grown = figures_.grown, .wanted = round.paths};
      tracing_ = true;
      traced_ = stored_ = 0;
    }
    if (lights.power() <= 0 || traced_ >= fitting.paths) break;
    const uint32_t count = std::min(wavefront.slots(), fitting.paths - traced_);
    const Timer timer;
    const Went went = trace_batch(wavefront, lights, fitting, count, picture, enabled, cancel);
    if (went == Went::cancelled) return false;
    if (went == Went::too_many) {
      // Half as many paths, from the start: the number that fits depends on the round alone, not on its
      // batches.
      fits_ = std::max(1u, fitting.paths / 2);
      tracing_ = false;
      log::warning(
          "photons: {} light paths leave more than the {} photons that one buffer of this device holds; "
          "{} are traced instead",
          fitting.paths, most_photons(), fits_);
      continue;
    }
    next_.trace_s += timer.seconds();
    traced_ += count;
    if (traced_ < fitting.paths) return true;
    break;
  }
  build(wavefront, fitting);
  return true;
}

PhotonMap::Went PhotonMap::trace_batch(transport::Wavefront& wavefront, const transport::LightSource& lights,
                                       const Round& round, uint32_t count, const Frame& picture,
                                       uint32_t enabled, const std::function<bool()>& cancel) {
  const auto short_of = [&](bool stored, const gpu::Buffer& buffer, uint64_t bytes) {
    return stored && buffer.bytes() < bytes * capacity_;
  };
  if (!list_ || short_of(noted_.stores_radiance != 0, radiances_, 4) ||
      short_of(noted_.stores_surface != 0, on_, sizeof(PhotonSurface)))
    grow(wavefront, std::min(most_photons(), std::max(k_first_capacity, capacity_)));
  const transport::LightVertexWork work{
      .vertex = &trace_, .stage = "photon vertex", .bind = [&](gpu::Resources& r) { bind_list(r); }};
  for (;;) {
    uint32_t counts[k_photon_counts] = {};
    counts[k_photons_stored] = stored_, counts[k_photons_capacity] = capacity_;
    counts_.write(counts, sizeof counts);
    const transport::TransportStats before = wavefront.stats();
    if (!emitter_.trace(wavefront, lights, round, traced_, count, work, picture, enabled, cancel))
      return Went::cancelled;
    counts_.read(counts, sizeof counts);
    if (counts[k_photons_stored] <= capacity_) {
      stored_ = counts[k_photons_stored];
      next_.escaped += emitter_.escaped(), next_.dark += emitter_.dark();
      next_.spared += counts[k_photons_spared];
      for (size_t p = 0; p < next_.by_part.size(); ++p) next_.by_part[p] += counts[k_photons_by_part + p];
      const transport::TransportStats& now = wavefront.stats();
      next_.rays += now.rays - before.rays, next_.roulette += now.roulette - before.roulette;
      next_.depth += now.depth - before.depth;
      return Went::on;
    }
    if (counts[k_photons_stored] > most_photons()) return Went::too_many;
    grow(wavefront, counts[k_photons_stored]);
    ++next_.grown;
  }
}

void PhotonMap::bind_list(gpu::Resources& r) const {
  r.set("PhotonBlock", block_);
  r.set("PhotonImportance", importance_of_->importance_);
  r.set("PhotonCounts", counts_);
  r.set("PhotonList", list_);
  r.set("photon_list_texels", list_);
  r.set("PhotonIds", ids_);
  r.set("PhotonRadiances", radiances_);
  r.set("PhotonSurfaces", on_);
}

uint32_t PhotonMap::most_photons() const {
  return uint32_t(std::min<uint64_t>(device_.info().limits.max_storage_buffer / sizeof(Photon), 1u << 28));
}

void PhotonMap::grow(transport::Wavefront& wavefront, uint32_t needed) {
  const auto capacity = uint32_t(std::min(uint64_t{most_photons()}, std::bit_ceil(uint64_t{needed})));
  gpu::Buffer list = texels(device_, "photons of a round", uint64_t{capacity} * sizeof(Photon));
  gpu::Buffer ids = texels(device_, "numbers of photons", uint64_t{capacity} * 4);
  const bool radiance = noted_.stores_radiance != 0, surface = noted_.stores_surface != 0;
  const auto buffer_of = [&](const char* name, bool stored, uint64_t bytes) {
    return gpu::Buffer(device_, {.name = name, .bytes = stored ? capacity * bytes : bytes});
  };
  gpu::Buffer radiances = buffer_of("radiances of photons", radiance, 4);
  gpu::Buffer on = buffer_of("surfaces of photons", surface, sizeof(PhotonSurface));
  if (stored_ > 0) {
    wavefront.stream().copy(list_, list, uint64_t{stored_} * sizeof(Photon));
    wavefront.stream().copy(ids_, ids, uint64_t{stored_} * 4);
    if (radiance) wavefront.stream().copy(radiances_, radiances, uint64_t{stored_} * 4);
    if (surface) wavefront.stream().copy(on_, on, uint64_t{stored_} * sizeof(PhotonSurface));
    wavefront.account_stages();
  }
  list_ = std::move(list), ids_ = std::move(ids), radiances_ = std::move(radiances), on_ = std::move(on);
  capacity_ = capacity;
}

void PhotonMap::build(transport::Wavefront& wavefront, const Round& round) {
  const Timer timer;
  gpu::Stream& stream = wavefront.stream();
  lookup_ = round.lookup;
  lookup_.round = round.number;
  const bool moved = cells_.make_room(stored_, lookup_);
  write_lookup();
  cells_.encode(stream, list_, ids_, block_, stored_);
  wavefront.account_stages();
  if (moved) wavefront.rebind_lookup();
  next_.build_s = timer.seconds();
  figures_ = next_;
  figures_.photons = stored_, figures_.entries = cells_.entries();
  tracing_ = false;
  complete_ = true;
}

}  // namespace lucerna::photons
