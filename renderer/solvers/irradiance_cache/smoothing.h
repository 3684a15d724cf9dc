#pragma once
// The light of records as lookups read it: smoothed over neighbouring records. Pure; no device.
//
// Neighbouring records of a surface have independent noise and similar light. So each record's light is
// replaced by a plane fitted to its own and its neighbours', evaluated at its place (locally weighted
// regression; W. Cleveland, "Robust Locally Weighted Regression and Smoothing Scatterplots", 1979):
//
//   E_i' = sum_j w_ij E_j,   sum_j w_ij = 1,   w_ij >= 0.
//
// In the fit a record counts by
//   - its rays;
//   - the distance: 1 - d / reach;
//   - the likeness of its luminance: exp(-(L_i - L_j)^2 / (2 (3 s)^2)), s the root mean square of both
//     standard errors. Shadows' borders stay, and as records get more rays, less is smoothed;
//   - the share of its disc that it represents. A record in a crease may see a surface within its minimum
//     radius. It is then right for a band along the crease as narrow as that distance, but serves its whole
//     disc; so it counts by the distance over the radius, at most 1, and the rest of its own disc may be
//     unlike it. Otherwise its shadow would show as dark discs.
// Weights of the solution below 0, at borders of surfaces, become 0.
//
// Balance. A bright record among dark ones, which found light that few rays find, is mixed with all of them,
// while each of them counts it as one of many: the light would be lost. So the weights of each record in all
// fits are scaled until it is read by as much area as it represents, A_j (squared radius times share):
//
//   sum_i A_i w_ij = A_j for all j, and so sum_i A_i E_i' = sum_j A_j E_j
//
// (R. Sinkhorn, P. Knopp, "Concerning Nonnegative Matrices and Doubly Stochastic Matrices", 1967; P.
// Milanfar, "Symmetrizing Smoothing Filters", 2013). In few rounds, so it holds nearly; and records in
// creases are not scaled up, because others are right to reject their light.
//
// All parts, channels and shares of light groups get the same weights, so components still add up, and the
// errors of records propagate exactly but for the weights' own dependence on the light. Rotational gradients
// are smoothed alike. Translational ones stay: each is valid only up to its own distance.
#include <vector>

#include "solvers/irradiance_cache/records.h"

namespace lucerna::irradiance_cache {

struct SmoothingOptions {
  /// Largest distance of neighbours, over a record's lesser radius; 0: each record keeps its light.
  float reach = 3;
  /// Largest difference between the normals of neighbours, as 1 - cos: 10 degrees.
  float normal_tolerance = 0.015f;
  /// Largest distance of a neighbour from the plane midway between the tangent planes, over the lesser
  /// radius.
  float off_plane = 0.1f;
};

/// Light for Records::publish(). Crowded records, records without a radius, and records without neighbours
/// keep theirs bit by bit; the first two serve no neighbour, and neither do records in another medium.
PublishedLight smooth(const RawRecords& raw, const SmoothingOptions& options);

}  // namespace lucerna::irradiance_cache
