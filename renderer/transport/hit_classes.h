#pragma once
// Choice of shading kernels. The scene's material kinds (upload/material_kinds.h) with the most hits get
// separate kernels that compile in nothing else. Other kinds join the class that has all their features and
// the fewest others, or use the kernel for all hits. Pure; shading is bit-identical in every class that may
// take a hit.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "gpu/kernel.h"
#include "shaders/shared/scene.h"

namespace lucerna::transport {

struct HitClass {
  uint32_t features = 0;  ///< upload::MaterialFeature, union over its kinds
  bool sky = false;       ///< only paths that leave the scene
  bool operator==(const HitClass&) const = default;
};

struct HitClasses {
  std::vector<HitClass> classes;  ///< at most shared::k_hit_classes - 1
  /// By kind: 0: no class, else 1 + number of its class.
  std::array<uint32_t, shared::k_hit_kinds> of_kind{};
  bool operator==(const HitClasses&) const = default;
};

/// Minimum share of hits of a kind with a class.
inline constexpr double k_least_class_share = 0.03;

/// Minimum mean number of features (lobes and textures) omitted per hit; with fewer, sorting takes longer
/// than it saves.
inline constexpr double k_least_left_out = 0.5;

/// `features`: by kind; `hits`: number by kind, shared::k_hit_kinds of them. No classes if they save nothing.
HitClasses choose_hit_classes(std::span<const uint32_t> features, std::span<const uint64_t> hits);

/// transport::ClassesPush::classes.
std::array<uint32_t, 4> packed(const HitClasses& classes);

/// Kinds (bits) of surfaces at which paths of which only emission counts need no shading, because they
/// neither emit nor let rays pass (transport::ClassesPush).
struct DarkKinds {
  uint32_t diffuse = 0;  ///< with diffuse lobes alone: where only further diffuse events bring no light
  uint32_t all = 0;      ///< with any lobes: where no further event does
};
/// `features`: by kind. None where kernels compiled with these defines do more at a hit: record paths, or add
/// lamps that the ray has passed.
DarkKinds dark_kinds(std::span<const uint32_t> features, const gpu::Defines& all);

/// Defines of a class's kernel; `all`: of the kernel for all hits.
gpu::Defines defines_of(const HitClass& hits, const gpu::Defines& all);

}  // namespace lucerna::transport
