#include "scene/light_mix.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/blackbody.h"
#include "base/color.h"
#include "base/error.h"
#include "base/text.h"

namespace lucerna::scene {
namespace {

float number(const std::string& text, float lo, float hi, const std::string& where, const std::string& part) {
  float value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, code] = std::from_chars(text.data(), end, value);
  if (code != std::errc() || stop != end || !std::isfinite(value))
    throw Error(where, fmt::format("'{}': '{}' is no number", part, text));
  if (value < lo || value > hi) throw Error(where, fmt::format("'{}': expected {} to {}", part, lo, hi));
  return value;
}

void take_word(GroupMix& mix, const std::string& word, const std::string& where) {
  if (word == "mute") {
    mix.mute = true;
    return;
  }
  if (word == "solo") {
    mix.solo = true;
    return;
  }
  const size_t equals = word.find('=');
  const std::string key = word.substr(0, equals);
  const std::string value = equals == std::string::npos ? "" : word.substr(equals + 1);
  if (key == "ev") {
    mix.ev = number(value, -k_most_ev, k_most_ev, where, word);
  } else if (key == "factor") {
    mix.ev = std::log2(number(value, std::exp2(-k_most_ev), std::exp2(k_most_ev), where, word));
  } else if (key == "kelvin") {
    mix.color = blackbody_color(number(value, k_coolest_kelvin, k_hottest_kelvin, where, word));
  } else if (key == "color") {
    const std::vector<std::string> parts = split(value, ',');
    if (parts.size() != 3) throw Error(where, fmt::format("'{}': expected color=R,G,B", word));
    for (int k = 0; k < 3; ++k) mix.color[k] = number(parts[size_t(k)], 0, k_most_tint, where, word);
  } else {
    throw Error(where, fmt::format("'{}': expected ev=, factor=, color=R,G,B, kelvin=, mute or solo", word));
  }
}

bool anything_solo(const LightMix& mix) {
  return std::any_of(mix.begin(), mix.end(), [](const auto& entry) { return entry.second.solo; });
}

}  // namespace

LightMix parse_mix(const std::string& text, const std::string& where) {
  LightMix mix;
  for (const std::string& part : split(text, ';')) {
    if (trimmed(part).empty()) continue;
    const size_t colon = part.find(':');
    const std::string name = colon == std::string::npos ? "" : group_name(part.substr(0, colon));
    if (name.empty())
      throw Error(where, fmt::format("'{}': expected GROUP: ev=NUMBER color=R,G,B mute solo; ...", part));
    GroupMix group;
    std::string words = part.substr(colon + 1);
    for (char& c : words)
      if (c == '\t' || c == '\n' || c == '\r') c = ' ';
    for (const std::string& word : split(words, ' '))
      if (!word.empty()) take_word(group, word, where);
    mix[name] = group;
  }
  return mix;
}

std::string mix_text(const LightMix& mix) {
  std::string text;
  for (const auto& [name, group] : mix) {
    if (group.neutral()) continue;
    text += (text.empty() ? "" : "; ") + name + ":";
    if (group.ev != 0) text += fmt::format(" ev={}", group.ev);
    if (group.color != vec3(1))
      text += fmt::format(" color={},{},{}", group.color.x, group.color.y, group.color.z);
    if (group.mute) text += " mute";
    if (group.solo) text += " solo";
  }
  return text;
}

vec3 mix_weight(const LightMix& mix, const std::string& group) {
  const auto found = mix.find(group);
  const GroupMix own = found == mix.end() ? GroupMix() : found->second;
  if (own.mute || (!own.solo && anything_solo(mix))) return vec3(0);
  return own.color * std::exp2(own.ev);
}

std::vector<vec3> mix_weights(const LightMix& mix, const LightGroups& groups) {
  std::vector<vec3> weights;
  LightMix here;  // a missing group mutes no other group
  for (const LightGroup& group : groups.groups)
    if (const auto found = mix.find(group.name); found != mix.end()) here.insert(*found);
  for (const LightGroup& group : groups.groups) weights.push_back(mix_weight(here, group.name));
  return weights;
}

bool is_neutral(const LightMix& mix, const LightGroups& groups) {
  const std::vector<vec3> weights = mix_weights(mix, groups);
  return std::all_of(weights.begin(), weights.end(), [](const vec3& w) { return w == vec3(1); });
}

