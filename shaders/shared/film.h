// Layout of the film, and parameters of tone mapping. Read by C++ and GLSL.
#ifndef LUCERNA_SHARED_FILM_H
#define LUCERNA_SHARED_FILM_H
#include "shaders/shared/compat.h"
#include "shaders/shared/lanes.h"
#include "shaders/shared/seen_error.h"
LUCERNA_SHARED_BEGIN

/// Sum of half of a pixel's samples of one component: the value is sum + compensation. Radiance.
struct FilmHalf {
  vec3 sum;
  vec3 compensation;
};

/// A block of 8x8 pixels, the unit of work: its number, in raster order, and the first sample to take for its pixels.
struct WorkBlock {
  uint index;
  uint first_sample;
};
LUCERNA_CONST uint k_block = 8u;  ///< pixels along its side

LUCERNA_CONST uint k_coarse_step = 4u;  ///< width of a pixel of the coarse film, in pixels of the film

struct FilmPush {
  uint width, height;
  uint pixel_count;      ///< slots a sample: 64 for each block of the item
  uint sample_count;     ///< samples a pixel; 0, with groups by component: only mixes the groups again,
                         ///< in all blocks
  uint group;            ///< light group, with groups by component; film/add_layer.comp: the layer
  uint quick;            ///< not 0: GroupLights has room for all groups
};

/// Noise statistics of one block, from the two halves of the film. The means A and B of a pixel's halves are independent, so
/// v = ((A - B) / 2)^2 is an unbiased estimate, with one degree of freedom, of the variance of the pixel's mean (A + B) / 2.
/// All in luminance Y (Rec.709); [0] is the sum of the components, [1..4] the components. Sums run over the pixels with
/// samples in both halves. For layers by path expressions there are further ones, a set for each k_error_layers of them,
/// whose [1..4] are these layers; in them only these and `pixels` count.
LUCERNA_CONST uint k_error_layers = 4u;
struct BlockError {
  float pixels;
  float luminance[5];     ///< sum of Y
  float variance[5];      ///< sum of v
  float fourth;           ///< sum of v^2, of [0]: unevenness of the noise
  float difference;       ///< sum of (A - B) / 2, of [0]
  // Relative error r = sqrt(pi/2) min(e, 1), e the error as seen (seen_error.h), of [0], for the four quadrants of 4x4
  // pixels. For Gaussian noise its mean is the relative standard error; r is below 1.26, so no firefly outweighs its
  // neighbours.
  float relative[4];      ///< sum of r
  float quadrant_pixels[4];
  // Errors of lookups, where known, else 0: sums of the squares of lookup noise and of the mean lookup error, by
  // interpolation (BlockLookups; FilmLookups) and by blur (FilmBiasEven, FilmBiasOdd), which may be negative by chance; and
  // of these, where visible, relative as e.
  float lookup_noise, interpolation;
  float lookup_noise_relative, interpolation_relative;
  float bias[2];          ///< blur alone, signed: sum of the means of the even and of the odd samples
  /// Where lookup errors are known: luminance of the unmixed light (as in BlockLookups), [0]; `luminance` is that of the
  /// mix.
  float unmixed;
  // The error as seen: sums of e^2, and of e^4 of [0]; number of pixels at least as bright as white, and darker than the
  // floor.
  float seen[5];
  float seen_fourth;
  float white, dark;
};

/// Errors of lookups that are common to all samples, in luminance, summed over pixels of a block. They are not sample noise,
/// and more samples do not reduce them. Pixels that read the same stored light have correlated errors, so larger regions add these
/// sums before squaring. In each of k_lookup_lanes lanes (a multiple of 4, at most 32: a bit each of a word) the error of
/// each stored value has a random sign; two independent paths a pixel, [0] and [1], propagate it, and the mean product of their lanes is
/// the square.
LUCERNA_CONST uint k_lookup_lanes = 16u;
struct BlockLookups {
  float pixels;                            ///< summed pixels, of any size
  float interpolation[2];                  ///< estimated interpolation error
  float noise[2 * k_lookup_lanes];         ///< by path, by lane
  float interpolation_noise[2 * k_lookup_lanes];  ///< noise of `interpolation` from that noise
};

