// All macros that select kernel variants, with default 0. Include it before the first #if that tests one of them: testing an
// undefined macro is an error (renderer/gpu/kernel.h).
#ifndef LUCERNA_LIB_VARIANTS
#define LUCERNA_LIB_VARIANTS

// Features of the scene (renderer/upload/device_scene.cpp).
#ifndef LUCERNA_LIGHTS
#define LUCERNA_LIGHTS 0
#endif
#ifndef LUCERNA_EMISSIVE
#define LUCERNA_EMISSIVE 0
#endif
// Lamps with a shape (lib/shapes.glsl).
#ifndef LUCERNA_SHAPES
#define LUCERNA_SHAPES 0
#endif
// Lamps with a measured distribution (lib/profiles.glsl).
#ifndef LUCERNA_PROFILES
#define LUCERNA_PROFILES 0
#endif
// Spots with a picture (lib/pictures.glsl).
#ifndef LUCERNA_PICTURES
#define LUCERNA_PICTURES 0
#endif
// All emissive surfaces are opaque and emit uniformly.
#ifndef LUCERNA_PLAIN_EMITTERS
#define LUCERNA_PLAIN_EMITTERS 0
#endif
#ifndef LUCERNA_ENVIRONMENT_MAP
#define LUCERNA_ENVIRONMENT_MAP 0
#endif
#ifndef LUCERNA_SEPARATE_SKY
#define LUCERNA_SEPARATE_SKY 0
#endif
#ifndef LUCERNA_SUN
#define LUCERNA_SUN 0
#endif
// Number of portals through which the sky is sampled.
#ifndef LUCERNA_PORTALS
#define LUCERNA_PORTALS 0
#endif
#ifndef LUCERNA_LAMP_CANDIDATES
#define LUCERNA_LAMP_CANDIDATES 0
#endif
#ifndef LUCERNA_LEARNED
#define LUCERNA_LEARNED 0
#endif
#ifndef LUCERNA_SKY_SQUARES
#define LUCERNA_SKY_SQUARES 0
#endif
#ifndef LUCERNA_TRIANGLE_CANDIDATES
#define LUCERNA_TRIANGLE_CANDIDATES 0
#endif
#ifndef LUCERNA_LIGHT_GROUPS
#define LUCERNA_LIGHT_GROUPS 0
#endif
#ifndef LUCERNA_GROUP_SUMS
#define LUCERNA_GROUP_SUMS 0
#endif
// Number of layers by path expressions (lib/layers.glsl).
#ifndef LUCERNA_WORD_LAYERS
#define LUCERNA_WORD_LAYERS 0
#endif
#ifndef LUCERNA_SPECULAR
#define LUCERNA_SPECULAR 0
#endif
#ifndef LUCERNA_SOLID_GLASS
#define LUCERNA_SOLID_GLASS 0
#endif
#ifndef LUCERNA_THIN_GLASS
#define LUCERNA_THIN_GLASS 0
#endif
#ifndef LUCERNA_GLASS_SPECULAR
#define LUCERNA_GLASS_SPECULAR 0
#endif
#ifndef LUCERNA_DIFFUSE_TRANSMISSION
#define LUCERNA_DIFFUSE_TRANSMISSION 0
#endif
#ifndef LUCERNA_VOLUMES
#define LUCERNA_VOLUMES 0
#endif
#ifndef LUCERNA_MEDIA
#define LUCERNA_MEDIA 0
#endif
#ifndef LUCERNA_UNLIT
#define LUCERNA_UNLIT 0
#endif
#ifndef LUCERNA_ALPHA
#define LUCERNA_ALPHA 0
#endif
#ifndef LUCERNA_NORMAL_MAPS
#define LUCERNA_NORMAL_MAPS 0
#endif
#ifndef LUCERNA_VERTEX_EXTRA
#define LUCERNA_VERTEX_EXTRA 0
#endif
#ifndef LUCERNA_TEX_BASE
#define LUCERNA_TEX_BASE 0
#endif
#ifndef LUCERNA_TEX_METALLIC_ROUGHNESS
#define LUCERNA_TEX_METALLIC_ROUGHNESS 0
#endif
#ifndef LUCERNA_TEX_EMISSION
#define LUCERNA_TEX_EMISSION 0
#endif
#ifndef LUCERNA_TEX_SPECULAR
#define LUCERNA_TEX_SPECULAR 0
#endif
#ifndef LUCERNA_TEX_TRANSMISSION
#define LUCERNA_TEX_TRANSMISSION 0
#endif
#ifndef LUCERNA_TEX_DIFFUSE_TRANSMISSION
#define LUCERNA_TEX_DIFFUSE_TRANSMISSION 0
#endif
#ifndef LUCERNA_TANGENTS
#define LUCERNA_TANGENTS 0
#endif
#ifndef LUCERNA_ROUGH_DIFFUSE
#define LUCERNA_ROUGH_DIFFUSE 0
#endif
#ifndef LUCERNA_TEX_DIFFUSE_ROUGHNESS
#define LUCERNA_TEX_DIFFUSE_ROUGHNESS 0
#endif
#ifndef LUCERNA_CATCHER
#define LUCERNA_CATCHER 0
#endif
#ifndef LUCERNA_HEIGHTS
#define LUCERNA_HEIGHTS 0
#endif
#ifndef LUCERNA_PARALLAX
#define LUCERNA_PARALLAX 0
#endif
#ifndef LUCERNA_CLEARCOAT
#define LUCERNA_CLEARCOAT 0
#endif
#ifndef LUCERNA_TEX_CLEARCOAT
#define LUCERNA_TEX_CLEARCOAT 0
#endif
#ifndef LUCERNA_CLEARCOAT_NORMALS
#define LUCERNA_CLEARCOAT_NORMALS 0
#endif
#ifndef LUCERNA_SHEEN
#define LUCERNA_SHEEN 0
#endif
#ifndef LUCERNA_TEX_SHEEN
#define LUCERNA_TEX_SHEEN 0
#endif
#ifndef LUCERNA_ANISOTROPY
#define LUCERNA_ANISOTROPY 0
#endif
#ifndef LUCERNA_TEX_ANISOTROPY
#define LUCERNA_TEX_ANISOTROPY 0
#endif
#ifndef LUCERNA_DISPERSION
#define LUCERNA_DISPERSION 0
#endif
#ifndef LUCERNA_IRIDESCENCE
#define LUCERNA_IRIDESCENCE 0
#endif
#ifndef LUCERNA_TEX_IRIDESCENCE
#define LUCERNA_TEX_IRIDESCENCE 0
#endif
#ifndef LUCERNA_UV_TRANSFORMS
#define LUCERNA_UV_TRANSFORMS 0
#endif
#ifndef LUCERNA_TEX_NEAREST
#define LUCERNA_TEX_NEAREST 0
#endif
#ifndef LUCERNA_TEX_WRAPS
#define LUCERNA_TEX_WRAPS 0
#endif
#ifndef LUCERNA_BUCKETS
#define LUCERNA_BUCKETS 0
#endif

