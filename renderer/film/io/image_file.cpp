#include "film/io/image_file.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>

#include "base/file.h"
#include "base/picture_window.h"
#include "base/radiance_hdr.h"

namespace lucerna::film {
namespace {

namespace fs = std::filesystem;

/// OpenImageIO ends some messages with a line break or joins several by one; an Error is one line.
std::string one_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == '.')) text.pop_back();
  std::replace(text.begin(), text.end(), '\n', ';');
  return text;
}

/// The file under its temporary name, as OpenImageIO writes it. Its own PNG writer does not notice a full
/// disk; OutputFile::commit does.
class FileProxy : public OIIO::Filesystem::IOProxy {
 public:
  FileProxy(OutputFile& output, const std::string& name) : IOProxy(name, Write), output_(output) {}
  const char* proxytype() const override { return "file"; }
  size_t write(const void* data, size_t size) override {
    const size_t written = pwrite(data, size, m_pos);
    m_pos += static_cast<int64_t>(written);
    return written;
  }
  size_t pwrite(const void* data, size_t size, int64_t offset) override {
    const size_t done = output_.write_at(data, size, offset);
    end_ = std::max(end_, offset + static_cast<int64_t>(done));
    return done;
  }
  size_t size() const override { return static_cast<size_t>(end_); }

 private:
  OutputFile& output_;
  int64_t end_ = 0;
};

void check_size(const std::string& where, int64_t width, int64_t height) {
  if (width <= 0 || height <= 0) throw_error(where, "the image is empty ({}x{})", width, height);
  if (width > k_max_image_size || height > k_max_image_size)
    throw_error(where, "the image has {}x{} pixels, at most {}x{} are handled", width, height,
                k_max_image_size, k_max_image_size);
}

/// `format` is OpenImageIO's name of the format, "openexr" or "png".
void write_with_oiio(const fs::path& file, const std::string& format, const OIIO::ImageSpec& spec,
                     OIIO::TypeDesc type, const void* pixels) {
  OutputFile target(file);
  // Formats are written back and forth; what can only be appended to has them whole.
  FileProxy in_file(target, file.string());
  OIIO::Filesystem::IOVecOutput in_memory;
  OIIO::Filesystem::IOProxy* proxy = &in_file;
  if (target.streams()) proxy = &in_memory;
  auto output = OIIO::ImageOutput::create(format);
  if (!output || !output->set_ioproxy(proxy))
    throw_error(file.string(), "cannot write {} here: {}", format, one_line(OIIO::geterror()));
  const bool written =
      output->open(file.string(), spec) && output->write_image(type, pixels) && output->close();
  if (target.streams() && written)
    target.write({reinterpret_cast<const char*>(in_memory.buffer().data()), in_memory.buffer().size()});
  // An error of the disk has more information than that of the format's writer.
  if (written || target.failed()) target.commit();
  if (!written) throw_error(file.string(), "cannot be written: {}", one_line(output->geterror()));
}

/// "primary.R" -> {"primary", "R"}; "R" -> {"", "R"}.
std::pair<std::string, std::string> split_name(const std::string& channel) {
  const size_t dot = channel.rfind('.');
  if (dot == std::string::npos) return {"", channel};
  return {channel.substr(0, dot), channel.substr(dot + 1)};
}

int rank_of_component(const std::string& name) {
  static const std::array<const char*, 9> k_order = {"R", "G", "B", "r", "g", "b", "X", "Y", "Z"};
  const auto found = std::find(k_order.begin(), k_order.end(), name);
  return static_cast<int>(found - k_order.begin());
}

bool is_sum(const std::string& name) { return name.empty() || name == "rgb" || name == "sum"; }

}  // namespace

const std::vector<float>* FilmImage::find(const std::string& name) const {
  for (const auto& [channel, values] : channels)
    if (channel == name) return &values;
  return nullptr;
}

std::vector<size_t> FilmImage::layer(const std::string& name) const {
  std::vector<size_t> found;
  for (size_t i = 0; i < channels.size(); ++i) {
    const auto [prefix, component] = split_name(channels[i].first);
    if (is_sum(name) ? prefix.empty() && rank_of_component(component) < 3 : prefix == name)
      found.push_back(i);
  }
  // One grey channel is the picture of a file that has no colour.
  if (found.empty() && is_sum(name))
    for (size_t i = 0; i < channels.size(); ++i)
      if (channels[i].first == "Y") found.push_back(i);
  if (found.empty())
    for (size_t i = 0; i < channels.size(); ++i)
      if (channels[i].first == name) found.push_back(i);
  std::stable_sort(found.begin(), found.end(), [&](size_t a, size_t b) {
    return rank_of_component(split_name(channels[a].first).second) <
           rank_of_component(split_name(channels[b].first).second);
  });
  return found;
}

