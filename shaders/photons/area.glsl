// Surface area around a point, weighted by the photons' kernel: 1 within a surface, less near its borders and creases.
// Photons that count at x lie on the surfaces that count here (k_photon_normals, k_photon_slab), so dividing by this area
// makes uniform light uniform up to the border (H. Hey and W. Purgathofer, "Advanced Radiance Estimation for Photon Map
// Global Illumination", 2002; with Epanechnikov's kernel instead of a constant one).
//
// Over a polygon in a plane at distance c from x, the integral of the kernel is an integral over the angle seen from the
// foot of x:
//   sum over edges  integral G(min(rho(phi), R)) dphi,  R^2 = r^2 - c^2,  G(rho) = integral_0^rho K(t) t dt
//                                                     = 2 / (pi r^4) (R^2 rho^2 / 2 - rho^4 / 4),
// which along a straight edge at distance h, rho^2 = h^2 + t^2 and dphi = h dt / rho^2, is a polynomial in t within the disc,
// and G(R) times an angle without. A kernel that is flat over the disc, 1 / (pi r^2), has G(rho) = rho^2 / (2 pi r^2).
#ifndef LUCERNA_PHOTONS_AREA
#define LUCERNA_PHOTONS_AREA
#include "photons/photon.glsl"

uniform samplerBuffer photon_surface_nodes;
uniform samplerBuffer photon_surface_triangles;

// Angle between t0 and t1 on a line at distance h.
float photon_angle(float h, float t0, float t1) {
  float along = h * h + t0 * t1, across = h * (t1 - t0);
  return across == 0.0 && along == 0.0 ? 0.0 : atan(across, along);
}

// Contribution of the edge from a to b, relative to the foot of x; n: normal of the plane, big2: R^2. x: Epanechnikov's
// kernel, times pi r^4 / 2; y: constant kernel, times pi r^2.
vec2 photon_edge(vec3 a, vec3 b, vec3 n, float big2) {
  vec3 e = b - a;
  float l = length(e);
  if (l <= 0.0) return vec2(0.0);
  e /= l;
  float t0 = dot(a, e), t1 = dot(b, e), h = dot(n, cross(a, e)), h2 = h * h;
  float w = sqrt(max(0.0, big2 - h2)), u0 = clamp(t0, -w, w), u1 = clamp(t1, -w, w);
  float within = h * ((0.5 * big2 - 0.25 * h2) * (u1 - u0) - (u1 * u1 * u1 - u0 * u0 * u0) / 12.0);
  float angle = photon_angle(h, t0, u0) + photon_angle(h, u1, t1);
  return vec2(within + 0.25 * big2 * big2 * angle, 0.5 * (h * (u1 - u0) + big2 * angle));
}

// Contribution of a triangle, vertices relative to x, clipped to the slab around the plane through x with that normal.
vec2 photon_triangle(vec3 p0, vec3 p1, vec3 p2, vec3 normal, float slab, float r2) {
  vec3 n = cross(p1 - p0, p2 - p0);
  n = normalize(n / max(max3(abs(n)), 1e-37));
  float agree = dot(n, normal);
  // A back-facing triangle counts only as the same surface with opposite winding, not as the far side of a plate.
  bool turned = agree < 0.0;
  slab *= turned ? k_photon_turned_slab : 1.0;
  vec3 foot = dot(n, p0) * n;
  float big2 = r2 - dot(foot, foot);
  if (abs(agree) <= k_photon_normals || big2 <= 0.0) return vec2(0.0);
  vec2 sum = vec2(0.0);
  vec3 top_up = vec3(0.0), top_down = vec3(0.0), low_up = vec3(0.0), low_down = vec3(0.0);
  bool crosses_top = false, crosses_low = false;
  for (uint k = 0u; k < 3u; ++k) {
    vec3 a = p0, b = p1;
    p0 = p1, p1 = p2, p2 = a;
    float za = dot(a, normal), zb = dot(b, normal), d = zb - za;
    float inverse = d != 0.0 ? 1.0 / d : 0.0, s_top = (slab - za) * inverse, s_low = (-slab - za) * inverse;
    vec3 at_top = mix(a, b, s_top), at_low = mix(a, b, s_low);
    bool up = d > 0.0, top = (za > slab) != (zb > slab), low = (za < -slab) != (zb < -slab);
    top_up = top && up ? at_top : top_up, top_down = top && !up ? at_top : top_down;
    low_up = low && up ? at_low : low_up, low_down = low && !up ? at_low : low_down;
    crosses_top = crosses_top || top, crosses_low = crosses_low || low;
    if ((za > slab && zb > slab) || (za < -slab && zb < -slab)) continue;
    vec3 from = za > slab ? at_top : za < -slab ? at_low : a, to = zb > slab ? at_top : zb < -slab ? at_low : b;
    sum += photon_edge(from - foot, to - foot, n, big2);
  }
  // Edges on the faces of the slab, between the points where the outline leaves and re-enters it.
  if (crosses_top) sum += photon_edge(top_up - foot, top_down - foot, n, big2);
  if (crosses_low) sum += photon_edge(low_down - foot, low_up - foot, n, big2);
  return abs(sum);
}

// Area at x on a surface with that normal, by Epanechnikov's and by the constant kernel; 1 if very many triangles are near.
// Overlapping surfaces count twice, so errors are towards a larger area: the correction never adds light.
// made more than it is.
vec2 photon_areas(vec3 x, vec3 normal, float radius) {
  float r2 = radius * radius;
  vec2 sum = vec2(0.0);
  uint node = 0u, nodes = photons.surface_nodes, visits = 0u;
  for (; node < nodes && visits < photons.most_visits; ++visits) {
    vec4 a = texelFetch(photon_surface_nodes, int(2u * node)), b = texelFetch(photon_surface_nodes, int(2u * node + 1u));
    vec3 away = max(max(a.xyz - x, x - b.xyz), vec3(0.0));
    // Within the radius, and not entirely above or below the slab.
    float height = dot(0.5 * (a.xyz + b.xyz) - x, normal), extent = dot(0.5 * (b.xyz - a.xyz), abs(normal));
    bool meets = dot(away, away) < r2 && abs(height) <= extent + k_photon_slab * radius;
    uint leaf = floatBitsToUint(b.w), first = leaf >> 3, count = meets ? leaf & 7u : 0u;
    for (uint i = first; i < first + count; ++i)
      sum += photon_triangle(texelFetch(photon_surface_triangles, int(3u * i)).xyz - x, texelFetch(photon_surface_triangles, int(3u * i + 1u)).xyz - x,
                             texelFetch(photon_surface_triangles, int(3u * i + 2u)).xyz - x, normal, k_photon_slab * radius, r2);
    node = meets ? node + 1u : floatBitsToUint(a.w);
  }
  vec2 area = k_inv_pi * sum / vec2(0.5 * r2 * r2, r2);
  return node < nodes || nodes == 0u ? vec2(1.0) : clamp(area, k_photon_least_area, 1.0);
}
// By Epanechnikov's kernel only.
float photon_area(vec3 x, vec3 normal, float radius) { return photon_areas(x, normal, radius).x; }
#endif
