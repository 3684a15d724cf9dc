// How much light has changed, from noisy sums of it over many places: what the window's preview asks of records and of the
// picture.
#ifndef LUCERNA_LIB_LIGHT_CHANGE
#define LUCERNA_LIB_LIGHT_CHANGE

const float k_most_light_ratio = 16.0;  // that light is taken to have grown by
const float k_dark_place = 0.1;         // no place weighs more than one with so much of the mean light

// How far sums are believed, where what is known without them is `off` from them, squared: nothing within two standard errors,
// by the square that has been found (`spread`) or by that which was to be expected; all of it far off.
vec4 light_belief(vec4 off, vec4 spread, vec4 expected) {
  vec4 found = clamp(1.0 - 4.0 * spread / max(off, vec4(1e-20)), 0.0, 1.0);
  return found * smoothstep(4.0 * expected, 9.0 * expected + 1e-20, off);
}
#endif
