#pragma once
// What a change leaves of an irradiance cache: the invalidation matrix. The renderer asks here, and nowhere
// else, what to keep; tests/images/cache_invalidation_test.cpp goes through it row by row.
//
// Of a record a change may spoil three things, each without the ones before it:
//   coverage  records serve on as they are; the picture may ask where none serves, so passes are added
//   light     places and distances stand, and radii unless the light decides them (Metric::hessian); the
//             rays over the hemispheres are traced again, level by level, in the order in which the records
//             came, so that those that read others find them relit
//   places    where records lie and how far they serve: the cache begins anew
//
// Lights and materials move no surface: whatever rays measured of the scene's shape stays true. With light
// groups (shaders/shared/irradiance_cache.h) a change of one group's strength would spoil nothing at all, and
// one of its lamps the light of its parts alone.
#include <span>
#include <string_view>

namespace lucerna::irradiance_cache {

struct Spoilt {
  bool coverage = false, light = false, places = false;
  Spoilt& operator|=(const Spoilt& o) {
    coverage |= o.coverage, light |= o.light, places |= o.places;
    return *this;
  }
  bool operator==(const Spoilt&) const = default;
};
inline constexpr Spoilt k_spoils_nothing{};
inline constexpr Spoilt k_spoils_coverage{.coverage = true};
inline constexpr Spoilt k_spoils_light{.light = true};
inline constexpr Spoilt k_spoils_light_and_coverage{.coverage = true, .light = true};
inline constexpr Spoilt k_spoils_all{.coverage = true, .light = true, .places = true};

struct Change {
  /// An edit in words ("lamp"), or the settings that begin with this ("cache.rays", "overlay.").
  std::string_view what;
  bool setting;
  Spoilt spoils;
  std::string_view why;
};

/// All rows.
std::span<const Change> changes();
/// Of an edit: one of the rows that are no settings (an assertion).
Spoilt spoilt_by_edit(std::string_view what);
/// Of a setting: of the rows that its key begins with, the longest; everything where there is none.
/// `components.*` spoil nothing here: what records lack of what is then looked up is known only when the
/// cache is made for it (Cache::adopt).
Spoilt spoilt_by_setting(std::string_view key);

}  // namespace lucerna::irradiance_cache
