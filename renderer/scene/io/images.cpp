#include "scene/io/images.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/color.h"
#include "base/error.h"
#include "base/picture_window.h"
#include "base/primaries.h"
#include "base/radiance_hdr.h"

namespace lucerna::scene {
namespace {

constexpr uint64_t k_max_texels = uint64_t{1} << 28;

bool begins(const std::vector<uint8_t>& bytes, std::initializer_list<int> magic) {
  return bytes.size() >= magic.size() &&
         std::equal(magic.begin(), magic.end(), bytes.begin(), [](int a, uint8_t b) { return a == b; });
}

// OpenImageIO's name of the format, or an ending.
std::string format_name(const std::vector<uint8_t>& bytes, const std::string& hint) {
  if (begins(bytes, {0x89, 'P', 'N', 'G'})) return "png";
  if (begins(bytes, {0xff, 0xd8, 0xff})) return "jpg";
  if (begins(bytes, {0x76, 0x2f, 0x31, 0x01})) return "exr";
  if (begins(bytes, {'#', '?'})) return "hdr";
  if (bytes.size() > 12 && std::memcmp(bytes.data(), "RIFF", 4) == 0 &&
      std::memcmp(bytes.data() + 8, "WEBP", 4) == 0)
    return "webp";
  const size_t dot = hint.find_last_of("./");
  std::string name = dot == std::string::npos ? "png" : hint.substr(dot + 1);
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return name;
}

// OpenImageIO keeps its messages per thread until they are fetched.
std::string reader_error(const std::string& message) {
  std::string text = message.empty() ? OIIO::geterror() : message;
  OIIO::geterror();
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
  return text.empty() ? "the file is damaged" : text;
}

void change_primaries(std::vector<float>& pixels, int channels, const glm::dmat3& matrix) {
  for (size_t i = 0; i + 2 < pixels.size(); i += static_cast<size_t>(channels)) {
    const glm::dvec3 color = matrix * glm::dvec3(pixels[i], pixels[i + 1], pixels[i + 2]);
    for (int k = 0; k < 3; ++k) pixels[i + static_cast<size_t>(k)] = static_cast<float>(color[k]);
  }
}

// n channels to RGBA; one and two channels are grey and grey with alpha.
template <class T>
std::vector<T> to_rgba(const std::vector<T>& from, size_t texels, size_t channels, T one) {
  std::vector<T> result(4 * texels);
  for (size_t i = 0; i < texels; ++i) {
    const T* in = from.data() + i * channels;
    T* out = result.data() + 4 * i;
    const bool grey = channels < 3;
    out[0] = in[0];
    out[1] = grey ? in[0] : in[1];
    out[2] = grey ? in[0] : in[2];
    out[3] = channels == 2 ? in[1] : channels >= 4 ? in[3] : one;
  }
  return result;
}

}  // namespace

Image decode_image(const std::vector<uint8_t>& bytes, const std::string& hint, const std::string& where,
                   Precision precision, Budget& budget) {
  if (bytes.empty()) throw Error(where, "the image has no bytes");
  const auto radiance = read_radiance_header(bytes);
  std::vector<uint8_t> plain;
  if (radiance) {
    budget.take(bytes.size(), where, "a file of {} bytes", bytes.size());
    plain = without_radiance_header(bytes, *radiance);
  }
  const std::vector<uint8_t>& file = radiance ? plain : bytes;
  OIIO::Filesystem::IOMemReader memory(file.data(), file.size());
  OIIO::ImageSpec config;
  config["oiio:UnassociatedAlpha"] = 1;
  // Readers take the memory from the configuration: with a proxy alone, open() with a configuration looks for
  // a file.
  OIIO::Filesystem::IOProxy* proxy = &memory;
  config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
  std::unique_ptr<OIIO::ImageInput> input;
  try {
    // Opens by one format only, because by a name every reader would try the file of that name. Some open a
    // file even with memory given; their formats are refused, and the name is one that no file can have. The
    // reader "null" makes images from names.
    const std::string format = format_name(bytes, hint);
    const bool word =
        std::all_of(format.begin(), format.end(), [](unsigned char c) { return std::isalnum(c) != 0; });
    if (word) input = OIIO::ImageInput::create(format);
    if (!input) throw_error(where, "'{}' is no image format that is known: {}", format, reader_error({}));
    const std::string known = input->format_name();
    if (!input->supports("ioproxy") || known == "null")
      throw_error(where,
                  "images in the format '{}' cannot be read here; save it as PNG, JPEG, EXR or HDR instead",
                  known);
    OIIO::ImageSpec spec;
    if (!input->open("/dev/null/image", spec, config)) {
      const std::string message = input->geterror();
      throw Error(where, "the image cannot be decoded: " + reader_error(message));
    }
    if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0)
      throw_error(where, "the image has no texels ({} x {})", spec.width, spec.height);
    const uint64_t texels = static_cast<uint64_t>(spec.width) * static_cast<uint64_t>(spec.height);
    const PictureWindow window = window_of(spec, format == "exr");
    const uint64_t shown = uint64_t{window.full_width} * window.full_height;
    if (std::max(texels, shown) > k_max_texels || spec.depth > 1 || spec.deep)
      throw_error(where, "an image of {} x {} x {} is beyond what can be read", window.full_width,
                  window.full_height, spec.depth);
    // A fourth channel of an EXR may be a depth.
    const bool no_alpha = format == "exr" && spec.nchannels > 3 && spec.alpha_channel != 3;
    const int channels = no_alpha ? 3 : std::min(spec.nchannels, 4);
    // A header may promise far more than the file holds; the densest compressions reach about 1 : 1000.
    if (texels * static_cast<uint64_t>(channels) / 4096 > bytes.size())
      throw_error(where, "{} bytes cannot hold {} x {} texels", bytes.size(), spec.width, spec.height);

    const bool is_float = spec.format.is_floating_point();
    const bool wide = is_float || spec.format.basesize() > 1;
    const bool floats =
        is_float || precision == Precision::linear_floats || (wide && precision == Precision::keep);
    Image image;
    image.width = radiance ? radiance->width() : window.full_width;
    image.height = radiance ? radiance->height() : window.full_height;
    budget.take(std::max(texels, shown) * 4 * (floats ? sizeof(float) : 1), where, "an image of {} x {}",
                image.width, image.height);
    const auto read = [&](auto& buffer, OIIO::TypeDesc type) {
      buffer.resize(texels * static_cast<uint64_t>(channels));
      if (!input->read_image(0, 0, 0, channels, type, buffer.data())) {
        const std::string message = input->geterror();
        throw Error(where, "the image cannot be decoded: " + reader_error(message));
      }
      if (!window.whole()) buffer = fit_to_picture(buffer, static_cast<size_t>(channels), window);
    };
    if (floats) {
      std::vector<float> raw;
      read(raw, OIIO::TypeDesc::FLOAT);
      if (radiance) raw = upright_radiance(raw, static_cast<size_t>(channels), *radiance);
      Chromaticities primaries{};
      if (precision != Precision::keep && channels >= 3 &&
          spec.getattribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), primaries.data()))
        if (const auto to_rec709 = rec709_from(primaries)) change_primaries(raw, channels, *to_rec709);
      image.floats = to_rgba(raw, shown, static_cast<size_t>(channels), 1.0f);
      if (precision == Precision::linear_floats && !is_float)
        for (size_t i = 0; i < image.floats.size(); ++i)
          if (i % 4 != 3) image.floats[i] = linear_from_srgb(image.floats[i]);
    } else {
      std::vector<uint8_t> raw;
      read(raw, OIIO::TypeDesc::UINT8);
      image.bytes =
          channels == 4 ? std::move(raw) : to_rgba(raw, shown, static_cast<size_t>(channels), uint8_t{255});
    }
    return image;
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw Error(where, "the image cannot be decoded: " + reader_error(error.what()));
  }
}

std::string mime_type(std::string_view bytes) {
  if (bytes.starts_with("\x89PNG\r\n\x1a\n")) return "image/png";
  if (bytes.starts_with("\xFF\xD8\xFF")) return "image/jpeg";
  return "";
}

void check_environment_shape(const Image& image, const std::string& where) {
  const double ratio = static_cast<double>(image.width) / image.height;
  if (std::abs(ratio / 2 - 1) > 0.02 && (image.width != 1 || image.height != 1))
    throw_error(where, "{} x {} pixels: a latitude-longitude image is twice as wide as high", image.width,
                image.height);
}

size_t mend_texels(Image& image) {
  size_t count = 0;
  for (float& value : image.floats) {
    if (std::isfinite(value) && value >= 0) continue;
    value = value > 0 ? 65504.0f : 0.0f;
    ++count;
  }
  return count;
}

}  // namespace lucerna::scene
