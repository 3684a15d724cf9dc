#pragma once
// Pictures with the irradiance cache, for tests that edit the scene.
#include "support/records.h"
#include "support/render.h"

namespace lucerna::test {

/// Every component that can be cached.
inline const Settings k_cached{{"components.secondary", "cache"}, {"components.tertiary", "cache"}};

/// Shows a scene of the test; on destruction no validation message may exist. `validated`: use the validation
/// layers, which take half of the time. `interactive`: as for a window, with preview samples.
struct CacheRenderer {
  session::Renderer r;
  /// As from a file beside the scene: used where nothing else is set.
  static auto scene_settings() {
    std::vector<session::SettingChange> all{{"cache.max_records", k_room, ""}};
    for (const auto& [key, value] : k_dense_records) all.push_back({key, value, ""});
    return all;
  }
  CacheRenderer(const scene::Scene& scene, uint32_t size, bool validated = true, bool interactive = false)
      : r(test::renderer_options(validated, {}, interactive)) {
    r.set_size(size, size);
    r.settings().set("path.batch", "8192");
    r.set_scene(std::make_shared<scene::Scene>(scene), {}, scene_settings());
  }
  ~CacheRenderer() { CHECK(r.device().validation_messages() == 0); }
  void set(const Settings& settings) { test::set(r, settings); }
  film::Image finish() { return test::finish(r); }
  const irradiance_cache::CacheStatus& status() const { return test::cache(r)->status(); }
  irradiance_cache::RawRecords records() const {
    return test::cache(r)->records().raw(test::cache(r)->records().size());
  }
};

}  // namespace lucerna::test
