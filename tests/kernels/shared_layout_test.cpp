// links: gpu
// Structs shared by C++ and the shaders: every member must have the same name and offset on both sides, and
// an array of them the same stride. A new struct in shaders/shared/ needs one line in `structs()`; the second
// test fails without it.
#include <algorithm>
#include <fstream>
#include <set>

#include "gpu/spirv.h"
#include "kernels/gpu_support.h"
#include "shaders/shared/emission.h"
#include "shaders/shared/film.h"
#include "shaders/shared/filter.h"
#include "shaders/shared/irradiance_cache/discontinuity.h"
#include "shaders/shared/irradiance_cache/inspect.h"
#include "shaders/shared/irradiance_cache/placement.h"
#include "shaders/shared/irradiance_cache/placement_view.h"
#include "shaders/shared/irradiance_cache/records.h"
#include "shaders/shared/layers.h"
#include "shaders/shared/learned_lights.h"
#include "shaders/shared/learned_view.h"
#include "shaders/shared/octree.h"
#include "shaders/shared/overlay.h"
#include "shaders/shared/path_events.h"
#include "shaders/shared/photons/inspect.h"
#include "shaders/shared/photons/irradiance.h"
#include "shaders/shared/photons/photons.h"
#include "shaders/shared/preview.h"
#include "shaders/shared/ramp.h"
#include "shaders/shared/ray.h"
#include "shaders/shared/scene.h"
#include "shaders/shared/sheet.h"
#include "shaders/shared/sight.h"
#include "shaders/shared/sort.h"
#include "shaders/shared/splat.h"
#include "shaders/shared/trace.h"
#include "shaders/shared/transport.h"
#include "shaders/shared/wide_sum.h"

using namespace lucerna;
using namespace lucerna::gpu;

