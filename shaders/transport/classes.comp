// Sorts hits by the features of their material. Counts them by kind (LUCERNA_COUNT_KINDS), or appends each to the queue part
// of its class, whose shading kernel compiles in nothing else (renderer/transport/hit_classes.h).
#define LUCERNA_PUSH ClassesPush
#include "lib/variants.glsl"
#include "lib/wavefront.glsl"

uniform samplerBuffer scene_triangles;
uniform samplerBuffer scene_materials;
layout(scalar) writeonly buffer ClassQueue { uint class_queue[]; };  // push.slots for each class

uint kind_of(Hit hit) {
  bool met = hit.prim != k_no_hit;
  uint material = floatBitsToUint(texelFetch(scene_triangles, int(met ? hit.prim : 0u)).w) & k_triangle_material_mask;
  uint kind = floatBitsToUint(texelFetch(scene_materials, int(material * k_material_texels + k_material_detail)).w);
  return met ? kind : k_kind_sky;
}

void main() {
  uint index = global_index();
  if (index >= push.count) return;
  uint slot = push.use_queue != 0u ? queue[index] : index;
  uint kind = kind_of(load_hit(slot));
#if LUCERNA_COUNT_KINDS
  atomicAdd(counters[k_counter_kinds + kind], 1u);
#else
  // A path of which only emission counts ends without light at most surfaces. Those at the first surface and at the maximum
  // depth are written or counted.
  PathState path = load_path(slot);
  uint depth = path_depth(path);
  bool of_diffuse = (push.diffuse >> kind & 1u) != 0u && automaton_ends_on_diffuse(path_automaton(path));
  bool of_all = (push.all >> kind & 1u) != 0u && automaton_ends(path_automaton(path));
  bool ends = (of_diffuse || of_all) && depth > 0u && depth < frame.max_depth;
  if (ends) return;
  const uint in_word = 32u / k_class_bits;
  uint to = push.classes[kind / in_word] >> k_class_bits * (kind % in_word) & (1u << k_class_bits) - 1u;
  class_queue[to * push.slots + atomicAdd(counters[k_counter_classes + to], 1u)] = slot;
#endif
}
