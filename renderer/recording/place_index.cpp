#include "recording/place_index.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <string_view>

namespace lucerna::recording {
namespace {

/// Spreads the low 10 bits to every third place.
uint32_t spread(uint32_t x) {
  x = (x | x << 16) & 0x030000ffu;
  x = (x | x << 8) & 0x0300f00fu;
  x = (x | x << 4) & 0x030c30c3u;
  return (x | x << 2) & 0x09249249u;
}

uint32_t morton(const vec3& place, const Box& around) {
  uint32_t code = 0;
  for (int k = 0; k < 3; ++k) {
    const float size = around.hi[k] - around.lo[k];
    const float at = size > 0 ? (place[k] - around.lo[k]) / size : 0;
    code |= spread(at > 0 ? uint32_t(std::min(at, 1.0f) * 1023) : 0) << k;
  }
  return code;
}

bool meet(const Box& a, const Box& b) {
  for (int k = 0; k < 3; ++k)
    if (a.lo[k] > b.hi[k] || b.lo[k] > a.hi[k]) return false;
  return true;
}

}  // namespace

vec3 lit_place(std::span<const Event> path, uint32_t event) {
  const auto before = [&](uint32_t at) { return path[at].parent < at ? path[at].parent : at; };
  uint32_t at = event;
  switch (kind_of(path[event])) {
    case shared::k_path_emission:
      at = before(before(event));
      break;
    case shared::k_path_light:
    case shared::k_path_blocked:
    case shared::k_path_background:
      at = before(event);
      break;
    default:
      break;
  }
  while (kind_of(path[at]) == shared::k_path_passed && before(at) != at) at = before(at);
  return kind_of(path[at]) == shared::k_path_camera ? path[event].position : path[at].position;
}

PlaceIndex make_place_index(const Recording& recording) {
  PlaceIndex index;
  std::vector<vec3> places;
  std::vector<PlaceIndex::Row> rows;
  Box around;
  for (uint32_t p = 0; p < recording.paths.size(); ++p) {
    const Path& path = recording.paths[p];
    const std::span<const Event> events = recording.events_of(path);
    index.hash.push_back(path_checksum(path, events));
    for (uint32_t e = 0; e < events.size(); ++e) {
      if (!shared::is_component(component_of(events[e]))) continue;
      if (contributes_light(events[e])) index.light += double(luminance(events[e].contribution));
      rows.push_back({p, e});
      places.push_back(lit_place(events, e));
      around.grow(places.back());
    }
  }
  std::vector<uint32_t> order(rows.size()), code(rows.size());
  std::iota(order.begin(), order.end(), 0u);
  for (size_t i = 0; i < rows.size(); ++i) code[i] = morton(places[i], around);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return code[a] < code[b]; });
  index.rows.reserve(rows.size());
  for (size_t i = 0; i < order.size(); ++i) {
    if (i % PlaceIndex::k_leaf_rows == 0) index.leaves.emplace_back();
    index.leaves.back().grow(places[order[i]]);
    index.rows.push_back(rows[order[i]]);
  }
  return index;
}

std::vector<uint32_t> paths_in(const PlaceIndex& index, const Box& box) {
  std::vector<uint32_t> found;
  for (size_t leaf = 0; leaf < index.leaves.size(); ++leaf) {
    if (!meet(index.leaves[leaf], box)) continue;
    const size_t end = std::min(index.rows.size(), (leaf + 1) * PlaceIndex::k_leaf_rows);
    for (size_t i = leaf * PlaceIndex::k_leaf_rows; i < end; ++i) found.push_back(index.rows[i].path);
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

uint64_t checksum(std::string_view bytes, uint64_t before) {
  constexpr uint64_t k_prime = 0x100000001b3ull;
  uint64_t hash = before;
  const auto add = [&](uint64_t word) {
    hash = (hash ^ word) * k_prime;
    hash ^= hash >> 29;
  };
  size_t at = 0;
  for (uint64_t word; at + sizeof word <= bytes.size(); at += sizeof word) {
    std::memcpy(&word, bytes.data() + at, sizeof word);
    add(word);
  }
  if (at < bytes.size()) {
    uint64_t word = 0;
    std::memcpy(&word, bytes.data() + at, bytes.size() - at);
    add(word);
  }
  return hash;
}

uint64_t path_checksum(const Path& path, std::span<const Event> events) {
  const std::string_view own(reinterpret_cast<const char*>(&path), sizeof path);
  return checksum({reinterpret_cast<const char*>(events.data()), events.size_bytes()}, checksum(own));
}

}  // namespace lucerna::recording
