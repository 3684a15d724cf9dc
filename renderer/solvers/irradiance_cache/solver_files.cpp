// Cache files: saving, and loading with a check of what the records were made with.
#include <set>

#include "base/log.h"
#include "solvers/irradiance_cache/file.h"
#include "solvers/irradiance_cache/info.h"
#include "solvers/irradiance_cache/solver.h"

namespace lucerna::irradiance_cache {
namespace {

/// Options that affect the number of records, not their contents.
const std::set<std::string> k_amounts{"cache.max_records", "cache.passes", "cache.stop",
                                      "cache.irradiance_weight"};
/// Changes no record.
constexpr const char* k_of_lookups = "cache.smooth";

MadeWith current_provenance(const Cache& cache, const OptionValues& settings,
                            const solvers::Provenance& provenance) {
  MadeWith made_with;
  made_with.scene = provenance.scene;
  made_with.hashes = provenance.hashes;
  for (const OptionInfo& o : info().options)
    if (o.key.starts_with("cache.") && o.restarts && !k_amounts.contains(o.key) && o.key != k_of_lookups)
      made_with.settings[o.key] = settings.text(o.key);
  for (const char* key : {"path.max_depth", "path.roulette_depth"})
    made_with.settings[key] = settings.text(key);
  made_with.parts = cache.parts();
  made_with.recursive = cache.recursive(), made_with.elsewhere = cache.elsewhere();
  made_with.seed = settings.text("seed");
  return made_with;
}

/// Everything that determines which records this picture needs, as text.
std::string view_text(const OptionValues& settings, const solvers::Provenance& provenance) {
  std::string text = fmt::format("{} seed {}", provenance.view, settings.text("seed"));
  for (const std::string& key : k_amounts)
    if (key != "cache.max_records") text += fmt::format(" {} {}", key, settings.text(key));
  for (const char* name : paths::k_component_names)
    text += fmt::format(" {} {}", name, settings.text(std::string("components.") + name));
  return text;
}

}  // namespace

void CacheSolver::save(const std::string& file, const solvers::Picture& picture,
                       const solvers::Provenance& provenance) const {
  const CacheStatus& status = cache_.status();
  if (!cache_.ready())
    throw_error(file,
                "the cache is still being built (pass {}, {} records so far); save it once the picture has "
                "samples",
                status.pass + 1, status.records);
  const OptionValues& settings = picture.task.settings;
  write_cache(file, {.program = LUCERNA_VERSION,
                     .made_with = current_provenance(cache_, settings, provenance),
                     .view = view_text(settings, provenance),
                     .status = status,
                     .grouping = light_grouping(picture.flat),
                     .records = cache_.records().raw(status.records)});
}

void CacheSolver::load(const std::string& file, transport::Wavefront& wavefront,
                       const solvers::Picture& picture, const solvers::Provenance& provenance) {
  const OptionValues& settings = picture.task.settings;
  CacheFile saved = read_cache(file);
  const uint32_t room = cache_.records().capacity();
  check_fits(saved, current_provenance(cache_, settings, provenance), room, file);
  // It is complete for the view it was saved for, unless it was full then.
  const bool full = saved.status.stop == StopReason::records;
  const bool complete =
      saved.view == view_text(settings, provenance) && (!full || saved.records.size() == room);
  const uint32_t count = saved.records.size();
  // Places serve any grouping of lights; if it differs, begin() gathers their light again.
  grouping_ = saved.grouping;
  const bool regroups = cache_.records().groups() > 1 && grouping_ != light_grouping(picture.flat);
  cache_.restore(wavefront, std::move(saved.records), saved.status, complete);
  log::info(
      "{}: {} records{}{}", file, count,
      regroups   ? "; their light is gathered again by light groups"
      : complete ? ", complete for this view"
                 : "; missing records of this view are added",
      saved.made_with.seed == settings.text("seed") ? "" : " (made with seed " + saved.made_with.seed + ")");
}

}  // namespace lucerna::irradiance_cache
