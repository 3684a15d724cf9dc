#include "solvers/irradiance_cache/inspector.h"

#include <algorithm>
#include <cmath>

#include "gpu/stream.h"
#include "overlay/painter.h"

namespace lucerna::irradiance_cache {

using namespace shared;

namespace {

constexpr uint64_t k_inspection_bytes = sizeof(InspectHeader) + k_inspect_most * sizeof(InspectServing);
constexpr vec3 k_line_ink{1.0f, 0.86f, 0.45f};
constexpr float k_least_weight = 0.004f;  // of lines; thinner ones would be invisible

}  // namespace

struct Inspector::Impl {
  gpu::Device& device;
  gpu::ShaderCompiler& compiler;
  struct {
    gpu::Kernel inspect, overlap, look_up, lines, normals;
  } kernels;  // compiled at the first use
  struct {
    gpu::Buffer inspection, overlap, looked_up, lines, segments;
  } buffers;
  overlay::Painter painter;
  gpu::Resources resources;

  Impl(gpu::Device& d, gpu::ShaderCompiler& c) : device(d), compiler(c), painter(d, c) {}

  const gpu::Kernel& ready(gpu::Kernel& kernel, const char* file) {
    // The light of records is not read here: none of that code is compiled in.
    if (!kernel)
      kernel = gpu::Kernel(device, compiler, file,
                           {{"LUCERNA_CACHE_PARTS", "0u"}, {"LUCERNA_CACHE_ELLIPSES", "1"}});
    return kernel;
  }

  gpu::Buffer& ready(gpu::Buffer& buffer, const char* name, uint64_t bytes, gpu::Memory memory) {
    gpu::make_room(device, buffer, {.name = name, .bytes = bytes, .memory = memory});
    return buffer;
  }

