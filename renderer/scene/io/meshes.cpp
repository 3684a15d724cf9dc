// Primitives: checked, triangulated, with normals and (where a normal texture needs them) tangents.
#include <cmath>
#include <cstring>

#include "scene/io/document.h"

namespace lucerna::scene::io {
namespace {

template <class V>
std::vector<V> read_vectors(const Document& d, int accessor, const std::string& element) {
  const std::vector<float> floats = read_floats(d, accessor, V::length(), element);
  std::vector<V> out(floats.size() / V::length());
  if (!out.empty()) std::memcpy(static_cast<void*>(out.data()), floats.data(), floats.size() * 4);
  return out;
}

std::vector<uvec3> assemble(const Document& d, int mode, const std::vector<uint32_t>& index, const std::string& element) {
  std::vector<uvec3> out;
  const size_t n = index.size();
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    if (n % 3) d.fail(element, fmt::format("{} indices are not whole triangles", n));
    for (size_t i = 0; i + 2 < n; i += 3) out.emplace_back(index[i], index[i + 1], index[i + 2]);
  } else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
    for (size_t i = 0; i + 2 < n; ++i) out.emplace_back(index[i], index[i + 1 + i % 2], index[i + 2 - i % 2]);
  } else {
    for (size_t i = 1; i + 1 < n; ++i) out.emplace_back(index[i], index[i + 1], index[0]);
  }
  return out;
}

/// Vertices used by one triangle corner each, so that flat normals or split tangents can differ at shared corners.
void unshare(Primitive& p) {
  const auto spread = [&](auto& stream) {
    if (stream.empty()) return;
    std::remove_reference_t<decltype(stream)> out;
    out.reserve(3 * p.triangles.size());
    for (const uvec3& t : p.triangles)
      for (int k = 0; k < 3; ++k) out.push_back(stream[t[k]]);
    stream = std::move(out);
  };
  spread(p.positions);
  spread(p.normals);
  spread(p.tangents);
  spread(p.uv0);
  spread(p.uv1);
  spread(p.colors);
  for (size_t i = 0; i < p.triangles.size(); ++i) p.triangles[i] = uvec3(3 * i, 3 * i + 1, 3 * i + 2);
}

void flat_normals(Primitive& p) {
  unshare(p);
  p.normals.resize(p.positions.size());
  for (const uvec3& t : p.triangles) {
    const glm::dvec3 a(p.positions[t.x]), b(p.positions[t.y]), c(p.positions[t.z]);
    const vec3 n(glm::normalize(glm::cross(b - a, c - a)));
    for (int k = 0; k < 3; ++k) p.normals[t[k]] = n;
  }
}

