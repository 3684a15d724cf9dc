// links: session
// Views of learned lights: arrows from the point under the pointer to the lights chosen there, and the shadow
// rays that arrive. They do not change the picture.
#include "images/learned_lights_support.h"

namespace lights_view_tests {

using namespace lucerna;
using test::sky, test::window_room;

namespace {

const solvers::Report* of_lights(const std::vector<std::shared_ptr<const solvers::Report>>& reports) {
  for (const auto& report : reports)
    if (report->solver == "lights") return report.get();
  return nullptr;
}

size_t different(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b) {
  size_t count = 0;
  for (size_t i = 0; i < a.size(); i += 4) count += std::memcmp(&a[i], &b[i], 4) != 0;
  return count;
}

}  // namespace

TEST_CASE("arrows show a point's lights with their shares, and a map shows which shadow rays arrive") {
  session::Renderer r(test::renderer_options());
  r.settings().set("path.batch", test::k_batch);
  r.set_size(48, 48);
  r.set_scene(std::make_shared<scene::Scene>(window_room(sky(), false)));
  test::set(r, {{"samples", "8"}, {"lights.portals", "marked"}});
  const film::Image image = test::finish(r);
  const std::vector<uint8_t> plain = r.output().picture(false);
  CHECK(of_lights(r.solvers().reports()) == nullptr);

  test::set(r, {{"overlay.lights", "true"}});
  CHECK(r.output().picture(false) == plain);  // no point is inspected
  {
    const auto reports = r.solvers().reports();
    const solvers::Report* report = of_lights(reports);
    REQUIRE(report);
    REQUIRE(report->legends.size() == 1);
    CHECK_FALSE(report->card);
  }
  r.overlays().inspect(vec2(0.3f, 0.5f));
  CHECK(different(r.output().picture(false), plain) > 20);
  {
    const auto reports = r.solvers().reports();
    const solvers::Report* report = of_lights(reports);
    REQUIRE(report);
    REQUIRE(report->card);
    // Parts of the environment, the largest first, whose shares sum to at most 100 %.
    double sum = 0, before = 100;
    size_t parts = 0;
    for (const solvers::Card::Line& line : report->card->lines)
      if (const auto* row = std::get_if<solvers::Card::Row>(&line.what);
          row && row->name.starts_with("sky, ")) {
        const double share = std::stod(row->value);
        CHECK(share <= before);
        before = share, sum += share, ++parts;
      }
    CHECK(parts > 3);
    CHECK(sum > 10);
    CHECK(sum <= 100.5);
  }
  r.overlays().inspect(std::nullopt);
  test::set(r, {{"overlay.lights", "false"}, {"overlay.light_arrival", "true"}});
  CHECK(different(r.output().picture(false), plain) > 48 * 48 / 2);
  {
    const auto reports = r.solvers().reports();
    const solvers::Report* report = of_lights(reports);
    REQUIRE(report);
    REQUIRE(report->legends.size() == 1);
    CHECK(report->legends[0].ramp);
    CHECK_FALSE(report->legends[0].note.empty());
    CHECK(report->figure("arrived") > 0.02);
  }
  test::set(r, {{"overlay.light_arrival", "false"}});
  CHECK(r.output().picture(false) == plain);
  CHECK(of_lights(r.solvers().reports()) == nullptr);
  CHECK(test::identical(r.image(), image));
  // With selection by power there is nothing to show, and the legend states this.
  test::set(r, {{"lights.sampling", "power"}, {"overlay.light_arrival", "true"}});
  test::finish(r);
  r.output().picture(false);
  const auto reports = r.solvers().reports();
  REQUIRE(of_lights(reports));
  CHECK(of_lights(reports)->legends.size() == 1);
  CHECK(r.device().validation_messages() == 0);
}

TEST_CASE("clusters lie at their lamps or at the bright part of the environment, and have names") {
  scene::Scene s = test::block_room();
  s.lights.push_back(s.lights[0]);
  s.lights[1].name = "second", s.lights[1].position = {-1, 2, 1};
  s.lights.push_back(s.lights[0]);
  s.lights[2].name = "sun", s.lights[2].kind = scene::LightKind::directional;
  s.lights[2].direction = vec3(0, -1, 0);
  s.images.push_back(sky());
  s.environment.image = 0;
  const upload::FlatScene flat = upload::flatten(s);
  const upload::LightClusters clusters = upload::make_light_clusters(flat);
  REQUIRE(clusters.places.size() == clusters.count());
  size_t lamps = 0;
  for (uint32_t c = 0; c < clusters.count(); ++c) {
    const upload::ClusterPlace& place = clusters.places[c];
    CHECK(place.is_sky == (c < clusters.sky));
    const std::string text = session::cluster_text(place, flat, s);
    if (place.is_sky) {
      CHECK(text.starts_with("sky, "));
      CHECK(glm::length(place.at) == Approx(1));
    } else if (text == "sun") {
      CHECK(glm::length(place.at - vec3(0, 1, 0)) < 1e-5f);
    } else {
      CHECK(glm::length(place.at - s.lights[text == "lamp" ? 0 : 1].position) < 1e-5f);
      ++lamps;
    }
  }
  CHECK(lamps == 2);
}

}  // namespace lights_view_tests
