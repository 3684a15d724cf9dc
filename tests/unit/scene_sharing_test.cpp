// links: scene
// Copies of a scene share large data until it is changed.
#include <catch2/catch.hpp>

#include "scene/scene.h"

namespace scene_sharing_tests {

using namespace lucerna;

TEST_CASE("an edited copy of a scene shares geometry, images and textures, and owns its changes") {
  scene::Scene scene;
  scene.images.resize(2);
  scene.images[0].bytes = {1, 2, 3, 4};
  scene.textures = {{.image = 0}, {.image = 1}};
  scene.meshes.push_back({"mesh", {}});
  scene.instances.resize(3);
  scene.lights.resize(1);
  const scene::Scene& before = scene;
  scene::Scene edited = scene;
  edited.lights[0].intensity = vec3(7);
  const scene::Scene& after = edited;
  CHECK(after.images.shares_with(before.images));
  CHECK(after.textures.shares_with(before.textures));
  CHECK(after.meshes.shares_with(before.meshes));
  CHECK(after.instances.shares_with(before.instances));
  CHECK(after.images[0].bytes.data() == before.images[0].bytes.data());
  // After a change it is a separate copy, and the other stays as it was.
  edited.images[0].bytes[0] = 9;
  CHECK_FALSE(after.images.shares_with(before.images));
  CHECK(before.images[0].bytes[0] == 1);
  CHECK(after.images[0].bytes[0] == 9);
  edited.textures.push_back({.image = 1});
  CHECK(before.textures.size() == 2);
  CHECK(after.textures.size() == 3);
  // A sole owner is changed in place.
  const uint8_t* at = after.images[0].bytes.data();
  edited.images[0].bytes[1] = 8;
  CHECK(after.images[0].bytes.data() == at);
}

TEST_CASE("an empty one reads as empty") {
  const SharedVector<int> none;
  CHECK(none.empty());
  CHECK(none.begin() == none.end());
  SharedVector<int> some{1, 2};
  some.clear();
  CHECK(some.empty());
  CHECK(some.shares_with(none));
}

}  // namespace scene_sharing_tests
