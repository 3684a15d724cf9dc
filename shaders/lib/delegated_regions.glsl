// Regions of the picture: share of samples whose light a solver delegates to eye paths.
#ifndef LUCERNA_LIB_DELEGATED_REGIONS
#define LUCERNA_LIB_DELEGATED_REGIONS

uniform samplerBuffer delegated_regions;  // first texel: bits of the number of regions across and down; then a texel each, row by row

// place: 0..1 to the right and down. Interpolated between the centres of regions, so that no edges show.
float delegated_share(vec2 place) {
  uvec2 size = floatBitsToUint(texelFetch(delegated_regions, 0).xy);
  vec2 at = clamp(place * vec2(size) - 0.5, vec2(0.0), vec2(size - 1u));
  uvec2 low = uvec2(at), high = min(low + 1u, size - 1u);
  vec2 f = at - vec2(low);
  vec4 share = vec4(texelFetch(delegated_regions, int(1u + low.y * size.x + low.x)).x,
                    texelFetch(delegated_regions, int(1u + low.y * size.x + high.x)).x,
                    texelFetch(delegated_regions, int(1u + high.y * size.x + low.x)).x,
                    texelFetch(delegated_regions, int(1u + high.y * size.x + high.x)).x);
  vec2 rows = mix(share.xz, share.yw, f.x);
  return mix(rows.x, rows.y, f.y);
}
#endif
