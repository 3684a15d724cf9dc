// links: scene_io
// The files that a scene can make the program read: those of its folder, by content, and no others.
#include "unit/scene_support.h"

namespace scene_files_tests {

using namespace lucerna;
using namespace lucerna::test;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

/// A folder that contains a scene's folder and, outside that, a red image.
struct Bed {
  TempFolder outer;
  fs::path scene = outer / "scene";
  Bed() {
    fs::create_directories(scene / "textures");
    for (const fs::path& place : {outer / "red.png", scene / "textures" / "red.png"})
      write_image<uint8_t>(place, 1, 1, 3, {255, 0, 0});
  }
  /// A scene with an image and, unless empty, its buffer's bytes in a file of that name.
  fs::path gltf(const std::string& image, const std::string& buffer = "") const {
    Asset asset;
    const int texture = asset.add("textures", {{"source", asset.add("images", {{"uri", image}})}});
    asset.textured_triangle({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
    json doc = asset.complete(buffer.empty());
    if (!buffer.empty()) doc["buffers"][0]["uri"] = buffer;
    write(outer / "a.bin", asset.bin.data(), asset.bin.size());
    write(scene / "a.gltf", doc.dump());
    return scene / "a.gltf";
  }
};

bool red(const scene::Scene& scene) {
  return scene.images.at(0).bytes == std::vector<uint8_t>{255, 0, 0, 255};
}

}  // namespace

TEST_CASE("files outside the scene's folder are read only if allowed") {
  const Bed bed;
  fs::create_symlink(bed.outer.path, bed.scene / "link");
  fs::create_symlink(bed.outer / "red.png", bed.scene / "linked.png");
  fs::create_symlink(bed.scene / "textures", bed.scene / "within");
  for (const std::string& uri :
       {std::string("../red.png"), std::string("textures/../../red.png"), std::string("%2e%2e/red.png"),
        std::string("..%2Fred.png"), (bed.outer / "red.png").string(), std::string("link/red.png"),
        std::string("linked.png"), std::string("./link/./red.png")}) {
    INFO(uri);
    const fs::path file = bed.gltf(uri);
    const scene::Scene refused = scene::load(file);
    CHECK_FALSE(red(refused));
    CHECK(warnings_with(refused, "1 images lie outside the scene's folder") == 1);
    CHECK(warnings_with(refused, "a.gltf: images[0].uri: '") == 1);
    CHECK(warnings_with(refused, "--allow-outside") == 1);
    CHECK(red(scene::load(file, {.outside = true})));
  }
  for (const char* uri : {"textures/red.png", "within/red.png", "textures/../textures/red.png",
                          "../scene/textures/red.png", "textures/%72ed.png"}) {
    INFO(uri);
    CHECK(red(scene::load(bed.gltf(uri))));
  }
  // Names of other systems and schemes are plain names of missing files.
  for (const char* uri : {"C:\\red.png", "..\\red.png", "file:///etc/hostname", "http://localhost/red.png"}) {
    INFO(uri);
    const scene::Scene scene = scene::load(bed.gltf(uri));
    CHECK(warnings_with(scene, "no such file") == 1);
  }
}

TEST_CASE("a buffer, an environment or settings outside the folder are reported as errors") {
  const Bed bed;
  CHECK(failure(bed.gltf("textures/red.png", "../a.bin")) ==
        (bed.scene / "a.gltf").string() + ": buffers[0].uri: '" + (bed.scene / "../a.bin").string() +
            "' is not in the scene's folder and is not read; --allow-outside reads what scenes name "
            "elsewhere, as "
            "scene.open FILE outside=true does in the window");
  CHECK_NOTHROW(scene::load(bed.scene / "a.gltf", {.outside = true}));

  const fs::path file = bed.gltf("textures/red.png");
  const fs::path settings = bed.scene / "settings.json";
  write(settings, R"({"environment": {"file": "../red.png"}})");
  CHECK_THAT(failure(file), Contains("settings.json: environment.file: '") && Contains("--allow-outside"));
  CHECK_NOTHROW(scene::load(file, {.outside = true}));
  fs::remove(settings);
  write(bed.outer / "theirs.json", R"({"film": {"ev": 3}})");
  fs::create_symlink(bed.outer / "theirs.json", settings);
  CHECK_THAT(failure(file), Contains("settings.json' is not in the scene's folder"));
  CHECK(scene::load(file, {.outside = true}).settings.size() == 1);
  // A link to the scene itself is the user's choice.
  fs::remove(settings);
  fs::create_symlink(bed.scene, bed.outer / "alias");
  CHECK(red(scene::load(bed.outer / "alias" / "a.gltf")));
  // Also from its own folder.
  const fs::path before = fs::current_path();
  fs::current_path(bed.scene);
  CHECK(red(scene::load("a.gltf")));
  bed.gltf("../red.png");
  CHECK_FALSE(red(scene::load("a.gltf")));
  fs::current_path(before);
}

TEST_CASE("an image is decoded from its own bytes, never from a file in the working folder") {
  const TempFolder folder;
  const fs::path before = fs::current_path();
  fs::current_path(folder.path);
  size_t decoded = 0, refused = 0;
  for (const char* ending : {"png", "tif", "bmp", "tga", "webp", "ppm", "hdr", "exr", "dpx", "iff", "sgi",
                             "rgb", "fits", "rla", "ico"}) {
    INFO(ending);
    const std::string decoy = std::string("image.") + ending, mine = std::string("mine.") + ending;
    const auto out = OIIO::ImageOutput::create(decoy);
    if (!out) continue;
    // Green in the image, white in the file of the name that decoders could open.
    write_image<uint8_t>(mine, 16, 16, 3, [] {
      std::vector<uint8_t> texels(3 * 256, 0);
      for (size_t i = 1; i < texels.size(); i += 3) texels[i] = 255;
      return texels;
    }());
    write_image<uint8_t>(decoy, 16, 16, 3, std::vector<uint8_t>(3 * 256, 255));
    if (!fs::exists(mine)) continue;  // a format that cannot be written
    Asset asset;
    const int image = asset.add(
        "images", {{"bufferView", asset.view(bytes_of(mine))}, {"mimeType", std::string("image/") + ending}});
    const int texture = asset.add("textures", {{"source", image}});
    asset.textured_triangle({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
    const scene::Scene scene = scene::load(asset.gltf(folder));
    REQUIRE(scene.images.size() == 1);
    const scene::Image& shown = scene.images[0];
    if (scene.warnings.empty()) {
      ++decoded;
      CHECK(shown.width == 16);
      const float green = shown.floats.empty() ? shown.bytes[1] / 255.0f : shown.floats[1];
      const float red = shown.floats.empty() ? shown.bytes[0] / 255.0f : shown.floats[0];
      CHECK(green == Approx(1).margin(0.02));
      CHECK(red == Approx(0).margin(0.02));
    } else {
      ++refused;
      CHECK(shown.name == "neutral white");
      CHECK(warnings_with(scene, "cannot be read here; save it as PNG, JPEG, EXR or HDR instead") == 1);
    }
  }
  fs::current_path(before);
  CHECK(decoded >= 8);
  CHECK(refused >= 2);
}

TEST_CASE("a hint that is no format name is an error, not a file name") {
  const TempFolder folder;
  for (const char* hint :
       {"image/x y", "image/../../etc/passwd", "image/", "image/foo.null?RES=4096x4096", "image/m3u8"}) {
    INFO(hint);
    Asset asset;
    const int image = asset.add(
        "images", {{"bufferView", asset.view(std::vector<uint8_t>{1, 2, 3, 4})}, {"mimeType", hint}});
    const int texture = asset.add("textures", {{"source", image}});
    asset.textured_triangle({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
    const scene::Scene scene = scene::load(asset.gltf(folder));
    CHECK(scene.images.at(0).name == "neutral white");
    CHECK(warnings_with(scene, "is no image format that is known") == 1);
  }
}

}  // namespace scene_files_tests
