// Layers of light by path expressions (renderer/paths/layers.h), beside the components. Read by C++ and GLSL.
//
// Each layer adds its light to paths and sums to the film. A path follows the layers' automaton by its events, in a
// state of its own (PathState::nulls), because layers may overlap and know nothing of the solvers.
#ifndef LUCERNA_SHARED_LAYERS_H
#define LUCERNA_SHARED_LAYERS_H
#include "shaders/shared/lanes.h"
LUCERNA_SHARED_BEGIN

LUCERNA_CONST uint k_most_layers = 16u;        ///< a bit each
LUCERNA_CONST uint k_most_layer_states = 255u;  ///< of their automaton; a byte

struct LayerState {
  uint next;                          ///< bits 0-7 state after D, 8-15 after G, 16-23 after S
  uint accept;                        ///< layers of light that is met in this state
  uint looked_up[k_component_count];  ///< at a diffuse vertex reached in this state: layers of looked-up light of a component
};

struct LayerTable {
  uint splat[k_component_count];  ///< layers of light of a component that light paths have brought to the camera
  LayerState states[k_most_layer_states];
};

LUCERNA_SHARED_END
#endif
