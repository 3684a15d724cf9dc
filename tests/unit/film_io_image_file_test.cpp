// links: film_io
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <OpenImageIO/imageio.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <cstring>
#include <fstream>
#include <functional>
#include <limits>

#include "film/io/image_file.h"
#include "support/folder.h"

namespace film_io_image_file_tests {

namespace fs = std::filesystem;
using namespace lucerna;
using film::FilmImage;

namespace {

/// A separate folder for each test case, removed afterwards.
struct Folder : test::Folder {
  ~Folder() {
    std::error_code ignored;
    fs::permissions(path, fs::perms::owner_all, ignored);
  }
  size_t entries() const {
    return static_cast<size_t>(std::distance(fs::directory_iterator(path), fs::directory_iterator()));
  }
};

const std::vector<std::string> k_channels = {
    "R",           "G",           "B",           "primary.R",  "primary.G",  "primary.B",
    "secondary.R", "secondary.G", "secondary.B", "tertiary.R", "tertiary.G", "tertiary.B",
    "caustic.R",   "caustic.G",   "caustic.B",   "albedo.R",   "albedo.G",   "albedo.B",
    "N.X",         "N.Y",         "N.Z",         "Z",          "samples"};

FilmImage film_image(uint32_t width = 17, uint32_t height = 5) {
  FilmImage image{.width = width, .height = height, .channels = {}, .metadata = {}};
  float value = 0;
  for (const std::string& name : k_channels) {
    std::vector<float> plane(size_t{width} * height);
    for (float& v : plane) v = 1e-3f * (value += 1.37f) - 0.1f;
    image.channels.emplace_back(name, plane);
  }
  image.metadata = {
      {"settings", R"({"components.primary": "off"})"}, {"seed", "12345678901234"}, {"device", "llvmpipe"}};
  return image;
}

std::string error_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

void write_text(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}
std::string read_text(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST_CASE("An EXR keeps every layer and the metadata bit for bit") {
  Folder folder;
  FilmImage image = film_image();
  std::vector<float>& z = image.channels[21].second;
  z[0] = std::numeric_limits<float>::infinity(), z[1] = 1e-42f, z[2] = -0.0f;
  image.channels[0].second[3] = std::numeric_limits<float>::quiet_NaN();
  film::write_exr(folder.path / "a.exr", image);
  const FilmImage back = film::read_exr(folder.path / "a.exr");
  REQUIRE(back.width == image.width);
  REQUIRE(back.height == image.height);
  REQUIRE(back.channels.size() == k_channels.size());
  for (const auto& [name, values] : image.channels) {
    INFO(name);
    const std::vector<float>* found = back.find(name);
    REQUIRE(found);
    REQUIRE(found->size() == values.size());
    CHECK(std::memcmp(found->data(), values.data(), values.size() * sizeof(float)) == 0);
  }
  for (const auto& [key, value] : image.metadata) CHECK(back.metadata.at(key) == value);
  CHECK(folder.entries() == 1);
}

TEST_CASE("Layers are found by name") {
  const FilmImage image = film_image();
  const auto names = [&](const std::string& layer) {
    std::string text;
    for (size_t i : image.layer(layer)) text += image.channels[i].first + " ";
    return text;
  };
  CHECK(names("") == "R G B ");
  CHECK(names("rgb") == "R G B ");
  CHECK(names("primary") == "primary.R primary.G primary.B ");
  CHECK(names("N") == "N.X N.Y N.Z ");
  CHECK(names("Z") == "Z ");
  CHECK(names("samples") == "samples ");
  CHECK(names("primary.G") == "primary.G ");
  CHECK(names("prim").empty());
  CHECK(image.layers() == std::vector<std::string>{"rgb", "primary", "secondary", "tertiary", "caustic",
                                                   "albedo", "N", "Z", "samples"});
}

TEST_CASE("Layers are in the order R G B whatever the file's order") {
  FilmImage image{.width = 1, .height = 1, .channels = {}, .metadata = {}};
  for (const char* name : {"a.B", "a.G", "a.R", "n.Z", "n.X", "n.Y"}) image.channels.push_back({name, {0}});
  CHECK(image.layer("a") == std::vector<size_t>{2, 1, 0});
  CHECK(image.layer("n") == std::vector<size_t>{4, 5, 3});
}

TEST_CASE("A PNG keeps its pixels, and has text") {
  Folder folder;
  std::vector<uint8_t> rgba;
  for (int i = 0; i < 3 * 2 * 4; ++i) rgba.push_back(static_cast<uint8_t>(i % 4 == 3 ? 255 : 10 * i));
  film::write_png(folder.path / "a.png", 3, 2, rgba, {{"seed", "7"}});
  const FilmImage back = film::read_exr(folder.path / "a.png");
  REQUIRE(back.width == 3);
  REQUIRE(back.height == 2);
  const std::vector<size_t> rgb = back.layer("");
  REQUIRE(rgb.size() == 3);
  for (size_t p = 0; p < 6; ++p)
    for (size_t c = 0; c < 3; ++c)
      CHECK(std::lround(255 * back.channels[rgb[c]].second[p]) == static_cast<long>(rgba[4 * p + c]));
  CHECK(back.metadata.at("seed") == "7");
  CHECK(folder.entries() == 1);
}

TEST_CASE("Output follows the umask and replaces an existing file") {
  Folder folder;
  const fs::path file = folder.path / "a.exr";
  write_text(file, "old");
  const mode_t mask = umask(022);
  film::write_exr(file, film_image());
  umask(mask);
  struct stat status {};
  REQUIRE(stat(file.c_str(), &status) == 0);
  CHECK((status.st_mode & 0777) == 0644);
  CHECK(film::read_exr(file).width == 17);
}

TEST_CASE("A failed output gives one located message and keeps the old file") {
  Folder folder;
  const std::string missing = (folder.path / "none" / "a.exr").string();
  CHECK_THAT(error_of([&] { film::check_writable(missing); }),
             Catch::StartsWith(missing + ": ") && Catch::Contains("does not exist"));
  CHECK_THAT(error_of([&] { film::write_exr(missing, film_image()); }), Catch::StartsWith(missing + ": "));
  CHECK_THAT(error_of([&] { film::write_png(missing, 1, 1, std::vector<uint8_t>(4)); }),
             Catch::StartsWith(missing + ": "));
  CHECK_THAT(error_of([&] { film::check_writable(folder.path); }), Catch::Contains("is a folder"));
  CHECK_THAT(error_of([&] { film::check_writable(folder.path / "a.tga"); }), Catch::Contains(".exr or .png"));
  CHECK_THAT(error_of([&] { film::check_writable(""); }), Catch::Contains("expected a file name"));
  write_text(folder.path / "file", "x");
  CHECK_THAT(error_of([&] { film::check_writable(folder.path / "file" / "a.exr"); }),
             Catch::Contains("a.exr: "));

  const fs::path old = folder.path / "old.exr";
  write_text(old, "old");
  FilmImage wrong = film_image();
  wrong.channels[1].second.pop_back();
  CHECK_THAT(error_of([&] { film::write_exr(old, wrong); }),
             Catch::Contains("'G' has 84 values, expected 85"));
  wrong = film_image();
  wrong.channels[1].first = wrong.channels[0].first;
  CHECK_THAT(error_of([&] { film::write_exr(old, wrong); }), Catch::Contains("repeated"));
  CHECK_THAT(error_of([&] { film::write_exr(old, FilmImage{}); }), Catch::Contains("empty (0x0)"));
  CHECK_THAT(error_of([&] { film::write_png(old, 2, 2, std::vector<uint8_t>(4)); }),
             Catch::Contains("expected 16"));
  CHECK(read_text(old) == "old");
  CHECK(folder.entries() == 2);

  CHECK_NOTHROW(film::check_writable(folder.path / "new.png"));
  CHECK_NOTHROW(film::check_writable(old));
  CHECK(folder.entries() == 2);
  CHECK(read_text(old) == "old");
  if (geteuid() != 0) {  // root can write everywhere
    fs::permissions(folder.path, fs::perms::owner_read | fs::perms::owner_exec);
    CHECK_THAT(error_of([&] { film::check_writable(folder.path / "b.exr"); }),
               Catch::Contains("cannot be written"));
  }
}

TEST_CASE("A full disk gives one located message and keeps the old file") {
  Folder folder;
  const fs::path file = folder.path / "a.exr";
  write_text(file, "old");
  // A limit on file size has the same effect as a full disk.
  rlimit before{};
  REQUIRE(getrlimit(RLIMIT_FSIZE, &before) == 0);
  const rlimit small{.rlim_cur = 2000, .rlim_max = before.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  REQUIRE(setrlimit(RLIMIT_FSIZE, &small) == 0);
  const std::string exr = error_of([&] { film::write_exr(file, film_image(64, 64)); });
  const std::string png = error_of([&] {
    std::vector<uint8_t> noise(64 * 64 * 4);
    for (size_t i = 0; i < noise.size(); ++i) noise[i] = static_cast<uint8_t>((i * i * 2654435761u) >> 13);
    film::write_png(folder.path / "a.png", 64, 64, noise);
  });
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  CHECK_THAT(exr, Catch::StartsWith(file.string() + ": cannot be written: File too large"));
  CHECK_THAT(png,
             Catch::StartsWith((folder.path / "a.png").string() + ": cannot be written: File too large"));
  CHECK(read_text(file) == "old");
  CHECK(folder.entries() == 1);
}

TEST_CASE("An unreadable image gives one located message") {
  Folder folder;
  const std::string none = (folder.path / "none.exr").string();
  CHECK_THAT(error_of([&] { film::read_exr(none); }), Catch::Equals(none + ": there is no such file"));
  CHECK_THAT(error_of([&] { film::read_exr(folder.path); }), Catch::Contains("is a folder"));
  REQUIRE(mkfifo((folder.path / "pipe.exr").c_str(), 0600) == 0);
  CHECK_THAT(error_of([&] { film::read_metadata(folder.path / "pipe.exr"); }), Catch::Contains("is a pipe"));
  write_text(folder.path / "text.exr", "this is no image");
  CHECK_THAT(error_of([&] { film::read_exr(folder.path / "text.exr"); }),
             Catch::Contains("text.exr: cannot read"));
  write_text(folder.path / "empty.png", "");
  CHECK_THAT(error_of([&] { film::read_exr(folder.path / "empty.png"); }),
             Catch::Contains("empty.png: cannot read"));
  film::write_exr(folder.path / "whole.exr", film_image(64, 64));
  const std::string whole = read_text(folder.path / "whole.exr");
  for (const size_t length : {whole.size() / 2, whole.size() - 100, size_t{700}, size_t{6}}) {
    INFO(length << " of " << whole.size());
    write_text(folder.path / "cut.exr", whole.substr(0, length));
    const std::string message = error_of([&] { film::read_exr(folder.path / "cut.exr"); });
    CHECK_THAT(message, Catch::Contains("cut.exr: cannot read"));
    CHECK(message.find('\n') == std::string::npos);
  }
}

TEST_CASE("a window is the EXR's data window in the picture; a bad one leaves the old file") {
  const Folder folder;
  const auto file = folder / "part.exr";
  FilmImage image{.width = 6, .height = 4, .channels = {{"R", {}}, {"Z", {}}}};
  for (auto& [name, values] : image.channels)
    for (int i = 0; i < 24; ++i) values.push_back(float(i) + (name == "Z" ? 0.5f : 0));
  image.window = FilmImage::Window{2, 1, 5, 3};
  film::write_exr(file, image);
  const auto input = OIIO::ImageInput::open(file.string());
  REQUIRE(input);
  const OIIO::ImageSpec& spec = input->spec();
  CHECK(spec.x == 2);
  CHECK(spec.y == 1);
  CHECK(spec.width == 3);
  CHECK(spec.height == 2);
  CHECK(spec.full_x == 0);
  CHECK(spec.full_width == 6);
  CHECK(spec.full_height == 4);
  const FilmImage read = film::read_exr(file);
  REQUIRE(read.width == 6);
  for (uint32_t i = 0; i < 24; ++i) {
    const bool inside = i % 6 >= 2 && i % 6 < 5 && i / 6 >= 1 && i / 6 < 3;
    CHECK((*read.find("R"))[i] == (inside ? float(i) : 0));
    CHECK((*read.find("Z"))[i] == (inside ? float(i) + 0.5f : 0));
  }
  for (const FilmImage::Window& bad :
       {FilmImage::Window{2, 1, 2, 3}, {2, 3, 5, 1}, {0, 0, 7, 4}, {0, 0, 6, 5}, {0, 0, 0, 0}}) {
    image.window = bad;
    CHECK_THROWS_WITH(film::write_exr(file, image),
                      Catch::Contains(file.string() + ": the stored part is empty"));
  }
  CHECK(film::read_exr(file).width == 6);
}

}  // namespace film_io_image_file_tests