std::vector<std::string> FilmImage::layers() const {
  std::vector<std::string> names;
  for (const auto& [channel, values] : channels) {
    const auto [prefix, component] = split_name(channel);
    std::string name = prefix.empty() ? component : prefix;
    if (prefix.empty() && rank_of_component(component) < 3) name = "rgb";
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

void write_exr(const fs::path& file, const FilmImage& image) {
  const std::string where = file.string();
  check_size(where, image.width, image.height);
  if (image.channels.empty()) throw_error(where, "the image has no channels");
  const size_t pixels = size_t{image.width} * image.height, count = image.channels.size();
  const FilmImage::Window window = image.window.value_or(FilmImage::Window{0, 0, image.width, image.height});
  if (window.left >= window.right || window.top >= window.bottom || window.right > image.width ||
      window.bottom > image.height)
    throw_error(where, "the stored part is empty or reaches out of the image");
  OIIO::ImageSpec spec(static_cast<int>(window.right - window.left),
                       static_cast<int>(window.bottom - window.top), static_cast<int>(count),
                       OIIO::TypeDesc::FLOAT);
  spec.x = static_cast<int>(window.left), spec.y = static_cast<int>(window.top);
  spec.full_width = static_cast<int>(image.width), spec.full_height = static_cast<int>(image.height);
  spec.channelnames.clear();
  std::set<std::string> names;
  for (const auto& [name, values] : image.channels) {
    if (values.size() != pixels)
      throw_error(where, "channel '{}' has {} values, expected {}", name, values.size(), pixels);
    if (name.empty() || !names.insert(name).second)
      throw_error(where, "channel name '{}' is empty or repeated", name);
    spec.channelnames.push_back(name);
  }
  if (!image.halves.empty())
    for (const auto& [name, values] : image.channels)
      spec.channelformats.push_back(image.halves.contains(name) ? OIIO::TypeDesc::HALF
                                                                : OIIO::TypeDesc::FLOAT);
  // OpenImageIO guesses alpha and depth by name; here they are what the name says and nothing is multiplied.
  spec.alpha_channel = spec.z_channel = -1;
  spec.attribute("compression", "zip");
  spec.attribute("oiio:ColorSpace", "Linear");
  for (const auto& [key, value] : image.metadata) spec.attribute("lucerna:" + key, value);

  std::vector<float> interleaved(spec.image_pixels() * count);
  for (size_t c = 0; c < count; ++c) {
    const std::vector<float>& values = image.channels[c].second;
    size_t to = c;
    for (uint32_t y = window.top; y < window.bottom; ++y)
      for (uint32_t x = window.left; x < window.right; ++x, to += count)
        interleaved[to] = values[size_t{y} * image.width + x];
  }
  write_with_oiio(file, "openexr", spec, OIIO::TypeDesc::FLOAT, interleaved.data());
}

namespace {

struct OpenImage {
  std::optional<RadianceHeader> radiance;
  std::vector<uint8_t> bytes;  // of a Radiance picture, without its header
  std::unique_ptr<OIIO::Filesystem::IOMemReader> memory;
  std::unique_ptr<OIIO::ImageInput> input;
};

bool is_radiance(const fs::path& file) {
  char magic[2] = {};
  std::ifstream stream(file, std::ios::binary);
  return stream.read(magic, 2) && magic[0] == '#' && magic[1] == '?';
}

OpenImage open_image(const fs::path& file) {
  const std::string where = file.string();
  std::error_code code;
  if (!fs::exists(file, code)) throw_error(where.empty() ? "image" : where, "there is no such file");
  if (fs::is_directory(file, code)) throw_error(where, "is a folder, expected an image");
  // A pipe cannot be read back and forth, and may never answer.
  if (!is_plain_file(file)) throw_error(where, "is a pipe or a device, expected an image");
  OpenImage image;
  if (is_radiance(file)) {
    std::ifstream stream(file, std::ios::binary);
    const std::vector<uint8_t> bytes{std::istreambuf_iterator<char>(stream), {}};
    image.radiance = read_radiance_header(bytes);
    if (image.radiance) image.bytes = without_radiance_header(bytes, *image.radiance);
  }
  if (image.radiance) {
    image.memory = std::make_unique<OIIO::Filesystem::IOMemReader>(image.bytes.data(), image.bytes.size());
    OIIO::ImageSpec config;
    OIIO::Filesystem::IOProxy* proxy = image.memory.get();
    config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    OIIO::ImageSpec spec;
    image.input = OIIO::ImageInput::create("hdr");
    if (image.input && !image.input->open("/dev/null/image", spec, config))
      throw_error(where, "cannot read this image: {}", one_line(image.input->geterror()));
  } else {
    image.input = OIIO::ImageInput::open(where);
  }
  if (!image.input) throw_error(where, "cannot read this image: {}", one_line(OIIO::geterror()));
  return image;
}

std::map<std::string, std::string> metadata_of(const OIIO::ImageSpec& spec) {
  std::map<std::string, std::string> metadata;
  const std::string prefix = "lucerna:";
  for (const auto& attribute : spec.extra_attribs) {
    if (attribute.type() != OIIO::TypeDesc::STRING) continue;
    const std::string name = attribute.name().string();
    metadata[name.starts_with(prefix) ? name.substr(prefix.size()) : name] = attribute.get_string();
  }
  return metadata;
}

}  // namespace

std::map<std::string, std::string> read_metadata(const fs::path& file) {
  return metadata_of(open_image(file).input->spec());
}

namespace {

/// Consecutive channels that are read: first, and behind the last.
std::vector<std::pair<int, int>> channel_runs(const OIIO::ImageSpec& spec, const ReadOptions& options) {
  std::vector<std::pair<int, int>> runs;
  for (int c = 0; c < spec.nchannels; ++c) {
    if (options.wants && !options.wants(spec.channel_name(c))) continue;
    if (runs.empty() || runs.back().second != c) runs.emplace_back(c, c);
    ++runs.back().second;
  }
  return runs;
}

/// Reads the channels of one run, interleaved. Throws Error located at `where`, also if it is stopped.
std::vector<float> read_run(OIIO::ImageInput& input, const std::string& where, size_t pixels,
                            const std::pair<int, int>& run, const ReadOptions& options) {
  struct Progress {
    const ReadOptions& options;
    double before, share;
    bool stopped = false;
  };
  const double all = input.spec().nchannels;
  Progress progress{options, run.first / all, (run.second - run.first) / all};
  const auto stop = [](void* data, float done) {
    auto& p = *static_cast<Progress*>(data);
    return p.stopped = p.stopped || (p.options.stop && p.options.stop(p.before + p.share * double(done)));
  };
  std::vector<float> interleaved(pixels * size_t(run.second - run.first));
  const bool read = input.read_image(0, 0, run.first, run.second, OIIO::TypeDesc::FLOAT, interleaved.data(),
                                     OIIO::AutoStride, OIIO::AutoStride, OIIO::AutoStride, stop, &progress);
  if (progress.stopped) throw_error(where, "reading was stopped");
  if (!read) throw_error(where, "cannot read this image: {}", one_line(input.geterror()));
  return interleaved;
}

}  // namespace

FilmImage read_exr(const fs::path& file, const ReadOptions& options) {
  const std::string where = file.string();
  const OpenImage opened = open_image(file);
  const auto& input = opened.input;
  const OIIO::ImageSpec& spec = input->spec();
  check_size(where, spec.width, spec.height);
  const PictureWindow window = window_of(spec, std::string_view(input->format_name()) == "openexr");
  check_size(where, window.full_width, window.full_height);
  if (spec.depth > 1 || spec.deep)
    throw_error(where, "expected a flat image, found a deep or volumetric one");

  FilmImage image;
  image.width = opened.radiance ? opened.radiance->width() : window.full_width;
  image.height = opened.radiance ? opened.radiance->height() : window.full_height;
  const size_t pixels = size_t{image.width} * image.height;
  for (const std::pair<int, int>& run : channel_runs(spec, options)) {
    const auto count = size_t(run.second - run.first);
    std::vector<float> interleaved =
        read_run(*input, where, size_t{window.width} * window.height, run, options);
    if (opened.radiance) interleaved = upright_radiance(interleaved, count, *opened.radiance);
    if (!window.whole()) interleaved = fit_to_picture(interleaved, count, window);
    for (size_t c = 0; c < count; ++c) {
      std::vector<float> values(pixels);
      for (size_t p = 0; p < pixels; ++p) values[p] = interleaved[p * count + c];
      image.channels.emplace_back(spec.channel_name(run.first + int(c)), std::move(values));
    }
  }
  image.encoded = !spec.format.is_floating_point();
  image.metadata = metadata_of(spec);
  return image;
}

void write_png(const fs::path& file, uint32_t width, uint32_t height, std::span<const uint8_t> rgba,
               const std::map<std::string, std::string>& metadata) {
  const std::string where = file.string();
  check_size(where, width, height);
  const size_t expected = size_t{width} * height * 4;
  if (rgba.size() != expected) throw_error(where, "{} bytes of pixels, expected {}", rgba.size(), expected);
  OIIO::ImageSpec spec(static_cast<int>(width), static_cast<int>(height), 4, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("oiio:UnassociatedAlpha", 1);
  for (const auto& [key, value] : metadata) spec.attribute("lucerna:" + key, value);
  write_with_oiio(file, "png", spec, OIIO::TypeDesc::UINT8, rgba.data());
}

void check_writable(const fs::path& file) {
  lucerna::check_writable(file);
  const std::string ending = file.extension().string();
  if (ending != ".exr" && ending != ".png")
    throw_error(file.string(), "expected a name that ends in .exr or .png, found '{}'", ending);
}

}  // namespace lucerna::film
