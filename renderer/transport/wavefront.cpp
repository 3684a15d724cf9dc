#include "transport/wavefront.h"

#include <algorithm>
#include <bit>
#include <optional>

#include "base/timer.h"
#include "shaders/shared/trace.h"

namespace lucerna::transport {

using namespace shared;

struct Wavefront::Impl {
  gpu::Device& device;
  gpu::ShaderCompiler& compiler;
  gpu::Stream stream;
  HostTrace host_trace;
  uint32_t slots;
  bool transparent = false;
  uint32_t groups = 1;          // separate light groups
  bool compact_groups = false;  // ... with all components together
  uint32_t layers = 0;          // by path expressions
  bool writes_bias = false;
  uint32_t enabled = 15;
  std::vector<uint64_t> in_queue;  // a bit a slot
  uint8_t first_account = 0;
  double compile_seconds = 0;

  gpu::Buffer frame, blocks, rays, hits, paths, radiance, features, shadow_rays, shadow_hits, shadow_states,
      counters, branching, branching_queue, layer_table, layer_radiance;
  std::array<gpu::Buffer, 2> queues, shadow_queues;
  /// Of cameras with a lens (+ 1), and with a section plane (+ 2); those but the first are compiled at the
  /// first frame that needs them.
  std::array<gpu::Kernel, 4> cameras;
  gpu::Defines camera_defines;
  size_t camera_kind = 0;
  gpu::Kernel shade, shadow, film_add, film_add_images, layer_add, layer_add_images, lanes_add,
      lanes_add_images, groups_add, groups_add_images, unmixed_add, unmixed_add_images, trace_closest,
      trace_any, trace_non_opaque;
  std::array<gpu::Resources, 2> main, shade_shadow;  ///< by parity of the queue
  gpu::Resources film_resources;
  std::function<void(gpu::Resources&)> bind_lookup;
  std::optional<HitShading> by_class;
  std::shared_ptr<LightLearning> learning;
  TransportStats stats;

  Impl(gpu::Device& d, gpu::ShaderCompiler& c, uint32_t n, const upload::Effects& effects, HostTrace trace)
      : device(d),
        compiler(c),
        stream(d),
        host_trace(std::move(trace)),
        slots(n),
        groups(effects.light_groups),
        compact_groups(effects.has_compact_groups()),
        layers(effects.layers) {
    const gpu::Memory queue_memory = host_trace ? gpu::Memory::host : gpu::Memory::device;
    const auto make = [&](const char* name, uint64_t bytes, gpu::Memory memory) {
      return gpu::Buffer(device, {.name = name, .bytes = bytes, .memory = memory});
    };
    const auto texels = [&](const char* name, uint64_t bytes, gpu::Memory memory) {
      return gpu::Buffer(device, {.name = name, .bytes = bytes, .memory = memory, .texel = true});
    };
    frame = make("frame", sizeof(Frame), gpu::Memory::device);
    blocks = make("work blocks", uint64_t(n) / 64 * sizeof(WorkBlock), gpu::Memory::host);
    rays = texels("rays", uint64_t(n) * sizeof(Ray), queue_memory);
    hits = texels("hits", uint64_t(n) * sizeof(Hit), queue_memory);
    paths = texels("path states", uint64_t(n) * sizeof(PathState), gpu::Memory::device);
    const uint64_t lanes = compact_groups ? k_component_count + groups : k_component_count * groups;
    layer_radiance = texels("path radiance by layer", uint64_t(n) * 16 * layers, gpu::Memory::device);
    layer_table = make("layer table", sizeof(LayerTable), gpu::Memory::device);
    radiance = texels("path radiance", uint64_t(n) * 16 * lanes, gpu::Memory::device);
    features = texels("path features", uint64_t(n) * 32, gpu::Memory::device);
    shadow_rays = texels("shadow rays", uint64_t(n) * sizeof(Ray), queue_memory);
    shadow_hits = texels("shadow hits", uint64_t(n) * sizeof(Hit), queue_memory);
    shadow_states = texels("shadow states", uint64_t(n) * sizeof(ShadowState), gpu::Memory::device);
    counters = make("counters", 4 * k_counter_slots, gpu::Memory::host);
    branching = texels("branching vertices", uint64_t(n) * (sizeof(Ray) + sizeof(Hit) + sizeof(PathState)),
                       gpu::Memory::device);
    branching_queue = make("branching queue", uint64_t(n) * 4, gpu::Memory::device);
    for (auto& q : queues) q = make("queue", uint64_t(n) * 4, queue_memory);
    for (auto& q : shadow_queues) q = make("shadow queue", uint64_t(n) * 4, queue_memory);
  }

