#include "solvers/irradiance_cache/lookup_tables.h"

#include <cmath>

namespace lucerna::irradiance_cache {

using namespace shared;

namespace {

/// Octree references per record for which memory is allocated.
constexpr uint32_t k_references = 16;

/// Records in an octree leaf above which it is split.
constexpr uint32_t k_crowd = 16;

/// Largest distance from its plane at which a record serves, in radii: `off_plane` from the plane midway
/// between its own and the point's, plus what half the difference of the normals adds.
float slab_thickness(float off_plane, float normal_tolerance) {
  return off_plane + 0.5f * std::sqrt(2 * normal_tolerance);
}

/// In the format of CacheFrame::routes.
RouteTable packed(const paths::LookupRoutes& routes, const paths::LookupRoutes& gather) {
  RouteTable table;
  table.fill(k_no_routes);
  for (const auto& [phase, of] : {std::pair{k_phase_start, &routes}, std::pair{k_phase_gather, &gather}})
    for (uint32_t s = 0; s < of->component.size(); ++s) {
      uint32_t& word = table[in_phase(s, phase)] = 0;
      for (uint32_t p = 0; p < k_part_count; ++p)
        word |= std::min<uint32_t>(of->component[s][p], k_component_none) << (4 * p);
    }
  return table;
}

bool looks_up(uint32_t routes) { return routes != k_no_routes; }

}  // namespace

LookupTables::LookupTables(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t slots,
                           const CacheRoutes& routes, const CacheOptions& o)
    : records(device, o.most_records, o.groups),
      octree(device, compiler, octree_options(o.most_records)),
      frame(device, {.name = "cache frame", .bytes = sizeof(CacheFrame)}),
      candidates(device, {.name = "cache candidates",
                          .bytes = uint64_t{slots} * 16 * k_candidate_texels,
                          .memory = gpu::Memory::host,
                          .texel = true}) {
  const paths::LookupRoutes none;
  picture_routes = packed(routes.picture, o.gather ? routes.picture_gather : none);
  record_routes = packed(routes.records, o.gather ? routes.records_gather : none);
}

void LookupTables::bind(gpu::Resources& to) const {
  records.bind(to, Records::Use::look_up);
  to.set("CacheBlock", frame);
  to.set("Candidates", candidates);
  octree.bind(to);
}

lookup::OctreeOptions LookupTables::octree_options(uint32_t records) {
  return {.spheres = records,
          .references = k_references * records,
          .copies = true,
          .discs = true,
          .crowd = k_crowd};
}

lookup::Discs LookupTables::discs(const Records& records) {
  return records.discs(slab_thickness(std::max(k_off_plane, k_off_plane_least), k_normal_tolerance));
}

double LookupTables::build_octree(transport::Wavefront& wavefront, uint32_t count, IndexFor use) {
  octree.set_leaf_scale(use == IndexFor::picture ? 0.5f : use == IndexFor::building ? 1.0f : 2.0f);
  const lookup::Discs discs = LookupTables::discs(records);
  const shared::OctreeHeader& h =
      octree.build(wavefront.stream(), records.spheres(), {.most = count}, &discs);
  const double references = h.spheres ? double(h.references) / h.spheres : 0;
  wavefront.rebind_lookup();
  return references;
}

CacheFrame LookupTables::frame_for(uint32_t count, uint32_t probing, const RouteTable& routes) const {
  CacheFrame f{};
  std::copy(routes.begin(), routes.end(), f.routes);
  f.record_count = count;
  f.normal_tolerance = k_normal_tolerance;
  f.off_plane = k_off_plane, f.off_plane_least = k_off_plane_least;
  f.least_of_distance = least.of_distance, f.least_most = least.most;
  f.eye = least.eye, f.parallel = least.parallel;
  f.probing = probing;
  f.branches = 1;
  return f;
}

void LookupTables::write_frame(uint32_t count, uint32_t probing, const RouteTable& routes,
                               uint32_t branches) {
  CacheFrame f = frame_for(count, probing, routes);
  f.branches = branches;
  frame.write(&f, sizeof f);
}

bool LookupTables::records_look_up() const {
  return std::any_of(record_routes.begin(), record_routes.end(), looks_up);
}

RouteTable LookupTables::routes_beyond_picture() const {
  // Beyond the picture's lookups paths read like rays of records do; records there contain light of any
  // number of further diffuse events.
  RouteTable table = picture_routes;
  const auto end = record_routes.begin() + k_phase_states;
  const auto own = std::find_if(record_routes.begin(), end, looks_up);
  if (own != end)
    for (uint32_t s = 1; s < k_phase_states; ++s) table[in_phase(s, k_phase_fallback)] = *own;
  return table;
}

uint64_t LookupTables::bytes() const { return records.bytes() + candidates.bytes() + octree.bytes(); }

}  // namespace lucerna::irradiance_cache
