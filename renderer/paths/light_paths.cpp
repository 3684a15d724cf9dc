#include "paths/light_paths.h"

#include <deque>
#include <map>
#include <utility>

namespace lucerna::paths {

LightAutomaton reverse(const Automaton& automaton) {
  LightAutomaton out;
  std::map<std::vector<uint8_t>, uint8_t> number;
  const auto state_of = [&](const std::vector<uint8_t>& component) {
    const auto [it, fresh] = number.emplace(component, static_cast<uint8_t>(out.states.size()));
    if (fresh) {
      if (out.states.size() == 31) throw Error("path expressions", "need more than 31 states from the light");
      out.states.push_back({.next = {}, .component = component});
      out.states.back().part = component[automaton.after(0, Event::diffuse)];
    }
    return it->second;
  };
  std::vector<uint8_t> unscattered;
  for (const Automaton::State& s : automaton.states) unscattered.push_back(s.accept);
  state_of(unscattered);
  for (size_t i = 0; i < out.states.size(); ++i)
    for (int e = 0; e < k_scatter_events; ++e) {
      // The event stands in front of all that the light path has met before.
      std::vector<uint8_t> component;
      for (const Automaton::State& s : automaton.states)
        component.push_back(out.states[i].component[s.next[e]]);
      const uint8_t next = state_of(component);
      out.states[i].next[e] = next;
    }
  return out;
}

std::vector<uint32_t> pack(const LightAutomaton& automaton, uint32_t parts, uint32_t account) {
  const auto stored = [&](const LightAutomaton::State& s) {
    return s.part != k_no_component && (parts >> s.part & 1u) != 0;
  };
  std::vector<bool> live(automaton.states.size(), false);
  for (bool changed = true; changed;) {
    changed = false;
    for (size_t i = 0; i < live.size(); ++i) {
      bool now = stored(automaton.states[i]);
      for (const uint8_t next : automaton.states[i].next) now = now || live[next];
      changed |= now != live[i];
      live[i] = now;
    }
  }
  std::vector<uint32_t> packed;
  for (size_t i = 0; i < live.size(); ++i) {
    const LightAutomaton::State& s = automaton.states[i];
    const uint32_t part = stored(s) ? s.part : shared::k_component_none;
    packed.push_back(s.next[0] | s.next[1] << 8 | s.next[2] << 16 | part << 24 | (live[i] ? 1u << 27 : 0u) |
                     account << 29);
  }
  return packed;
}

namespace {}  // namespace

LookupRoutes photon_routes(const Automaton& automaton, uint32_t enabled, uint32_t own,
                           uint32_t directly_visible_by_other) {
  own &= enabled;
  const auto within = [](uint8_t component, uint32_t set) {
    return component != k_no_component && (set >> component & 1u) != 0;
  };
  LookupRoutes routes;
  // Emitters that are seen directly or in mirrors remain to eye paths.
  routes.traced = enabled & (~own | k_primary_bit);
  if ((own & k_primary_bit) != 0) routes.replaced.assign(automaton.states.size(), 0);
  routes.component.assign(automaton.states.size(),
                          {k_no_component, k_no_component, k_no_component, k_no_component});
  // States of eye paths, each with the components that have been looked up on the way there.
  std::deque<std::pair<uint8_t, uint32_t>> open{{0, 0}};
  std::map<uint8_t, uint32_t> seen{{0, 0}};
  while (!open.empty()) {
    const auto [state, before] = open.front();
    open.pop_front();
    const uint8_t d = automaton.after(state, Event::diffuse), dd = automaton.after(d, Event::diffuse);
    const std::array<uint8_t, k_part_count> component{
        automaton.states[d].accept, automaton.states[dd].accept,
        automaton.states[automaton.after(dd, Event::diffuse)].accept,
        automaton.states[automaton.after(d, Event::specular)].accept};
    // A further diffuse event leads to a component of another solver: its paths continue, and carry this
    // lookup's light.
    const bool passed_on = component[1] != component[2] && within(component[1], enabled & ~own);
    uint32_t looked_up = before;
    for (uint32_t p = 0; p < k_part_count; ++p) {
      if (!within(component[p], own & ~before) || (p == 2 && passed_on)) continue;
      if (state == 0 && p == k_caustic_part && within(component[p], directly_visible_by_other)) continue;
      routes.component[state][p] = component[p];
      routes.parts |= 1u << p;
      looked_up |= 1u << component[p];
      if (component[p] == k_primary) routes.replaced[d] = 1;
    }
    for (const Event e : {Event::diffuse, Event::glossy, Event::specular}) {
      const uint8_t next = automaton.after(state, e);
      const uint32_t done = e == Event::diffuse ? looked_up : before;
      const auto [it, fresh] = seen.emplace(next, done);
      if (fresh) open.emplace_back(next, done);
    }
  }
  return routes;
}

LookupRoutes camera_routes(const Automaton& automaton, uint32_t enabled, uint32_t own) {
  LookupRoutes routes;
  routes.traced = enabled;
  routes.component.assign(automaton.states.size(),
                          {k_no_component, k_no_component, k_no_component, k_no_component});
  routes.replaced.assign(automaton.states.size(), 0);
  const uint8_t lit = automaton.after(automaton.after(0, Event::diffuse), Event::specular);
  const uint8_t component = automaton.states[lit].accept;
  if (component == k_no_component || (enabled & own & 1u << component) == 0) return routes;
  routes.replaced[lit] = 1;
  routes.parts = 1u << k_caustic_part;
  return routes;
}

}  // namespace lucerna::paths
