#include "film/io/ocio.h"

#include <OpenImageIO/color.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <mutex>
#include <string_view>

#include "base/color.h"
#include "base/error.h"
#include "base/file.h"
#include "shaders/shared/display_lut.h"

namespace lucerna::film {
namespace {

/// Names of linear Rec.709 in configurations in use: OCIO's own of 2021 and later, ACES 1.x, Blender, others.
constexpr std::array k_rec709_names = {
    "Linear Rec.709 (sRGB)",    "lin_rec709",     "lin_rec709_scene",
    "lin_rec709_srgb",          "lin_srgb",       "Utility - Linear - Rec.709",
    "Utility - Linear - sRGB",  "Linear Rec.709", "Linear sRGB",
    "scene-linear Rec.709-sRGB"};

std::string first_line(std::string text) {
  text = text.substr(0, text.find('\n'));
  while (!text.empty() && (text.back() == '.' || text.back() == ' ')) text.pop_back();
  return text.empty() ? "unknown error" : text;
}

}  // namespace

struct OcioConfig::Impl {
  explicit Impl(const std::string& file) : config(file) {}
  OIIO::ColorConfig config;
};

OcioConfig::OcioConfig(const std::filesystem::path& file) : file_(file.string()) {
  if (!OIIO::ColorConfig::supportsOpenColorIO())
    throw Error(file_, "OpenImageIO was built without OpenColorIO; the picture is shown by its tone curve");
  std::error_code code;
  if (!std::filesystem::exists(file, code)) throw Error(file_, "there is no such file");
  if (!is_plain_file(file)) throw Error(file_, "is no file, expected an OpenColorIO configuration");
  impl_ = std::make_unique<Impl>(file_);
  OIIO::ColorConfig& config = impl_->config;
  if (config.has_error())
    throw_error(file_, "cannot be read as an OpenColorIO configuration: {}", first_line(config.geterror()));
  const auto default_first = [](std::vector<std::string>& names, const char* first) {
    const auto at = std::find(names.begin(), names.end(), first ? first : "");
    if (at != names.end()) std::rotate(names.begin(), at, at + 1);
  };
  std::vector<std::string> names = config.getDisplayNames();
  default_first(names, config.getDefaultDisplayName());
  for (const std::string& name : names) {
    std::vector<std::string> views = config.getViewNames(name);
    default_first(views, config.getDefaultViewName(name));
    if (!views.empty()) displays_.push_back({name, std::move(views)});
  }
  if (displays_.empty()) throw Error(file_, "the configuration has no display with a view");
  const std::vector<std::string> spaces = config.getColorSpaceNames();
  const auto has = [&](const std::string& name) {
    return std::find(spaces.begin(), spaces.end(), name) != spaces.end();
  };
  const auto named = std::find_if(k_rec709_names.begin(), k_rec709_names.end(), has);
  rec709_ = named != k_rec709_names.end();
  if (rec709_)
    source_ = *named;
  else if (const char* role = config.getColorSpaceNameByRole("scene_linear"))
    source_ = role;
  if (source_.empty())
    throw Error(file_, "the configuration names neither linear Rec.709 nor the role scene_linear");
}

OcioConfig::~OcioConfig() = default;

void OcioConfig::show(const std::string& display, const std::string& view, std::span<vec3> colors) const {
  const auto found = std::find_if(displays_.begin(), displays_.end(),
                                  [&](const OcioDisplay& d) { return d.name == display; });
  if (found == displays_.end()) {
    std::vector<std::string> names;
    for (const OcioDisplay& d : displays_) names.push_back(d.name);
    throw_error(file_, "there is no display '{}'; there are: {}", display, fmt::join(names, ", "));
  }
  const std::string& chosen = view.empty() ? found->views.front() : view;
  if (std::find(found->views.begin(), found->views.end(), chosen) == found->views.end())
    throw_error(file_, "the display '{}' has no view '{}'; it has: {}", display, chosen,
                fmt::join(found->views, ", "));
  if (colors.empty()) return;
  const OIIO::ColorProcessorHandle processor =
      impl_->config.createDisplayTransform(display, chosen, source_, "", "", "");
  if (!processor)
    throw_error(file_, "the view '{}' of '{}' cannot be used: {}", chosen, display,
                first_line(impl_->config.geterror()));
  static_assert(sizeof(vec3) == 3 * sizeof(float));
  OIIO::ImageSpec spec(static_cast<int>(colors.size()), 1, 3, OIIO::TypeDesc::FLOAT);
  OIIO::ImageBuf pixels(spec, colors.data());
  if (!OIIO::ImageBufAlgo::colorconvert(pixels, pixels, processor.get(), false))
    throw_error(file_, "the view '{}' of '{}' cannot be used: {}", chosen, display,
                first_line(pixels.geterror()));
}

std::pair<std::string, std::string> OcioConfig::split(const std::string& text) const {
  constexpr std::string_view k_between = ": ";
  size_t at = text.find(k_between);
  for (const OcioDisplay& display : displays_) {
    if (text == display.name) return {text, ""};
    if (text.starts_with(display.name + std::string(k_between))) at = display.name.size();
  }
  if (at == std::string::npos) return {text, ""};
  return {text.substr(0, at), text.substr(at + k_between.size())};
}

std::vector<vec4> OcioConfig::table(const std::string& display, const std::string& view) const {
  constexpr uint32_t k_size = shared::k_display_lut_size;
  std::vector<vec3> colors;
  colors.reserve(size_t{k_size} * k_size * k_size);
  for (uint32_t b = 0; b < k_size; ++b)
    for (uint32_t g = 0; g < k_size; ++g)
      for (uint32_t r = 0; r < k_size; ++r)
        colors.emplace_back(shared::display_lut_radiance(r), shared::display_lut_radiance(g),
                            shared::display_lut_radiance(b));
  show(display, view, colors);
  std::vector<vec4> nodes;
  nodes.reserve(colors.size());
  // What is not a number becomes black.
  const auto shown = [](float x) { return x > 0 ? std::min(x, 1.0f) : 0.0f; };
  for (const vec3& c : colors) nodes.emplace_back(shown(c.x), shown(c.y), shown(c.z), 1);
  return nodes;
}

float OcioConfig::white(const std::string& display, const std::string& view) const {
  constexpr int k_steps = 8, k_darkest = -8, k_brightest = 12;  // a stop; stops
  constexpr float k_seen = 0.1f;
  std::vector<vec3> greys;
  for (int i = k_darkest * k_steps; i <= k_brightest * k_steps; ++i)
    greys.emplace_back(std::exp2(float(i) / k_steps));
  std::vector<vec3> colors = greys;
  show(display, view, colors);
  const auto shown = [&](size_t i) {
    const vec3& c = colors[i];
    vec3 linear;
    for (int k = 0; k < 3; ++k) linear[k] = linear_from_srgb(c[k] > 0 ? std::min(c[k], 1.0f) : 0.0f);
    return luminance(linear);
  };
  for (size_t i = greys.size() - 1; i > 0; --i) {
    const float low = shown(i - 1), high = shown(i);
    const float change = std::log2(std::max(high, 1e-6f) / std::max(low, 1e-6f)) * k_steps;
    if (change >= k_seen) return greys[i].x;
  }
  return 1;
}

std::shared_ptr<const OcioConfig> ocio_config() {
  static std::mutex mutex;
  static std::shared_ptr<const OcioConfig> config;
  const char* file = std::getenv("OCIO");
  if (!file || !*file) return nullptr;
  const std::lock_guard lock(mutex);
  if (!config || config->file() != file) {
    config.reset();
    try {
      config = std::make_shared<const OcioConfig>(file);
    } catch (const Error& e) {
      throw Error("OCIO", e.what());
    }
  }
  return config;
}

std::string ocio_text(const std::string& display, const std::string& view) {
  return view.empty() ? display : display + ": " + view;
}

}  // namespace lucerna::film
