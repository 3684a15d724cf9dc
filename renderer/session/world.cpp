#include "session/world.h"

#include "base/error.h"
#include "bvh/embree/build.h"

namespace lucerna::session {

void report_progress(const Progress& progress, float fraction, const std::string& what) {
  if (progress && !progress(fraction, what)) throw Error("", "cancelled");
}

transport::HostTrace World::trace() const {
  if (!host) return {};
  return [tracer = host.get()](bvh::Query query, std::span<const shared::Ray> rays,
                               std::span<shared::Hit> hits, const uint32_t* queue, uint32_t count,
                               bool coherent) { tracer->trace(query, rays, hits, queue, count, coherent); };
}

World make_world(gpu::Device& device, std::shared_ptr<const scene::Scene> scene,
                 std::shared_ptr<const scene::Scene> lit, const std::string& tracer,
                 const upload::LightSeparation& separation, const Progress& progress) {
  World world;
  world.scene = std::move(scene);
  world.lit = std::move(lit);
  report_progress(progress, 0, "flattening the scene");
  world.flat = upload::flatten(*world.lit, separation);
  report_progress(progress, 0.2f, "building the BVH");
  const bvh::Triangles triangles{world.flat.positions, world.flat.non_opaque};
  bvh::BvhData tree;
  if (tracer == "host" || (tracer == "auto" && device.info().is_cpu)) {
    world.host = std::make_unique<bvh::HostTracer>(triangles);
  } else {
    bvh::BuildOptions options;
    options.progress = [&](float f) { return !progress || progress(0.2f + 0.6f * f, "building the BVH"); };
    tree = bvh::build(triangles, options);
  }
  report_progress(progress, 0.8f, "uploading the scene");
  world.device = std::make_unique<upload::DeviceScene>(device, world.flat, tree);
  return world;
}

WorldEdit::WorldEdit(gpu::Device& device, World& world, std::shared_ptr<const scene::Scene> edited,
                     std::shared_ptr<const scene::Scene> lit, const upload::LightSeparation& separation,
                     bool factors)
    : world_(world),
      scene_(world.scene),
      lit_(world.lit),
      effects_(world.flat.effects),
      separation_(upload::light_separation(world.flat)) {
  world_.scene = std::move(edited);
  world_.lit = std::move(lit);
  upload::set_light_separation(world_.flat, separation);
  try_out(device, factors);
}

WorldEdit::~WorldEdit() {
  if (!kept_) put_back();
}

void WorldEdit::try_out(gpu::Device& device, bool factors) {
  try {
    if (factors) materials_ = world_.flat;
    materials_out_ = factors;
    if (factors) upload::flatten_factors(*world_.lit, world_.flat);
    lights_ = world_.flat;
    lights_out_ = true;
    upload::flatten_lights(*world_.lit, world_.flat);
    upload::MaterialBuffers materials;
    if (factors) materials = upload::MaterialBuffers(device, world_.flat);
    upload::LightBuffers lights(device, world_.flat, world_.device->lights());
    // Nothing fails from here on.
    if (factors) material_buffers_ = world_.device->exchange(std::move(materials), world_.flat.effects);
    light_buffers_ = world_.device->exchange(std::move(lights), world_.flat.effects);
  } catch (...) {
    put_back();
    throw;
  }
}

void WorldEdit::put_back() noexcept {
  if (light_buffers_) world_.device->exchange(std::move(light_buffers_), effects_);
  if (material_buffers_) world_.device->exchange(std::move(material_buffers_), effects_);
  if (lights_out_) static_cast<upload::FlatLights&>(world_.flat) = std::move(lights_);
  if (materials_out_) static_cast<upload::FlatMaterials&>(world_.flat) = std::move(materials_);
  world_.flat.effects = effects_;
  upload::set_light_separation(world_.flat, separation_);
  world_.scene = scene_;
  world_.lit = lit_;
}

}  // namespace lucerna::session
