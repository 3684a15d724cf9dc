#include "scene/light_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "base/error.h"
#include "base/hash.h"
#include "base/text.h"

namespace lucerna::scene {
namespace {

bool shines(const Environment& e) { return e.scale > 0 && (e.image != k_none || luminance(e.radiance) > 0); }

/// Collects the groups in the order in which they come.
class Grouping {
 public:
  Grouping(const Scene& scene, const std::vector<LightGroupRule>& rules,
           std::optional<bool> sun = std::nullopt)
      : scene_(scene), rules_(rules), sun_known_(sun) {}

  LightGroups make() {
    group_environment();
    for (const Light& lamp : scene_.lights) {
      const std::string given = group_name(lamp.group);
      out_.lamps.push_back(place(by_rule({lamp.name}), given, lamp.name, "lamp"));
      ++group(out_.lamps.back()).lamps;
    }
    group_surfaces();
    if (out_.groups.empty()) out_.groups.push_back({.name = "light"});
    if (!joined_.empty())
      out_.messages.push_back(
          fmt::format("{} light groups, but at most {} can be separate: {} joined in '{}'",
                      k_most_light_groups - 1 + joined_.size(), k_most_light_groups, fmt::join(joined_, ", "),
                      k_other_lights));
    return std::move(out_);
  }

 private:
  LightGroup& group(uint8_t index) { return out_.groups[index]; }

  std::optional<std::string> by_rule(std::initializer_list<std::string> names) const {
    for (auto rule = rules_.rbegin(); rule != rules_.rend(); ++rule)
      for (const std::string& name : names)
        if (matches_pattern(rule->pattern, name)) return rule->group;
    return std::nullopt;
  }

  uint8_t place(const std::optional<std::string>& ruled, const std::string& given, const std::string& name,
                const char* nameless) {
    if (ruled) return index_of(*ruled);
    if (!given.empty()) return index_of(given);
    const std::string kind = kind_of_light(name);
    return index_of(kind.empty() ? nameless : kind);
  }

  uint8_t index_of(const std::string& name) {
    const auto [at, fresh] = known_.try_emplace(name, uint8_t(0));
    if (!fresh) return at->second;
    if (out_.groups.size() < k_most_light_groups) {
      out_.groups.push_back({.name = name});
      at->second = uint8_t(out_.groups.size() - 1);
      return at->second;
    }
    // The last place is that of all that come now, and of the one that had it.
    LightGroup& last = out_.groups.back();
    if (joined_.empty()) {
      joined_.push_back("'" + last.name + "'");
      last.name = k_other_lights;
    }
    joined_.push_back("'" + name + "'");
    at->second = uint8_t(k_most_light_groups - 1);
    return at->second;
  }

  void group_environment() {
    if (!shines(scene_.environment)) return;
    out_.sky = place(by_rule({"sky"}), "", "sky", "sky");
    group(out_.sky).sky = true;
    out_.has_sun = sun_known_ ? *sun_known_ : has_sun(scene_);
    out_.sun = out_.has_sun ? place(by_rule({"sun"}), "", "sun", "sun") : out_.sky;
    if (out_.has_sun) group(out_.sun).sun = true;
  }

  void group_surfaces() {
    out_.surfaces.resize(scene_.instances.size());
    for (size_t i = 0; i < scene_.instances.size(); ++i) {
      const Instance& instance = scene_.instances[i];
      if (instance.mesh >= scene_.meshes.size()) continue;
      const auto& primitives = scene_.meshes[instance.mesh].primitives;
      const bool any = std::any_of(primitives.begin(), primitives.end(), [&](const Primitive& p) {
        return is_light(scene_.materials[p.material]);
      });
      if (!any) continue;
      out_.surfaces[i].assign(primitives.size(), 0);
      for (size_t p = 0; p < primitives.size(); ++p) {
        const Material& material = scene_.materials[primitives[p].material];
        if (!is_light(material)) continue;
        const std::string of_node = group_name(instance.group);
        const std::string given = of_node.empty() ? group_name(material.group) : of_node;
        const uint8_t at = place(by_rule({material.name, instance.name}), given,
                                 material.unlit ? "unlit" : material.name, "surface");
        out_.surfaces[i][p] = at;
        ++group(at).surfaces;
      }
    }
  }

  const Scene& scene_;
  const std::vector<LightGroupRule>& rules_;
  std::optional<bool> sun_known_;
  std::map<std::string, uint8_t> known_;
  std::vector<std::string> joined_;
  LightGroups out_;
};

}  // namespace

bool is_light(const Material& m) { return m.unlit || m.emission != vec3(0); }

size_t LightGroups::find(const std::string& name) const {
  const auto at = std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.name == name; });
  return size_t(at - groups.begin());
}

