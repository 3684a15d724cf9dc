// Images through OpenImageIO, from files and from memory.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <cmath>

#include "scene/io/document.h"

namespace lucerna::scene::io {
namespace {

/// Any channel count to RGBA: grey is spread, a missing alpha is 1.
template <class T>
std::vector<T> to_rgba(const std::vector<T>& in, int channels, size_t pixels, T one) {
  std::vector<T> out(pixels * 4);
  for (size_t i = 0; i < pixels; ++i) {
    const T* p = &in[i * channels];
    T* o = &out[i * 4];
    if (channels < 3) o[0] = o[1] = o[2] = p[0];
    else o[0] = p[0], o[1] = p[1], o[2] = p[2];
    o[3] = channels == 2 ? p[1] : channels >= 4 ? p[3] : one;
  }
  return out;
}

/// Decodes; returns false with a reason. 8-bit files stay bytes, all others become floats.
bool decode(OIIO::ImageInput& in, Image& image, bool floats, std::string& why) {
  const OIIO::ImageSpec spec = in.spec();
  if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0) return why = "it has no pixels", false;
  if (spec.width > 32768 || spec.height > 32768) return why = fmt::format("{}x{} is larger than 32768x32768", spec.width, spec.height), false;
  image.width = uint32_t(spec.width);
  image.height = uint32_t(spec.height);
  const size_t pixels = size_t(spec.width) * spec.height;
  if (spec.format == OIIO::TypeDesc::UINT8 && !floats) {
    std::vector<uint8_t> raw(pixels * spec.nchannels);
    if (!in.read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT8, raw.data())) return why = in.geterror(), false;
    image.bytes = to_rgba<uint8_t>(raw, spec.nchannels, pixels, 255);
  } else if (!floats && spec.format == OIIO::TypeDesc::UINT16) {
    // 16-bit files keep their encoding (which may be sRGB); bytes are precise enough for reflectances.
    std::vector<uint8_t> raw(pixels * spec.nchannels);
    if (!in.read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT8, raw.data())) return why = in.geterror(), false;
    image.bytes = to_rgba<uint8_t>(raw, spec.nchannels, pixels, 255);
  } else {
    std::vector<float> raw(pixels * spec.nchannels);
    if (!in.read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, raw.data())) return why = in.geterror(), false;
    for (float& f : raw)
      if (!std::isfinite(f)) f = 0;
    image.floats = to_rgba<float>(raw, spec.nchannels, pixels, 1.f);
  }
  return true;
}

OIIO::ImageSpec straight_alpha() {
  OIIO::ImageSpec config;
  config["oiio:UnassociatedAlpha"] = 1;
  return config;
}

bool decode_memory(const std::vector<unsigned char>& bytes, Image& image, std::string& why) {
  if (bytes.size() < 12) return why = "it is empty", false;
  const char* name = bytes[0] == 0x89 ? "a.png" : bytes[0] == 0xff ? "a.jpg" : bytes[0] == 0x76 ? "a.exr" : bytes[0] == '#' ? "a.hdr" : "a.png";
  if (bytes[0] == 'R' && bytes[1] == 'I') name = "a.webp";
  OIIO::Filesystem::IOMemReader memory(const_cast<unsigned char*>(bytes.data()), bytes.size());
  const OIIO::ImageSpec config = straight_alpha();
  auto in = OIIO::ImageInput::open(name, &config, &memory);
  if (!in) return why = OIIO::geterror(), false;
  return decode(*in, image, false, why);
}

}  // namespace

Image read_float_image(const std::filesystem::path& file) {
  Image image;
  image.name = file.filename().string();
  std::string why;
  auto in = OIIO::ImageInput::open(file.string());
  if (!in) throw Error(file.string(), "cannot be read as an image: " + OIIO::geterror());
  if (!decode(*in, image, true, why)) throw Error(file.string(), "cannot be read as an image: " + why);
  return image;
}

void load_images(Document& d, Scene& scene, const LoadOptions& options, const LoadProgress& progress) {
  for (size_t i = 0; i < d.model.images.size(); ++i) {
    const tinygltf::Image& in = d.model.images[i];
    Image image;
    image.name = !in.uri.empty() && in.uri.rfind("data:", 0) != 0 ? in.uri : fmt::format("images[{}]", i);
    std::string why = "not found";
    bool read = false;
    if (options.images) {
      try {
        read = decode_memory(in.image, image, why);
      } catch (const std::exception& e) { why = e.what(); }
    }
    if (!read) {
      if (options.images) {
        while (!why.empty() && why.back() == '\n') why.pop_back();
        d.count(fmt::format("{{}} texture image cannot be read and is white: {} ({})", image.name, why));
      }
      image.width = image.height = 1;
      image.floats.clear();
      image.bytes = {255, 255, 255, 255};
    }
    scene.images.push_back(std::move(image));
    if (progress && !progress(0.5f + 0.5f * float(i + 1) / float(d.model.images.size()), "textures")) throw Error("", "cancelled");
  }
  // What textures without an image point at.
  Image white;
  white.name = "white";
  white.width = white.height = 1;
  white.bytes = {255, 255, 255, 255};
  scene.images.push_back(std::move(white));
  // An unreadable normal map is flat, not white.
  for (Material& m : scene.materials)
    if (m.normal_texture) {
      const Image& image = scene.images[scene.textures[m.normal_texture.texture].image];
      if (image.width == 1 && image.height == 1 && image.bytes == std::vector<uint8_t>{255, 255, 255, 255}) m.normal_texture = {};
    }
}

}  // namespace lucerna::scene::io
