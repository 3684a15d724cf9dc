#include "session/path_recording.h"

#include <algorithm>
#include <map>

#include "scene/display_name.h"
#include "scene/light_groups.h"

namespace lucerna::session {
namespace {

uint32_t material_of(const upload::FlatScene& flat, uint32_t primitive) {
  return flat.triangles[primitive].w & shared::k_triangle_material_mask;
}

/// Names of the lights, each once, and for each entry of the light table the index of its name.
struct LightNames {
  std::vector<std::string> names;
  std::vector<uint32_t> by_entry;

  LightNames(const upload::FlatScene& flat, const std::vector<std::string>& materials) {
    std::map<std::string, uint32_t> known;
    for (const upload::LightEntry& entry : flat.entries) {
      std::string name = "environment";
      if (entry.kind == shared::k_light_triangle)
        name = materials[material_of(flat, entry.index)];
      else if (entry.kind != shared::k_light_environment)
        name = flat.lamp_name(entry.index);
      const auto [at, is_new] = known.try_emplace(name, uint32_t(names.size()));
      if (is_new) names.push_back(name);
      by_entry.push_back(at->second);
    }
  }
};

}  // namespace

PathChoices::PathChoices(const PathSelection& selection, uint32_t width, uint32_t height)
    : of_(selection), width_(width), every_(std::max(selection.every, 1u)) {
  of_.right = std::min(of_.right, width), of_.bottom = std::min(of_.bottom, height);
  if (of_.left < of_.right && of_.top < of_.bottom)
    all_ = uint64_t{of_.right - of_.left} * (of_.bottom - of_.top) * of_.samples;
}

std::vector<shared::PathChoice> PathChoices::take(size_t most) {
  std::vector<shared::PathChoice> choices;
  const uint32_t across = of_.right - of_.left;
  for (; next_ < all_ && choices.size() < most; next_ += every_) {
    const uint64_t pixel = next_ / of_.samples;
    choices.push_back({(of_.top + uint32_t(pixel / across)) * width_ + of_.left + uint32_t(pixel % across),
                       of_.first_sample + uint32_t(next_ % of_.samples)});
  }
  return choices;
}

std::vector<shared::PathChoice> choices_of(const PathSelection& selection, uint32_t width, uint32_t height) {
  PathChoices all(selection, width, height);
  return all.take(all.count());
}

uvec2 pixel_at(const vec2& place, uint32_t width, uint32_t height) {
  const auto at = [](float p, uint32_t size) {
    return uint32_t(std::clamp(p * float(size), 0.f, float(size) - 1));
  };
  return {at(place.x, width), at(place.y, height)};
}

recording::Recording PathRecording::begin(const PictureView& picture) const {
  recording::Recording all;
  all.width = picture.width, all.height = picture.height;
  all.seed = uint32_t(picture.settings.integer("seed"));
  const scene::Scene& scene = *picture.world.scene;
  all.scene = scene.name;
  for (size_t m = 0; m < scene.materials.size(); ++m)
    all.materials.push_back(scene::display_name(scene.materials[m].name, "material", m));
  all.lights = LightNames(picture.world.flat, all.materials).names;
  if (picture.world.flat.groups)
    for (const scene::LightGroup& group : picture.world.flat.groups->groups) all.groups.push_back(group.name);
  return all;
}

bool PathRecording::record(Engine& engine, const PictureView& picture,
                           std::span<const shared::PathChoice> choices, recording::Recording& into,
                           const std::function<bool()>& cancel, uint32_t events_per_path) {
  transport::Wavefront& wavefront = engine.wavefront();
  if (!recorder_ || recorder_->path_defines() != engine.path_defines() || events_per_path_ != events_per_path)
    recorder_.emplace(device_, compiler_, engine.path_defines(), events_per_path);
  events_per_path_ = events_per_path;
  const upload::FlatScene& flat = picture.world.flat;
  const std::vector<uint32_t> lights = LightNames(flat, into.materials).by_entry;
  const shared::Frame frame = engine.frame(picture, picture.width, picture.height);
  wavefront.set_frame(frame, engine.enabled());
  const auto sink = [&](const transport::RecordedPath& path) {
    into.paths.push_back({path.of.pixel, path.of.sample_index, uint32_t(into.events.size()),
                          uint32_t(path.events.size()), path.lost});
    for (recording::Event e : path.events) {
      if (e.light < lights.size()) e.light = lights[e.light];
      // The picture's light, with the mix of its groups.
      if (const uint32_t group = recording::group_of(e); group < picture.mix.size())
        e.contribution *= picture.mix[group];
      into.events.push_back(e);
    }
  };
  return recorder_->record(wavefront, frame, choices, 2 * flat.core_radius, sink, cancel);
}

}  // namespace lucerna::session
