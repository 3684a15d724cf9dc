#pragma once
// The automaton as a path from a light sees it: what it has met since is the end of a word, read backwards.
// Where paths from the eye look its light up (photons).
#include "paths/automaton.h"

namespace lucerna::paths {

/// A deterministic automaton over the scattering events of a path from a light. State 0 is the light's (L).
///
/// A word E u v L is of one component, where a path from the eye brings u and one from a light brings v, last
/// letter first. All that v decides is a function of the state that u leads to; states here are these
/// functions, so that two light paths in one state belong to the same component whatever eye path they meet.
struct LightAutomaton {
  struct State {
    std::array<uint8_t, k_scatter_events> next{};  ///< by event
    /// Component, by the state of Automaton in which the eye path arrives.
    std::vector<uint8_t> component;
    /// The same of an eye path that comes straight from the camera and is scattered diffusely: which of the
    /// parts of light that arrives there (k_part_count) this is.
    uint8_t part = k_no_component;
  };
  std::vector<State> states;

  uint8_t after(uint8_t state, Event event) const { return states[state].next[static_cast<int>(event)]; }
};

/// Throws Error where there are more than 31 states.
LightAutomaton reverse(const Automaton& automaton);

/// As it is uploaded, in the form of pack(): bits 0-7 next on D, 8-15 on G, 16-23 on S, 24-26 the part, if
/// its light is stored, else k_component_count; bit 27: something can still be stored, here or further on;
/// bits 29-30: `account`, the component that rays are accounted to. `parts` bit p: light of part p is stored.
std::vector<uint32_t> pack(const LightAutomaton& automaton, uint32_t parts, uint32_t account);

/// Where light of the `own` components is looked up among photons, by part. Caustics and secondary light at
/// the first diffuse vertex, and tertiary light with them; but where secondary light is somebody else's,
/// which goes on from there, tertiary light is looked up at the vertex that this leads to (final gathering).
/// A path that has been looked up goes on for the components that are traced. `traced`: enabled but not own.
/// `straight`: of own, the components of which light tracing brings what camera_routes() says.
LookupRoutes photon_routes(const Automaton& automaton, uint32_t enabled, uint32_t own,
                           uint32_t directly_visible_by_other = 0);

/// Where paths from the lights are joined straight to the camera (light tracing): nothing is looked up, and
/// of the `own` components paths from the eye no longer bring what light has done that has met mirrors and
/// glass alone (part 3) and falls on what the camera sees straight. All else they go on to bring.
LookupRoutes camera_routes(const Automaton& automaton, uint32_t enabled, uint32_t own);

}  // namespace lucerna::paths
