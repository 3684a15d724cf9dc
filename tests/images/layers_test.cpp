// links: session
// Layers by path expressions in the film: bit for bit the components where their expressions are; the sum of
// the recorded paths whose words they have; with stored light, photons, light tracing and mixes; beside
// unchanged components.
#include <catch2/catch.hpp>
#include <filesystem>

#include "film/io/image_file.h"
#include "paths/layers.h"
#include "recording/recording.h"
#include "support/folder.h"
#include "support/render.h"
#include "support/rooms.h"

namespace layers_tests {

using namespace lucerna;
using test::identical;

namespace {

/// The components' expressions as layers, and all light.
const std::string k_layers = [] {
  std::string text = "all = E.*L";
  for (const size_t c : k_components)
    text += fmt::format(", own-{} = {}", paths::k_component_names[c], paths::k_component_expressions[c]);
  return text;
}();

double worst_difference(const std::vector<vec3>& a, const std::vector<vec3>& b) {
  double worst = 0;
  for (size_t i = 0; i < a.size(); ++i)
    worst = std::max(worst, double(glm::length(a[i] - b[i])) / (double(glm::length(b[i])) + 1e-4));
  return worst;
}

std::vector<vec3> sum_of(const film::Image& image) {
  std::vector<vec3> sum;
  for (size_t i = 0; i < image.samples.size(); ++i) sum.push_back(test::sum_at(image, i));
  return sum;
}

}  // namespace

TEST_CASE("a layer with a component's expression is that component, and changes no bit of the picture") {
  struct Case {
    const char* scene;
    test::Settings settings;
  };
  const Case cases[] = {
      {"glass", {}},
      {"ring", {{"components.caustic", "light"}}},
      {"ring", {{"components.caustic", "photons"}}},
      {"cornell", {{"components.secondary", "cache"}, {"components.tertiary", "cache"}}},
      {"cornell", {{"components.secondary", "photons"}, {"components.tertiary", "photons"}}},
      {"gallery", {{"relight.enabled", "compact"}}}};
  for (const Case& c : cases) {
    INFO(c.scene << " " << (c.settings.empty() ? "" : c.settings.begin()->first));
    test::Render plain{.scene = c.scene,
                       .width = 24,
                       .height = 24,
                       .samples = 3,
                       .settings = c.settings,
                       .validated = &c == cases};
    test::Render layered = plain;
    layered.settings["film.layers"] = k_layers;
    const test::Result a = test::render(plain), b = test::render(layered);
    CHECK(b.validation_messages == 0);
    CHECK(identical(a.image, b.image));
    CHECK(a.image.layers.empty());
    REQUIRE(b.image.layers.size() == 5);
    for (size_t k = 0; k < 4; ++k) {
      INFO(paths::k_component_names[k]);
      CHECK(worst_difference(b.image.layers[1 + k], b.image.components[k]) < 1e-6);
      CHECK(worst_difference(b.image.odd_layers[1 + k], b.image.odd_half[k]) < 1e-6);
    }
    CHECK(test::mean(b.image.layers[0]) > 0.01);
    CHECK(worst_difference(b.image.layers[0], sum_of(b.image)) < 1e-5);
  }
}

TEST_CASE("a layer is the light of the recorded paths with its words") {
  constexpr uint32_t k_side = 16, k_samples = 4;
  const std::string text =
      "direct = EDL, mirrored = E[SG]+D.*L, near = ED?D?L, behind-glass = E.*SS.*L, deep = E......+L";
  for (const char* scene : {"glass", "ring"}) {
    INFO(scene);
    session::Renderer renderer(test::renderer_options(false));
    renderer.settings().set("path.batch", test::k_batch);
    renderer.set_size(k_side, k_side);
    renderer.load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/" + scene + "/" + scene + ".gltf");
    test::set(renderer, {{"film.layers", text},
                         {"samples", std::to_string(k_samples)},
                         {"components.caustic", "path"},
                         {"lights.sampling", "power"}});
    const film::Image image = test::finish(renderer);
    recording::Recording all = renderer.paths().begin();
    const session::PathSelection selection{.right = k_side, .bottom = k_side, .samples = k_samples};
    REQUIRE(renderer.paths().record(session::choices_of(selection, k_side, k_side), all, {},
                                    transport::PathRecorder::k_events));
    CHECK(all.lost() == 0);
    const paths::LayerSet set(paths::compile_components(), text, {});
    std::vector<std::vector<vec3>> sums(set.size(), std::vector<vec3>(k_side * k_side, vec3(0)));
    for (const recording::Path& path : all.paths) {
      const auto events = all.events_of(path);
      for (uint32_t i = 0; i < events.size(); ++i) {
        if (!recording::contributes_light(events[i])) continue;
        const std::string word = recording::word_of(events, i);
        for (uint32_t l = 0; l < set.size(); ++l)
          if (paths::matches(set.layers()[l].expression, word))
            sums[l][path.pixel] += events[i].contribution / float(k_samples);
      }
    }
    double lit = 0;
    for (uint32_t l = 0; l < set.size(); ++l) {
      INFO(set.layers()[l].name);
      lit += test::mean(sums[l]) > 0 ? 1 : 0;
      CHECK(worst_difference(image.layers[l], sums[l]) < 1e-5);
    }
    CHECK(lit >= 3);
  }
}

TEST_CASE("errors of layers with the components' expressions are the components' errors") {
  for (const bool mixed : {false, true}) {
    session::Renderer renderer(test::renderer_options(!mixed));
    renderer.settings().set("path.batch", test::k_batch);
    renderer.set_size(44, 36);  // with blocks that are cut
    const char* scene = mixed ? "gallery" : "glass";
    renderer.load(fmt::format("{}/scenes/{}/{}.gltf", LUCERNA_SOURCE_DIR, scene, scene));
    test::set(renderer, {{"film.layers", k_layers}, {"samples", "6"}});
    if (mixed) {
      test::set(renderer, {{"relight.enabled", "compact"}});
      test::set(renderer,
                {{"relight.mix", fmt::format("{}: ev=2", renderer.relight().groups->groups[0].name)}});
    }
    test::finish(renderer);
    const film::ImageError error = renderer.image_error();
    REQUIRE(error.layers.size() == 5);
    for (size_t k = 0; k < 5; ++k) {
      INFO(scene << " " << k);
      CHECK(error.layers[k].luminance == Approx(error.luminance[k]).epsilon(1e-4));
      CHECK(error.layers[k].rms == Approx(error.rms[k]).epsilon(1e-4).margin(1e-9));
      CHECK(error.layers[k].seen_rms == Approx(error.seen_rms[k]).epsilon(1e-4).margin(1e-9));
    }
    CHECK(error.layers[1].seen_rms > 0);
    renderer.finish_ledger();
    const stats::Ledger& ledger = renderer.progress().ledger();
    CHECK(ledger.layers() ==
          std::vector<std::string>{"all", "own-primary", "own-secondary", "own-tertiary", "own-caustic"});
    REQUIRE(ledger.entries().back().layers.size() == 5);
    CHECK(ledger.entries().back().layers[2] == error.layers[2].seen_rms);
    const auto status = renderer.layer_status(renderer.image());
    CHECK(status.at(3).error == error.layers[3].seen_rms);
    CHECK(status.at(3).error_of_mean == error.relative(error.layers[3]));
  }
}

TEST_CASE("layers follow a mix of light groups as the components do") {
  session::Renderer renderer(test::renderer_options(false));
  renderer.settings().set("path.batch", test::k_batch);
  renderer.set_size(32, 32);
  renderer.load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/gallery/gallery.gltf");
  test::set(renderer, {{"film.layers", k_layers}, {"samples", "4"}, {"relight.enabled", "compact"}});
  const film::Image before = test::finish(renderer);
  REQUIRE(renderer.film().is_compact());
  const std::string group = renderer.relight().groups->groups[0].name;
  test::set(renderer, {{"relight.mix", fmt::format("{}: ev=2", group)}});
  const film::Image mixed = test::finish(renderer);
  CHECK(worst_difference(mixed.layers[1], before.layers[1]) > 0.05);
  for (size_t k = 0; k < 4; ++k) CHECK(worst_difference(mixed.layers[1 + k], mixed.components[k]) < 1e-5);
}

TEST_CASE("what stored light does not tell apart is missing, and said") {
  session::Renderer renderer(test::renderer_options(false));
  renderer.settings().set("path.batch", test::k_batch);
  renderer.set_size(16, 16);
  renderer.load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/cornell/cornell.gltf");
  test::Settings settings = test::dense_records({{"components.secondary", "cache"},
                                                 {"components.tertiary", "cache"},
                                                 {"film.layers", "three = EDDDL, mine = ED.*L"},
                                                 {"samples", "2"}});
  settings["cache.max_records"] = test::k_room;
  test::set(renderer, settings);
  film::Image image = test::finish(renderer);
  auto status = renderer.layer_status(image);
  REQUIRE(status.size() == 2);
  CHECK(status[0].lacks == "tertiary");
  const float part = luminance(status[0].mean);
  CHECK(status[1].lacks.empty());
  CHECK(status[1].share > 0.5);
  CHECK_FALSE(status[0].error);
  CHECK(status[1].error.value() > 0);
  test::set(renderer, {{"components.tertiary", "path"}, {"components.secondary", "path"}});
  image = test::finish(renderer);
  status = renderer.layer_status(image);
  CHECK(status[0].lacks.empty());
  CHECK(luminance(status[0].mean) > 2 * part);
}

TEST_CASE("layers are shown and written, and another set of them restarts the picture alone") {
  const test::Folder folder;
  session::Renderer renderer(test::renderer_options(true));
  renderer.settings().set("path.batch", test::k_batch);
  renderer.set_size(24, 16);
  renderer.load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/glass/glass.gltf");
  test::set(renderer, {{"film.layers", "mirrored = ES.*L, first = E[SG]*L|E[SG]*DL"}, {"samples", "2"}});
  test::finish(renderer);
  const auto shown = [&](const char* layer) {
    test::set(renderer, {{"film.layer", layer}});
    return renderer.output().picture(false);
  };
  CHECK(shown("first") == shown("primary"));
  CHECK(shown("mirrored") != shown("primary"));
  CHECK(shown("mirrored") != shown("beauty"));
  const std::filesystem::path file = folder.path / "layers.exr";
  renderer.output().save(file);
  const film::FilmImage written = film::read_exr(file);
  const auto has = [&](const char* name) {
    return std::any_of(written.channels.begin(), written.channels.end(),
                       [&](const auto& channel) { return channel.first == name; });
  };
  CHECK(has("mirrored.R"));
  CHECK(has("first.B"));
  CHECK(has("primary.G"));
  // The halves, for the noise of a pixel.
  const film::FilmImage halves = renderer.output().film_image_with_halves();
  CHECK(halves.layer("odd.mirrored").size() == 3);
  // Refused, and nothing has changed.
  for (const auto& [key, value] : test::Settings{{"film.layers", "a = DL"}, {"film.layer", "nothing"}}) {
    INFO(key);
    CHECK_THROWS_AS(test::set(renderer, {{key, value}}), Error);
    CHECK(renderer.settings().text("film.layers") == "mirrored = ES.*L, first = E[SG]*L|E[SG]*DL");
  }
  // Without the layer that is shown, the picture is.
  test::set(renderer, {{"film.layer", "mirrored"}});
  test::set(renderer, {{"film.layers", "first = EDL"}});
  CHECK(renderer.settings().text("film.layer") == "beauty");
  CHECK(test::finish(renderer).layers.size() == 1);
  test::set(renderer, {{"film.layers", ""}});
  CHECK(test::finish(renderer).layers.empty());
  CHECK(renderer.device().validation_messages() == 0);
}

}  // namespace layers_tests
