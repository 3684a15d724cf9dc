#pragma once
// Layers of light that a person defines by path expressions (automaton.h), beside the components: parts of
// the picture for compositing and study. They may overlap, and change nothing else.
#include <string>
#include <string_view>
#include <vector>

#include "paths/automaton.h"
#include "shaders/shared/layers.h"

namespace lucerna::paths {

struct Layer {
  std::string name;        ///< letters, digits, '_' and '-', starting with a letter
  std::string expression;  ///< of complete words, from E to L
  bool operator==(const Layer&) const = default;
};

/// From "NAME = EXPRESSION, NAME = EXPRESSION"; "": none. Throws Error located at `where`: syntax, a name
/// twice or of `reserved` ones, too many layers. Expressions are not read.
std::vector<Layer> parse_layers(const std::string& text, const std::vector<std::string>& reserved,
                                const std::string& where = "film.layers");
/// The text that parse_layers() reads.
std::string layers_text(const std::vector<Layer>& layers);

/// At most shared::k_most_layers layers, in their order, and the automaton that finds the layers of a path. A
/// state of it is one of the components' automaton together with the progress in each expression.
class LayerSet {
 public:
  LayerSet() = default;
  /// Throws Error located at `where`: like parse_layers(), an expression that cannot be read or has no word,
  /// too many states.
  LayerSet(const Automaton& components, const std::string& text, const std::vector<std::string>& reserved,
           const std::string& where = "film.layers");

  const std::vector<Layer>& layers() const { return layers_; }
  uint32_t size() const { return static_cast<uint32_t>(layers_.size()); }
  /// Index of a layer; size(): there is none of that name.
  uint32_t index_of(std::string_view name) const;
  /// Layers (bits) of a word such as "EGDL"; 0 if it is no word.
  uint32_t classify(std::string_view word) const;

  /// Stored light contains the light of many words together; a layer that has some of these but not others
  /// cannot be separated from it.
  struct Routed {
    shared::LayerTable table;
    /// By layer: components (bits) of whose stored light it has an unknown part; 0: the layer is complete.
    std::vector<uint32_t> unknown;
  };
  /// For paths with these lookups: `gather` of those that have passed one (transport/frame.h).
  Routed routed(const LookupRoutes& routes, const LookupRoutes& gather) const;

 private:
  struct State {
    uint8_t component_state = 0;                   ///< of the components' automaton
    uint8_t component = k_no_component;            ///< of light met here
    std::array<uint8_t, k_scatter_events> next{};  ///< by event
    uint32_t accept = 0;                           ///< layers of light met here
  };
  /// Layers of all and of any words of a component that begin with a way to `state`; its light may be met
  /// there.
  struct Words {
    uint32_t all = ~0u, any = 0;
  };
  Words words_from(uint8_t state, uint8_t component) const;

  std::vector<Layer> layers_;
  std::vector<State> states_;
};

/// Names of components (bits) for a sentence: "secondary and caustic"; "": none.
std::string unknown_text(uint32_t unknown);

}  // namespace lucerna::paths
