#include "solvers/photons/irradiance_map.h"

#include <algorithm>

namespace lucerna::photons {

using namespace shared;

namespace {

uint32_t group_texels(const gpu::Defines& defines) {
  const auto groups = defines.find("LUCERNA_LIGHT_GROUPS");
  return defines.contains("LUCERNA_GROUP_SUMS") ? (uint32_t(std::stoul(groups->second)) + 3) / 4 : 0;
}

}  // namespace

IrradianceMap::IrradianceMap(gpu::Device& device, gpu::ShaderCompiler& compiler,
                             const gpu::Defines& scene_defines)
    : device_(device),
      choose_(device, compiler, "photons/places.comp"),
      gather_(device, compiler, "photons/place_irradiance.comp", scene_defines),
      cells_(device, compiler),
      group_words_(group_texels(scene_defines)),
      block_(device, {.name = "lookups of irradiance", .bytes = sizeof(PhotonFrame)}) {
  clear();
}

void IrradianceMap::clear() {
  complete_ = false;
  lookup_ = {};
  lookup_.least = lookup_.most = 1;
  std::fill(std::begin(lookup_.component), std::end(lookup_.component), 0xffffu);
  cells_.make_room(0, lookup_);
  gpu::make_texel_room(device_, irradiance_, "irradiance of places", k_photon_place_texels * 16);
  if (group_words_ > 0) gpu::make_texel_room(device_, shares_, "groups of places", group_words_ * 16);
  write_lookup();
}

void IrradianceMap::write_lookup() { block_.write(&lookup_, sizeof lookup_); }

void IrradianceMap::make(transport::Wavefront& wavefront, const PhotonMap& map,
                         const std::vector<uint32_t>& component,
                         const std::function<void(gpu::Resources&)>& from) {
  const uint32_t count = gpu::groups_for(map.figures().photons, k_photon_place_step);
  lookup_ = map.lookup();
  lookup_.most_candidates = k_photon_place_candidates;
  std::copy(component.begin(), component.end(), std::begin(lookup_.component));
  cells_.make_room(count, lookup_);
  write_lookup();
  const auto room = [&](gpu::Buffer& buffer, const char* name, uint64_t bytes) {
    gpu::make_texel_room(device_, buffer, name, std::max<uint64_t>(bytes, 16));
  };
  room(list_, "places of irradiance", uint64_t{count} * sizeof(Photon));
  room(ids_, "numbers of places", (uint64_t{count} * 4 + 15) / 16 * 16);
  room(irradiance_, "irradiance of places", uint64_t{count} * k_photon_place_texels * 16);
  if (group_words_ > 0) room(shares_, "groups of places", uint64_t{count} * group_words_ * 16);
  if (count > 0) {
    gpu::Stream& stream = wavefront.stream();
    const PhotonListPush push{count};
    const uint32_t groups = gpu::groups_for(count, 64);
    gpu::Resources r;
    from(r);
    r.set("PhotonList", list_);
    r.set("PhotonIds", ids_);
    stream.dispatch(choose_, r, push, groups, "photon map");
    cells_.encode(stream, list_, ids_, block_, count);
    r.set("place_texels", cells_.photons());
    r.set("PlaceIrradiance", irradiance_);
    if (group_words_ > 0) r.set("PlaceGroups", shares_);
    stream.dispatch(gather_, r, push, groups, "photon map");
    wavefront.account_stages();
  }
  complete_ = true;
  wavefront.rebind_lookup();
}

void IrradianceMap::bind(gpu::Resources& resources) const {
  resources.set("place_irradiance_texels", irradiance_);
  resources.set("place_table", cells_.table());
  resources.set("IrradianceBlock", block_);
  if (group_words_ > 0) resources.set("irradiance_group_texels", shares_);
}

uint64_t IrradianceMap::bytes() const {
  uint64_t sum = cells_.bytes();
  for (const gpu::Buffer* b : {&list_, &ids_, &irradiance_, &shares_}) sum += *b ? b->bytes() : 0;
  return sum;
}

}  // namespace lucerna::photons
