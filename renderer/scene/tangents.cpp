#include "scene/tangents.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <unordered_map>

namespace lucerna::scene {
namespace {

template <class T>
void gather(std::vector<T>& stream, const std::vector<uint32_t>& source) {
  if (stream.empty()) return;
  std::vector<T> result(source.size());
  for (size_t i = 0; i < source.size(); ++i) result[i] = stream[source[i]];
  stream = std::move(result);
}

struct Corner {
  vec3 position, normal;
  vec2 uv;
  bool operator==(const Corner&) const = default;
};

struct CornerHash {
  size_t operator()(const Corner& corner) const {
    const float values[8] = {corner.position.x, corner.position.y, corner.position.z, corner.normal.x,
                             corner.normal.y,   corner.normal.z,   corner.uv.x,       corner.uv.y};
    uint64_t hash = 0xcbf29ce484222325ull;
    for (float value : values) {
      uint32_t bits = 0;
      value += 0.0f;  // -0 equals +0, so they must hash alike
      std::memcpy(&bits, &value, sizeof bits);
      hash = (hash ^ bits) * 0x9e3779b97f4a7c15ull;
      hash ^= hash >> 29;
    }
    return hash;
  }
};

vec3 any_tangent(const vec3& n) {
  const vec3 axis = std::abs(n.x) < 0.6f ? vec3(1, 0, 0) : vec3(0, 1, 0);
  return glm::normalize(axis - n * glm::dot(n, axis));
}

bool usable(const vec3& v) {
  const float length2 = glm::dot(v, v);
  return std::isfinite(length2) && length2 > 0;
}

// Twice the signed area in texture space with v upwards, and the gradient of position along u.
struct Gradient {
  float area = 0;
  vec3 tangent{0};
};

Gradient uv_gradient(const Primitive& primitive, const std::vector<vec2>& uvs, const uvec3& t) {
  Gradient result;
  if (uvs.empty()) return result;
  const vec3 e1 = primitive.positions[t.y] - primitive.positions[t.x];
  const vec3 e2 = primitive.positions[t.z] - primitive.positions[t.x];
  const vec2 d1 = uvs[t.y] - uvs[t.x], d2 = uvs[t.z] - uvs[t.x];
  const float area_down = d1.x * d2.y - d2.x * d1.y;
  if (area_down == 0 || !std::isfinite(area_down)) return result;
  const vec3 tangent = (e1 * d2.y - e2 * d1.y) * (area_down > 0 ? 1.0f : -1.0f);
  if (!usable(tangent)) return result;
  result.area = -area_down;
  result.tangent = glm::normalize(tangent);
  return result;
}

}  // namespace

void make_flat_normals(Primitive& primitive) {
  const size_t count = primitive.triangles.size();
  std::vector<uint32_t> source(3 * count);
  std::vector<vec3> normals(3 * count);
  for (size_t i = 0; i < count; ++i) {
    const uvec3 t = primitive.triangles[i];
    const glm::dvec3 a = primitive.positions[t.x], b = primitive.positions[t.y], c = primitive.positions[t.z];
    const vec3 normal = glm::normalize(glm::cross(b - a, c - a));
    for (uint32_t k = 0; k < 3; ++k) {
      source[3 * i + k] = t[static_cast<int>(k)];
      normals[3 * i + k] = normal;
    }
    const auto first = static_cast<uint32_t>(3 * i);
    primitive.triangles[i] = uvec3(first, first + 1, first + 2);
  }
  gather(primitive.positions, source);
  gather(primitive.uv0, source);
  gather(primitive.uv1, source);
  gather(primitive.colors, source);
  primitive.tangents.clear();
  primitive.normals = std::move(normals);
}

void make_tangents(Primitive& primitive, const TextureUse& map) {
  std::vector<vec2> uvs = map.uv_set == 0 ? primitive.uv0 : primitive.uv1;
  for (vec2& uv : uvs)
    uv = vec2(map.m[0] * uv.x + map.m[1] * uv.y + map.m[2], map.m[3] * uv.x + map.m[4] * uv.y + map.m[5]);
  const size_t vertices = primitive.positions.size();

  std::vector<uint32_t> weld(vertices);
  {
    std::unordered_map<Corner, uint32_t, CornerHash> known;
    known.reserve(vertices);
    for (size_t i = 0; i < vertices; ++i) {
      const Corner corner{primitive.positions[i], primitive.normals[i], uvs.empty() ? vec2(0) : uvs[i]};
      weld[i] = known.emplace(corner, static_cast<uint32_t>(known.size())).first->second;
    }
  }

  // Groups: 2 * weld + (1 where mirrored).
  std::vector<vec3> sum(2 * vertices, vec3(0));
  std::vector<uint8_t> orientation(
      primitive.triangles.size());            // 0, 1 = mirrored, 2 = no area in texture space
  std::vector<uint8_t> present(vertices, 0);  // bit per orientation, by weld
  for (size_t i = 0; i < primitive.triangles.size(); ++i) {
    const uvec3 t = primitive.triangles[i];
    const Gradient gradient = uv_gradient(primitive, uvs, t);
    orientation[i] = gradient.area == 0 ? 2 : gradient.area > 0 ? 0 : 1;
    if (orientation[i] == 2) continue;
    for (int k = 0; k < 3; ++k) {
      const uint32_t v = t[k];
      const vec3 n = primitive.normals[v];
      const auto project = [&n](const vec3& x) {
        const vec3 y = x - n * glm::dot(n, x);
        return usable(y) ? glm::normalize(y) : vec3(0);
      };
      const vec3 to_next = project(primitive.positions[t[(k + 1) % 3]] - primitive.positions[v]);
      const vec3 to_last = project(primitive.positions[t[(k + 2) % 3]] - primitive.positions[v]);
      const float angle = std::acos(std::clamp(glm::dot(to_next, to_last), -1.0f, 1.0f));
      sum[2 * weld[v] + orientation[i]] += project(gradient.tangent) * angle;
      present[weld[v]] |= static_cast<uint8_t>(1u << orientation[i]);
    }
  }

  std::vector<uint32_t> source(vertices);
  std::vector<int> kind(vertices, -1);           // orientation that a vertex has taken
  std::vector<uint32_t> twin(vertices, k_none);  // its copy for the other one
  for (size_t i = 0; i < vertices; ++i) source[i] = static_cast<uint32_t>(i);
  for (size_t i = 0; i < primitive.triangles.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      uint32_t& v = primitive.triangles[i][k];
      int wanted = orientation[i];
      if (wanted == 2) wanted = kind[v] >= 0 ? kind[v] : (present[weld[v]] == 2 ? 1 : 0);
      if (kind[v] < 0) kind[v] = wanted;
      if (kind[v] == wanted) continue;
      if (twin[v] == k_none) {
        twin[v] = static_cast<uint32_t>(source.size());
        source.push_back(v);
        kind.push_back(wanted);
      }
      v = twin[v];
    }
  }
  if (source.size() != vertices) {
    gather(primitive.positions, source);
    gather(primitive.normals, source);
    gather(primitive.uv0, source);
    gather(primitive.uv1, source);
    gather(primitive.colors, source);
  }

  primitive.tangents.resize(source.size());
  for (size_t i = 0; i < source.size(); ++i) {
    const bool mirrored = kind[i] == 1;
    const vec3 n = primitive.normals[i];
    const vec3 mean = sum[2 * weld[source[i]] + (mirrored ? 1 : 0)];
    const vec3 tangent = usable(mean) ? glm::normalize(mean) : any_tangent(n);
    primitive.tangents[i] = vec4(tangent, mirrored ? -1.0f : 1.0f);
  }
}

}  // namespace lucerna::scene
