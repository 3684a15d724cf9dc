#pragma once
// Light-path words, path expressions, and the automaton that assigns paths to components during tracing.
//
// A word begins at the eye and has one letter per event, that of the sampled lobe: D diffuse, G glossy, S
// specular (delta), and L where it meets light. An expression is a regular expression over E D G S L:
// letters, [classes], . (any of D G S), * + ? | and parentheses. The four component expressions (the
// partition) are compiled into one deterministic automaton whose table is uploaded; shaders have no other
// rules for components.
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "shaders/shared/lanes.h"

namespace lucerna::paths {

enum class Event : uint8_t { diffuse, glossy, specular, light };
inline constexpr int k_scatter_events = 3;
inline constexpr uint8_t k_no_component = 0xff;

/// Components, as indices of k_component_names.
inline constexpr uint8_t k_primary = 0, k_secondary = 1, k_tertiary = 2, k_caustic = 3;
/// Bits of sets of components.
inline constexpr uint32_t k_primary_bit = 1u << k_primary, k_secondary_bit = 1u << k_secondary,
                          k_tertiary_bit = 1u << k_tertiary, k_caustic_bit = 1u << k_caustic;
extern const ByComponent<const char*> k_component_names;
extern const ByComponent<const char*> k_component_expressions;

/// A deterministic automaton over scattering events. State 0 is the eye's (after E).
struct Automaton {
  struct State {
    std::array<uint8_t, k_scatter_events> next{};  ///< by event
    uint8_t accept = k_no_component;               ///< expression of a path that hits light in this state
    uint8_t reachable = 0;  ///< bit i: expression i can still be reached, here or later
  };
  std::vector<State> states;

  uint8_t after(uint8_t state, Event event) const { return states[state].next[static_cast<int>(event)]; }
  /// Component of a word such as "EGDL" (it must start with E and end with L), or k_no_component.
  uint8_t classify(std::string_view word) const;
};

/// Compiles expressions (all starting with E and ending with L) into one automaton, minimized.
/// Throws Error, located at the expression: a syntax error, or two expressions that share a word (one such is
/// named).
Automaton compile(const std::vector<std::string>& expressions);

/// The automaton of the four components. Also checks that every word E[DGS]*L belongs to one of them; throws
/// Error naming a word that does not. Directly visible caustics and those seen in mirrors or through glass
/// have separate states, because light tracing computes only the former.
Automaton compile_components();

/// True when the word belongs to the expression: a direct backtracking matcher that shares no code with
/// compile(), kept as its oracle and for one-off queries.
bool matches(const std::string& expression, std::string_view word);

/// Light arriving at a diffuse vertex, by its path: direct, over one diffuse event ([SG]*DL), over more, or
/// over mirrors and glass alone ([SG]+L). Numbered as the components they belong to after ED.
inline constexpr int k_part_count = 4;
inline constexpr uint32_t k_caustic_part = 3;  ///< over mirrors and glass alone

/// Lookups of such parts (of a record, of photons) that replace further tracing from a diffuse lobe.
struct LookupRoutes {
  /// By automaton state at the vertex, for each part: the component it contributes to; k_no_component: left
  /// to the path. Empty: no lookups.
  std::vector<std::array<uint8_t, k_part_count>> component;
  uint32_t parts = 0;   ///< bit p: some state reads part p
  uint32_t traced = 0;  ///< components that paths still compute besides lookups (bit i)
  /// By state, if not empty: nonzero if light paths (photons, or connected to the camera) replace the light
  /// that an eye path hits.
  std::vector<uint8_t> replaced;
};

/// The uploaded automaton: packed[state] bits 0-7 next on D, 8-15 next on G, 16-23 next on S, 24-26 component
/// (shared::k_component_none: none, or off), bit 27: further light is possible, of an enabled component or by
/// a lookup, bit 28: no D so far (E[SG]*), bits 29-30: component to which rays are accounted, the lowest of
/// those, bit 31: a surface with diffuse lobes alone adds nothing and ends the path. `enabled` bit i:
/// component i is on. `met`: some lights can be hit by rays; if all are points or directions, a path that
/// could only hit a light contributes nothing.
std::vector<uint32_t> pack(const Automaton& automaton, uint32_t enabled, const LookupRoutes& routes = {},
                           bool met = true);

/// For `cached` components among the enabled ones. A lookup is at the first diffuse vertex behind which only
/// cached components have a further diffuse event: at the first with secondary and tertiary cached, at the
/// second with tertiary alone. Tertiary light behind a cached secondary component comes from the same lookup,
/// whatever its solver. `direct`: stored light includes direct environment light; every lookup then
/// contributes it too, if its component is enabled. Paths always trace primary light: of it only direct
/// environment light is looked up.
LookupRoutes lookup_routes(const Automaton& automaton, uint32_t enabled, uint32_t cached,
                           bool direct = false);

/// For the rays of a cache's records, which start in the state after ED and compute the parts that the
/// picture's lookups read. `recursive`: their tertiary light is looked up, at the first vertex behind which
/// there is nothing else, whose parts are then gathered too (caustics only if they exist).
LookupRoutes record_routes(const Automaton& automaton, uint32_t parts, bool recursive, bool caustics);

/// For gathering paths, which have intentionally passed lookups, of the picture, or of records with `enabled`
/// their parts: tertiary light is looked up at every further diffuse vertex, up to the first that is not
/// passed too, if records look it up (`own`: their routes); otherwise nothing.
LookupRoutes gather_routes(const Automaton& automaton, uint32_t enabled, const LookupRoutes& own);

}  // namespace lucerna::paths
