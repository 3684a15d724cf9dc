// links: session
// Recorded paths are the picture's: their contributions sum to its film, component by component; recording
// changes no picture; two recordings are equal; what does not fit is counted.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "recording/recording.h"
#include "support/render.h"

namespace path_recording_tests {

using namespace lucerna;

namespace {

constexpr uint32_t k_side = 16, k_samples = 4;

std::unique_ptr<session::Renderer> renderer_of(const std::string& scene, const test::Settings& settings,
                                               uint32_t samples = k_samples, bool validated = false) {
  auto renderer = std::make_unique<session::Renderer>(test::renderer_options(validated));
  renderer->settings().set("path.batch", test::k_batch);
  renderer->set_size(k_side, k_side);
  renderer->load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/" + scene + "/" + scene + ".gltf");
  test::Settings all = test::dense_records(settings);
  all["samples"] = std::to_string(samples);
  all.try_emplace("cache.max_records", test::k_room);
  // What is learned about lights changes while the picture is rendered.
  all.try_emplace("lights.sampling", "power");
  test::set(*renderer, all);
  return renderer;
}

session::PathSelection all_paths(uint32_t samples = k_samples) {
  return {.right = k_side, .bottom = k_side, .samples = samples};
}

recording::Recording record(session::Renderer& renderer, const session::PathSelection& selection,
                            uint32_t events = transport::PathRecorder::k_events) {
  recording::Recording all = renderer.paths().begin();
  REQUIRE(renderer.paths().record(session::choices_of(selection, k_side, k_side), all, {}, events));
  return all;
}

/// Compares the mean light of the recorded paths with the film, pixel by pixel and component by component.
void check_sums(const recording::Recording& all, const film::Image& image, uint32_t samples) {
  std::vector<recording::Light> sums(k_side * k_side);
  for (const recording::Path& path : all.paths) {
    const recording::Light light = recording::light_of(all.events_of(path));
    for (size_t c = 0; c < light.size(); ++c)
      for (size_t k = 0; k < 3; ++k) sums[path.pixel][c][k] += light[c][k] / samples;
  }
  double worst = 0, brightest = 0;
  for (size_t i = 0; i < sums.size(); ++i)
    for (size_t c = 0; c < 4; ++c)
      for (int k = 0; k < 3; ++k) {
        const double film = double(image.components[c][i][k]);
        brightest = std::max(brightest, film);
        worst = std::max(worst, std::abs(sums[i][c][size_t(k)] - film) / (film + 1e-6));
      }
  CHECK(brightest > 0);
  CHECK(worst < 2e-6);
}

uint32_t count(const recording::Recording& all, uint32_t kind) {
  uint32_t n = 0;
  for (const recording::Event& e : all.events) n += recording::kind_of(e) == kind ? 1 : 0;
  return n;
}

bool same(const recording::Recording& a, const recording::Recording& b) {
  return a.paths == b.paths && a.events.size() == b.events.size() &&
         std::memcmp(a.events.data(), b.events.data(), a.events.size() * sizeof(recording::Event)) == 0;
}

}  // namespace

TEST_CASE("the light of all recorded paths is the film's, by component") {
  struct Case {
    const char* scene;
    test::Settings settings;
    uint32_t kind;  // of an event that must be there
  };
  const Case cases[] = {{"ring", {{"components.caustic", "path"}}, shared::k_path_blocked},
                        {"glass", {}, shared::k_path_background},
                        {"cornell", {}, shared::k_path_emission},
                        {"cornell",
                         {{"components.secondary", "cache"}, {"components.tertiary", "cache"}},
                         shared::k_path_records},
                        {"cornell", {{"relight.enabled", "on"}}, shared::k_path_light}};
  for (const Case& c : cases) {
    INFO(c.scene << (c.settings.empty() ? "" : " ") << (c.settings.empty() ? "" : c.settings.begin()->first));
    const auto renderer = renderer_of(c.scene, c.settings, k_samples, &c == cases);
    const film::Image image = test::finish(*renderer);
    const recording::Recording all = record(*renderer, all_paths());
    CHECK(all.paths.size() == k_side * k_side * k_samples);
    CHECK(all.lost() == 0);
    CHECK(count(all, c.kind) > 0);
    check_sums(all, image, k_samples);
    // Every word belongs to the component of its light.
    const paths::Automaton automaton = paths::compile_components();
    size_t words = 0;
    for (const recording::Path& path : all.paths) {
      const auto events = all.events_of(path);
      for (uint32_t i = 0; i < events.size(); ++i) {
        // Light that a vertex has met is listed before the path's end there.
        if (i > 0 && recording::kind_of(events[i]) == shared::k_path_emission &&
            recording::kind_of(events[i - 1]) == shared::k_path_end)
          FAIL_CHECK("emission after the end");
        const std::string word = recording::word_of(events, i);
        if (!recording::contributes_light(events[i])) continue;
        if (recording::is_open(word)) {
          // What is known of stored light belongs to its component too.
          const std::string way = word.substr(0, word.find(' '));
          const auto diffuse = uint32_t(std::count(way.begin(), way.end(), 'D'));
          if (recording::rest_of_way(recording::component_of(events[i]), diffuse).empty()) FAIL_CHECK(word);
          continue;
        }
        if (automaton.classify(word) != recording::component_of(events[i])) FAIL_CHECK(word);
        ++words;
      }
    }
    CHECK(words > 100);
    CHECK(renderer->device().validation_messages() == 0);
  }
}

TEST_CASE("paths that read photons say how many; their light is that of the picture's only pass") {
  const auto renderer = renderer_of("ring", {{"components.caustic", "photons"}}, 1);
  const film::Image image = test::finish(*renderer);
  const recording::Recording all = record(*renderer, all_paths(1));
  uint32_t photons = 0;
  for (const recording::Event& e : all.events)
    if (recording::kind_of(e) == shared::k_path_photons) photons += e.served;
  CHECK(photons > 0);
  check_sums(all, image, 1);
}

TEST_CASE("recording changes no picture, and two recordings are equal") {
  // Photons: recorded while their pilot's notes are being taken.
  for (const char* caustic : {"path", "photons"}) {
    INFO(caustic);
    const test::Settings settings{{"components.caustic", caustic}};
    const auto plain = renderer_of("ring", settings), recorded = renderer_of("ring", settings);
    const film::Image expected = test::finish(*plain);
    while (recorded->step()) record(*recorded, {.right = k_side, .bottom = 1});
    CHECK(test::identical(expected, recorded->image()));
    CHECK(recorded->stats().rays == plain->stats().rays);
    CHECK(same(record(*plain, all_paths()), record(*recorded, all_paths())));
    CHECK(same(record(*plain, all_paths()), record(*plain, all_paths())));
  }
}

TEST_CASE("recording while records are built changes none of them") {
  const test::Settings settings{{"components.secondary", "cache"}, {"components.tertiary", "cache"}};
  const auto plain = renderer_of("cornell", settings), recorded = renderer_of("cornell", settings);
  const film::Image expected = test::finish(*plain);
  while (recorded->step()) record(*recorded, {.right = k_side, .bottom = 1});
  CHECK(test::identical(expected, recorded->image()));
}

TEST_CASE("recorded paths are drawn with each colour, and a legend for it") {
  const auto r = renderer_of("ring", {});
  test::finish(*r);
  const std::vector<uint8_t> plain = r->output().picture(false);
  r->overlays().show_paths({.of = std::make_shared<recording::Recording>(
                                record(*r, {.left = 8, .top = 8, .right = 12, .bottom = 12, .samples = 2}))});
  std::vector<std::vector<uint8_t>> shown;
  std::vector<std::string> notes;
  for (const char* color : {"event", "component", "contribution", "word", "time"}) {
    INFO(color);
    test::set(*r, {{"overlay.path_color", color}});
    shown.push_back(r->output().picture(false));
    CHECK(shown.back() != plain);
    const auto reports = r->solvers().reports();
    const auto of_paths = std::find_if(reports.begin(), reports.end(),
                                       [](const auto& report) { return report->solver == "paths"; });
    REQUIRE(of_paths != reports.end());
    notes.push_back((*of_paths)->legends.at(0).note);
  }
  CHECK(shown[0] != shown[1]);
  CHECK(shown[1] != shown[2]);
  CHECK(notes[0] != notes[1]);
  CHECK(notes[1] != notes[2]);
  CHECK(shown[3] != shown[1]);
  CHECK(shown[4] != shown[2]);
}

TEST_CASE("the sink is not compiled into the picture's kernels") {
  const auto renderer = renderer_of("cornell", {});
  gpu::ShaderCompiler compiler;
  const gpu::Defines off{};
  gpu::Defines on = off;
  on["LUCERNA_PATH_EVENTS"] = "1";
  for (const char* file : {"transport/camera.comp", "transport/shade.comp", "transport/shadow.comp"}) {
    gpu::Kernel without(renderer->device(), compiler, file, off),
        with(renderer->device(), compiler, file, on);
    const auto names = without.resource_names(), more = with.resource_names();
    CHECK(std::find(names.begin(), names.end(), "PathEvents") == names.end());
    CHECK(std::find(more.begin(), more.end(), "PathEvents") != more.end());
  }
}

TEST_CASE("events without room are counted, and only they are missing") {
  const auto renderer = renderer_of("glass", {});
  test::finish(*renderer);
  const session::PathSelection few{.right = k_side, .bottom = 4, .samples = 2};
  const recording::Recording all = record(*renderer, few), cut = record(*renderer, few, 6);
  REQUIRE(all.paths.size() == cut.paths.size());
  uint64_t missing = 0;
  for (size_t i = 0; i < all.paths.size(); ++i) {
    CHECK(cut.paths[i].count <= 6);
    CHECK(cut.paths[i].count + cut.paths[i].lost == all.paths[i].count);
    missing += cut.paths[i].lost;
  }
  CHECK(missing > 0);
  CHECK(cut.lost() == missing);
  CHECK(same(cut, record(*renderer, few, 6)));
}

TEST_CASE("a selection is clipped to the picture, and takes every n-th path") {
  const auto choices = session::choices_of(
      {.left = 14, .top = 15, .right = 99, .bottom = 99, .first_sample = 4, .samples = 3, .every = 2}, 16,
      16);
  REQUIRE(choices.size() == 3);
  CHECK(choices[0].pixel == 15 * 16 + 14);
  CHECK(choices[0].sample_index == 4);
  CHECK(choices[1].sample_index == 6);
  CHECK(choices[2].pixel == 15 * 16 + 15);
  CHECK(choices[2].sample_index == 5);
}

}  // namespace path_recording_tests
