#include "scene/io/geometry.h"

#include <algorithm>
#include <cmath>

#include "scene/io/accessor.h"
#include "scene/tangents.h"

namespace lucerna::scene {
namespace {

constexpr size_t k_max_triangles = size_t{1} << 27;

bool finite(const vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

class PrimitiveLoader {
 public:
  /// `origin`: of placed vertices; chosen by the first one where it has no value.
  PrimitiveLoader(Document& document, const tinygltf::Primitive& source, const Item& item, const Pose& pose,
                  std::optional<glm::dvec3>& origin)
      : document_(document),
        source_(source),
        item_(item),
        where_(item.path()),
        pose_(pose),
        origin_(origin) {}

  /// False when there is nothing to show.
  bool load(MaterialLoader& materials, Primitive& primitive);

 private:
  std::string located(const std::string& member) const {
    return fmt::format("{}: {}.{}", document_.file, where_, member);
  }
  template <class... Args>
  void budget(uint64_t bytes, const char* member, fmt::format_string<Args...> format, Args&&... args) {
    document_.budget.take(bytes, located(member), format, std::forward<Args>(args)...);
  }
  void warn(const char* kind, uint64_t count = 1) { document_.warnings.add(kind, where_, count); }
  int attribute(const char* name) const {
    const auto found = source_.attributes.find(name);
    return found == source_.attributes.end() ? -1 : found->second;
  }
  AccessorReader open(const char* name, int least, int most) const;
  bool read_triangles(size_t vertices);
  void keep_used_vertices();
  template <class Vector>
  std::vector<Vector> read_stream(const AccessorReader& reader, int components) const;
  void check_position(const vec3& p, size_t element) const;
  void read_positions(Primitive& primitive);
  void turn_mirrored_triangles();
  size_t drop_degenerate(const std::vector<vec3>& positions);
  void read_normals(Primitive& primitive);
  std::vector<vec2> read_uvs(const char* name);
  void read_colors(Primitive& primitive);
  void read_tangents(Primitive& primitive);
  void read_variants(MaterialLoader& materials, Primitive& primitive, MaterialNeeds& needs);

  Document& document_;
  const tinygltf::Primitive& source_;
  Item item_;
  std::string where_;
  const Pose& pose_;
  std::optional<glm::dvec3>& origin_;
  std::optional<Deformer> deformer_;
  std::vector<uvec3> triangles_;
  std::vector<uint32_t> used_;  // accessor element of each kept vertex
  size_t vertices_ = 0;         // of the POSITION accessor
};

AccessorReader PrimitiveLoader::open(const char* name, int least, int most) const {
  const std::string where = located("attributes." + std::string(name));
  AccessorReader reader(document_, static_cast<uint32_t>(attribute(name)));
  if (reader.components() < least || reader.components() > most)
    throw_error(where, "{} components, expected {}{}", reader.components(), least,
                most > least ? fmt::format(" to {}", most) : "");
  if (reader.component_type() == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
    throw_error(where, "32-bit integers are not an attribute's type");
  if (vertices_ != 0 && reader.count() != vertices_)
    throw_error(where, "{} elements, but POSITION has {}", reader.count(), vertices_);
  return reader;
}

bool PrimitiveLoader::read_triangles(size_t vertices) {
  std::vector<uint32_t> list;
  if (source_.indices >= 0) {
    const AccessorReader reader(document_, static_cast<uint32_t>(source_.indices));
    const int type = reader.component_type();
    if (reader.components() != 1 ||
        (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
         type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT))
      throw Error(located("indices"), "expected scalars of an unsigned integer type");
    budget(reader.count() * sizeof(uint32_t), "indices", "{} indices", reader.count());
    list.resize(reader.count());
    for (size_t i = 0; i < list.size(); ++i) {
      list[i] = reader.read_index(i);
      if (list[i] >= vertices)
        throw_error(located("indices"), "index {} is {}, but there are {} vertices", i, list[i], vertices);
    }
  } else {
    budget(vertices * sizeof(uint32_t), "attributes.POSITION", "{} vertices", vertices);
    list.resize(vertices);
    for (size_t i = 0; i < vertices; ++i) list[i] = static_cast<uint32_t>(i);
  }
  const size_t n = list.size();
  if (n / 3 > k_max_triangles || (source_.mode != 4 && n > k_max_triangles))
    throw_error(located("indices"), "more than {} triangles", k_max_triangles);
  const size_t triangles = source_.mode == TINYGLTF_MODE_TRIANGLES ? n / 3 : n - std::min<size_t>(n, 2);
  budget(triangles * sizeof(uvec3), "indices", "{} triangles", triangles);
  if (source_.mode == TINYGLTF_MODE_TRIANGLES) {
    triangles_.reserve(n / 3);
    for (size_t i = 0; i + 2 < n; i += 3) triangles_.emplace_back(list[i], list[i + 1], list[i + 2]);
    if (n % 3 != 0) warn("{} primitives whose vertices are not a multiple of 3: the rest is ignored");
  } else if (source_.mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
    // Every other triangle is turned, so that all have the winding of the first (glTF 2.0, 3.7.2.1).
    for (size_t i = 0; i + 2 < n; ++i)
      triangles_.emplace_back(list[i], list[i + 1 + i % 2], list[i + 2 - i % 2]);
  } else {
    for (size_t i = 1; i + 1 < n; ++i) triangles_.emplace_back(list[i], list[i + 1], list[0]);
  }
  return !triangles_.empty();
}

// Primitives often share one large vertex buffer; each keeps only what its triangles use, in the buffer's
// order, and takes no longer for it than its triangles are many.
void PrimitiveLoader::keep_used_vertices() {
  used_.clear();
  if (vertices_ / 16 > triangles_.size()) {
    for (const uvec3& t : triangles_) used_.insert(used_.end(), {t.x, t.y, t.z});
    std::sort(used_.begin(), used_.end());
    used_.erase(std::unique(used_.begin(), used_.end()), used_.end());
    const auto place = [&](uint32_t vertex) {
      return static_cast<uint32_t>(std::lower_bound(used_.begin(), used_.end(), vertex) - used_.begin());
    };
    for (uvec3& t : triangles_) t = uvec3(place(t.x), place(t.y), place(t.z));
    return;
  }
  std::vector<uint32_t> place(vertices_, k_none);
  for (const uvec3& t : triangles_) place[t.x] = place[t.y] = place[t.z] = 0;
  for (size_t i = 0; i < vertices_; ++i) {
    if (place[i] == k_none) continue;
    place[i] = static_cast<uint32_t>(used_.size());
    used_.push_back(static_cast<uint32_t>(i));
  }
  for (uvec3& t : triangles_) t = uvec3(place[t.x], place[t.y], place[t.z]);
}

template <class Vector>
std::vector<Vector> PrimitiveLoader::read_stream(const AccessorReader& reader, int components) const {
  std::vector<Vector> result(used_.size());
  for (size_t i = 0; i < used_.size(); ++i) reader.read(used_[i], &result[i][0], components);
  return result;
}

void PrimitiveLoader::check_position(const vec3& p, size_t element) const {
  if (!finite(p))
    throw_error(located("attributes.POSITION"), "vertex {} is ({}, {}, {}), expected finite numbers", element,
                p.x, p.y, p.z);
  const vec3 a = glm::abs(p);
  if (std::max({a.x, a.y, a.z}) > k_max_coordinate)
    throw_error(located("attributes.POSITION"), "vertex {} is ({}, {}, {}), beyond {} m", element, p.x, p.y,
                p.z, k_max_coordinate);
}

void PrimitiveLoader::read_positions(Primitive& primitive) {
  primitive.positions = read_stream<vec3>(open("POSITION", 3, 3), 3);
  for (size_t i = 0; i < used_.size(); ++i) check_position(primitive.positions[i], used_[i]);
  deformer_->add_targets("POSITION", used_, primitive.positions, 3, 3);
  for (size_t i = 0; i < used_.size(); ++i) {
    vec3& p = primitive.positions[i];
    check_position(p, used_[i]);
    if (!deformer_->placed()) continue;
    const glm::dvec3 placed(deformer_->matrix(used_[i]) * glm::dvec4(p, 1));
    check_position(vec3(placed), used_[i]);
    if (!origin_) origin_ = glm::round(placed / 64.0) * 64.0;
    p = vec3(placed - *origin_);
  }
}

// A mirrored joint leaves the outside outside.
void PrimitiveLoader::turn_mirrored_triangles() {
  if (!deformer_->skinned()) return;
  std::vector<double> determinants;
  for (const uint32_t element : used_)
    determinants.push_back(glm::determinant(glm::dmat3(deformer_->matrix(element))));
  for (uvec3& t : triangles_)
    if (determinants[t.x] + determinants[t.y] + determinants[t.z] < 0) std::swap(t.y, t.z);
}

size_t PrimitiveLoader::drop_degenerate(const std::vector<vec3>& positions) {
  const size_t before = triangles_.size();
  std::erase_if(triangles_, [&positions](const uvec3& t) {
    if (t.x == t.y || t.y == t.z || t.z == t.x) return true;
    const vec3 a = positions[t.x];
    const vec3 n = glm::cross(positions[t.y] - a, positions[t.z] - a);
    return !(glm::dot(n, n) > 0);  // as float arithmetic sees it: later pdfs divide by this area
  });
  return before - triangles_.size();
}

void PrimitiveLoader::read_normals(Primitive& primitive) {
  if (attribute("NORMAL") < 0) {
    make_flat_normals(primitive);
    return;
  }
  primitive.normals = read_stream<vec3>(open("NORMAL", 3, 3), 3);
  deformer_->add_targets("NORMAL", used_, primitive.normals, 3, 3);
  if (deformer_->placed())
    for (size_t i = 0; i < used_.size(); ++i)
      primitive.normals[i] =
          vec3(normal_matrix(glm::dmat3(deformer_->matrix(used_[i]))) * glm::dvec3(primitive.normals[i]));
  std::vector<uint8_t> bad(primitive.normals.size(), 0);
  size_t count = 0;
  for (size_t i = 0; i < primitive.normals.size(); ++i) {
    vec3& n = primitive.normals[i];
    const double length = glm::length(glm::dvec3(n));
    if (std::isfinite(length) && length > 1e-12) {
      n = vec3(glm::dvec3(n) / length);
    } else {
      bad[i] = 1;
      n = vec3(0);
      ++count;
    }
  }
  if (count == 0) return;
  warn("{} normals without a direction: replaced by those of their faces", count);
  std::vector<glm::dvec3> sum(primitive.normals.size(), glm::dvec3(0));
  for (const uvec3& t : primitive.triangles) {
    const glm::dvec3 a = primitive.positions[t.x];
    const glm::dvec3 n =
        glm::cross(glm::dvec3(primitive.positions[t.y]) - a, glm::dvec3(primitive.positions[t.z]) - a);
    for (int k = 0; k < 3; ++k) sum[t[k]] += n;
  }
  for (size_t i = 0; i < bad.size(); ++i) {
    if (!bad[i]) continue;
    const double length = glm::length(sum[i]);
    primitive.normals[i] = length > 0 ? vec3(sum[i] / length) : vec3(0, 1, 0);
  }
}

std::vector<vec2> PrimitiveLoader::read_uvs(const char* name) {
  if (attribute(name) < 0) {
    warn("{} primitives have a textured material but lack the texture coordinates: (0, 0) is taken");
    return {};
  }
  std::vector<vec2> uvs = read_stream<vec2>(open(name, 2, 2), 2);
  deformer_->add_targets(name, used_, uvs, 2, 2);
  size_t bad = 0;
  for (vec2& uv : uvs) {
    if (std::abs(uv.x) < 1e6f && std::abs(uv.y) < 1e6f) continue;
    uv = vec2(0);
    ++bad;
  }
  if (bad != 0) warn("{} texture coordinates that are not finite or beyond 10^6: (0, 0) is taken", bad);
  return uvs;
}

void PrimitiveLoader::read_colors(Primitive& primitive) {
  if (attribute("COLOR_0") < 0) return;
  AccessorReader reader = open("COLOR_0", 3, 4);
  reader.force_normalized();
  primitive.colors.assign(used_.size(), vec4(1));
  size_t bad = 0;
  bool white = true;
  for (size_t i = 0; i < used_.size(); ++i)
    reader.read(used_[i], &primitive.colors[i][0], reader.components());
  deformer_->add_targets("COLOR_0", used_, primitive.colors, 3, 4);
  for (vec4& color : primitive.colors) {
    for (int k = 0; k < 4; ++k) {
      if (std::isfinite(color[k])) {
        color[k] = std::clamp(color[k], 0.0f, 1.0f);  // glTF 2.0, 3.7.2.1
      } else {
        color[k] = 1;
        ++bad;
      }
    }
    white = white && color == vec4(1);
  }
  if (bad != 0) warn("{} vertex colour values that are not finite: 1 is taken", bad);
  if (white) primitive.colors.clear();
}

void PrimitiveLoader::read_tangents(Primitive& primitive) {
  primitive.tangents = read_stream<vec4>(open("TANGENT", 4, 4), 4);
  deformer_->add_targets("TANGENT", used_, primitive.tangents, 3, 3);
  for (size_t i = 0; deformer_->placed() && i < used_.size(); ++i) {
    const glm::dmat3 m(deformer_->matrix(used_[i]));
    vec4& t = primitive.tangents[i];
    t = vec4(vec3(m * glm::dvec3(t)), glm::determinant(m) < 0 ? -t.w : t.w);
  }
  size_t bad = 0;
  for (size_t i = 0; i < primitive.tangents.size(); ++i) {
    vec4& tangent = primitive.tangents[i];
    const vec3 n = primitive.normals[i];
    vec3 t = finite(vec3(tangent)) ? vec3(tangent) : vec3(0);
    const float length = glm::length(t);
    const vec3 across = length > 0 && std::isfinite(length) ? glm::cross(n, t / length) : vec3(0);
    if (glm::length(across) < 1e-4f) {  // none, or along the normal
      t = std::abs(n.x) < 0.6f ? vec3(1, 0, 0) : vec3(0, 1, 0);
      t = glm::normalize(t - n * glm::dot(n, t));
      ++bad;
    } else {
      t /= length;
    }
    tangent = vec4(t, tangent.w < 0 ? -1.0f : 1.0f);
  }
  if (bad != 0) warn("{} tangents without a direction in the surface: replaced", bad);
}

// Materials of variants share the vertices, so they must read the same sets of texture coordinates.
void PrimitiveLoader::read_variants(MaterialLoader& materials, Primitive& primitive, MaterialNeeds& needs) {
  const auto extensions = item_.find("extensions");
  const auto e = extensions ? extensions->find("KHR_materials_variants") : std::nullopt;
  if (!e) return;
  const Item mappings = e->at("mappings");
  const size_t count = document_.root().at("materials").size();
  for (size_t i = 0; i < mappings.size(); ++i) {
    const Item mapping = mappings.at(i);
    const Id id = materials.material(static_cast<int>(mapping.at("material").index(count, "materials")));
    const MaterialNeeds& others = materials.needs(id);
    bool fits = true;
    for (size_t s = 0; s < needs.sets.size(); ++s)
      fits = fits && (others.sets[s] < 0 || needs.sets[s] < 0 || others.sets[s] == needs.sets[s]);
    if (!fits) {
      warn("{} materials of variants read other texture coordinates than the default one: left out");
      continue;
    }
    for (size_t s = 0; s < needs.sets.size(); ++s) needs.sets[s] = std::max(needs.sets[s], others.sets[s]);
    if (!needs.tangents) needs.tangents = others.tangents;
    const Item variants = mapping.at("variants");
    for (size_t k = 0; k < variants.size(); ++k) {
      const uint32_t variant = variants.at(k).index(materials.variants(), "variants");
      if (primitive.variants.size() <= variant) primitive.variants.resize(variant + 1, k_none);
      primitive.variants[variant] = id;
    }
  }
}

bool PrimitiveLoader::load(MaterialLoader& materials, Primitive& primitive) {
  if (source_.mode < TINYGLTF_MODE_TRIANGLES) {
    warn("{} primitives of points or lines are left out");
    return false;
  }
  if (attribute("POSITION") < 0) {
    warn("{} primitives without positions are left out");
    return false;
  }
  vertices_ = open("POSITION", 3, 3).count();
  deformer_.emplace(document_, source_, item_, pose_, vertices_);
  if (!read_triangles(vertices_)) return false;

  keep_used_vertices();
  // Positions, normals, two texture coordinates, colours and tangents, whichever there are.
  budget(used_.size() * (2 * sizeof(vec3) + 2 * sizeof(vec2) + 2 * sizeof(vec4)), "attributes", "{} vertices",
         used_.size());
  read_positions(primitive);
  if (const size_t dropped = drop_degenerate(primitive.positions)) {
    warn("{} degenerate triangles removed", dropped);
    if (triangles_.empty()) return false;
    for (uvec3& t : triangles_) t = uvec3(used_[t.x], used_[t.y], used_[t.z]);
    keep_used_vertices();
    read_positions(primitive);
  }
  turn_mirrored_triangles();
  primitive.material = materials.material(source_.material);
  MaterialNeeds needs = materials.needs(primitive.material);
  read_variants(materials, primitive, needs);
  // The first set is read even if no texture of the file uses it: a material may get textures.
  if (needs.sets[0] >= 0 || attribute("TEXCOORD_0") >= 0)
    primitive.uv0 = read_uvs(fmt::format("TEXCOORD_{}", std::max(needs.sets[0], 0)).c_str());
  if (needs.sets[1] >= 0) primitive.uv1 = read_uvs(fmt::format("TEXCOORD_{}", needs.sets[1]).c_str());
  read_colors(primitive);
  primitive.triangles = std::move(triangles_);
  read_normals(primitive);
  if (needs.tangents) {
    if (attribute("TANGENT") >= 0 && attribute("NORMAL") >= 0)
      read_tangents(primitive);
    else
      make_tangents(primitive, *needs.tangents);
  }
  return true;
}

}  // namespace

Mesh load_mesh(Document& document, uint32_t index, MaterialLoader& materials, const Pose& pose,
               glm::dvec3& origin) {
  const tinygltf::Mesh& source = document.model.meshes[index];
  const Item primitives = document.root().at("meshes").at(index).at("primitives");
  Mesh mesh;
  mesh.name = source.name.empty() ? fmt::format("mesh {}", index) : source.name;
  std::optional<glm::dvec3> chosen;
  for (size_t i = 0; i < source.primitives.size(); ++i) {
    PrimitiveLoader loader(document, source.primitives[i], primitives.at(i), pose, chosen);
    Primitive primitive;
    if (loader.load(materials, primitive)) mesh.primitives.push_back(std::move(primitive));
  }
  origin = chosen.value_or(glm::dvec3(0));
  return mesh;
}

}  // namespace lucerna::scene