/// Per-vertex tangents from the texture gradients, angle-weighted as MikkTSpace does; corners where mirrored and unmirrored
/// triangles meet are split.
void make_tangents(Primitive& p, const TextureUse& use) {
  const std::vector<vec2>& source = use.uv_set == 1 ? p.uv1 : p.uv0;
  if (source.empty()) return;
  std::vector<vec2> uv(source.size());
  for (size_t i = 0; i < uv.size(); ++i)
    uv[i] = vec2(use.m[0] * source[i].x + use.m[1] * source[i].y + use.m[2], use.m[3] * source[i].x + use.m[4] * source[i].y + use.m[5]);
  const auto signed_area = [&](const uvec3& t) {
    const vec2 e = uv[t.y] - uv[t.x], f = uv[t.z] - uv[t.x];
    return e.x * f.y - e.y * f.x;
  };
  std::vector<uint8_t> seen(p.positions.size(), 0);  // bit 0: unmirrored, bit 1: mirrored
  for (const uvec3& t : p.triangles)
    for (int k = 0; k < 3; ++k) seen[t[k]] |= signed_area(t) < 0 ? 2 : 1;
  const auto copy = [](auto& stream, uint32_t from) {
    if (!stream.empty()) stream.push_back(stream[from]);
  };
  std::vector<uint32_t> twin(p.positions.size(), k_none);
  for (uvec3& t : p.triangles) {
    if (!(signed_area(t) < 0)) continue;
    for (int k = 0; k < 3; ++k) {
      if (t[k] >= seen.size() || seen[t[k]] != 3) continue;
      uint32_t& other = twin[t[k]];
      if (other == k_none) {
        other = uint32_t(p.positions.size());
        const uint32_t from = t[k];
        copy(p.positions, from), copy(p.normals, from), copy(p.uv0, from), copy(p.uv1, from), copy(p.colors, from);
        uv.push_back(uv[from]);
      }
      t[k] = other;
    }
  }
  std::vector<vec3> sum(p.positions.size(), vec3(0));
  std::vector<float> handedness(p.positions.size(), 1);
  for (const uvec3& t : p.triangles) {
    const float area = signed_area(t);
    const vec2 e = uv[t.y] - uv[t.x], f = uv[t.z] - uv[t.x];
    // dP/du times |area|: the sign of a mirrored map goes into the direction.
    vec3 tangent = (p.positions[t.y] - p.positions[t.x]) * f.y - (p.positions[t.z] - p.positions[t.x]) * e.y;
    if (area < 0) tangent = -tangent;
    for (int k = 0; k < 3; ++k) {
      const vec3& n = p.normals[t[k]];
      const vec3 a = p.positions[t[(k + 1) % 3]] - p.positions[t[k]], b = p.positions[t[(k + 2) % 3]] - p.positions[t[k]];
      const float angle = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
      const vec3 in_plane = tangent - n * glm::dot(n, tangent);
      const float length = glm::length(in_plane);
      if (length > 0) sum[t[k]] += in_plane * (angle / length);
      // v runs down the texture, so an unmirrored map has a negative area here; cross(normal, tangent) then points up it,
      // where a normal texture's green points.
      handedness[t[k]] = area < 0 ? 1.f : -1.f;
    }
  }
  p.tangents.resize(p.positions.size());
  for (size_t i = 0; i < sum.size(); ++i) {
    float length = glm::length(sum[i]);
    vec3 t = sum[i];
    if (!(length > 0)) {
      const vec3 n = p.normals[i];
      t = glm::cross(std::abs(n.x) < 0.5f ? vec3(1, 0, 0) : vec3(0, 1, 0), n);
      length = glm::length(t);
    }
    p.tangents[i] = vec4(t / std::max(length, 1e-30f), handedness[i]);
  }
}