  SightGrid bind(const overlay::Canvas& canvas, const Cache& cache) {
    canvas.bind(resources);
    cache.bind(resources);
    return cache.bind_sight(resources);
  }
};

Inspector::Inspector(gpu::Device& device, gpu::ShaderCompiler& compiler)
    : impl_(new Impl(device, compiler)) {}
Inspector::~Inspector() = default;

Inspection Inspector::inspect(const overlay::Canvas& sheet, const Cache& cache, uint32_t x, uint32_t y) {
  Impl& i = *impl_;
  const overlay::Canvas canvas = sheet.at_film();
  const film::Film& film = canvas.film;
  const gpu::Kernel& kernel = i.ready(i.kernels.inspect, "irradiance_cache/inspect.comp");
  const InspectPush push{film.width(), film.height(), y * film.width() + x, i.bind(canvas, cache)};
  i.resources.set("Inspection",
                  i.ready(i.buffers.inspection, "cache inspection", k_inspection_bytes, gpu::Memory::host));
  canvas.stream().dispatch(kernel, i.resources, push, 1);
  canvas.finish();

  const auto* header = static_cast<const InspectHeader*>(i.buffers.inspection.mapped());
  const auto* served = reinterpret_cast<const InspectServing*>(header + 1);
  Inspection found;
  found.x = x, found.y = y;
  found.solid = header->solid != 0;
  if (!found.solid) return found;
  found.lookup = header->lookup;
  found.surface.position = header->position, found.surface.normal = header->normal;
  found.surface.size = header->size, found.surface.depth = header->depth;
  found.count = header->count, found.gathers = header->gathers != 0;
  const uint32_t listed = std::min(found.count, k_inspect_most);
  double sum = 0;
  for (uint32_t k = 0; k < listed; ++k) {
    const InspectServing& s = served[k];
    found.serving.push_back({s.record, s.weight, s.at, s.depth});
    sum += double{s.weight};
  }
  for (Serving& s : found.serving) s.weight = float(s.weight / sum);
  std::stable_sort(found.serving.begin(), found.serving.end(),
                   [](const Serving& a, const Serving& b) { return a.weight > b.weight; });
  if (header->under != k_no_record)
    found.under = {.index = header->under,
                   .record = cache.records().read(header->under),
                   .read = cache.records().published_luminance(header->under),
                   .at = vec2(header->under_at)};
  return found;
}

Overlap Inspector::overlap(const overlay::Canvas& sheet, const Cache& cache) {
  Impl& i = *impl_;
  const overlay::Canvas canvas = sheet.at_film();
  const film::Film& film = canvas.film;
  const gpu::Kernel& kernel = i.ready(i.kernels.overlap, "irradiance_cache/overlap.comp");
  const OverlapPush push{film.width(), film.height(), i.bind(canvas, cache)};
  const gpu::Buffer& counts =
      i.ready(i.buffers.overlap, "cache overlap", sizeof(OverlapCounts), gpu::Memory::host);
  i.resources.set("Overlap", counts);
  canvas.stream().fill(counts, 0);
  canvas.stream().dispatch(kernel, i.resources, push,
                           gpu::groups_for(uint64_t{film.width()} * film.height(), 64));
  canvas.finish();

  const auto* c = static_cast<const OverlapCounts*>(counts.mapped());
  Overlap o;
  o.histogram.assign(std::begin(c->pixels), std::end(c->pixels));
  for (const uint32_t n : o.histogram) o.pixels += n;
  o.served = o.pixels - o.histogram[0], o.gathered = c->gathered;
  o.mean = o.served > 0 ? double(value(c->records)) / double(o.served) : 0;
  o.listed = o.pixels > 0 ? double(value(c->listed)) / double(o.pixels) : 0;
  o.most = c->most;
  return o;
}

void Inspector::look_up(const overlay::Canvas& sheet, const Cache& cache, const gpu::Defines& defines) {
  Impl& i = *impl_;
  const overlay::Canvas canvas = sheet.at_film();
  const film::Film& film = canvas.film;
  const uint64_t pixels = uint64_t{film.width()} * film.height();
  if (!i.kernels.look_up)
    i.kernels.look_up = gpu::Kernel(i.device, i.compiler, "irradiance_cache/lookups.comp", defines);
  const OverlapPush push{film.width(), film.height(), i.bind(canvas, cache)};
  i.resources.set("LookedUp",
                  i.ready(i.buffers.looked_up, "cache lookups", pixels * sizeof(float), gpu::Memory::device));
  canvas.stream().dispatch(i.kernels.look_up, i.resources, push, gpu::groups_for(pixels, 64));
  canvas.finish();
}

void Inspector::draw_lines(const overlay::Canvas& canvas, const Cache& cache, const Inspection& found) {
  if (!found.solid) return;
  Impl& i = *impl_;
  // Found in pixels of the film.
  const auto scale = float(canvas.scale());
  const float width = float(canvas.width()), height = float(canvas.height());
  const vec2 here = scale * (vec2(found.x, found.y) + 0.5f);
  vec2 lo = here - 4.0f, hi = here + 4.0f;
  const auto cover = [&](const vec2& p, float reach) {
    // A centre may be far outside the picture.
    const vec2 inside = glm::clamp(p, vec2(-1e4f), vec2(1e5f));
    lo = glm::min(lo, inside - reach), hi = glm::max(hi, inside + reach);
  };
  std::vector<OverlayLine> list;
  for (auto s = found.serving.rbegin(); s != found.serving.rend(); ++s) {  // heaviest last, on top
    if (s->weight < k_least_weight || s->depth <= 0) continue;
    const float strength = std::sqrt(s->weight / found.serving.front().weight);
    const vec2 centre = scale * s->at;
    list.push_back({here, centre, found.surface.depth, s->depth, 0.4f + 1.2f * strength,
                    0.3f + 0.65f * strength, k_line_ink});
    cover(centre, 4);
    // Its centre: a point.
    list.push_back({centre, centre, s->depth, s->depth, 1.5f + strength, 0.5f + 0.5f * strength, k_line_ink});
  }
  list.push_back({here, here, found.surface.depth, found.surface.depth, 2.0f, 1.0f, vec3(1)});
  if (found.under)
    cover(scale * found.under->at,
          1.5f * scale * found.under->record.radius / std::max(found.surface.size, 1e-20f) + 4);

  const vec2 first = glm::clamp(glm::floor(lo), vec2(0), vec2(width, height));
  const vec2 last = glm::clamp(glm::ceil(hi), vec2(0), vec2(width, height));
  const vec2 size = last - first;
  if (size.x < 1 || size.y < 1) return;
  const gpu::Kernel& kernel = i.ready(i.kernels.lines, "irradiance_cache/lines.comp");
  i.bind(canvas, cache);
  gpu::Buffer& lines = i.ready(i.buffers.lines, "cache lines", (2 * k_inspect_most + 1) * sizeof(OverlayLine),
                               gpu::Memory::host);
  lines.write(list.data(), list.size() * sizeof(OverlayLine));
  i.resources.set("OverlayLines", lines);
  const CacheLinesPush push{canvas.width(),        canvas.height(),
                            uint32_t(first.x),     uint32_t(first.y),
                            uint32_t(size.x),      uint32_t(size.y),
                            uint32_t(list.size()), found.under ? found.under->index : k_no_record};
  canvas.stream().dispatch(kernel, i.resources, push,
                           gpu::groups_for(uint64_t(size.x) * uint64_t(size.y), 64));
  canvas.finish();
}

void Inspector::draw_normals(const overlay::Canvas& canvas, const Cache& cache, uint32_t color) {
  // Complete records only: the others have no radius yet.
  const uint32_t records = cache.status().records;
  if (records == 0) return;
  Impl& i = *impl_;
  const gpu::Kernel& kernel = i.ready(i.kernels.normals, "irradiance_cache/normals.comp");
  i.bind(canvas, cache);
  i.resources.set("OverlaySegments", i.ready(i.buffers.segments, "cache normals",
                                             records * sizeof(OverlaySegment), gpu::Memory::device));
  const auto [lo, hi] = cache.scale(color);
  const CacheNormalsPush push{canvas.width(), canvas.height(), records, color, lo, hi};
  canvas.stream().dispatch(kernel, i.resources, push, gpu::groups_for(records, 64));
  i.painter.draw(canvas, {.points = {}, .segments = {&i.buffers.segments, records}, .discs = {}},
                 {.edge_alpha = 0.4f});
}

}  // namespace lucerna::irradiance_cache