namespace {

struct SharedStruct {
  std::string header, name;
  size_t bytes;
  std::vector<spirv::Member> members;
};

// SHARED(header, type, member, member, ...): repeats MEMBER for each member by rescanning (up to 64).
#define AGAIN4(...) AGAIN3(AGAIN3(AGAIN3(AGAIN3(__VA_ARGS__))))
#define AGAIN3(...) AGAIN2(AGAIN2(AGAIN2(AGAIN2(__VA_ARGS__))))
#define AGAIN2(...) AGAIN1(AGAIN1(AGAIN1(AGAIN1(__VA_ARGS__))))
#define AGAIN1(...) __VA_ARGS__
#define PARENTHESES ()
#define MEMBER(type, member) {#member, static_cast<uint32_t>(offsetof(shared::type, member))},
#define MEMBERS(type, member, ...) \
  MEMBER(type, member) __VA_OPT__(MEMBERS_LATER PARENTHESES(type, __VA_ARGS__))
#define MEMBERS_LATER() MEMBERS
#define SHARED(header, type, ...)                                               \
  {                                                                             \
    header, #type, sizeof(shared::type), { AGAIN4(MEMBERS(type, __VA_ARGS__)) } \
  }

std::vector<SharedStruct> structs() {
  return {
      SHARED("irradiance_cache/inspect.h", InspectPush, width, height, pixel, grid),
      SHARED("irradiance_cache/inspect.h", InspectHeader, solid, lookup, count, gathers, under, size, depth,
             position, normal, under_at),
      SHARED("irradiance_cache/inspect.h", InspectServing, record, weight, at, depth),
      SHARED("irradiance_cache/inspect.h", OverlapPush, width, height, grid),
      SHARED("irradiance_cache/inspect.h", OverlapCounts, pixels, gathered, most, records, listed),
      SHARED("wide_sum.h", WideSum, low, high),
      SHARED("wide_sum.h", LongSum, low, middle, high),
      SHARED("splat.h", SplatOwners, red, green, blue),
      SHARED("splat.h", SplatFrame, width, height, component, unit, first, pixels),
      SHARED("splat.h", SplatPush, count),
      SHARED("path_events.h", PathEvent, position, pdf, normal, parent, throughput, bits, contribution,
             served, primitive, material, light, record),
      SHARED("path_events.h", PathEventState, count, last, branch, by, lost),
      SHARED("path_events.h", PathEventFrame, most, far),
      SHARED("path_events.h", PathChoice, pixel, sample_index),
      SHARED("overlay.h", LightPathsView, step, light, radius, pad0),
      SHARED("irradiance_cache/inspect.h", CacheLinesPush, width, height, left, top, across, down, lines,
             ring),
      SHARED("irradiance_cache/inspect.h", CacheNormalsPush, width, height, records, color, lo, hi),
      SHARED("irradiance_cache/placement_view.h", PlacedPoint, position, bits, normal, radius),
      SHARED("irradiance_cache/placement_view.h", PlacementPush, count, rings, dot, tried_dot, by_cluster),
      SHARED("sight.h", SightGrid, across, stride),
      SHARED("emission.h", EmissionTable, centre, radius, count, sky, sun_pmf, casters, groups, core_centre,
             core_radius, core_share),
      SHARED("photons/photons.h", Photon, position, direction, flux, bits),
      SHARED("photons/photons.h", PhotonFrame, eye, slope, base, most, count, mask, round, most_candidates,
             most_visits, surface_nodes, importance_mask, importance_eye, importance_slope, importance_base,
             importance_counts, lookups, vertices, stores_radiance, stores_surface, unreachable_parts,
             skips_unreachable, component),
      SHARED("photons/irradiance.h", IrradianceFrame, triangles, states, gathers),
      SHARED("photons/inspect.h", PhotonDensityPush, width, height, of, first, count, grid),
      SHARED("photons/inspect.h", PhotonHeatPush, width, height, scale, lo, hi),
      SHARED("photons/inspect.h", PhotonSmoothPush, width, height, taps, down),
      SHARED("photons/inspect.h", PhotonInspectPush, width, height, pixel, grid),
      SHARED("photons/inspect.h", PhotonInspectHeader, position, radius, normal, area, irradiance, density,
             solid, count, pad0, pad1),
      SHARED("photons/inspect.h", PhotonInspected, position, contribution, direction, bits, flux, pad0),
      SHARED("photons/photons.h", PhotonContribution, stratum, light, id, contribution, position, importance,
             flux, radiance, facet, unreachable),
      SHARED("photons/photons.h", PhotonSurface, side, barycentric),
      SHARED("photons/photons.h", PhotonLookup, position, carried, facet),
      SHARED("emission.h", EmitPush, count, first, round, share, step),
      SHARED("photons/photons.h", PhotonContributionPush, count, step, first),
      SHARED("photons/photons.h", PhotonListPush, count),
      SHARED("photons/photons.h", PhotonPointsPush, count, step, by, round),
      SHARED("sheet.h", EnlargePush, width, height, scale),
      SHARED("sheet.h", SheetView, film_width, film_height, scale, surfaces_known),
      SHARED("sight.h", SeePush, first, count, across, down, stride),
      SHARED("irradiance_cache/discontinuity.h", LitPush, count),
      SHARED("irradiance_cache/discontinuity.h", DetailPush, across, down, level, first, finer, pixel,
             parallel, depth_weight, normal_weight, irradiance_weight, irradiance_noise, least),
      SHARED("irradiance_cache/discontinuity.h", DitherPush, across, down, levels, first_level, density,
             falloff, pixel, parallel, finest, flat_side, spacing, key),
      SHARED("irradiance_cache/discontinuity.h", DiscontinuityDrawPush, width, height, across, down, stride,
             level, first),
      SHARED("filter.h", FilterPush, width, height, component, stride, first, looked_up, seen, scale),
      SHARED("film.h", FilmHalf, sum, compensation),
      SHARED("film.h", WorkBlock, index, first_sample),
      SHARED("film.h", BlockError, pixels, luminance, variance, fourth, difference, relative, quadrant_pixels,
             lookup_noise, interpolation, lookup_noise_relative, interpolation_relative, bias, unmixed, seen,
             seen_fourth, white, dark),
      SHARED("film.h", BlockLookups, pixels, interpolation, noise, interpolation_noise),
      SHARED("film.h", ErrorPush, width, height, block_count, luminance_floor, luminance_white, lookup_errors,
             bias),
      SHARED("film.h", FilmPush, width, height, pixel_count, sample_count, group, quick),
      SHARED("film.h", GroupLight, rg, b),
      SHARED("film.h", GroupSum, low, high),
      SHARED("film.h", GroupSums, even, odd),
      SHARED("film.h", GroupMix, groups, pixels, pad0, pad1, whole, weight),
      SHARED("film.h", MixPush, width, height, groups, exposure),
      SHARED("film.h", TonePush, width, height, layer, show, curve, exposure, scale, coarse_width,
             coarse_height, use_coarse_film),
      SHARED("preview.h", PreviewCamera, origin, right, up, forward),
      SHARED("preview.h", PreviewPackPush, width, height, exposure, guided, show, noise, taken),
      SHARED("preview.h", PreviewHalvePush, width, height, across, down, draft_width, draft_height, history,
             repainted, history_scale, draft_share, step, sampled, surfaces, moved),
      SHARED("preview.h", PreviewFilterPush, across, down, step, projection, history, blocks_across,
             blocks_down, right, up, forward),
      SHARED("preview.h", PreviewReprojectPush, width, height, pass, projections, before, now),
      SHARED("preview.h", PreviewRecallPush, width, height, pass, show, curve, history_scale, seen, across,
             down, tint),
      SHARED("preview.h", PreviewFetchPush, width, height, across, down, projections, keep, before, now),
      SHARED("preview.h", PreviewResolvePush, width, height, across, down, show, curve, filtering, history,
             repainted, history_scale, step, sampled, same_light, recoloured, blocks_across, blocks_down,
             surfaces, moved, tint, doubt),
      SHARED("preview.h", PreviewChangePush, across, down, blocks_across, blocks_down, all),
      SHARED("preview.h", PreviewShares, all, stale, filtered),
      SHARED("preview.h", PreviewJudgePush, width, height, film_width, film_height, step),
      SHARED("preview.h", PreviewTile, error, square, noise),
      SHARED("irradiance_cache/records.h", RelightPreviewPush, factor, count, sky_group),
      SHARED("irradiance_cache/records.h", CacheFrame, routes, record_count, normal_tolerance, off_plane,
             probing, off_plane_least, least_of_distance, least_most, parallel, eye, branches),
      SHARED("irradiance_cache/records.h", RecordPush, first, records, elevations, azimuths, rays_before,
             parts, state, seed, pilot),
      SHARED("irradiance_cache/records.h", RadiusPush, first, count, error, most, near, crowd),
      SHARED("irradiance_cache/records.h", ClampPush, count, near, crowd, undecided),
      SHARED("irradiance_cache/records.h", ImportancePush, pixels, first, next),
      SHARED("irradiance_cache/records.h", PropagatePush, width, height, step, pixels, beyond),
      SHARED("irradiance_cache/records.h", EllipsePush, first, count, reach, most, dark, near, near_tried,
             crowd),
      SHARED("irradiance_cache/records.h", PoolPush, first, count),
      SHARED("irradiance_cache/records.h", OverlayPush, width, height, discs, overlap, color, lo, hi,
             overlap_most, grid),
      SHARED("overlay.h", OverlayPoint, position, half_width, color, alpha, edge_width, rank),
      SHARED("overlay.h", OverlaySegment, from, to, half_width, edge_width, color, alpha, strength, slack,
             rank),
      SHARED("overlay.h", OverlayDisc, position, radius, normal, half_width, color, alpha, edge_width,
             strength, rank),
      SHARED("overlay.h", OverlayMarkPush, width, height, count, first, pieces),
      SHARED("overlay.h", OverlayLayPush, width, height, dimmed, edge_alpha),
      SHARED("overlay.h", OverlayFocusPush, width, height, focus, nearest, farthest, line, tint),
      SHARED("overlay.h", OverlayLine, from, to, from_depth, to_depth, half_width, alpha, color),
      SHARED("irradiance_cache/placement.h", CollectPush, count, samples, to, screen_too, parallel, spacing,
             spacing_beyond, spacing_of_distance, cell, pixel, eye),
      SHARED("irradiance_cache/placement.h", PlacementGrid, origin, scale, exponent),
      SHARED("irradiance_cache/placement.h", ChoosePush, count, seed, normal_tolerance),
      SHARED("learned_view.h", LearnedPoint, position, solid, normal, row),
      SHARED("learned_view.h", LearnedViewPush, width, height, pixel, rows),
      SHARED("learned_lights.h", LightRecord, position, cell, value, rate, full, arrived, before, met,
             met_value, met_rate),
      SHARED("ray.h", Ray, origin, tmax, direction, slot),
      SHARED("ray.h", Hit, t, prim, u, v),
      SHARED("scene.h", Frame, camera_origin, width, camera_right, height, camera_up, projection,
             camera_forward, seed, camera_axis, section_normal, section_offset, lens_radius, focus_distance,
             lens_blades, lens_rotation, environment_radiance, light_count, first_lamp, lamp_count,
             first_shape, shape_count, lamp_pmf, environment_width, environment_height, environment_rotation,
             environment_light_pmf, max_depth, roulette_depth, most_branches, scene_radius, camera_in_solids,
             sky_group, sun_group, learned_origin, learned_scale, light_clusters, sky_clusters, learning,
             automaton),
      SHARED("ramp.h", TileMark, position, bits),
      SHARED("ramp.h", TilesPush, width, height, side, across, line),
      SHARED("ramp.h", HeatPush, width, height, layer, ramp, logarithmic, lo, hi, unit),
      SHARED("sort.h", SortPair, key, value),
      SHARED("sort.h", SortEntry64, low, high, value, unused),
      SHARED("sort.h", ScanPush, count, count_at, total_at),
      SHARED("sort.h", SortPush, count, count_at, shift, bins, high_word),
      SHARED("octree.h", OctreeHeader, origin, leaf, inverse_leaf, edge, mean_diameter, level, wanted_level,
             cells, spheres, references, needed, capacity, leaves, slots, slot_shift, split, split_references,
             split_cells, open, overflow),
      SHARED("layers.h", LayerState, next, accept, looked_up),
      SHARED("layers.h", LayerTable, splat, states),
      SHARED("octree.h", OctreePush, count, count_at, capacity, slot_capacity, level_capacity, most_split,
             crowd, scale, normal_stride, normal_at, thickness, core_low, core_high),
      SHARED("trace.h", TracePush, count, use_queue),
      SHARED("transport.h", PathState, throughput, pdf, pixel, sample_index, bits, media, travelled,
             eta_scale, nulls, light_group),
      SHARED("transport.h", ShadowState, diffuse, lanes, glossy, tag),
      SHARED("transport.h", TransportPush, count, use_queue, pixel_count, round),
      SHARED("transport.h", ClassesPush, count, use_queue, slots, classes, diffuse, all),
  };
}

std::filesystem::path folder() { return std::filesystem::path(LUCERNA_SOURCE_DIR) / "shaders" / "shared"; }

/// A kernel that copies one element of an array of the struct.
std::vector<uint32_t> compile(const SharedStruct& s, const std::filesystem::path& where) {
  const auto file = where / (s.name + ".comp");
  std::ofstream(file) << "#include \"shaders/shared/" << s.header << "\"\n"
                      << "layout(local_size_x = 1) in;\n"
                      << "buffer Items { " << s.name << " items[]; };\n"
                      << "void main() { items[1] = items[0]; }\n";
  ShaderCompiler compiler;
  compiler.set_cache(false);
  return compiler.compile(file.string());
}

}  // namespace