Primitive load_primitive(Document& d, const tinygltf::Primitive& in, const Scene& scene, const std::string& element) {
  Primitive p;
  const auto attribute = [&](const char* name) {
    const auto at = in.attributes.find(name);
    return at == in.attributes.end() ? -1 : at->second;
  };
  for (const auto& [name, accessor] : in.attributes) {
    if (name.rfind("TEXCOORD_", 0) == 0 && name != "TEXCOORD_0" && name != "TEXCOORD_1") d.count("{} UV sets beyond the second are left out");
    if (name.rfind("COLOR_", 0) == 0 && name != "COLOR_0") d.count("{} vertex colour sets beyond the first are left out");
    if (name.rfind("JOINTS_", 0) == 0) d.count("{} skinned primitives are shown in their bind pose");
  }
  if (!in.targets.empty()) d.count("{} primitives have morph targets, which are left out");
  if (attribute("POSITION") < 0) d.fail(element, "has no POSITION attribute");
  p.positions = read_vectors<vec3>(d, attribute("POSITION"), element + ".attributes.POSITION");
  const size_t n = p.positions.size();
  for (size_t i = 0; i < n; ++i)
    if (!std::isfinite(p.positions[i].x) || !std::isfinite(p.positions[i].y) || !std::isfinite(p.positions[i].z))
      d.fail(element + ".attributes.POSITION", fmt::format("vertex {} is not finite", i));
  const auto optional = [&](const char* name, auto& stream) {
    using V = typename std::remove_reference_t<decltype(stream)>::value_type;
    if (attribute(name) < 0) return;
    const std::string where = element + ".attributes." + name;
    stream = read_vectors<V>(d, attribute(name), where);
    if (stream.size() != n) d.fail(where, fmt::format("has {} entries for {} vertices", stream.size(), n));
    for (V& v : stream)
      for (int k = 0; k < V::length(); ++k)
        if (!std::isfinite(v[k])) v[k] = 0, d.count("{} vertex attribute values were not finite and became 0");
  };
  optional("NORMAL", p.normals);
  optional("TANGENT", p.tangents);
  optional("TEXCOORD_0", p.uv0);
  optional("TEXCOORD_1", p.uv1);
  if (const int color = attribute("COLOR_0"); color >= 0) {
    const std::string where = element + ".attributes.COLOR_0";
    if (component_count(d, color, where) == 3) {
      std::vector<vec3> rgb;
      optional("COLOR_0", rgb);
      for (const vec3& c : rgb) p.colors.emplace_back(c, 1);
    } else {
      optional("COLOR_0", p.colors);
    }
  }
  std::vector<uint32_t> index;
  if (in.indices >= 0) {
    index = read_indices(d, in.indices, element + ".indices");
    for (size_t i = 0; i < index.size(); ++i)
      if (index[i] >= n) d.fail(element + ".indices", fmt::format("index {} is {}, but there are {} vertices", i, index[i], n));
  } else {
    index.resize(n);
    for (size_t i = 0; i < n; ++i) index[i] = uint32_t(i);
  }
  p.triangles = assemble(d, in.mode, index, element);
  // Zero area after rounding: nothing to hit, and no normal.
  const size_t before = p.triangles.size();
  std::erase_if(p.triangles, [&](const uvec3& t) {
    const glm::dvec3 a(p.positions[t.x]), b(p.positions[t.y]), c(p.positions[t.z]);
    const glm::dvec3 cross = glm::cross(b - a, c - a);
    return !(vec3(cross) != vec3(0)) || !(glm::dot(cross, cross) > 0);
  });
  if (before != p.triangles.size()) d.count("{} triangles without area were left out", before - p.triangles.size());
  if (in.material >= 0) {
    if (size_t(in.material) >= d.model.materials.size()) d.fail(element, fmt::format("material {} does not exist", in.material));
    p.material = Id(in.material);
  } else {
    p.material = Id(scene.materials.size() - 1);  // glTF's default, kept last
  }
  if (p.normals.empty()) {
    p.tangents.clear();
    flat_normals(p);
  } else {
    for (vec3& normal : p.normals) {
      const float length = glm::length(normal);
      normal = length > 0 && std::isfinite(length) ? normal / length : vec3(0);
    }
  }
  const TextureUse& map = scene.materials[p.material].normal_texture;
  if (!map) p.tangents.clear();
  else if (p.tangents.empty()) make_tangents(p, map);
  return p;
}

}  // namespace

void load_meshes(Document& d, Scene& scene, const LoadProgress& progress) {
  for (size_t m = 0; m < d.model.meshes.size(); ++m) {
    const tinygltf::Mesh& in = d.model.meshes[m];
    Mesh mesh;
    mesh.name = in.name.empty() ? fmt::format("mesh {}", m) : in.name;
    for (size_t k = 0; k < in.primitives.size(); ++k) {
      const tinygltf::Primitive& primitive = in.primitives[k];
      const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
      const std::string element = fmt::format("meshes[{}].primitives[{}]", m, k);
      if (mode > TINYGLTF_MODE_TRIANGLE_FAN) d.fail(element, fmt::format("mode {} is unknown", mode));
      if (mode < TINYGLTF_MODE_TRIANGLES) {
        d.count("{} primitives of points or lines are left out");
        continue;
      }
      tinygltf::Primitive fixed = primitive;
      fixed.mode = mode;
      Primitive loaded = load_primitive(d, fixed, scene, element);
      if (!loaded.triangles.empty()) mesh.primitives.push_back(std::move(loaded));
    }
    scene.meshes.push_back(std::move(mesh));
    if (progress && !progress(0.1f + 0.4f * float(m + 1) / float(d.model.meshes.size()), "meshes")) throw Error("", "cancelled");
  }
}

}  // namespace lucerna::scene::io
