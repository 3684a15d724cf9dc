// The irradiance cache of a renderer as a file.
#include <set>

#include "base/log.h"
#include "scene/hash.h"
#include "session/renderer.h"

namespace lucerna::session {
namespace {

/// Options of the cache that decide how many records there are, not what one holds.
const std::set<std::string> k_amounts{
    "cache.max_records",        "cache.passes",       "cache.stop",          "cache.candidates",
    "cache.candidates_falloff", "cache.depth_weight", "cache.normal_weight", "cache.irradiance_weight"};

}  // namespace

irradiance_cache::Making Renderer::cache_making() const {
  irradiance_cache::Making making;
  making.scene = scene_->name;
  const scene::LightHash hash = scene::light_hash(*scene_);
  making.hashes = {{"geometry", hash.geometry},
                   {"materials", hash.materials},
                   {"lights", hash.lights},
                   {"environment", hash.environment}};
  for (const OptionInfo& o : plan::options())
    if ((o.key.starts_with("cache.") && o.restarts && !k_amounts.contains(o.key)) ||
        o.key == "path.max_depth" || o.key == "path.roulette_depth")
      making.settings[o.key] = settings_.text(o.key);
  making.parts = cache_->parts();
  making.recursive = cache_->recursive();
  making.seed = settings_.text("seed");
  return making;
}

std::string Renderer::cache_view_text() const {
  std::string text = fmt::format("{} {}x{} seed {}", view_text(), width_, height_, settings_.text("seed"));
  for (const std::string& key : k_amounts)
    if (key != "cache.max_records") text += fmt::format(" {} {}", key, settings_.text(key));
  for (const char* name : paths::k_component_names)
    text += fmt::format(" {} {}", name, settings_.text(std::string("components.") + name));
  return text;
}

void Renderer::save_cache(const std::filesystem::path& file) {
  if (!wavefront_) throw Error(file.string(), "there is no cache to save yet; load a scene first");
  if (!cache_)
    throw Error(file.string(),
                "there is no cache to save: no component is computed by 'cache' (components.secondary, "
                "components.tertiary)");
  if (!cache_->ready())
    throw_error(file.string(),
                "the cache is still being built (pass {}, {} records so far); save it once the picture has "
                "samples",
                cache_->status().pass + 1, cache_->status().records);
  irradiance_cache::write_cache(file, {.program = LUCERNA_VERSION,
                                       .making = cache_making(),
                                       .view = cache_view_text(),
                                       .status = cache_->status(),
                                       .records = cache_->records().raw(cache_->status().records)});
}

void Renderer::load_cache(const std::filesystem::path& file) {
  if (!wavefront_) throw Error(file.string(), "a cache is of a scene; load the scene first");
  if (!cache_)
    throw Error(file.string(),
                "nothing would look it up: no component is computed by 'cache' (components.secondary, "
                "components.tertiary)");
  irradiance_cache::CacheFile saved = irradiance_cache::read_cache(file);
  const uint32_t room = cache_->records().capacity();
  irradiance_cache::check_fits(saved, cache_making(), room, file.string());
  // Of the view that it was complete for it lacks nothing, unless only room was missing then.
  const bool full = saved.status.stop == irradiance_cache::StopReason::records;
  const bool complete = saved.view == cache_view_text() && (!full || saved.records.size() == room);
  const uint32_t count = saved.records.size();
  cache_->restore(*wavefront_, std::move(saved.records), saved.status, complete);
  restart(solvers::k_spoils_nothing);
  log::info("{}: {} records{}{}", file.string(), count,
            complete ? ", complete for this view" : "; what this view is missing is added",
            saved.making.seed == settings_.text("seed") ? "" : " (made with seed " + saved.making.seed + ")");
}

}  // namespace lucerna::session