  void compile_camera(size_t kind) {
    if (cameras[kind]) return;
    gpu::Defines defines = camera_defines;
    if (kind & 1) defines["LUCERNA_THIN_LENS"] = "1";
    if (kind & 2) defines["LUCERNA_SECTION"] = "1";
    cameras[kind] = gpu::Kernel(device, compiler, "transport/camera.comp", defines);
  }

  void rebind_lookup() {
    for (size_t k = 0; k < main.size(); ++k) {
      if (bind_lookup) bind_lookup(main[k]);
      by_class->bind(k, main[k]);
    }
  }

  void bind(const upload::DeviceScene& scene) {
    transparent = scene.effects().transparent();
    by_class->set_features(scene.effects().kinds);
    for (int k = 0; k < 2; ++k) {
      for (gpu::Resources* r : {&main[k], &shade_shadow[k]}) {
        scene.bind(*r);
        r->set("FrameBlock", frame);
        r->set("WorkBlocks", blocks);
        r->set("ray_texels", rays);
        r->set("path_texels", paths);
        r->set("Paths", paths);
        r->set("radiance_texels", radiance);
        r->set("Radiance", radiance);
        r->set("feature_texels", features);
        r->set("Features", features);
        r->set("shadow_ray_texels", shadow_rays);
        r->set("ShadowRays", shadow_rays);
        r->set("shadow_state_texels", shadow_states);
        r->set("ShadowStates", shadow_states);
        r->set("Counters", counters);
        r->set("LayerTableBlock", layer_table);
        r->set("layer_texels", layer_radiance);
        r->set("LayerRadiance", layer_radiance);
      }
      main[k].set("Rays", rays);
      main[k].set("Hits", hits);
      main[k].set("hit_texels", hits);
      main[k].set("branching_texels", branching);
      main[k].set("Branching", branching);
      main[k].set("BranchingQueue", branching_queue);
      main[k].set("Queue", queues[k]);
      main[k].set("NextQueue", queues[1 - k]);
      main[k].set("ShadowQueue", shadow_queues[0]);
      // The tracer and the shadow kernel see the shadow rays under the tracer's names.
      shade_shadow[k].set("ray_texels", shadow_rays);
      shade_shadow[k].set("Hits", shadow_hits);
      shade_shadow[k].set("hit_texels", shadow_hits);
      shade_shadow[k].set("Queue", shadow_queues[k]);
      shade_shadow[k].set("NextQueue", queues[0]);
      shade_shadow[k].set("ShadowQueue", shadow_queues[1 - k]);
    }
    bind_learning();
    rebind_lookup();
    film_resources = main[0];
  }
  void bind_learning() {
    for (int k = 0; k < 2 && learning; ++k)
      for (gpu::Resources* r : {&main[k], &shade_shadow[k]}) learning->bind(*r);
  }

  /// Records the addition of the last item's paths to the film, or, with `samples` 0, its picture.
  void add(film::Film& film, uint32_t pixels, uint32_t samples);

  /// From `begin` until no path is alive. False if cancelled.
  bool trace_paths(uint32_t count, const PathEnds& ends, const std::function<bool()>& cancel);

  StageSum& stage(const std::string& name, bool host) {
    for (StageSum& s : stats.stages)
      if (s.name == name) return s;
    return stats.stages.emplace_back(StageSum{name, 0, host});
  }

  /// Adds a stage's time, distributed by rays per component; without rays to the account of eye paths.
  void account(const std::string& name, double ms, const uint32_t* rays_by_component, bool host) {
    stage(name, host).ms += ms;
    double total = 0;
    if (rays_by_component)
      for (const uint32_t c : k_components) total += rays_by_component[c];
    if (total <= 0) {
      stats.component_ms[first_account] += ms;
      return;
    }
    for (const uint32_t c : k_components) stats.component_ms[c] += ms * rays_by_component[c] / total;
  }

