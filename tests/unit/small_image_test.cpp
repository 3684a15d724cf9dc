// links: film_io scene
// Small images of files, for lists of them.
#include "film/io/small_image.h"

#include "film/io/image_file.h"
#include "unit/scene_support.h"

namespace small_image_tests {

using namespace lucerna;
using namespace lucerna::test;

TEST_CASE("images are made small by means, keep their shape, and say whether they are encoded") {
  TempFolder folder;
  std::vector<uint8_t> bytes;
  for (int i = 0; i < 8 * 4; ++i)
    for (const int x : {i % 2 ? 255 : 0, 128, 0, 255}) bytes.push_back(uint8_t(x));
  write_image<uint8_t>(folder / "a.png", 8, 4, 4, bytes);
  const film::SmallImage png = film::read_small_image((folder / "a.png").string(), 4);
  CHECK((png.width == 4 && png.height == 2 && png.encoded));
  REQUIRE(png.colours.size() == 8);
  for (const vec3& c : png.colours) CHECK(glm::distance(c, vec3(0.5f, 128 / 255.0f, 0)) < 0.01f);

  film::FilmImage sky;
  sky.width = 2, sky.height = 1;
  for (const char* c : {"R", "G", "B"})
    sky.channels.emplace_back(c, std::vector<float>{5000, std::numeric_limits<float>::quiet_NaN()});
  film::write_exr(folder / "sky.exr", sky);
  const film::SmallImage exr = film::read_small_image((folder / "sky.exr").string(), 100);
  CHECK((exr.width == 2 && exr.height == 1 && !exr.encoded));
  CHECK(exr.colours[0] == vec3(5000));
  CHECK(exr.colours[1] == vec3(0));

  write(folder / "text.png", std::string("no image"));
  CHECK_THROWS_WITH(film::read_small_image((folder / "text.png").string(), 9),
                    Catch::Contains("text.png: cannot be read"));
}

}  // namespace small_image_tests
