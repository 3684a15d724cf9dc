#include "paths/layers.h"

#include <algorithm>
#include <cctype>
#include <deque>
#include <map>

namespace lucerna::paths {
namespace {

constexpr size_t k_longest_name = 32;
constexpr std::string_view k_events = "DGS";

std::string trimmed(const std::string& text) {
  const size_t first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

void check_name(const std::string& name, const std::vector<std::string>& reserved, const std::string& where) {
  const auto fits = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-';
  };
  if (name.empty() || !std::isalpha(static_cast<unsigned char>(name[0])) ||
      !std::all_of(name.begin(), name.end(), fits) || name.size() > k_longest_name)
    throw_error(where,
                "'{}' is no name of a layer: up to {} letters, digits, '_' and '-', the first one a letter",
                name, k_longest_name);
  if (std::find(reserved.begin(), reserved.end(), name) != reserved.end())
    throw_error(where, "'{}' is the name of a layer that every picture has; choose another", name);
}

}  // namespace

std::vector<Layer> parse_layers(const std::string& text, const std::vector<std::string>& reserved,
                                const std::string& where) {
  std::vector<Layer> layers;
  if (trimmed(text).empty()) return layers;
  for (size_t from = 0; from <= text.size();) {
    const size_t comma = std::min(text.find(',', from), text.size());
    const std::string one = text.substr(from, comma - from);
    from = comma + 1;
    const size_t equals = one.find('=');
    if (equals == std::string::npos)
      throw_error(where, "'{}': expected NAME = EXPRESSION, NAME = EXPRESSION ...", trimmed(one));
    Layer layer{trimmed(one.substr(0, equals)), trimmed(one.substr(equals + 1))};
    check_name(layer.name, reserved, where);
    for (const Layer& other : layers)
      if (other.name == layer.name) throw_error(where, "there are two layers '{}'", layer.name);
    if (layer.expression.empty()) throw_error(where, "layer '{}' has no expression", layer.name);
    layers.push_back(std::move(layer));
  }
  if (layers.size() > shared::k_most_layers)
    throw_error(where, "{} layers; at most {}", layers.size(), shared::k_most_layers);
  return layers;
}

std::string layers_text(const std::vector<Layer>& layers) {
  std::string text;
  for (const Layer& layer : layers)
    text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", layer.name, layer.expression);
  return text;
}

LayerSet::LayerSet(const Automaton& components, const std::string& text,
                   const std::vector<std::string>& reserved, const std::string& where)
    : layers_(parse_layers(text, reserved, where)) {
  if (layers_.empty()) return;
  std::vector<Automaton> each;
  for (const Layer& layer : layers_) {
    try {
      each.push_back(compile({layer.expression}));
    } catch (const Error& error) {
      throw_error(where, "layer '{}': {}", layer.name, error.what());
    }
  }
  // Their product with the components' automaton, as far as paths reach.
  using Joint = std::vector<uint8_t>;
  std::map<Joint, uint8_t> number;
  std::vector<Joint> joints;
  const auto index = [&](const Joint& joint) {
    const auto [at, fresh] = number.emplace(joint, static_cast<uint8_t>(joints.size()));
    if (!fresh) return at->second;
    if (joints.size() == shared::k_most_layer_states)
      throw_error(where, "together the layers need more than {} states; use fewer or simpler expressions",
                  shared::k_most_layer_states);
    joints.push_back(joint);
    return at->second;
  };
  index(Joint(1 + each.size(), 0));
  uint32_t found = 0;
  for (size_t i = 0; i < joints.size(); ++i) {
    const Joint joint = joints[i];
    State state;
    state.component_state = joint[0];
    state.component = components.states[joint[0]].accept;
    for (size_t l = 0; l < each.size(); ++l)
      if (each[l].states[joint[1 + l]].accept != k_no_component) state.accept |= 1u << l;
    for (int e = 0; e < k_scatter_events; ++e) {
      Joint next{components.after(joint[0], static_cast<Event>(e))};
      for (size_t l = 0; l < each.size(); ++l)
        next.push_back(each[l].after(joint[1 + l], static_cast<Event>(e)));
      state.next[static_cast<size_t>(e)] = index(next);
    }
    found |= state.accept;
    states_.push_back(state);
  }
  for (size_t l = 0; l < layers_.size(); ++l)
    if ((found >> l & 1u) == 0)
      throw_error(
          where,
          "layer '{}': no path is a word of '{}'; words begin with E at the eye and end with L at the "
          "light, such as ED[SG]*L",
          layers_[l].name, layers_[l].expression);
}

uint32_t LayerSet::index_of(std::string_view name) const {
  const auto at =
      std::find_if(layers_.begin(), layers_.end(), [&](const Layer& l) { return l.name == name; });
  return static_cast<uint32_t>(at - layers_.begin());
}

uint32_t LayerSet::classify(std::string_view word) const {
  if (states_.empty() || word.size() < 2 || word.front() != 'E' || word.back() != 'L') return 0;
  uint8_t state = 0;
  for (const char c : word.substr(1, word.size() - 2)) {
    const size_t event = k_events.find(c);
    if (event == std::string_view::npos) return 0;
    state = states_[state].next[event];
  }
  return states_[state].accept;
}

LayerSet::Words LayerSet::words_from(uint8_t state, uint8_t component) const {
  Words words;
  std::vector<bool> seen(states_.size(), false);
  std::deque<uint8_t> open{state};
  seen[state] = true;
  while (!open.empty()) {
    const State& s = states_[open.front()];
    open.pop_front();
    if (s.component == component) words.all &= s.accept, words.any |= s.accept;
    for (const uint8_t next : s.next)
      if (!seen[next]) seen[next] = true, open.push_back(next);
  }
  return words;
}

LayerSet::Routed LayerSet::routed(const LookupRoutes& routes, const LookupRoutes& gather) const {
  Routed routed{.table = {}, .unknown = std::vector<uint32_t>(layers_.size(), 0)};
  const auto note = [&](const Words& words, size_t component) {
    for (size_t l = 0; l < layers_.size(); ++l)
      if (((words.any & ~words.all) >> l & 1u) != 0) routed.unknown[l] |= 1u << component;
    return words.any & words.all;
  };
  for (size_t i = 0; i < states_.size(); ++i) {
    const State& s = states_[i];
    shared::LayerState& packed = routed.table.states[i];
    packed.next = s.next[0] | uint32_t{s.next[1]} << 8 | uint32_t{s.next[2]} << 16;
    packed.accept = s.accept;
    for (const LookupRoutes* lookups : {&routes, &gather}) {
      if (s.component_state >= lookups->component.size()) continue;
      for (const uint8_t c : lookups->component[s.component_state])
        if (c != k_no_component) packed.looked_up[c] = note(words_from(s.next[0], c), c);
    }
  }
  // Light paths bring to the camera what eye paths do not meet any more.
  for (const uint8_t c : k_components) {
    Words words;
    for (const State& s : states_)
      if (s.component == c && s.component_state < routes.replaced.size() &&
          routes.replaced[s.component_state] != 0)
        words.all &= s.accept, words.any |= s.accept;
    routed.table.splat[c] = note(words, c);
  }
  return routed;
}

std::string unknown_text(uint32_t unknown) {
  std::string text;
  for (const size_t c : k_components)
    if ((unknown >> c & 1u) != 0) text += (text.empty() ? "" : " and ") + std::string(k_component_names[c]);
  return text;
}

}  // namespace lucerna::paths
