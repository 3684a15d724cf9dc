// Layers by path expressions (shared/layers.h): a path's state in their automaton, and its light in them.
#ifndef LUCERNA_LIB_LAYERS
#define LUCERNA_LIB_LAYERS
#include "lib/wavefront.glsl"

#if LUCERNA_WORD_LAYERS
#include "shaders/shared/layers.h"
layout(scalar) readonly buffer LayerTableBlock { LayerTable layer_table; };
// Radiance of paths in the layers, a texel for each slot and layer. A buffer of their own: whatever reads the components
// need not know the number of layers.
uniform samplerBuffer layer_texels;
layout(scalar) writeonly buffer LayerRadiance { vec4 layer_radiance[]; };

uint layer_state_after(uint state, uint event) { return layer_table.states[state].next >> 8u * event & 0xffu; }
// The state is in the highest bits of PathState::nulls.
uint path_layer_state(PathState path) { return path.nulls >> k_layer_state_shift; }

// Layers of looked-up light of a component, at a diffuse vertex.
uint layers_looked_up(uint state, uint component) { return layer_table.states[state].looked_up[component]; }

int layer_texel(uint slot, uint layer) { return int(slot * LUCERNA_WORD_LAYERS + layer); }
void set_layer(uint slot, uint layer, vec3 value) { layer_radiance[layer_texel(slot, layer)].rgb = value; }
// Adds light to all layers. At most once per slot and dispatch. Non-finite light is refused; it is counted with its
// component.
void add_to_layers(uint slot, vec3 value[LUCERNA_WORD_LAYERS]) {
  [[unroll]] for (uint l = 0u; l < LUCERNA_WORD_LAYERS; ++l)
    if (is_finite(value[l]) && any(notEqual(value[l], vec3(0.0)))) set_layer(slot, l, texelFetch(layer_texels, layer_texel(slot, l)).rgb + value[l]);
}
// The light, if the layer is one of these (bits).
vec3 in_layer(uint layer, uint layers, vec3 light) { return (layers >> layer & 1u) != 0u ? light : vec3(0.0); }
#endif

#endif