std::vector<std::string> unknown_groups(const LightMix& mix, const LightGroups& groups) {
  std::vector<std::string> names;
  for (const auto& [name, group] : mix)
    if (groups.find(name) == groups.groups.size()) names.push_back(name);
  return names;
}

LightMix blend(const LightMix& a, const LightMix& b, float t, const LightGroups& groups) {
  if (t <= 0) return a;
  if (t >= 1) return b;
  const std::vector<vec3> wa = mix_weights(a, groups), wb = mix_weights(b, groups);
  LightMix mix;
  for (size_t g = 0; g < groups.groups.size(); ++g) {
    const vec3 weight = (1 - t) * wa[g] + t * wb[g];
    const float strength = strength_of(weight);
    GroupMix& group = mix[groups.groups[g].name];
    if (strength > 0)
      group.ev = std::clamp(std::log2(strength), -k_most_ev, k_most_ev), group.color = tint_of(weight);
    else
      group.mute = true;
  }
  return mix;
}

MixPresets parse_presets(const std::string& text, const std::string& where) {
  MixPresets presets;
  for (const std::string& part : split(text, '|')) {
    if (trimmed(part).empty()) continue;
    const size_t equals = part.find('=');
    const std::string name = equals == std::string::npos ? "" : group_name(part.substr(0, equals));
    if (name.empty() || part.find(':') < equals)
      throw Error(where, fmt::format("'{}': expected NAME = GROUP: ...; GROUP: ... | NAME = ...", part));
    presets[name] = parse_mix(part.substr(equals + 1), where);
  }
  return presets;
}

std::string presets_text(const MixPresets& presets) {
  std::string text;
  for (const auto& [name, mix] : presets) text += (text.empty() ? "" : " | ") + name + " = " + mix_text(mix);
  return text;
}

namespace {

/// Texels of sky and sun by their own weights.
void mix_environment(Scene& scene, const LightGroups& groups, const std::vector<vec3>& weights) {
  Environment& e = scene.environment;
  const vec3 sky = weights[groups.sky], sun = weights[groups.sun];
  if (sky == vec3(1) && sun == vec3(1)) return;
  if (e.image == k_none) {
    e.radiance *= sky;
    return;
  }
  Image image = scene.images[e.image];
  const std::vector<uint8_t> is_sun =
      groups.has_sun ? sun_texels(scene, k_sun_threshold) : std::vector<uint8_t>();
  for (size_t i = 0; 4 * i < image.floats.size(); ++i) {
    const vec3& w = !is_sun.empty() && is_sun[i] ? sun : sky;
    for (int k = 0; k < 3; ++k) image.floats[4 * i + size_t(k)] *= w[k];
  }
  e.image = Id(scene.images.size());
  scene.images.push_back(std::move(image));
}

}  // namespace

Scene mixed_scene(const Scene& scene, const LightGroups& groups, const LightMix& mix,
                  std::vector<std::string>* messages) {
  const std::vector<vec3> weights = mix_weights(mix, groups);
  Scene mixed = scene;
  for (size_t i = 0; i < mixed.lights.size(); ++i) mixed.lights[i].intensity *= weights[groups.lamps[i]];
  mix_environment(mixed, groups, weights);
  std::vector<int> taken(scene.materials.size(), -1);  // group, by material
  std::vector<bool> warned(scene.materials.size());
  for (size_t i = 0; i < scene.instances.size(); ++i)
    for (size_t p = 0; p < groups.surfaces[i].size(); ++p) {
      const Id material = scene.meshes[scene.instances[i].mesh].primitives[p].material;
      Material& m = mixed.materials[material];
      if (!is_light(scene.materials[material])) continue;
      const int group = groups.surfaces[i][p];
      if (taken[material] < 0) {
        taken[material] = group;
        m.emission *= weights[size_t(group)];
        if (m.unlit) m.base_color *= vec4(weights[size_t(group)], 1);
      } else if (messages && !warned[material] &&
                 weights[size_t(taken[material])] != weights[size_t(group)]) {
        warned[material] = true;
        messages->push_back(fmt::format(
            "material '{}' shines in the groups '{}' and '{}', which are mixed separately: it takes the "
            "first's "
            "mix",
            m.name, groups.groups[size_t(taken[material])].name, groups.groups[size_t(group)].name));
      }
    }
  return mixed;
}

}  // namespace lucerna::scene