// Classes of hits that a kernel shades (renderer/transport/hit_classes.h): paths that leave the scene, surfaces, emitters,
// emitters that light samples reach; and properties of the other hits.
#ifndef LUCERNA_HITS_SKY
#define LUCERNA_HITS_SKY 1
#endif
#ifndef LUCERNA_HITS_SURFACES
#define LUCERNA_HITS_SURFACES 1
#endif
#ifndef LUCERNA_HITS_EMISSIVE
#define LUCERNA_HITS_EMISSIVE LUCERNA_EMISSIVE
#endif
#ifndef LUCERNA_HITS_LIT
#define LUCERNA_HITS_LIT LUCERNA_LIGHTS
#endif
#ifndef LUCERNA_SCENE_GLOSSY
#define LUCERNA_SCENE_GLOSSY (LUCERNA_SPECULAR || LUCERNA_SOLID_GLASS || LUCERNA_THIN_GLASS)
#endif
#ifndef LUCERNA_COUNT_KINDS
#define LUCERNA_COUNT_KINDS 0
#endif

// Features of the device (renderer/gpu/kernel.cpp).
#ifndef LUCERNA_SUBGROUPS
#define LUCERNA_SUBGROUPS 0
#endif

// Set by settings and tests.
#ifndef LUCERNA_PHOTON_IRRADIANCE
#define LUCERNA_PHOTON_IRRADIANCE 0
#endif
#ifndef LUCERNA_LOOKUP_BIAS
#define LUCERNA_LOOKUP_BIAS 0
#endif
#ifndef LUCERNA_CACHE_ELLIPSES
#define LUCERNA_CACHE_ELLIPSES 0
#endif
#ifndef LUCERNA_CACHE_GATHERS
#define LUCERNA_CACHE_GATHERS 0
#endif
#ifndef LUCERNA_HIDDEN_BACKGROUND
#define LUCERNA_HIDDEN_BACKGROUND 0
#endif
#ifndef LUCERNA_COHERENT
#define LUCERNA_COHERENT 0
#endif
#ifndef LUCERNA_NO_AUTOMATON
#define LUCERNA_NO_AUTOMATON 0
#endif