/// Bias that a lookup of secondary or tertiary light adds to its path if it finds nothing (no photons near): far below any
/// real bias, so it vanishes beside one. A block with nothing else has no evidence of its brightness (film/error.h):
/// BlockError::interpolation_relative is then above 0 and at most the second value.
LUCERNA_CONST float k_found_nothing = 1e-15f;
LUCERNA_CONST float k_most_without_evidence = 1e-22f;

struct ErrorPush {
  uint width, height;
  uint block_count;
  float luminance_floor, luminance_white;  ///< floor and white of seen_error.h
  uint lookup_errors;     ///< not 0: FilmLookups is valid
  uint bias;              ///< not 0: FilmBiasEven and FilmBiasOdd are valid
};

/// Radiance of one light group, summed over half of a pixel's samples and all components: three 18-bit mantissas with one
/// exponent (shaders/shared/group_sums.h). All bits 0: no light.
struct GroupSum {
  uint low, high;
};
/// Sums of a compact group at a pixel: a texel, at group * pixels + pixel.
struct GroupSums {
  GroupSum even, odd;
};

/// Mix of light groups for readers of a film: two texels, and one for each weight.
struct GroupMix {
  uint groups;  ///< number of groups whose GroupSums weight the components; 0: `whole` does
  uint pixels;  ///< of the film
  uint pad0, pad1;
  vec4 whole;   ///< factor on the light of a film of one group; else 1
  vec4 weight[k_most_groups];  ///< factor on each group's light
};

/// Mean radiance of one light group at a pixel, all components: halves (r, g), (b, 0). Groups are stored in pairs, a texel
/// each: group 2 p + q at ((p * pixels + pixel) * 2 + q).
struct GroupLight {
  uint rg, b;
};

struct MixPush {
  uint width, height;
  uint groups;           ///< number of light groups
  float exposure;
};

LUCERNA_CONST uint k_layer_beauty = 0u;   ///< sum of the shown components
LUCERNA_CONST uint k_layer_primary = 1u;  ///< ... to 4: one component
LUCERNA_CONST uint k_layer_albedo = 5u;
LUCERNA_CONST uint k_layer_normal = 6u;
LUCERNA_CONST uint k_layer_depth = 7u;
// Heat maps (shared/ramp.h):
LUCERNA_CONST uint k_layer_samples = 8u;
LUCERNA_CONST uint k_layer_error = 9u;
LUCERNA_CONST uint k_layer_cost = 10u;
LUCERNA_CONST uint k_layer_first_own = 11u;  ///< and above: layers by path expressions (shared/layers.h)
/// The sum or a component: of these there are previews and filtered pictures.
LUCERNA_INLINE bool is_component_layer(uint layer) { return layer < k_layer_albedo; }
/// By a path expression.
LUCERNA_INLINE bool is_own_layer(uint layer) { return layer >= k_layer_first_own; }
/// False for features and heat maps.
LUCERNA_INLINE bool is_light_layer(uint layer) { return is_component_layer(layer) || is_own_layer(layer); }

struct TonePush {
  uint width, height;
  uint layer;
  uint show;             ///< bit i: component i is part of the beauty layer
  uint curve;            ///< ToneCurve
  float exposure;        ///< factor, 2^EV
  float scale;           ///< depth: value shown white
  uint coarse_width, coarse_height;  ///< of the coarse film; 0: none
  uint use_coarse_film;  ///< 1: this dispatch reads the coarse film and fills pixels that the film has not reached
};

LUCERNA_SHARED_END
#ifdef __cplusplus
static_assert(sizeof(lucerna::shared::FilmHalf) == 24);
#endif
#endif
