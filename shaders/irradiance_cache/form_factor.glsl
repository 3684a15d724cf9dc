// Change of the irradiance from a triangle as the receiving point moves in its tangent plane.
//
// A triangle with vertices p_i of uniform radiance 1 gives a point x with normal n (Lambert's formula)
//
//   E = 1/2 sum over edges (a, b) of theta (a x b).n / |a x b|,    a = p_i - x, b = p_(i+1) - x, theta the angle between,
//
// so that a mesh is a sum over its edges, each with the difference of the radiances at its sides. With d = b - a and
// q(t) = a + t d, theta / |a x b| is the integral of 1/q^2 over t = 0..1; a x b changes by d x u when x moves by u, and q
// by -u. Hence, with c = a x b and m = n x d (the gradient of c.n), of one edge
//
//   gradient = 1/2 (m I + c.n G),                  I = int 1/q^2 dt,    G = int 2 q/q^4 dt
//   Hessian  = 1/2 (m G' + G m' + c.n K),          K = int (8 q q'/q^6 - 2/q^4) dt                     (': transposed)
//
// Along the edge dt = q^2 ds / |c| with s the angle from a, and 1/q is (sin(theta - s)/|a| + sin(s)/|b|) / sin(theta): in
// angles the integrands are smooth however different the distances of a and b are, and only inverse distances occur, which
// may be 0. Neighbouring rays enclose small angles, so two Gauss-Legendre points suffice. (J. Arvo, "The Irradiance
// Jacobian for Partially Occluded Polyhedral Sources", 1994; N. Holzschuch and F. Sillion, "An Exhaustive Error-Bounding
// Algorithm for Hierarchical Radiosity", 1998, have other forms of both.)
#ifndef LUCERNA_IRRADIANCE_CACHE_FORM_FACTOR
#define LUCERNA_IRRADIANCE_CACHE_FORM_FACTOR

// In the frame of tangent, bitangent and normal.
struct EdgeTerms {
  float value;    // irradiance
  vec2 gradient;  // in the tangent plane [1/m]
  vec3 hessian;   // xx, xy, yy [1/m^2]
};

// Terms of an edge between the unit directions `a` and `b`, at inverse distances `near_a` and `near_b` [1/m], per difference
// of radiance: left of the edge, as seen from the normal's tip, minus right of it.
EdgeTerms edge_terms(vec3 a, float near_a, vec3 b, float near_b) {
  vec3 c = cross(a, b);
  float sine = length(c), theta = atan(sine, dot(a, b));
  bool apart = sine > 1e-4;
  float per_sine = 1.0 / max(sine, 1e-4), stretch = apart ? theta * per_sine : 1.0;
  vec3 d = stretch * (near_a * b - near_b * a);
  vec2 m = vec2(-d.y, d.x);
  float facing = stretch * c.z;
  vec2 g = vec2(0.0);
  vec3 k = vec3(0.0);
  for (uint i = 0u; i < 2u; ++i) {
    float t = i == 0u ? 0.211324865 : 0.788675135;
    float weight_a = apart ? sin(theta * (1.0 - t)) * per_sine : 1.0 - t;
    float weight_b = apart ? sin(theta * t) * per_sine : t;
    vec2 e = weight_a * a.xy + weight_b * b.xy;
    float near = weight_a * near_a + weight_b * near_b;
    g += near * e;
    k += near * near * (4.0 * vec3(e.x * e.x, e.x * e.y, e.y * e.y) - vec3(1.0, 0.0, 1.0));
  }
  // The weights of the points, 1/2 each, and theta, which `m` and `facing` hold.
  EdgeTerms terms;
  terms.value = 0.5 * facing;
  terms.gradient = 0.5 * (m + facing * g);
  terms.hessian = 0.5 * (vec3(2.0 * m.x * g.x, m.x * g.y + m.y * g.x, 2.0 * m.y * g.y) + facing * k);
  return terms;
}
#endif
