#include "solvers/photons/irradiance_map.h"

#include "solvers/photons/surface_index.h"

namespace lucerna::photons {

using namespace shared;

IrradianceMap::IrradianceMap(gpu::Device& device, uint32_t groups)
    : device_(device),
      groups_(groups),
      block_(device, {.name = "lookups of irradiance", .bytes = sizeof(IrradianceFrame)}) {
  clear();
}

void IrradianceMap::clear() {
  restart();
  pieces_ = 0, readable_ = false;
  gpu::make_texel_room(device_, roots_, "triangles of irradiance", sizeof(uvec4));
  gpu::make_texel_room(device_, nodes_, "irradiance", (1 + groups_) * sizeof(vec4));
  const IrradianceFrame none{};
  block_.write(&none, sizeof none);
}

void IrradianceMap::make(transport::Wavefront& wavefront, const PhotonMap& map, const upload::FlatScene& flat,
                         const Wanted& wanted) {
  std::vector<bool> diffuse = diffuse_materials(flat);
  if (!order_ || diffuse != diffuse_) {
    order_ = std::make_unique<SideOrder>(order_sides(flat, diffuse));
    diffuse_ = std::move(diffuse);
    builder_.reset();
  }
  if (!builder_) {
    const std::vector<Photon> photons = map.photons();
    const std::vector<uint32_t> numbers = map.numbers();
    const std::vector<PhotonSurface> surfaces = map.surfaces();
    std::vector<PhotonOnSide> all(photons.size());
    for (size_t i = 0; i < all.size(); ++i) {
      const uint32_t part = photons[i].bits >> k_photon_part_shift & 3u;
      const uint32_t events = photons[i].bits >> k_photon_events_shift & k_photon_most_events;
      const bool counts = part > 0 && k_irradiance_events + 1 + events <= wanted.max_depth;
      all[i] = {.side = surfaces[i].side,
                .barycentric = surfaces[i].barycentric,
                .number = numbers[i],
                .group = photons[i].bits >> k_photon_group_shift,
                .flux = counts ? photons[i].flux : vec3(0)};
    }
    builder_ = std::make_unique<IrradianceCellsBuilder>(*order_, std::move(all), groups_, wanted.nearest,
                                                        wanted.widest);
    maps_ = 0;
    return;
  }
  builder_->add_map(maps_++);
  if (maps_ < 2) return;
  upload(builder_->take(), wanted);
  builder_.reset();
  complete_ = true;
  wavefront.rebind_lookup();
}

void IrradianceMap::upload(const IrradianceCells& cells, const Wanted& wanted) {
  gpu::make_texel_room(device_, roots_, "triangles of irradiance", cells.roots.size() * sizeof(uvec4));
  gpu::make_texel_room(device_, nodes_, "irradiance", cells.nodes.size() * sizeof(vec4));
  roots_.write(std::span<const uvec4>(cells.roots));
  nodes_.write(std::span<const vec4>(cells.nodes));
  const IrradianceFrame frame{.triangles = uint32_t(cells.roots.size()),
                              .states = {uint32_t(wanted.states), uint32_t(wanted.states >> 32)},
                              .gathers = wanted.gathers ? 1u : 0u};
  block_.write(&frame, sizeof frame);
  pieces_ = cells.known, readable_ = true;
}

void IrradianceMap::bind(gpu::Resources& resources) const {
  resources.set("irradiance_roots", roots_);
  resources.set("irradiance_nodes", nodes_);
  resources.set("IrradianceBlock", block_);
}

uint64_t IrradianceMap::bytes() const { return roots_.bytes() + nodes_.bytes() + block_.bytes(); }

}  // namespace lucerna::photons