// The film's kernels.
#ifndef LUCERNA_FILM_IMAGES
#define LUCERNA_FILM_IMAGES 0
#endif
#ifndef LUCERNA_FILM_LANES
#define LUCERNA_FILM_LANES 0
#endif
#ifndef LUCERNA_FILM_LAYER
#define LUCERNA_FILM_LAYER 0
#endif
#ifndef LUCERNA_ERROR_LAYERS
#define LUCERNA_ERROR_LAYERS 0
#endif
#ifndef LUCERNA_FILM_UNMIXED  // compact groups: ignores their mix
#define LUCERNA_FILM_UNMIXED 0
#endif
#ifndef LUCERNA_VERTEX_COUNT
#define LUCERNA_VERTEX_COUNT 0
#endif
#ifndef LUCERNA_TONE_CURVE
#define LUCERNA_TONE_CURVE 0
#endif
#ifndef LUCERNA_LOOKUP_ERRORS
#define LUCERNA_LOOKUP_ERRORS 0
#endif
#ifndef LUCERNA_STOPPING_ONLY
#define LUCERNA_STOPPING_ONLY 0
#endif

// The camera has a lens (Frame::lens_radius).
#ifndef LUCERNA_THIN_LENS
#define LUCERNA_THIN_LENS 0
#endif

// The view is cut (Frame::section_normal).
#ifndef LUCERNA_SECTION
#define LUCERNA_SECTION 0
#endif

// Light tracing: splats read by camera paths, and targets of connected light.
#ifndef LUCERNA_SPLATS
#define LUCERNA_SPLATS 0
#endif
#ifndef LUCERNA_SPLATS_SUMMED
#define LUCERNA_SPLATS_SUMMED 0
#endif
#ifndef LUCERNA_SPLATS_WEIGHED
#define LUCERNA_SPLATS_WEIGHED 0
#endif

// Eye paths are recorded (lib/path_events.glsl).
#ifndef LUCERNA_PATH_EVENTS
#define LUCERNA_PATH_EVENTS 0
#endif

// Photons: regions whose light is delegated to eye paths.
#ifndef LUCERNA_DELEGATED_REGIONS
#define LUCERNA_DELEGATED_REGIONS 0
#endif

// The tracer (lib/bvh.glsl).
#ifndef LUCERNA_QUERY
#define LUCERNA_QUERY 0
#endif
#ifndef LUCERNA_NON_OPAQUE
#define LUCERNA_NON_OPAQUE 0
#endif
#ifndef LUCERNA_FETCH_STORAGE
#define LUCERNA_FETCH_STORAGE 0
#endif
#ifndef LUCERNA_COUNT_BVH
#define LUCERNA_COUNT_BVH 0
#endif
#ifndef LUCERNA_STACK_LOCAL
#define LUCERNA_STACK_LOCAL 0
#endif
#ifndef LUCERNA_ROUNDED_EDGES
#define LUCERNA_ROUNDED_EDGES 0
#endif

// Sort, octree and cache.
#ifndef LUCERNA_SORT_WIDE
#define LUCERNA_SORT_WIDE 0
#endif
#ifndef LUCERNA_OCTREE_SINGLE
#define LUCERNA_OCTREE_SINGLE 0
#endif
#ifndef LUCERNA_OCTREE_DISCS
#define LUCERNA_OCTREE_DISCS 0
#endif
#ifndef LUCERNA_WRITE
#define LUCERNA_WRITE 0
#endif
#ifndef LUCERNA_FROM_SCREEN
#define LUCERNA_FROM_SCREEN 0
#endif

// Benches.
#ifndef LUCERNA_NEIGHBOURS
#define LUCERNA_NEIGHBOURS 0
#endif
#ifndef LUCERNA_COPIES
#define LUCERNA_COPIES 0
#endif

// Derived from these.
#define LUCERNA_GLASS (LUCERNA_SOLID_GLASS || LUCERNA_THIN_GLASS)
// Lobes above the base material, which it is seen through.
#define LUCERNA_LAYERS (LUCERNA_CLEARCOAT || LUCERNA_SHEEN)
#define LUCERNA_TRANSPARENT (LUCERNA_ALPHA || LUCERNA_THIN_GLASS)
// The sky is sampled through portals.
#define LUCERNA_SKY_PORTALS (LUCERNA_PORTALS && LUCERNA_ENVIRONMENT_MAP && !LUCERNA_SEPARATE_SKY)
// Light samples of emissive triangles read their surface, for textures and holes.
#define LUCERNA_LIGHT_SURFACE \
  (LUCERNA_EMISSIVE && !LUCERNA_PLAIN_EMITTERS && (LUCERNA_TEX_EMISSION || LUCERNA_ALPHA || LUCERNA_VERTEX_EXTRA))

#endif
