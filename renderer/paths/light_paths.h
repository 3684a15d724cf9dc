#pragma once
// The automaton for light paths: their events since the light are the end of a word, read backwards. Also
// where eye paths look up their light (photons).
#include "paths/automaton.h"

namespace lucerna::paths {

/// A deterministic automaton over the scattering events of a light path. State 0 is the light's (L).
///
/// A word E u v L, with u from an eye path and v from a light path, last letter first, belongs to one
/// component. Everything that v decides is a function of the state that u leads to; states here are these
/// functions, so two light paths in one state belong to the same component for any eye path.
struct LightAutomaton {
  struct State {
    std::array<uint8_t, k_scatter_events> next{};  ///< by event
    /// Component, by the state of Automaton in which the eye path arrives.
    std::vector<uint8_t> component;
    /// Likewise, for an eye path of one diffuse event: the part (k_part_count) of the light arriving there.
    uint8_t part = k_no_component;
  };
  std::vector<State> states;

  uint8_t after(uint8_t state, Event event) const { return states[state].next[static_cast<int>(event)]; }
};

/// Throws Error if there are more than 31 states.
LightAutomaton reverse(const Automaton& automaton);

/// The uploaded automaton, in the form of pack(): bits 0-7 next on D, 8-15 on G, 16-23 on S, 24-26 the part,
/// if its light is stored, else shared::k_component_none; bit 27: something can still be stored, here or
/// further on; bits 29-30: `account`, the component that rays are accounted to. `parts` bit p: light of part
/// p is stored.
std::vector<uint32_t> pack(const LightAutomaton& automaton, uint32_t parts, uint32_t account);

/// Lookups of the `own` components among photons, by part. Caustics, primary and secondary light at the first
/// diffuse vertex, and tertiary light with them; but if another solver computes secondary light and its paths
/// continue, tertiary light is looked up at the next diffuse vertex (final gathering). A path continues
/// behind a lookup for the traced components. `traced`: enabled but not own, and primary: paths compute the
/// light of emitters without a diffuse event (`replaced`). `directly_visible_by_other`: own
/// components whose directly visible light is computed by light tracing (camera_routes()).
LookupRoutes photon_routes(const Automaton& automaton, uint32_t enabled, uint32_t own,
                           uint32_t directly_visible_by_other = 0);

/// Connection of light paths to the camera (light tracing): no lookups. For the `own` components, eye paths
/// no longer compute directly visible light of part 3 (mirrors and glass alone); they compute everything
/// else.
LookupRoutes camera_routes(const Automaton& automaton, uint32_t enabled, uint32_t own);

}  // namespace lucerna::paths