std::vector<LightGroupRule> parse_group_rules(const std::string& text) {
  std::vector<LightGroupRule> rules;
  for (const std::string& each : split(text, ';')) {
    const std::string part = trimmed(each);
    if (part.empty()) continue;
    const size_t equals = part.rfind('=');
    const std::string pattern = equals == std::string::npos ? "" : trimmed(part.substr(0, equals));
    const std::string group = equals == std::string::npos ? "" : group_name(part.substr(equals + 1));
    if (pattern.empty() || group.empty())
      throw Error("relight.groups", fmt::format("'{}': expected PATTERN=GROUP; PATTERN=GROUP", part));
    rules.push_back({pattern, group});
  }
  return rules;
}

bool matches_pattern(const std::string& pattern, const std::string& name) {
  // The end of the character of UTF-8 that begins there.
  const auto after = [&name](size_t at) {
    do ++at;
    while (at < name.size() && (static_cast<unsigned char>(name[at]) & 0xc0) == 0x80);
    return at;
  };
  // The last * is gone back to when what follows it does not fit.
  size_t p = 0, n = 0, star = std::string::npos, from = 0;
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*')
      star = p++, from = n;
    else if (p < pattern.size() && pattern[p] == '?')
      ++p, n = after(n);
    else if (p < pattern.size() && pattern[p] == name[n])
      ++p, ++n;
    else if (star != std::string::npos)
      p = star + 1, n = ++from;
    else
      return false;
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

std::string group_name(const std::string& text) {
  constexpr size_t k_most = 64;
  const std::string whole = trimmed(text);
  std::string name = whole;
  for (char& c : name)
    if (c == ';' || c == ':' || c == '=' || c == '|' || static_cast<unsigned char>(c) < 32) c = '_';
  if (name == whole && name.size() <= k_most) return name;
  Hash hash;
  hash.add(whole);
  return fmt::format("{}~{:08x}", trimmed(cut_text(name, k_most - 9)), static_cast<uint32_t>(hash.low()));
}

std::string kind_of_light(const std::string& name) {
  size_t end = name.size();
  for (;;) {
    size_t digits = end;
    while (digits > 0 && std::isdigit(static_cast<unsigned char>(name[digits - 1]))) --digits;
    size_t parting = digits;
    while (parting > 0 && std::string_view(" ._-#").find(name[parting - 1]) != std::string_view::npos)
      --parting;
    if (digits == end && parting == end) break;
    if (parting == 0) break;
    end = parting;
  }
  return group_name(name.substr(0, end));
}

LightGroups group_lights(const Scene& scene, const std::vector<LightGroupRule>& rules) {
  return Grouping(scene, rules).make();
}

LightGroups group_lights(const Scene& scene, const std::vector<LightGroupRule>& rules, const Scene& earlier,
                         const LightGroups& known) {
  const auto texels = [](const Scene& s) {
    return s.environment.image == k_none ? nullptr : s.images[s.environment.image].floats.data();
  };
  const bool same = texels(scene) == texels(earlier) && shines(earlier.environment);
  return Grouping(scene, rules, same ? std::optional(known.has_sun) : std::nullopt).make();
}

std::vector<uint8_t> sun_texels(const Scene& scene, float threshold) {
  if (scene.environment.image == k_none) return {};
  const Image& image = scene.images[scene.environment.image];
  std::vector<double> y(size_t{image.width} * image.height);
  double sum = 0;
  for (size_t i = 0; i < y.size(); ++i) {
    vec3 c(image.floats[4 * i], image.floats[4 * i + 1], image.floats[4 * i + 2]);
    for (int k = 0; k < 3; ++k) c[k] = std::isfinite(c[k]) ? std::max(c[k], 0.f) : 0.f;
    y[i] = luminance(c);
    // The part of the sphere that a texel covers, times width / 2 pi.
    const double row = double(i / image.width), h = image.height;
    sum += y[i] * 2 * std::sin(std::numbers::pi * (row + 0.5) / h) * std::sin(0.5 * std::numbers::pi / h);
  }
  const double mean = sum / (2.0 * image.width);
  std::vector<uint8_t> sun(y.size());
  for (size_t i = 0; i < y.size(); ++i) sun[i] = y[i] > double{threshold} * mean;
  return sun;
}

bool has_sun(const Scene& scene) {
  const std::vector<uint8_t> sun = sun_texels(scene, k_sun_threshold);
  return std::find(sun.begin(), sun.end(), uint8_t(1)) != sun.end();
}

}  // namespace lucerna::scene
