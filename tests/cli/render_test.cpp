// links: film_io
// The command line in use: its outputs, and one located error line with status 1 for every invalid input.
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "film/io/image_file.h"
#include "support/run.h"

namespace render_tests {

namespace fs = std::filesystem;
using namespace lucerna;
using test::run;
using test::Run;

namespace {

fs::path folder() {
  const fs::path p = fs::temp_directory_path() / ("lucerna-cli-" + std::to_string(getpid()));
  fs::create_directories(p);
  return p;
}

std::string scene(const std::string& name) {
  return std::string(LUCERNA_SOURCE_DIR) + "/scenes/" + name + "/" + name + ".gltf";
}

void refused(const std::string& arguments, const std::string& expected) {
  const Run r = run(arguments);
  INFO(arguments << "\n" << r.out);
  CHECK(r.status == 1);
  CHECK(r.out.find(expected) != std::string::npos);
}

}  // namespace

TEST_CASE("render writes layers, PNG and figures") {
  const fs::path f = folder();
  const Run r =
      run("render " + scene("cornell") + " --samples 4 --size 40x30 --quiet -o " + (f / "a.exr").string() +
          " -o " + (f / "a.png").string() + " --stats " + (f / "a.json").string());
  INFO(r.out);
  REQUIRE(r.status == 0);
  const film::FilmImage image = film::read_exr(f / "a.exr");
  CHECK(image.width == 40);
  CHECK(image.height == 30);
  for (const char* name :
       {"R", "primary.R", "secondary.G", "tertiary.B", "caustic.R", "albedo.R", "N.X", "Z", "samples"}) {
    bool found = false;
    for (const auto& [channel, values] : image.channels) found |= channel == name;
    INFO(name);
    CHECK(found);
  }
  CHECK(image.metadata.count("seed") == 1);
  // What a picture that is held for comparison is read with.
  CHECK(image.metadata.at("methods") == "primary path, secondary path, tertiary path, caustic path");
  for (const char* key : {"seconds", "error", "accuracy"}) {
    INFO(key);
    REQUIRE(image.metadata.count(key) == 1);
    CHECK(std::atof(image.metadata.at(key).c_str()) > 0);
  }
  CHECK(fs::file_size(f / "a.png") > 500);
  std::ifstream stats(f / "a.json");
  const std::string text((std::istreambuf_iterator<char>(stats)), {});
  for (const char* key : {"wall_s", "load_s", "compile_s", "device", "samples", "rays", "peak_host_mb",
                          "peak_device_mb", "stages", "components", "mean_radiance"})
    CHECK(text.find(std::string(1, '"').append(key).append("\"")) != std::string::npos);
  const Run same =
      run("compare " + (f / "a.exr").string() + " " + (f / "a.exr").string() + " --json --max-relmse 0");
  CHECK(same.status == 0);
  const Run other = run("render " + scene("cornell") + " --samples 4 --seed 5 --size 40x30 --quiet -o " +
                        (f / "b.exr").string());
  CHECK(other.status == 0);
  CHECK(run("compare " + (f / "a.exr").string() + " " + (f / "b.exr").string() + " --max-relmse 0").status ==
        1);
  film::FilmImage broken = image;
  for (auto& [channel, values] : broken.channels)
    if (channel.starts_with("caustic.")) values[7] = std::nanf("");
  film::write_exr(f / "nan.exr", broken);
  const std::string a_exr = (f / "a.exr").string(), nan_exr = (f / "nan.exr").string();
  CHECK(run("compare " + a_exr + " " + nan_exr).status == 0);
  refused("compare " + a_exr + " " + nan_exr + " --max-relmse 1",
          "not finite: caustic: 0 pixels of the first image, 1 of the second");
  refused("compare " + nan_exr + " " + nan_exr + " --layer caustic --max-relmse 1", "caustic: 1 pixels");
  for (const auto& entry : fs::directory_iterator(f))
    CHECK(entry.path().filename().string().find("tmp") == std::string::npos);
  fs::remove_all(f);
}

TEST_CASE("a batch render measures the exposure only if requested, and if none is set") {
  // The box of the tests with its lamp dimmed by about 6 stops, and without its settings.
  const fs::path f = folder() / "dim";
  fs::create_directories(f);
  fs::copy(fs::path(scene("cornell")).parent_path(), f,
           fs::copy_options::recursive | fs::copy_options::overwrite_existing);
  fs::remove(f / "settings.json");
  const auto brightness = [&](const std::string& more) {
    const fs::path file = f / "a.png";
    const Run r = run("render " + (f / "cornell.gltf").string() + " --samples 4 --size 40x30 --quiet -o " +
                      file.string() + " " + more);
    INFO(r.out);
    REQUIRE(r.status == 0);
    const film::FilmImage image = film::read_exr(file);
    double sum = 0;
    for (const float v : image.channels[1].second) sum += double{v};
    return sum / double(image.channels[1].second.size());
  };
  const double plain = brightness(""), own = brightness("--set film.ev=-4");
  CHECK(own < 0.5 * plain);
  CHECK(brightness("--set film.exposure_at_load=window") == plain);
  // Whatever the scene's brightness, its log-average is middle grey, whose encoded value is 0.46.
  const double found = brightness("--set film.exposure_at_load=always");
  CHECK(found != plain);
  CHECK(found > 0.3);
  CHECK(found < 0.65);
  CHECK(brightness("--set film.exposure_at_load=always --set film.ev=-4") == own);
}

TEST_CASE("invalid arguments are refused with their location") {
  const std::string good = "render " + scene("cornell") + " --quiet -o /tmp/lucerna-never.exr ";
  refused("render no/such.gltf -o /tmp/lucerna-never.exr", "no/such.gltf");
  refused(good + "--set components.primary=magic", "components.primary");
  refused(good + "--set colour=red", "unknown setting 'colour'");
  refused(good + "--set samples", "expected key=value");
  refused(good + "--samples 0", "--samples");
  for (const char* error : {"0", "-1", "-0.05", "nan", "100", "x"})
    refused(good + "--error " + error, "error");
  refused(good + "--set sampling.tile=4", "8, 16");
  refused(good + "--set sampling.target_error=0", "sampling.target_error");
  refused(good + "--set sampling.mode=magic", "uniform, adaptive");
  refused(good + "--size 0x10", "--size");
  refused(good + "--size 10", "--size");
  // Before anything is loaded.
  const std::string nowhere = "render no/such.gltf --quiet -o /tmp/lucerna-never.exr --samples 1 ";
  refused(nowhere + "--size 30000x30000", "can hold at most");
  refused(nowhere + "--size 65536x1", "--size: '65536x1': expected WIDTHxHEIGHT, each from 1 to 32768");
  for (const char* seconds : {"0", "-0", "-1", "nan", "-nan", "inf", "x"})
    refused(nowhere + "--time " + seconds, "--time");
  refused("compare a.exr b.exr --max-relmse nan", "--max-relmse");
  refused("compare a.exr b.exr --max-relmse -1", "--max-relmse");
  const fs::path f = folder();
  std::ofstream(f / "binary.lucerna") << std::string("wait 0\n\0", 8);
  refused("--script " + f.string(), f.string() + ": cannot be read: it is a folder");
  refused("--script " + (f / "none.lucerna").string(), "none.lucerna: cannot be read: No such file");
  refused("--script " + (f / "binary.lucerna").string(), "binary.lucerna: is not a text file");
  for (const char* option : {"--script", "render x.gltf --stats", "render x.gltf --ledger",
                             "render x.gltf --reference", "render x.gltf --cache-save"})
    refused(option + std::string(" ''"), "expected a file name");
  fs::remove_all(f);
  refused(good + "--camera nowhere --samples 1", "no camera 'nowhere'");
  refused(good + "--device nothing", "nothing");
  refused("render " + scene("cornell") + " -o /no/such/folder/a.exr", "/no/such/folder");
  refused("render " + scene("cornell") + " -o a.gif", ".gif");
  refused("render " + scene("cornell"), "-o: name at least one output");
  refused("compare no.exr nothing.exr", "no.exr");
  refused("info no.gltf", "no.gltf");
  CHECK_FALSE(fs::exists("/tmp/lucerna-never.exr"));
}

TEST_CASE("a --time that is too short for a picture is reported, and leaves no black one") {
  const fs::path f = folder() / "early.png";
  refused("render " + scene("hall") +
              " --size 256x256 --quiet --time 0.01 --set components.secondary=cache --set "
              "components.tertiary=cache -o " +
              f.string(),
          "no pixel has a sample after this many seconds: the irradiance cache was still at work");
  CHECK_FALSE(fs::exists(f));
}

TEST_CASE("a render ends at the first given limit, and at no other") {
  const fs::path f = folder();
  const auto stats = [&](const std::string& more) {
    const Run r = run("render " + scene("cornell") + " --size 8x8 --quiet --stats " +
                      (f / "l.json").string() + " " + more);
    INFO(r.out);
    REQUIRE(r.status == 0);
    std::ifstream in(f / "l.json");
    return nlohmann::json::parse(in);
  };
  CHECK(stats("--time 60 --set samples=3")["samples"] == 3);
  CHECK(stats("--time 60 --samples 3")["samples"] == 3);
  const auto uniform = stats("--time 0.5");
  CHECK(uniform["settings"]["samples"] == "1048576");
  CHECK(uniform["wall_s"] < 30);
  // With a limit of time alone the program chooses the solvers.
  CHECK(uniform["settings"]["components.tertiary"] == "auto");
  for (const char* more : {"--time 60 --samples 3", "--time 0.5 --set components.secondary=path",
                           "--time 0.5 --set relight.enabled=on", "--time 0.5 --error 0.1"})
    CHECK_FALSE(stats(more)["settings"].contains("components.tertiary"));
  const std::string unreachable = "--set sampling.min_samples=2 --error 0.0001 ";
  const auto timed = stats(unreachable + "--time 0.5");
  CHECK(timed["settings"]["sampling.max_samples"] == "1048576");
  CHECK(timed["wall_s"] < 30);
  CHECK(stats(unreachable + "--time 60 --samples 4")["tiles"]["most_samples"] == 4);
  CHECK(stats(unreachable + "--time 60 --set sampling.max_samples=4")["tiles"]["most_samples"] == 4);
  const auto by_setting =
      stats("--set sampling.mode=adaptive --set sampling.target_error=0.0001 --samples 4");
  CHECK(by_setting["tiles"]["most_samples"] == 4);
  CHECK(stats("--error 10 --time 60 --set sampling.min_samples=4")["tiles"]["most_samples"] == 4);
  fs::remove_all(f);
}

TEST_CASE("--error: samples go where the noise is, and unreached targets are reported") {
  const fs::path f = folder();
  const auto stats = [&](const std::string& arguments) {
    const Run r = run("render " + scene("cornell") + " --size 64x64 --quiet -o " + (f / "e.exr").string() +
                      " --stats " + (f / "e.json").string() + " " + arguments);
    INFO(r.out);
    CHECK(r.status == 0);
    std::ifstream file(f / "e.json");
    return std::pair(nlohmann::json::parse(file), r.out);
  };
  const auto [j, out] = stats("--error 0.08 --set sampling.min_samples=16");
  CHECK(j["tiles"]["count"] == 16);
  CHECK(j["tiles"]["done"] == 16);
  CHECK(j["tiles"]["unreached"].empty());
  CHECK(j["error"]["tile_worst"] <= 0.0801);
  CHECK(j["tiles"]["most_samples"] > j["tiles"]["least_samples"]);
  CHECK(j["error"]["components"].size() == 4);
  CHECK(j["error"]["of"] == "sum");
  CHECK(j["error"]["components"]["tertiary"]["bias"] == 0);
  const auto [capped, warning] = stats("--error 0.01 --samples 32 --set sampling.min_samples=16");
  CHECK(capped["tiles"]["most_samples"] == 32);
  CHECK(capped["tiles"]["capped"] == capped["tiles"]["unreached"].size());
  CHECK(capped["tiles"]["unreached"].size() > 8);
  CHECK(warning.find("over the error of 0.01") != std::string::npos);
  // Figures alone need no picture; no output at all is an error.
  const std::string small = "render " + scene("cornell") + " --size 16x16 --samples 4 --quiet";
  CHECK(run(small + " --stats " + (f / "alone.json").string()).status == 0);
  CHECK(std::filesystem::exists(f / "alone.json"));
  const Run nowhere = run(small);
  CHECK(nowhere.status == 1);
  CHECK(nowhere.out.find("name at least one output") != std::string::npos);
  // The ledger of the render, in JSON and as a table with as many lines.
  const auto [result, nothing] = stats("--samples 32 --ledger " + (f / "e.csv").string());
  std::ifstream table(f / "e.csv");
  size_t lines = 0;
  for (std::string line; std::getline(table, line);) ++lines;
  CHECK(result["ledger"].size() + 1 == lines);
  CHECK(lines > 5);
  CHECK(result["ledger"].back()["paths"] == result["paths"]);
  CHECK(result["ledger"].back()["seen"]["sum"] == result["error"]["seen"]);
  CHECK(result["ledger"].back()["of_mean"]["sum"] == result["error"]["of_mean"]);
  double shares = 0;
  for (const auto& component : result["error"]["components"]) shares += component["share"].get<double>();
  CHECK(shares == Approx(1));
  CHECK(result["forecast"]["seconds_to"]["0.01"][0] <= result["forecast"]["seconds_to"]["0.01"][2]);
  CHECK(j["ledger"].back()["forecast_rays"][1].get<double>() ==
        Approx(j["rays"].get<double>()).epsilon(0.01));
  refused("render " + scene("cornell") + " --quiet -o " + (f / "e.exr").string() +
              " --ledger /no/such/folder/e.csv",
          "/no/such/folder");
  // An exposure that shows no light leaves nothing to sample, which is reported.
  const auto [unseen, dark] = stats("--error 0.08 --set sampling.min_samples=4 --set film.ev=-12");
  CHECK(unseen["error"]["dark"].get<double>() > 0.9);
  CHECK(unseen["tiles"]["most_samples"] == 4);
  CHECK(dark.find("% black: no error is visible there") != std::string::npos);
  CHECK(warning.find("no error is visible") == std::string::npos);
  // In uniform sampling noise is reported too, and falls as expected.
  const auto few = stats("--samples 64").first["error"], many = stats("--samples 256").first["error"];
  for (const char* error : {"seen", "of_mean"}) {
    CHECK(many[error].get<double>() < 0.6 * few[error].get<double>());
    CHECK(many[error].get<double>() > 0.3 * few[error].get<double>());
  }
}

TEST_CASE("--stats and --ledger report noise and bias of lookups separately") {
  const fs::path f = folder();
  const auto stats = [&](const std::string& arguments) {
    const Run r = run("render " + scene("glass") + " --size 40x30 --quiet --stats " +
                      (f / "b.json").string() + " --ledger " + (f / "b.csv").string() + " " + arguments);
    INFO(r.out);
    CHECK(r.status == 0);
    std::ifstream file(f / "b.json");
    return nlohmann::json::parse(file);
  };
  const auto j = stats(
      "--samples 6 --set components.caustic=photons --set photons.efficiency=false --set photons.radius=6");
  const auto& error = j["error"];
  CHECK(error["records"]["seen"] == 0);
  CHECK(error["records"]["of_mean"] == 0);
  CHECK(error["bias"]["of_mean"] > 0.01);
  CHECK(error["bias"]["tile_worst"] > error["bias"]["tile_median"]);
  for (const char* name : {"seen", "of_mean"})
    CHECK(error[name].get<double>() ==
          Approx(error["paths"][name].get<double>() + error["bias"][name].get<double>()));
  CHECK(error["components"]["caustic"]["bias"].is_null());
  CHECK(error["components"]["primary"]["bias"] == 0);
  CHECK(j["ledger"].back()["seen_bias"] == error["bias"]["seen"]);
  CHECK(j["ledger"].back()["of_mean_bias"] == error["bias"]["of_mean"]);
  CHECK(j["ledger"].back()["seen_records"] == 0);
  CHECK(j["forecast"].contains("limited_by_lookups"));
  std::ifstream table(f / "b.csv");
  std::string head;
  std::getline(table, head);
  CHECK(head.find(",seen_records,seen_bias,seen_total,of_mean_records,of_mean_bias,of_mean_total,") !=
        std::string::npos);
  // One sample has no halves, so the bias is unknown; paths have no bias.
  CHECK(stats("--set components.caustic=photons --set photons.efficiency=false --samples 1")["error"]["bias"]
            .is_null());
  // The irradiance map of tertiary light has a bias that nothing estimates.
  CHECK(stats("--samples 2 --set components.tertiary=photons --set photons.efficiency=false")["error"]["bias"]
            .is_null());
  CHECK_FALSE(stats("--samples 6 --set components.caustic=path")["error"].contains("bias"));
}

TEST_CASE("--reference: the ledger has the true error, which equals the estimated one") {
  const fs::path f = folder();
  const std::string reference = (f / "reference.exr").string(), out = (f / "r.exr").string();
  const std::string cornell = "render " + scene("cornell") + " --size 48x48 --quiet ";
  REQUIRE(run(cornell + "--samples 1024 --seed 7 -o " + reference).status == 0);
  const Run r = run(cornell + "--samples 64 -o " + out + " --reference " + reference + " --stats " +
                    (f / "r.json").string() + " --ledger " + (f / "r.csv").string());
  INFO(r.out);
  REQUIRE(r.status == 0);
  std::ifstream file(f / "r.json");
  const auto j = nlohmann::json::parse(file);
  for (const char* layer : {"sum", "primary", "secondary", "tertiary", "caustic"}) {
    INFO(layer);
    const double truth = j["truth"][layer]["of_mean"], estimate = j["ledger"].back()["of_mean"][layer];
    CHECK(j["ledger"].back()["truth"][layer] == truth);
    CHECK(j["truth"][layer]["reference_noise"] <= estimate);
    // 2304 pixels; caustics come in few large amounts and are excluded.
    if (std::string(layer) != "caustic") CHECK(truth == Approx(estimate).epsilon(0.25));
  }
  CHECK(j["ledger"][0].contains("truth"));
  refused("render " + scene("cornell") + " --size 47x48 --quiet -o " + out + " --reference " + reference,
          "48x48");
  refused("render " + scene("glass") + " --size 48x48 --quiet -o " + out + " --reference " + reference,
          "of the scene 'cornell'");
  refused(cornell + "-o " + out + " --reference /no/such.exr", "/no/such.exr");
  CHECK(run(cornell + "--samples 2 --seed 7 -o " + out + " --reference " + reference)
            .out.find("with seed 7 like this picture") != std::string::npos);
  fs::remove_all(f);
}

TEST_CASE("Ctrl-C, SIGTERM and SIGHUP write the present picture and report it") {
  const fs::path f = folder();
  const std::string file = (f / "interrupted.exr").string();
  const std::string endless = "-v render " + scene("cornell") + " --samples 1000000 --size 64x64 -o " + file;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    INFO(signal);
    fs::remove(file);
    test::Running running(endless);
    // The signal comes during the render, however slow the machine is.
    REQUIRE(running.says("every pixel has a sample"));
    running.send(signal);
    const Run r = running.finish();
    INFO(r.out);
    CHECK(r.out.find("interrupted after") != std::string::npos);
    CHECK(r.out.find("writing the present picture") != std::string::npos);
    CHECK(r.status == 128 + signal);
    const film::FilmImage image = film::read_exr(file);
    CHECK(image.width == 64);
    const std::vector<float>& samples = *image.find("samples");
    CHECK(*std::min_element(samples.begin(), samples.end()) >= 1);
  }
  // Also if the reader of the output has ended, as in a pipe on the same terminal.
  fs::remove(file);
  test::Running running(endless);
  REQUIRE(running.says("every pixel has a sample"));
  running.stop_reading();
  running.send(SIGINT);
  CHECK(running.finish().status == 130);
  CHECK(film::read_exr(file).width == 64);
  fs::remove_all(f);
}

