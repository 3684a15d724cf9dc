// The film's layout and what tone mapping is told. Read by C++ and GLSL.
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

/// A block of 8x8 pixels, the unit of work: which one, in raster order, and the first of the samples that its pixels
/// are to be given.
struct WorkBlock {
  uint index;
  uint first_sample;
};
LUCERNA_CONST uint k_block = 8u;  ///< pixels along its side

LUCERNA_CONST uint k_coarse_step = 4u;  ///< pixels of the film along the side of one of the coarse film

struct FilmPush {
  uint width, height;
  uint pixel_count;      ///< slots a sample: 64 for each block of the item
  uint sample_count;     ///< samples a pixel; 0, where the film keeps groups of lights apart by component: only what the
                         ///< picture makes of them, of all blocks
  uint group;            ///< of lights, where the film keeps them apart by component
  uint quick;            ///< not 0: GroupLights has room for all
};

/// What is known of the noise in one block, from the two halves of the film. A pixel's halves have the means A and B, which
/// are independent, so that v = ((A - B) / 2)^2 is an unbiased estimate, with one degree of freedom, of the variance of the
/// pixel's mean (A + B) / 2. All in luminance Y (Rec.709); [0] is the sum of the components, [1..4] are they.
/// Sums run over the pixels that have samples in both halves.
struct BlockError {
  float pixels;
  float luminance[5];     ///< sum of Y
  float variance[5];      ///< sum of v
  float fourth;           ///< sum of v^2, of [0]: how unevenly the noise is spread
  float difference;       ///< sum of (A - B) / 2, of [0]
  // Relative error r = sqrt(pi/2) min(e, 1), e the error as seen (seen_error.h), of [0], for the four quadrants of 4x4
  // pixels. Its mean is the relative standard error where noise is Gaussian; r stays below 1.26, so that no firefly can
  // outweigh its neighbours.
  float relative[4];      ///< sum of r
  float quadrant_pixels[4];
  // Of what the pixels look up, where that is known, else 0: sums of the squares of the records' noise and of what lookups
  // are off by in the mean, by interpolation (BlockRecords; FilmRecords) and by blur (FilmBiasEven, FilmBiasOdd), which may
  // be below 0 by chance; and of these, where they are seen, over the square of what e is held against.
  float records, interpolation;
  float records_relative, interpolation_relative;
  float bias[2];          ///< blur alone, with its sign: sum of the even samples' mean, of the odd ones'
  /// Where what pixels look up is known: the luminance of the light as it is (BlockRecords is of that), [0], as `luminance`
  /// sums up what is made of it by the mix of groups of lights.
  float unmixed;
  // The error as seen: sums of e^2, and of e^4 of [0]; and how many pixels are no darker than white, are darker than the
  // floor.
  float seen[5];
  float seen_fourth;
  float white, dark;
};

/// What records of light that all samples read may be wrong by, in luminance, summed over pixels of a block: not the
/// samples' noise, and no sample takes it away. Pixels that read one record err together, so that sums over larger regions
/// are sums of these, taken before they are squared. Every record's error is drawn anew in each of k_record_lanes lanes
/// (a multiple of 4, at most 32: a bit each of a word); two independent paths a pixel, [0] and [1], carry it there, so that
/// the mean product of their lanes is the square.
LUCERNA_CONST uint k_record_lanes = 16u;
struct BlockRecords {
  float pixels;                            ///< that are summed, of any size
  float interpolation[2];                  ///< by how much interpolation is told to be off
  float noise[2 * k_record_lanes];         ///< by path, by lane
  float interpolation_noise[2 * k_record_lanes];  ///< of `interpolation`, by noise of the records
};

/// What a lookup of secondary or tertiary light adds to its path's bias when it has found nothing at all (photons that do not
/// lie anywhere near): far below any bias, so that it is lost beside one. A block in which this is all that there is has no
/// evidence of how dark it is (film/error.h): BlockError::interpolation_relative is then above 0 and at most the second value.
LUCERNA_CONST float k_found_nothing = 1e-15f;
LUCERNA_CONST float k_most_without_evidence = 1e-22f;

struct ErrorPush {
  uint width, height;
  uint block_count;
  float luminance_floor, luminance_white;  ///< floor and white of seen_error.h
  uint records;           ///< not 0: FilmRecords is known
  uint bias;              ///< not 0: FilmBiasEven and FilmBiasOdd are
};

/// Radiance of one group of lights, summed over half of a pixel's samples, all components together: three mantissas of 18
/// bits with one exponent (shaders/shared/group_sums.h). All bits 0 is no light.
struct GroupSum {
  uint low, high;
};
/// A group's sums at a pixel where groups are kept in short: a texel, at group * pixels + pixel.
struct GroupSums {
  GroupSum even, odd;
};

/// How groups of lights are mixed where a film is read: two texels, and one for each weight.
struct GroupMix {
  uint groups;  ///< whose sums (GroupSums) the components are to be weighed by; 0: they are to be by `whole`
  uint pixels;  ///< of the film
  uint pad0, pad1;
  vec4 whole;   ///< of a film of one group of lights: what its light is multiplied by; else 1
  vec4 weight[k_most_groups];  ///< what each group's light is multiplied by
};

/// Mean radiance of one group of lights at a pixel, all components: halves (r, g), (b, 0). In pairs of groups, a texel
/// each, pair by pair: group 2 p + q at ((p * pixels + pixel) * 2 + q).
struct GroupLight {
  uint rg, b;
};

struct MixPush {
  uint width, height;
  uint groups;           ///< of lights
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
