// The picture in the format of kernels: 8-bit sRGB, a word a pixel, red lowest.
#ifndef LUCERNA_LIB_PICTURE
#define LUCERNA_LIB_PICTURE

// Encoded, 0..1.
vec3 picture_color(uint packed) { return vec3(packed & 0xffu, packed >> 8 & 0xffu, packed >> 16 & 0xffu) / 255.0; }

uint picture_packed(vec3 color) {
  uvec3 bytes = uvec3(clamp(color, vec3(0.0), vec3(1.0)) * 255.0 + 0.5);
  return bytes.x | bytes.y << 8 | bytes.z << 16 | 0xff000000u;
}
#endif
