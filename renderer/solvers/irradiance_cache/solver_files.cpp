// The cache kept as a file: what it was made of, and what must agree with that.
#include <set>

#include "base/log.h"
#include "solvers/irradiance_cache/file.h"
#include "solvers/irradiance_cache/info.h"
#include "solvers/irradiance_cache/solver.h"

namespace lucerna::irradiance_cache {
namespace {

/// Options that decide how many records there are, not what one holds.
const std::set<std::string> k_amounts{"cache.max_records", "cache.passes", "cache.stop", "cache.candidates",
                                      "cache.irradiance_weight"};

MadeWith current_provenance(const Cache& cache, const OptionValues& settings,
                            const solvers::Provenance& provenance) {
  MadeWith made_with;
  made_with.scene = provenance.scene;
  made_with.hashes = provenance.hashes;
  for (const OptionInfo& o : info().options)
    if (o.key.starts_with("cache.") && o.restarts && !k_amounts.contains(o.key))
      made_with.settings[o.key] = settings.text(o.key);
  for (const char* key : {"path.max_depth", "path.roulette_depth"})
    made_with.settings[key] = settings.text(key);
  made_with.parts = cache.parts();
  made_with.recursive = cache.recursive(), made_with.elsewhere = cache.elsewhere();
  made_with.seed = settings.text("seed");
  return made_with;
}

/// All that decides which records this picture asks for, as text.
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
  // Of the view that it was complete for it lacks nothing, unless only room was missing then.
  const bool full = saved.status.stop == StopReason::records;
  const bool complete =
      saved.view == view_text(settings, provenance) && (!full || saved.records.size() == room);
  const uint32_t count = saved.records.size();
  // Places serve whatever groups there are; where these are others begin() has their light gathered anew.
  grouping_ = saved.grouping;
  const bool regroups = cache_.records().groups() > 1 && grouping_ != light_grouping(picture.flat);
  cache_.restore(wavefront, std::move(saved.records), saved.status, complete);
  log::info(
      "{}: {} records{}{}", file, count,
      regroups   ? "; their light is gathered anew by groups of lights"
      : complete ? ", complete for this view"
                 : "; what this view is missing is added",
      saved.made_with.seed == settings.text("seed") ? "" : " (made with seed " + saved.made_with.seed + ")");
}

}  // namespace lucerna::irradiance_cache
