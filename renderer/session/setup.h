#pragma once
// Everything that a renderer computes its picture from. Edits change it through a Transaction.
#include <memory>
#include <string>

#include "film/error.h"
#include "film/film.h"
#include "plan/settings.h"
#include "scene/scene.h"
#include "scene/view_text.h"
#include "session/engine.h"
#include "session/kept_solvers.h"
#include "session/relight.h"
#include "session/world.h"

namespace lucerna::session {

struct Setup {
  plan::Settings settings;
  scene::Camera camera;
  uint32_t width = 1280, height = 720;  ///< of the picture
  float ocio_white = 0;                 ///< film::OcioConfig::white() of film.ocio; 0: the tone curve is used
  World world;
  Relight relight;
  std::unique_ptr<Engine> engine;            ///< null before the first scene; destroyed before the world
  KeptSolvers kept;                          ///< unused solvers
  std::unique_ptr<film::Film> film, coarse;  ///< null before the first scene; `coarse`: of preview samples

  PictureView view(const paths::Automaton& automaton) const {
    return {automaton, settings, world, camera, width, height, relight.weights};
  }
  std::string view_text() const { return scene::view_text(camera); }
  film::SeenRange seen_range() const;
  uint32_t tile_side() const;  ///< sampling.tile [pixels]
  std::string tracer_name() const { return world.host ? "host" : "compute-bvh"; }
};

}  // namespace lucerna::session