  /// Runs the recorded commands and distributes their times: shadow stages by `shadow`, the others by
  /// `closest`.
  void run_and_account(const uint32_t* closest, const uint32_t* shadow_rays_by_component) {
    stream.run();
    for (const gpu::StageTime& t : stream.take_times()) {
      const bool is_shadow = t.stage.rfind("shadow", 0) == 0;
      account(t.stage, t.milliseconds, is_shadow ? shadow_rays_by_component : closest, false);
    }
  }

  void trace(bvh::Query query, const gpu::Kernel& kernel, const gpu::Resources& resources,
             const gpu::Buffer& r, const gpu::Buffer& h, const gpu::Buffer* queue, uint32_t count,
             const char* name, const uint32_t* closest, const uint32_t* shadows) {
    if (!host_trace) {
      stream.dispatch(kernel, resources, TracePush{count, queue ? 1u : 0u}, workgroups(count), name);
      return;
    }
    run_and_account(closest, shadows);
    const Timer timer;
    if (queue) order_by_slot({static_cast<uint32_t*>(queue->mapped()), count});
    host_trace(query, {static_cast<const Ray*>(r.mapped()), slots}, {static_cast<Hit*>(h.mapped()), slots},
               queue ? static_cast<const uint32_t*>(queue->mapped()) : nullptr, count, !queue);
    const bool is_shadow = std::string_view(name).substr(0, 6) == "shadow";
    account(name, timer.milliseconds(), is_shadow ? shadows : closest, true);
  }

  /// Sorts the slots of a queue, all different, into their order in memory and in the picture.
  void order_by_slot(std::span<uint32_t> queue) {
    if (queue.size() < 1024) return;
    in_queue.assign((slots + 63) / 64, 0);
    for (const uint32_t slot : queue) in_queue[slot / 64] |= uint64_t{1} << slot % 64;
    uint32_t* out = queue.data();
    for (uint32_t word = 0; word < in_queue.size(); ++word)
      for (uint64_t bits = in_queue[word]; bits != 0; bits &= bits - 1)
        *out++ = word * 64 + uint32_t(std::countr_zero(bits));
  }
  /// Runs the recorded commands; returns the number of unfinished shadow rays.
  uint32_t take_going(const uint32_t* closest, const uint32_t* shadows) {
    run_and_account(closest, shadows);
    const uint32_t going = static_cast<const uint32_t*>(counters.mapped())[k_counter_shadow_next];
    stream.fill(counters, 0, 4 * k_counter_shadow_next, 4);
    return going;
  }
  /// On the host: appends the unblocked rays of the first shadow queue to the second one.
  uint32_t pass_unblocked(uint32_t count, const uint32_t* shadows) {
    const Timer timer;
    const auto* from = static_cast<const uint32_t*>(shadow_queues[0].mapped());
    auto* to = static_cast<uint32_t*>(shadow_queues[1].mapped());
    const auto* met = static_cast<const Hit*>(shadow_hits.mapped());
    uint32_t going = 0;
    for (uint32_t i = 0; i < count; ++i) {
      to[going] = from[i];
      going += met[from[i]].prim == k_no_hit ? 1 : 0;
    }
    account("shadow trace", timer.milliseconds(), shadows, true);
    return going;
  }
  /// True if any ray of a shadow queue has hit something.
  bool meets_any(uint32_t side, uint32_t count) const {
    const auto* queue = static_cast<const uint32_t*>(shadow_queues[side].mapped());
    const auto* met = static_cast<const Hit*>(shadow_hits.mapped());
    return std::any_of(queue, queue + count, [&](uint32_t slot) { return met[slot].prim != k_no_hit; });
  }