TEST_CASE("a scene's files outside its folder, and its memory, are allowed by options") {
  const fs::path f = folder();
  fs::create_directories(f / "scene");
  fs::copy_file(scene("cornell"), f / "scene" / "a.gltf");
  const fs::path data = fs::path(scene("cornell")).parent_path() / "cornell.bin";
  fs::create_symlink(data, f / "scene" / "cornell.bin");
  const std::string file = (f / "scene" / "a.gltf").string(),
                    small = " --size 8x8 --samples 1 --quiet -o " + (f / "a.exr").string();
  refused("info " + file, "buffers[0].uri: '");
  refused("render " + file + small, "--allow-outside reads what scenes name elsewhere");
  CHECK(run("info --allow-outside " + file).status == 0);
  CHECK(run("render --allow-outside " + file + small).status == 0);
  CHECK(run("--allow-outside render " + file + small).status == 0);
  refused("info " + scene("hall") + " --scene-memory 0.001", "--scene-memory GIB allows more");
  refused("info " + scene("cornell") + " --scene-memory nan", "--scene-memory");
  fs::remove_all(f);
}

TEST_CASE("devices and info print their lists") {
  CHECK(run("devices").out.find("Vulkan") != std::string::npos);
  CHECK(run("info " + scene("glass")).out.find("triangles") != std::string::npos);
  CHECK(run("--help").status == 0);
  CHECK(run("--help").out.find("components.primary") != std::string::npos);
  CHECK(run("render --help").out.find("components.primary") != std::string::npos);
  // A verb without settings does not list them.
  CHECK(run("info --help").out.find("components.primary") == std::string::npos);
  CHECK(run("bench latency --help").out.find("matrix file") == std::string::npos);
}

}  // namespace render_tests