TEST_CASE("shared structs have the same layout in C++ and GLSL") {
  const test::Folder temporary;
  for (const SharedStruct& s : structs()) {
    INFO(s.header << ": " << s.name);
    const auto words = compile(s, temporary.path);
    CHECK(spirv::struct_stride(words, s.name) == s.bytes);
    const auto members = spirv::struct_members(words, s.name);
    REQUIRE(members.size() == s.members.size());
    for (size_t i = 0; i < members.size(); ++i) {
      CHECK(members[i].name == s.members[i].name);
      CHECK(members[i].offset == s.members[i].offset);
    }
  }
}

TEST_CASE("every struct in shaders/shared is in the list above") {
  std::set<std::string> listed;
  for (const SharedStruct& s : structs()) listed.insert(s.header + " " + s.name);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder())) {
    if (!entry.is_regular_file()) continue;
    const std::string header = std::filesystem::relative(entry.path(), folder()).generic_string();
    std::ifstream file(entry.path());
    const std::string keyword = "struct ";
    for (std::string line; std::getline(file, line);) {
      if (line.rfind(keyword, 0) != 0) continue;
      const size_t end = line.find_first_of(" {;", keyword.size());
      const std::string name = line.substr(keyword.size(), end - keyword.size());
      INFO("add SHARED(\"" << header << "\", " << name << ", ...) to structs()");
      CHECK(listed.count(header + " " + name) == 1);
    }
  }
}
