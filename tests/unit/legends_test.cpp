// links: irradiance_cache photons light_tracing
// Every view that a solver draws over the picture has a legend that says in words what is drawn.
#include <catch2/catch.hpp>

#include "shaders/shared/photons/inspect.h"
#include "shaders/shared/photons/photons.h"
#include "solvers/irradiance_cache/info.h"
#include "solvers/irradiance_cache/report.h"
#include "solvers/light_tracing/report.h"
#include "solvers/photons/report.h"

namespace legends_tests {

using namespace lucerna;

namespace {

void check(const solvers::Report& report, size_t count) {
  REQUIRE(report.legends.size() == count);
  for (const solvers::Legend& legend : report.legends) {
    INFO(legend.title);
    CHECK(legend.title.size() > 4);
    CHECK(legend.note.size() > 20);
    CHECK((legend.note.empty() || legend.note.back() == '.'));
    CHECK(legend.note.size() < 150);  // three lines
  }
}

}  // namespace

TEST_CASE("records and how their places were chosen") {
  using namespace irradiance_cache;
  for (uint32_t color = 0; color < 5; ++color)
    for (const char* view : {"overlay.records", "overlay.normals"}) {
      OptionValues settings(info().options);
      settings.set(view, "true");
      CacheReport report;
      report.color = color;
      check(make_report(report, settings), 1);
    }
  OptionValues settings(info().options);
  for (const PlacementShow show :
       {PlacementShow::candidates, PlacementShow::clusters, PlacementShow::chosen}) {
    CacheReport report;
    report.placement = show;
    check(make_report(report, settings), 1);
  }
  settings.set("overlay.overlap", "true"), settings.set("overlay.discontinuity", "geometry");
  check(make_report(CacheReport{}, settings), 2);
}

TEST_CASE("photons, their density, paths of light and what they are aimed at") {
  check(photons::make_report({}), 0);
  for (uint32_t view = shared::k_photons_by_flux; view <= shared::k_photons_by_round; ++view) {
    photons::PhotonReport report;
    report.view = view;
    check(photons::make_report(report), 1);
  }
  for (const uint32_t of : {shared::k_density_of_photons, shared::k_density_of_irradiance,
                            shared::k_density_of_importance, shared::k_density_of_caustics}) {
    photons::PhotonReport report;
    report.density = {.of = of, .lo = 1, .hi = 1000};
    check(photons::make_report(report), 1);
  }
  photons::PhotonReport paths;
  paths.paths_shown = paths.aim_shown = true;
  paths.aimed.push_back({.light = "Lamp", .share = 1});
  check(photons::make_report(paths), 2);
  light_tracing::LightTracingReport light;
  light.paths_shown = light.aim_shown = true;
  light.aimed = paths.aimed;
  check(light_tracing::make_report(light), 2);
}

}  // namespace legends_tests
