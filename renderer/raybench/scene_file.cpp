#include "raybench/scene_file.h"

#include <cstring>
#include <fstream>
#include <sstream>
#include <type_traits>

#include "base/error.h"
#include "base/file.h"

namespace lucerna::raybench {
namespace {

// A file is only read by the version that wrote it: change the number if a structure below changes.
constexpr char k_magic[16] = "lucerna flat 6\n";

/// One description of the format serves both directions.
class Writer {
 public:
  explicit Writer(std::ostream& out) : out_(out) {}
  template <class T>
  void plain(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    out_.write(reinterpret_cast<const char*>(&value), sizeof(T));
  }
  template <class T>
  void list(const std::vector<T>& values) {
    plain(uint64_t(values.size()));
    if constexpr (std::is_trivially_copyable_v<T>)
      out_.write(reinterpret_cast<const char*>(values.data()), std::streamsize(values.size() * sizeof(T)));
    else
      for (const T& value : values) each(*this, value);
  }
  template <class T>
  void list(const SharedVector<T>& values) {
    list(static_cast<const std::vector<T>&>(values));
  }

 private:
  std::ostream& out_;
};

class Reader {
 public:
  Reader(std::istream& in, std::string where) : in_(in), where_(std::move(where)) {}
  template <class T>
  void plain(T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    in_.read(reinterpret_cast<char*>(&value), sizeof(T));
    if (!in_) throw Error(where_, "the flattened scene is cut short");
  }
  template <class T>
  void list(std::vector<T>& values) {
    uint64_t count = 0;
    plain(count);
    if constexpr (std::is_trivially_copyable_v<T>) {
      // Grown by blocks, so that a wrong count in a short file does not allocate gigabytes first.
      for (uint64_t done = 0; done < count;) {
        const uint64_t block = std::min<uint64_t>(count - done, 1 << 20);
        values.resize(done + block);
        in_.read(reinterpret_cast<char*>(&values[done]), std::streamsize(block * sizeof(T)));
        if (!in_) throw Error(where_, "the flattened scene is cut short");
        done += block;
      }
    } else {
      for (uint64_t i = 0; i < count; ++i) each(*this, values.emplace_back());
    }
  }
  template <class T>
  void list(SharedVector<T>& values) {
    std::vector<T> own;
    list(own);
    values = std::move(own);
  }

 private:
  std::istream& in_;
  std::string where_;
};

template <class Archive, class T>
void each(Archive& a, std::vector<T>& values) {
  a.list(values);
}
template <class Archive, class T>
void each(Archive& a, const std::vector<T>& values) {
  a.list(values);
}

template <class Archive, class Bucket>
requires std::is_same_v<std::remove_const_t<Bucket>, upload::Bucket>
void each(Archive& a, Bucket& b) {
  a.plain(b.width), a.plain(b.height), a.plain(b.floats), a.plain(b.srgb);
  a.list(b.layers);
}

template <class Archive, class Scene>
void scene_fields(Archive& a, Scene& s) {
  a.list(s.positions), a.list(s.non_opaque), a.list(s.triangles);
  a.list(s.vertices), a.list(s.tangents), a.list(s.extra), a.list(s.materials);
  a.list(s.buckets);
  a.list(s.entries), a.list(s.light_alias), a.list(s.primitive_light_pmf);
  a.list(s.environment.alias), a.list(s.environment.density);
  a.list(s.lights), a.list(s.environment_texels), a.list(s.bsdf_tables);
  a.plain(s.environment_width), a.plain(s.environment_height), a.plain(s.environment_radiance);
  a.plain(s.environment_rotation), a.plain(s.environment_light_pmf), a.plain(s.scene_radius);
  a.plain(s.effects);
}

template <class Archive, class Camera>
void camera_fields(Archive& a, Camera& c) {
  a.plain(c.to_world), a.plain(c.orthographic), a.plain(c.yfov), a.plain(c.xmag), a.plain(c.ymag),
      a.plain(c.aspect);
}

}  // namespace

void write(const std::filesystem::path& file, const FlatFile& flat) {
  std::ostringstream out(std::ios::binary);
  out.write(k_magic, sizeof k_magic);
  Writer w(out);
  w.list(std::vector<char>(flat.name.begin(), flat.name.end()));
  scene_fields(w, flat.scene);
  camera_fields(w, flat.camera);
  bvh::write(out, flat.tree);
  write_file(file, std::move(out).str());
}

FlatFile read(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw_error(file.string(), "cannot be read");
  char magic[sizeof k_magic] = {};
  in.read(magic, sizeof magic);
  if (!in || std::memcmp(magic, k_magic, sizeof magic) != 0)
    throw_error(file.string(),
                "not a flattened scene of this version; make it with 'lucerna bench rays SCENE --flat FILE'");
  FlatFile flat;
  Reader r(in, file.string());
  std::vector<char> name;
  r.list(name);
  flat.name.assign(name.begin(), name.end());
  scene_fields(r, flat.scene);
  flat.scene.effects.portals = 0;  // their tables are not in the file
  camera_fields(r, flat.camera);
  flat.tree = bvh::read(in, file.string());
  return flat;
}

}  // namespace lucerna::raybench
