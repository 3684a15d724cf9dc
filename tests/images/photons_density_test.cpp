// links: session
// Views of photons: density and irradiance as heat maps with a scale, and the disc under the pointer with its
// photons.
#include <catch2/catch.hpp>
#include <set>

#include "solvers/photons/solver.h"
#include "support/caustics.h"

namespace photons_density_tests {

using namespace lucerna;

namespace {

struct Shown {
  session::Renderer r{test::renderer_options()};
  photons::PhotonSolver* photons = nullptr;
  explicit Shown(const scene::Scene& scene = test::turned_sun(vec3(1))) {
    r.set_size(48, 40);
    r.set_scene(std::make_shared<scene::Scene>(scene));
    test::set(r, {{"components.caustic", "photons"},
                  {"photons.efficiency", "false"},
                  {"photons.per_round", "200000"},
                  {"photons.importons", "false"},
                  {"samples", "2"}});
    test::finish(r);
    photons = &dynamic_cast<photons::PhotonSolver&>(*r.solver("photons"));
  }
  ~Shown() { CHECK(r.device().validation_messages() == 0); }
  std::shared_ptr<const solvers::Report> report() {
    for (const auto& report : r.solvers().reports())
      if (report->solver == "photons") return report;
    return nullptr;
  }
};

double mean(const std::vector<float>& values) {
  double sum = 0;
  for (const float v : values) sum += double(v);
  return sum / double(values.size());
}

}  // namespace

TEST_CASE("the density map equals the pass's photons per area, and irradiance equals the sun's") {
  Shown s;
  const std::vector<uint8_t> plain = s.r.output().picture(false);
  test::set(s.r, {{"overlay.photon_density", "photons"}});
  const std::vector<uint8_t> shown = s.r.output().picture(false);
  CHECK(plain != shown);
  // All photons of the pass are distributed evenly over the floor of four square metres.
  const double density = double(s.photons->map().figures().photons) / 4;
  CHECK(mean(s.photons->inspector().densities()) == Approx(density).epsilon(0.03));
  auto report = s.report();
  REQUIRE(report->legends.size() == 1);
  REQUIRE(report->legends[0].range);
  CHECK(double(report->legends[0].range->hi) > density);
  CHECK(report->legends[0].range->lo < report->legends[0].range->hi);
  test::set(s.r, {{"overlay.photon_density", "irradiance"}});
  CHECK(s.r.output().picture(false) != plain);
  CHECK(mean(s.photons->inspector().densities()) == Approx(double(luminance(vec3(3, 4, 5)))).epsilon(0.03));
  CHECK(s.report()->legends[0].title.find("Irradiance") != std::string::npos);
  test::set(s.r, {{"overlay.photon_density", "off"}});
  CHECK(s.r.output().picture(false) == plain);
  CHECK(s.report()->legends.empty());
}

TEST_CASE("through glass and in mirrors the irradiance of the surface behind is shown") {
  // A small slab directly below the camera, through which the entire floor is seen.
  scene::Scene glass = test::turned_sun(vec3(1));
  glass.materials.push_back({});
  glass.materials[2].metallic = 0, glass.materials[2].transmission = 1, glass.materials[2].roughness = 0,
  glass.materials[2].ior = 1.5f;
  glass.materials[2].thickness = 1;
  test::add_quad(glass, {-0.04f, 0.87f, 0.04f}, {0.08f, 0, 0}, {0, 0, -0.08f}, 2);
  test::add_quad(glass, {-0.04f, 0.86f, 0.04f}, {0, 0, -0.08f}, {0.08f, 0, 0}, 2);
  // The floor seen from beside it, in a mirror that turns the view by a right angle.
  scene::Scene mirror = test::turned_sun(vec3(1));
  mirror.cameras[0].to_world = mat4(0, 0, 1, 0, 0, 1, 0, 0, -1, 0, 0, 0, -0.1f, 0.8f, 0, 1);  // along x
  test::add_quad(mirror, {-0.08f, 0.88f, -0.08f}, {0.16f, -0.16f, 0}, {0, 0, 0.16f}, 1);
  for (const scene::Scene& scene : {glass, mirror}) {
    Shown s(scene);
    test::set(s.r, {{"overlay.photon_density", "irradiance"}});
    s.r.output().picture(false);
    const std::vector<float> found = s.photons->inspector().densities();
    CHECK(mean(found) == Approx(double(luminance(vec3(3, 4, 5)))).epsilon(0.05));
    s.photons->look_at(vec2(0.5f, 0.5f));
    s.r.output().picture(false);
    REQUIRE(s.photons->inspected());
    CHECK(std::abs(s.photons->inspected()->at.position.y) < 1e-3f);
    CHECK(s.photons->inspected()->at.normal.y > 0.999f);
  }
}

TEST_CASE("rates of sending, storing, sorting and gathering photons are reported") {
  Shown s;
  const auto own = s.r.solvers().statistics().at("photons");
  const auto& rates = own.at("per_second");
  for (const char* what : {"emitted", "stored", "sorted", "looked_up", "gathered"}) CHECK(rates.at(what) > 0);
  // The number of photons in a disc follows its area. The radius grows with the distance from the camera, 0.9
  // m above the floor's middle.
  const auto& at = s.photons->map();
  const double up = std::tan(0.4), right = 1.2 * up;
  const double radius = double(at.lookup().slope) * 0.9 * std::sqrt(1 + (up * up + right * right) / 3);
  const double expected = double(at.figures().photons) / 4 * double(k_pi) * radius * radius;
  CHECK(double(rates.at("gathered_a_lookup")) == Approx(expected).epsilon(0.1));
  CHECK(double(rates.at("gathered")) == Approx(double(rates.at("looked_up")) * expected).epsilon(0.1));
  // The panel shows the same plus aiming, and benches read the seconds.
  const std::shared_ptr<const solvers::Report> report = s.report();
  REQUIRE(!report->sections.empty());
  std::set<std::string> rows;
  for (const solvers::PanelItem& item : report->sections[0].items)
    if (const auto* row = std::get_if<solvers::ValueRow>(&item)) rows.insert(row->name);
  for (const char* name : {"Casters", "Aimed", "Tracing rate", "Storing rate", "Sorting rate", "Memory"})
    CHECK(rows.count(name) == 1);
  CHECK(s.r.solvers().figure("seconds of light paths") > 0);
  CHECK(s.r.solvers().figure("seconds of sorting photons") > 0);
}

TEST_CASE("the view at the pointer shows the disc and its photons, with their contributions") {
  Shown s;
  test::set(s.r, {{"overlay.photon_density", "irradiance"}});
  const std::vector<uint8_t> without = s.r.output().picture(false);
  CHECK(!s.report()->card);
  s.photons->look_at(vec2(0.5f, 0.5f));
  CHECK(s.r.output().picture(false) != without);
  REQUIRE(s.photons->inspected());
  const photons::Inspected& found = *s.photons->inspected();
  CHECK(glm::length(found.at.position) < 0.05f);
  CHECK(found.at.normal.y > 0.999f);
  CHECK(found.at.area == Approx(1));
  CHECK(found.photons.size() == std::min(found.at.count, shared::k_photons_inspected));
  // The number of photons in the disc follows its area.
  const double expected =
      double(s.photons->map().figures().photons) / 4 * double(k_pi * found.at.radius * found.at.radius);
  CHECK(double(found.at.count) == Approx(expected).epsilon(0.2));
  double sum = 0;
  for (const shared::PhotonInspected& p : found.photons) {
    sum += double(p.contribution);
    CHECK(glm::distance(p.position, found.at.position) < found.at.radius * 1.01f);
    CHECK(p.direction.y == Approx(1).margin(1e-3));  // from above
    CHECK((p.bits >> shared::k_photon_events_shift & shared::k_photon_most_events) == 1);
  }
  if (found.at.count <= shared::k_photons_inspected)
    CHECK(sum == Approx(double(luminance(found.at.irradiance))).epsilon(1e-3));
  const auto report = s.report();
  REQUIRE(report->card);
  CHECK(report->looked_at);
  CHECK(report->card->lines.size() > 5);
  // Without a surface under the pointer nothing is drawn, and zero photons are not an error.
  s.photons->look_at(std::nullopt);
  CHECK(s.r.output().picture(false) == without);
}

TEST_CASE("importance is shown where lookups take place, and is even where lookups are") {
  Shown s;
  const std::vector<uint8_t> plain = s.r.output().picture(false);
  // Without importons there is no importance.
  test::set(s.r, {{"overlay.photon_density", "importance"}});
  s.r.output().picture(false);
  test::set(s.r, {{"photons.importons", "true"}});
  test::finish(s.r);
  s.photons = &dynamic_cast<photons::PhotonSolver&>(*s.r.solver("photons"));  // a new one
  CHECK(s.r.output().picture(false) != plain);
  // A camera that looks straight down sees a plane in even steps, so every cell has as many lookups, up to
  // noise of the pilot.
  const std::vector<float> found = s.photons->inspector().densities();
  const double middle = mean(found);
  CHECK(middle > 0);
  double squares = 0;
  for (const float v : found) squares += std::pow(double(v) / middle - 1, 2);
  CHECK(std::sqrt(squares / double(found.size())) < 0.5);
  CHECK(s.report()->legends[0].title.find("importance") != std::string::npos);
}

TEST_CASE("drawing photons' paths and aim targets does not change the picture") {
  Shown s;
  const std::vector<uint8_t> plain = s.r.output().picture(false);
  const uint64_t rays = s.r.stats().rays;
  test::set(s.r, {{"overlay.photon_paths", "true"}});
  const std::vector<uint8_t> paths = s.r.output().picture(false);
  CHECK(paths != plain);
  CHECK(s.r.output().picture(false) == paths);  // the view does not change
  test::set(s.r, {{"overlay.photon_paths_of", "1"}});
  CHECK(s.r.output().picture(false) != plain);
  test::set(s.r, {{"overlay.photon_paths_of", "2"}});  // there is no such light
  CHECK(s.r.output().picture(false) == plain);
  test::set(s.r, {{"overlay.photon_paths", "false"}, {"overlay.photon_aim", "true"}});
  CHECK(s.r.output().picture(false) != plain);
  CHECK(s.report()->legends.size() == 1);
  size_t rows = 0;
  const std::shared_ptr<const solvers::Report> report = s.report();
  for (const solvers::PanelItem& item : report->sections[0].items)
    if (const auto* table = std::get_if<solvers::Table>(&item)) {
      rows = table->rows.size();
      CHECK(table->rows[0].cells[1] == "sun");
    }
  CHECK(rows == 1);
  test::set(s.r, {{"overlay.photon_aim", "false"}});
  CHECK(s.r.output().picture(false) == plain);
  CHECK(s.r.stats().rays == rays);
  CHECK(s.r.samples() == 2);
}

}  // namespace photons_density_tests
