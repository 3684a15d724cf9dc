// Included by gpu_scale.comp; OFFSET comes from the host.
#ifndef GPU_OFFSET_GLSL
#define GPU_OFFSET_GLSL
const float k_offset = OFFSET;
#ifdef BREAK_THE_INCLUDE
const float k_broken = no_such_name;
#endif
#endif
