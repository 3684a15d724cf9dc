#include "transport/light_source.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/alias_table.h"
#include "transport/casters.h"

namespace lucerna::transport {

namespace {

float as_float(uint32_t bits) { return std::bit_cast<float>(bits); }

gpu::Buffer texels(gpu::Device& device, const char* name, std::span<const vec4> values) {
  gpu::Buffer buffer(
      device, {.name = name, .bytes = sizeof(vec4) * std::max<uint64_t>(1, values.size()), .texel = true});
  if (!values.empty()) buffer.write(values);
  return buffer;
}

}  // namespace

bool from_afar(const upload::FlatLights& lights, uint32_t entry) {
  if (entry >= lights.entries.size()) return true;
  const uint32_t kind = lights.entries[entry].kind;
  return kind == shared::k_light_directional || kind == shared::k_light_environment;
}

LightGroups group_lights(const upload::FlatScene& flat, std::span<const double> power, uint32_t most) {
  std::vector<uint32_t> triangles;
  std::vector<Box> boxes;
  LightGroups groups;
  std::vector<std::vector<uint32_t>> alone;
  for (uint32_t i = 0; i < power.size(); ++i) {
    if (power[i] <= 0) continue;
    if (i >= flat.entries.size() || flat.entries[i].kind != shared::k_light_triangle) {
      alone.push_back({i});
      continue;
    }
    Box box;
    for (size_t k = 0; k < 3; ++k) box.grow(flat.positions[3 * size_t{flat.entries[i].index} + k]);
    triangles.push_back(i), boxes.push_back(box);
  }
  if (!triangles.empty()) {
    // Lamps first; triangles get the rest, at least half.
    const auto wanted = uint32_t(std::min<size_t>(alone.size(), most / 2));
    const std::vector<uint32_t> of = cluster(boxes, std::max(1u, most - wanted));
    groups.members.resize(*std::max_element(of.begin(), of.end()) + 1);
    for (size_t i = 0; i < of.size(); ++i) groups.members[of[i]].push_back(triangles[i]);
  }
  for (std::vector<uint32_t>& lamp : alone) {
    if (groups.members.size() < most)
      groups.members.push_back(std::move(lamp));
    else
      groups.members.back().push_back(lamp[0]);
  }
  return groups;
}

LightSource::LightSource(gpu::Device& device, const upload::FlatLights& lights, const vec3& scene_centre,
                         float scene_radius)
    : powers_(lights.light_power), shares_{1} {
  // The disk covers the scene's outermost points in spite of rounding.
  table_ = {.centre = scene_centre,
            .radius = 1.0001f * scene_radius,
            .count = 0,
            .sky = shared::k_no_sky_entry,
            .sun_pmf = lights.light_alias.empty() ? 0 : lights.light_alias.back().z,
            .casters = 0,
            .groups = 0,
            .core_centre = scene_centre,
            .core_radius = 1.0001f * scene_radius,
            .core_share = 0};
  if (lights.sky_power > 0) {
    table_.sky = uint32_t(powers_.size());
    powers_.push_back(lights.sky_power);
  }
  for (uint32_t i = 0; i < powers_.size(); ++i) {
    power_ += powers_[i];
    if (from_afar(lights, i)) power_from_afar_ += powers_[i];
  }
  const std::vector<vec4> alias = build_alias_table(powers_);
  table_.count = uint32_t(alias.size());
  if (alias.empty()) power_ = power_from_afar_ = 0;
  alias_ = texels(device, "table of emission", alias);
  for (gpu::Buffer* b : {&strata_, &boxes_, &groups_, &members_}) *b = texels(device, "aimed emission", {});
  block_ = gpu::Buffer(device, {.name = "emission", .bytes = sizeof table_});
  block_.write(&table_, sizeof table_);
}

LightSource::LightSource(gpu::Device& device, const upload::FlatScene& flat)
    : LightSource(device, flat, flat.scene_centre, flat.scene_radius) {
  if (flat.core_radius == flat.scene_radius) return;
  table_.core_centre = flat.core_centre, table_.core_radius = 1.0001f * flat.core_radius;
  table_.core_share = 0.5f;
  block_.write(&table_, sizeof table_);
}

void LightSource::aim(gpu::Device& device, const upload::FlatScene& flat, std::span<const Box> casters,
                      double unaimed) {
  table_.casters = table_.groups = 0;
  shares_ = {1};
  members_of_groups_.clear();
  if (power_ > 0 && !casters.empty()) {
    const auto n = uint32_t(casters.size());
    LightGroups groups = group_lights(flat, powers_, shared::k_most_strata / n);
    std::vector<vec4> headers, by_entry(powers_.size(), vec4(0)), by_member, tables;
    for (uint32_t g = 0; g < groups.members.size(); ++g) {
      const std::vector<uint32_t>& members = groups.members[g];
      headers.emplace_back(as_float(uint32_t(tables.size())), as_float(uint32_t(members.size())), 0, 0);
      std::vector<double> power;
      for (uint32_t k = 0; k < members.size(); ++k) {
        power.push_back(powers_[members[k]]);
        by_entry[members[k]] = vec4(as_float(g), as_float(k), 0, 0);
        by_member.emplace_back(as_float(members[k]), 0, 0, 0);
      }
      const std::vector<vec4> table = build_alias_table(power);
      tables.insert(tables.end(), table.begin(), table.end());
    }
    std::vector<vec4> all = headers, boxes;
    all.insert(all.end(), by_entry.begin(), by_entry.end());
    all.insert(all.end(), by_member.begin(), by_member.end());
    for (const Box& b : casters) boxes.emplace_back(b.lo, 0), boxes.emplace_back(b.hi, 0);
    table_.casters = n, table_.groups = uint32_t(headers.size());
    shares_.assign(strata(), (1 - unaimed) / double(strata() - 1));
    shares_[0] = unaimed;
    boxes_ = texels(device, "boxes of casters", boxes);
    groups_ = texels(device, "groups of lights", all);
    members_ = texels(device, "lights of groups", tables);
    strata_ = texels(device, "shares of strata", std::vector<vec4>(strata()));
    share_out(std::vector<double>(shares_));
    members_of_groups_ = std::move(groups.members);
  }
  block_.write(&table_, sizeof table_);
}

void LightSource::choose_by(std::span<const double> weights) {
  if (const std::vector<vec4> alias = build_alias_table(std::vector<double>(weights.begin(), weights.end()));
      !alias.empty())
    alias_.write(std::span<const vec4>(alias));
}

void LightSource::share_out(std::span<const double> shares) {
  double sum = 0, before = 0;
  for (const double s : shares) sum += s;
  shares_.assign(shares.begin(), shares.end());
  // Shares come from the rounded intervals, so that densities equal those of sampling.
  std::vector<vec4> intervals;
  constexpr double k_all = 4294967296.0;
  const auto at = [&](double share) { return uint64_t(std::lround(k_all * std::min(1.0, share / sum))); };
  for (double& s : shares_) {
    const uint64_t first = at(before), end = &s == &shares_.back() ? uint64_t(k_all) : at(before + s);
    before += s;
    s = double(end - first) / k_all;
    intervals.emplace_back(as_float(uint32_t(std::min<uint64_t>(first, ~0u))), float(s), 0, 0);
  }
  if (table_.casters > 0) strata_.write(std::span<const vec4>(intervals));
}

void LightSource::bind(gpu::Resources& resources) const {
  resources.set("emission_alias", alias_);
  resources.set("emission_strata", strata_);
  resources.set("emission_boxes", boxes_);
  resources.set("emission_groups", groups_);
  resources.set("emission_members", members_);
  resources.set("EmissionBlock", block_);
}

uint64_t LightSource::bytes() const {
  uint64_t sum = 0;
  for (const gpu::Buffer* b : {&alias_, &strata_, &boxes_, &groups_, &members_}) sum += *b ? b->bytes() : 0;
  return sum;
}

}  // namespace lucerna::transport