  static uint32_t workgroups(uint32_t count) { return (count + 63) / 64; }
};

Wavefront::Wavefront(gpu::Device& device, gpu::ShaderCompiler& compiler, const upload::DeviceScene& scene,
                     uint32_t slots, HostTrace host_trace, const gpu::Defines& extra_defines,
                     std::function<void(gpu::Resources&)> bind_lookup, const HitClassRules& rules,
                     std::shared_ptr<LightLearning> learning)
    : impl_(std::make_unique<Impl>(device, compiler, slots, scene.effects(), std::move(host_trace))) {
  Impl& w = *impl_;
  const Timer timer;
  gpu::Defines defines = scene.defines();
  for (const auto& [name, value] : extra_defines) defines[name] = value;
  w.writes_bias = defines.contains("LUCERNA_LOOKUP_BIAS");
  w.camera_defines = defines;
  w.compile_camera(0);
  w.shade = gpu::Kernel(device, compiler, "transport/shade.comp", defines);
  w.shadow = gpu::Kernel(device, compiler, "transport/shadow.comp", defines);
  gpu::Defines adding = defines;
  adding["LUCERNA_VERTEX_COUNT"] = "1";
  w.film_add = gpu::Kernel(device, compiler, "film/add.comp", adding);
  gpu::Defines images = adding;
  images["LUCERNA_FILM_IMAGES"] = "1";
  w.film_add_images = gpu::Kernel(device, compiler, "film/add.comp", images);
  if (w.layers > 0) {
    gpu::Defines of_layer = defines;
    w.layer_add = gpu::Kernel(device, compiler, "film/add_layer.comp", of_layer);
    of_layer["LUCERNA_FILM_IMAGES"] = "1";
    w.layer_add_images = gpu::Kernel(device, compiler, "film/add_layer.comp", of_layer);
  }
  if (w.compact_groups) {
    w.groups_add = gpu::Kernel(device, compiler, "film/add_groups.comp", adding);
    w.groups_add_images = gpu::Kernel(device, compiler, "film/add_groups.comp", images);
    adding["LUCERNA_FILM_UNMIXED"] = images["LUCERNA_FILM_UNMIXED"] = "1";
    w.unmixed_add = gpu::Kernel(device, compiler, "film/add.comp", adding);
    w.unmixed_add_images = gpu::Kernel(device, compiler, "film/add.comp", images);
  } else if (w.groups > 1) {
    adding["LUCERNA_FILM_LANES"] = images["LUCERNA_FILM_LANES"] = "1";
    w.lanes_add = gpu::Kernel(device, compiler, "film/add.comp", adding);
    w.lanes_add_images = gpu::Kernel(device, compiler, "film/add.comp", images);
  }
  w.bind_lookup = std::move(bind_lookup);
  w.by_class.emplace(device, compiler, slots, defines, scene.effects().kinds, rules);
  w.learning = std::move(learning);
  w.bind(scene);
  if (!w.host_trace) {
    // Without transparent surfaces the any-hit kernel ignores the flag.
    const auto tracer = [&](int query) {
      return gpu::Kernel(
          device, compiler, "trace.comp",
          w.transparent ? gpu::Defines{{"LUCERNA_QUERY", std::to_string(query)}, {"LUCERNA_NON_OPAQUE", "1"}}
                        : gpu::Defines{{"LUCERNA_QUERY", std::to_string(query)}});
    };
    w.trace_closest = tracer(0);
    w.trace_any = tracer(1);
    if (w.transparent) w.trace_non_opaque = tracer(2);
  }
  // Drivers that compile at the first dispatch do so here: an item of no paths.
  w.stream.fill(w.counters, 0);
  w.stream.dispatch(w.cameras[0], w.main[0], TransportPush{0, 0, 64, 0}, 1);
  w.stream.dispatch(w.shade, w.main[0], TransportPush{}, 1);
  w.stream.dispatch(w.shadow, w.shade_shadow[0], TransportPush{}, 1);
  if (!w.host_trace) {
    w.stream.dispatch(w.trace_closest, w.main[0], TracePush{}, 1);
    w.stream.dispatch(w.trace_any, w.shade_shadow[0], TracePush{}, 1);
    if (w.transparent) w.stream.dispatch(w.trace_non_opaque, w.shade_shadow[0], TracePush{}, 1);
  }
  w.stream.run();
  w.stream.take_times();
  w.compile_seconds = timer.seconds();
}

Wavefront::~Wavefront() = default;

void Wavefront::set_frame(const Frame& frame, uint32_t enabled) {
  Impl& w = *impl_;
  const size_t kind = (frame.lens_radius > 0 ? 1 : 0) + (frame.section_normal != vec3(0) ? 2 : 0);
  w.compile_camera(kind);
  w.camera_kind = kind;
  Frame known = frame;
  if (impl_->learning) impl_->learning->describe(known);
  impl_->frame.write(&known, sizeof known);
  impl_->enabled = enabled;
  impl_->first_account = uint8_t(frame.automaton[0] >> 29 & 3u);
}

void Wavefront::set_layers(const LayerTable& table) { impl_->layer_table.write(&table, sizeof table); }
void Wavefront::rebind(const upload::DeviceScene& scene) { impl_->bind(scene); }
void Wavefront::rebind_lookup() { impl_->rebind_lookup(); }
uint32_t Wavefront::slots() const { return impl_->slots; }

bool Wavefront::run(const schedule::WorkItem& item, film::Film& film, const std::function<bool()>& cancel) {
  if (!try_out(item, film, cancel)) return false;
  if (impl_->enabled != 0) impl_->stats.paths += item.slots();
  return true;
}

bool Wavefront::try_out(const schedule::WorkItem& item, film::Film& film,
                        const std::function<bool()>& cancel) {
  Impl& w = *impl_;
  const auto pixels = static_cast<uint32_t>(item.blocks.size()) * 64;
  if (item.slots() == 0 || w.enabled == 0) return true;
  if (!probe(item, cancel)) return false;
  w.add(film, pixels, item.sample_count);
  w.run_and_account(nullptr, nullptr);
  return true;
}

void Wavefront::Impl::add(film::Film& film, uint32_t pixels, uint32_t samples) {
  if (writes_bias) film.make_room_for_lookup_bias(stream);
  film.bind(film_resources);
  const bool fits = film.fits_storage_buffers();
  FilmPush push{film.width(), film.height(), pixels, samples, 0, film.quick()};
  // Preview samples are kept without layers.
  for (; push.group < film.layers() && samples > 0; ++push.group) {
    film.bind_layer(film_resources, push.group);
    stream.dispatch(fits ? layer_add : layer_add_images, film_resources, push, workgroups(pixels), "film");
  }
  push.group = 0;
  if (film.groups() == 1) {
    stream.dispatch(fits ? film_add : film_add_images, film_resources, push, workgroups(pixels), "film");
    return;
  }
  if (film.groups() != groups)
    throw_error("transport", "a film of {} groups of lights, paths of {}", film.groups(), groups);
  if (film.is_compact() != compact_groups)
    throw_error("transport", "a film and paths that keep groups of lights in different ways");
  if (compact_groups) {
    // The picture's sums are of the unmixed light; readers mix them.
    stream.dispatch(fits ? unmixed_add : unmixed_add_images, film_resources, push, workgroups(pixels),
                    "film");
    stream.dispatch(fits ? groups_add : groups_add_images, film_resources, push, workgroups(pixels), "film");
    return;
  }
  for (push.group = 0; push.group < groups; ++push.group) {
    film.bind_group(film_resources, push.group);
    stream.dispatch(fits ? lanes_add : lanes_add_images, film_resources, push, workgroups(pixels), "film");
  }
}

void Wavefront::mix(film::Film& film) {
  if (film.groups() == 1 || film.is_compact()) return;
  impl_->add(film, 64 * film.blocks(), 0);
  impl_->run_and_account(nullptr, nullptr);
}

bool Wavefront::probe(const schedule::WorkItem& item, const std::function<bool()>& cancel) {
  Impl& w = *impl_;
  const uint32_t count = item.slots();
  if (count == 0 || w.enabled == 0) return true;
  if (count > w.slots) throw_error("transport", "work item of {} paths, room for {}", count, w.slots);
  w.blocks.write(std::span<const WorkBlock>(item.blocks));
  const TransportPush push{count, 0, static_cast<uint32_t>(item.blocks.size()) * 64, 0};
  const auto begin = [&] {
    w.stream.dispatch(w.cameras[w.camera_kind], w.main[0], push, Impl::workgroups(count), "camera");
  };
  return w.trace_paths(count, {.begin = begin, .first_hits = {}, .end = {}}, cancel);
}

bool Wavefront::learn(const schedule::WorkItem& item, const Frame& pilot, const Frame& picture,
                      uint32_t enabled, const std::function<bool()>& cancel) {
  Impl& w = *impl_;
  LightLearning& learning = *w.learning;
  if (learning.replay(pilot)) {
    w.bind_learning();
    set_frame(picture, enabled);
    return true;
  }
  learning.begin_generation(pilot);
  w.bind_learning();
  const size_t at_once = std::min(learning.most_paths(), w.slots) / 64;
  bool went = true;
  for (uint32_t sample = 0; sample < item.sample_count && went; ++sample)
    for (size_t first = 0; first < item.blocks.size() && went; first += at_once) {
      schedule::WorkItem part{{}, 1};
      for (size_t b = first; b < std::min(item.blocks.size(), first + at_once); ++b)
        part.blocks.push_back({item.blocks[b].index, item.blocks[b].first_sample + sample});
      learning.begin_recording();
      set_frame(pilot, k_all_components);
      went = probe(part, cancel);
      learning.end_recording(went ? part.slots() : 0);
    }
  if (went)
    learning.finish_generation();
  else
    learning.abandon_generation();
  w.bind_learning();
  set_frame(picture, enabled);
  return went;
}

void Wavefront::forget_learned(upload::LightClusters clusters) {
  if (!impl_->learning) return;
  impl_->learning->forget(std::move(clusters));
  impl_->bind_learning();
}

void Wavefront::rewind_learning() {
  if (!impl_->learning) return;
  impl_->learning->rewind();
  impl_->bind_learning();
}

LightLearning* Wavefront::learning() { return impl_->learning.get(); }
std::shared_ptr<LightLearning> Wavefront::shared_learning() { return impl_->learning; }
const LightLearning* Wavefront::learning() const { return impl_->learning.get(); }

bool Wavefront::run(uint32_t count, const PathEnds& ends, const std::function<bool()>& cancel) {
  Impl& w = *impl_;
  if (count == 0 || w.enabled == 0) return true;
  if (count > w.slots) throw_error("transport", "{} paths, room for {}", count, w.slots);
  if (!w.trace_paths(count, ends, cancel)) return false;
  if (ends.end) ends.end();
  w.run_and_account(nullptr, nullptr);
  return true;
}

bool Wavefront::Impl::trace_paths(uint32_t count, const PathEnds& ends, const std::function<bool()>& cancel) {
  Impl& w = *this;
  TransportPush push{count, 0, 0, 0};
  uint64_t shaded = 0;
  ByComponent<uint32_t> closest{}, shadows{};
  closest[w.first_account] = count;
  std::array<gpu::Resources, 2> own;  // of the caller's kernel
  for (size_t k = 0; ends.vertex && k < own.size(); ++k) {
    own[k] = w.main[k];
    if (ends.bind_vertex) ends.bind_vertex(own[k]);
  }
  std::array<gpu::Resources, 2> of_arrival;
  for (size_t k = 0; ends.arrival && k < of_arrival.size(); ++k) {
    of_arrival[k] = w.shade_shadow[k];
    if (ends.bind_vertex) ends.bind_vertex(of_arrival[k]);
  }
  const std::array<gpu::Resources, 2>& arriving = ends.arrival ? of_arrival : w.shade_shadow;
  const gpu::Kernel& shadow = ends.arrival ? *ends.arrival : w.shadow;
  if (!ends.vertex && !ends.hits_only) w.by_class->begin_run(w.stream);
  w.stream.fill(w.counters, 0);
  ends.begin();
  const uint32_t* counters = static_cast<const uint32_t*>(w.counters.mapped());
  uint32_t active = count, parity = 0, shadow_count = 0, branch = 0;
  bool first = true, branching = false;  // the vertices are stored, and another branch leaves them
  // A path may pass any number of transparent surfaces; each costs it a factor, and roulette bounds the
  // events.
  for (; active > 0 || shadow_count > 0; parity ^= 1) {
    if (cancel && cancel()) {
      w.run_and_account(closest.data(), shadows.data());
      return false;
    }
    // Shadow rays of the former vertices, then the next vertices. The host tracer traces both before the
    // device continues: one submission per bounce, each of which costs as much as tracing a thousand rays.
    const auto trace_vertices = [&] {
      w.trace(bvh::Query::closest, w.trace_closest, w.main[parity], w.rays, w.hits,
              first ? nullptr : &w.queues[parity], active, "closest trace", closest.data(), shadows.data());
      w.stats.rays += active;
    };
    bool vertices_traced = branching || active == 0;
    if (shadow_count > 0) {
      const gpu::Resources& table = arriving[0];
      w.trace(bvh::Query::any_opaque, w.trace_any, table, w.shadow_rays, w.shadow_hits, &w.shadow_queues[0],
              shadow_count, "shadow trace", closest.data(), shadows.data());
      w.stats.shadow_rays += shadow_count;
      w.stats.rays += shadow_count;
      uint32_t side = 0, going = shadow_count;
      push.use_queue = 1;
      push.round = 0;
      if (w.transparent) {
        // Rays that no opaque surface blocks; then again those that passed a transparent one.
        side = 1;
        if (w.host_trace) {
          going = w.pass_unblocked(shadow_count, shadows.data());
        } else {
          push.count = shadow_count;
          w.stream.dispatch(shadow, table, push, Impl::workgroups(shadow_count), "shadow light");
          going = w.take_going(closest.data(), shadows.data());
        }
        push.round = 1;
        for (; going > 0; side ^= 1) {
          w.trace(bvh::Query::closest_non_opaque, w.trace_non_opaque, arriving[side], w.shadow_rays,
                  w.shadow_hits, &w.shadow_queues[side], going, "shadow trace", closest.data(),
                  shadows.data());
          w.stats.shadow_rays += going;
          w.stats.rays += going;
          if (w.host_trace && !w.meets_any(side, going)) break;  // all arrive
          push.count = going;
          w.stream.dispatch(shadow, arriving[side], push, Impl::workgroups(going), "shadow light");
          going = w.take_going(closest.data(), shadows.data());
        }
      }
      if (w.host_trace && !vertices_traced) trace_vertices(), vertices_traced = true;
      push.count = going;
      if (going > 0) w.stream.dispatch(shadow, arriving[side], push, Impl::workgroups(going), "shadow light");
    }
    if (active > 0) {
      if (!vertices_traced) trace_vertices();
      if (first && ends.first_hits) ends.first_hits();
      if (ends.hits_only) {
        w.run_and_account(closest.data(), shadows.data());
        return true;
      }
      w.stream.fill(w.counters, 0, 0, 12);
      w.stream.fill(w.counters, 0, 4 * k_counter_rays, 32);
      push.count = active;
      push.use_queue = first ? 0 : 1;
      push.round = branching ? branch : 0;
      if (ends.vertex) {
        w.stream.dispatch(*ends.vertex, own[parity], push, Impl::workgroups(active), ends.vertex_stage);
      } else if (!branching && w.by_class->shades(active)) {
        w.by_class->sort(w.stream, parity, active, !first, w.counters);
        w.run_and_account(closest.data(), shadows.data());
        w.by_class->shade(w.stream, parity, w.shade, counters);
      } else {
        if (!branching) w.by_class->count(w.stream, parity, active, !first);
        w.stream.dispatch(w.shade, w.main[parity], push, Impl::workgroups(active), "shade");
      }
      shaded += active;
    } else {
      w.stream.fill(w.counters, 0, 0, 12);
    }
    w.run_and_account(closest.data(), shadows.data());
    active = counters[k_counter_next];
    shadow_count = counters[k_counter_shadow];
    for (const uint32_t c : k_components) {
      closest[c] = counters[k_counter_rays + c];
      shadows[c] = counters[k_counter_shadow_rays + c];
    }
    first = false, branching = false;
    if (const uint32_t again = counters[k_counter_branching]; active == 0 && shadow_count == 0 && again > 0) {
      ++branch;
      branching = true;
      active = again;
      std::copy_n(counters + k_counter_branching_rays, k_component_count, closest.begin());
      w.stream.copy(w.branching_queue, w.queues[1 - parity], uint64_t{again} * 4);
      w.stream.fill(w.counters, 0, 4 * k_counter_branching, 4);
      w.stream.fill(w.counters, 0, 4 * k_counter_branching_rays, 4 * k_component_count);
    }
  }
  w.stats.dropped += counters[k_counter_dropped];
  w.stats.roulette += counters[k_counter_roulette];
  w.stats.depth += counters[k_counter_depth];
  if (!ends.vertex) w.by_class->end_run(shaded, counters);
  return true;
}

void Wavefront::bind_paths(gpu::Resources& resources) const { resources = impl_->main[0]; }
const gpu::Buffer& Wavefront::hits() const { return impl_->hits; }
gpu::Stream& Wavefront::stream() { return impl_->stream; }

void Wavefront::account_stages() { impl_->run_and_account(nullptr, nullptr); }

const TransportStats& Wavefront::stats() const { return impl_->stats; }
void Wavefront::reset_stats() { impl_->stats = {}; }
void Wavefront::uncounted(const std::function<void()>& trace) {
  const TransportStats kept = impl_->stats;
  trace();
  stream().take_times();
  impl_->stats = kept;
}
double Wavefront::compile_seconds() const { return impl_->compile_seconds; }
HitClasses Wavefront::hit_classes() const {
  return impl_->by_class->ready() ? impl_->by_class->classes() : HitClasses{};
}

}  // namespace lucerna::transport
