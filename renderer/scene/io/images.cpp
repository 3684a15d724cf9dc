#include "scene/io/images.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/color.h"
#include "base/error.h"

namespace lucerna::scene {
namespace {

constexpr uint64_t k_max_texels = uint64_t{1} << 28;

bool begins(const std::vector<uint8_t>& bytes, std::initializer_list<int> magic) {
  return bytes.size() >= magic.size() &&
         std::equal(magic.begin(), magic.end(), bytes.begin(), [](int a, uint8_t b) { return a == b; });
}

// By what OpenImageIO knows the format: its name or an ending.
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
  OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
  OIIO::ImageSpec config;
  config["oiio:UnassociatedAlpha"] = 1;
  // Readers take the memory from the configuration: with a proxy alone, open() with a configuration looks for
  // a file.
  OIIO::Filesystem::IOProxy* proxy = &memory;
  config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
  std::unique_ptr<OIIO::ImageInput> input;
  try {
    // Of one format alone: to open by a name is to have every reader try the file of that name. Some open
    // one even when they are given memory; the formats of those are refused, and the name is one that no file
    // can have. The reader of nothing makes images from names.
    const std::string format = format_name(bytes, hint);
    const bool plain =
        std::all_of(format.begin(), format.end(), [](unsigned char c) { return std::isalnum(c) != 0; });
    if (plain) input = OIIO::ImageInput::create(format);
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
    if (texels > k_max_texels || spec.depth > 1 || spec.deep)
      throw_error(where, "an image of {} x {} x {} is beyond what can be read", spec.width, spec.height,
                  spec.depth);
    const int channels = std::min(spec.nchannels, 4);
    // A header may promise far more than the file holds; the densest compressions reach about 1 : 1000.
    if (texels * static_cast<uint64_t>(channels) / 4096 > bytes.size())
      throw_error(where, "{} bytes cannot hold {} x {} texels", bytes.size(), spec.width, spec.height);

    const bool is_float = spec.format.is_floating_point();
    const bool wide = is_float || spec.format.basesize() > 1;
    const bool floats =
        is_float || precision == Precision::linear_floats || (wide && precision == Precision::keep);
    Image image;
    image.width = static_cast<uint32_t>(spec.width);
    image.height = static_cast<uint32_t>(spec.height);
    budget.take(texels * 4 * (floats ? sizeof(float) : 1), where, "an image of {} x {}", spec.width,
                spec.height);
    const auto read = [&](auto& buffer, OIIO::TypeDesc type) {
      buffer.resize(texels * static_cast<uint64_t>(channels));
      if (input->read_image(0, 0, 0, channels, type, buffer.data())) return;
      const std::string message = input->geterror();
      throw Error(where, "the image cannot be decoded: " + reader_error(message));
    };
    if (floats) {
      std::vector<float> raw;
      read(raw, OIIO::TypeDesc::FLOAT);
      image.floats = to_rgba(raw, texels, static_cast<size_t>(channels), 1.0f);
      if (precision == Precision::linear_floats && !is_float)
        for (size_t i = 0; i < image.floats.size(); ++i)
          if (i % 4 != 3) image.floats[i] = linear_from_srgb(image.floats[i]);
    } else {
      std::vector<uint8_t> raw;
      read(raw, OIIO::TypeDesc::UINT8);
      image.bytes =
          channels == 4 ? std::move(raw) : to_rgba(raw, texels, static_cast<size_t>(channels), uint8_t{255});
    }
    return image;
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw Error(where, "the image cannot be decoded: " + reader_error(error.what()));
  }
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
