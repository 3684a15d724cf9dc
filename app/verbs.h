#pragma once
// The batch verbs of the command line. Each returns the process's exit status; errors are thrown.
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bench/interiors.h"
#include "bench/photons.h"
#include "scene/io/load.h"

namespace lucerna::app {

/// The largest number of pictures of a turntable.
inline constexpr uint32_t k_most_views = 9999;

/// What verbs take over from the program's own arguments.
struct VerbArguments {
  std::string device;         ///< --device
  scene::LoadOptions scenes;  ///< limits for files and memory of scenes
  std::string command;        ///< as typed, for reports
};

struct RenderArguments : VerbArguments {
  std::string scene;
  std::vector<std::string> outputs;
  std::string size = "1280x720", camera, stats, ledger, reference;
  std::map<std::string, std::string> solver_load,
      solver_save;                ///< files for solvers' work, by their names
  int64_t samples = -1;           ///< -1: the settings'; with `error`, the maximum of a pixel
  std::optional<double> error;    ///< target error of every tile: adaptive sampling
  std::optional<double> seconds;  ///< time limit
  int64_t seed = -1;
  std::optional<double> f_number, focus;  ///< of the camera's lens
  std::optional<int64_t> blades;
  std::string projection;  ///< "": the scene's
  bool upright = false;
  std::vector<double> shift;     ///< right, up; empty: the scene's
  std::vector<std::string> set;  ///< key=value
  bool quiet = false;
  std::optional<std::string> tev;       ///< HOST:PORT of a viewer that gets the layers; "": the default one
  bool filter = false;                  ///< files contain the filtered picture too
  std::string record_paths;             ///< file for recorded paths; "": none
  uint64_t record_every = 100;          ///< every n-th path is recorded
  double record_over = 0;               ///< only paths with more light, in luminance
  std::vector<uint32_t> record_region;  ///< X Y WIDTH HEIGHT, pixels; empty: the picture
  std::vector<uint32_t> region;         ///< likewise: pixels that get samples
  uint32_t turntable = 0;               ///< pictures around the camera's target; 0: one, from the camera
};
int render(const RenderArguments& arguments);

struct InfoArguments : VerbArguments {
  std::string scene;
  bool json = false;
  bool cost = false;   ///< measures the effects' costs; needs a device
  bool pilot = false;  ///< runs the pilot that chooses solvers; needs a device. Below: for its picture
  std::string size = "1280x720", camera;
  std::vector<std::string> set;
};
int info(const InfoArguments& arguments);
int devices(bool json);

struct ConvertArguments : VerbArguments {
  std::string scene, output;
  bool replace = false;  ///< writes over the scene itself
};
int convert(const ConvertArguments& arguments);

struct BenchRaysArguments : VerbArguments {
  std::string scene, camera;
  std::string flat;  ///< file to write the flattened scene to; empty: none
  uint32_t rays = 1 << 20, seed = 1;
  int repeats = 5;
  uint32_t width = 480, height = 270, samples = 16;  ///< of the path-traced frame; no samples: no frame
  bool json = false;
};
int bench_rays(const BenchRaysArguments& arguments);

struct BenchLatencyArguments : VerbArguments {
  std::vector<std::string> files;           ///< scenes: files, or names of the program's own
  std::vector<std::string> solvers, edits;  ///< empty: all
  std::string size = "960x540", references = "latency-references", pictures;
  uint32_t reference_samples = 64, repeats = 1;
  uint64_t seed = 0;  ///< seed of the edits' amounts
  std::string reference_solver = "path";
  double seconds = 10, settle = 120;
  std::vector<std::string> set;
  std::string json;  ///< file to write the figures to; empty: none
};
int bench_latency(const BenchLatencyArguments& arguments);

struct BenchPhotonsArguments : VerbArguments {
  bench::PhotonBenchOptions options;
  std::string report = "photons-report";
  bool quiet = false;
};
int bench_photons(const BenchPhotonsArguments& arguments);

struct BenchArguments : VerbArguments {
  std::string matrix;                         ///< file; or
  std::vector<std::string> built_in;          ///< the name of a built-in one; more than one matrix is refused
  std::string report = "report", references;  ///< references "": in the report folder
  int repeats = 0;                            ///< 0: the matrix's
  bool quiet = false;
  std::vector<std::string> compare;  ///< two reports: no measurement
  std::string page;                  ///< a report folder whose page is written again
};
int bench_matrix(const BenchArguments& arguments);

struct BenchInteriorsArguments : VerbArguments {
  bench::InteriorsOptions options;
  std::string report = "interiors-report", references = "interiors-references";
  bool quiet = false;
};
int bench_interiors(const BenchInteriorsArguments& arguments);

struct ScriptArguments : VerbArguments {
  std::vector<std::string> words;  ///< files, and variables NAME=VALUE
  bool headless = false;           ///< never uses a display of the user's
  std::string report;
  std::vector<std::string> typed;  ///< the program's arguments, to start it again
};
/// 0: all passed; 1: an expectation or a command failed; 2: a script cannot be read, or there is no window.
int run_scripts(const ScriptArguments& arguments);
/// Prints the help of a command, setting or topic; "": the list of commands.
int help(const std::string& topic);

struct PathsArguments {
  std::string file, where, group_by;
  bool csv = false, json = false;
  uint64_t most = 20;  ///< rows of the table: the brightest
};
/// Searches a file of recorded paths. Throws Error: query, file.
int search_paths(const PathsArguments& arguments);
/// The fields of its queries, for the help.
std::string describe_path_fields();

struct CompareArguments {
  std::string a, b, layer, difference;
  bool json = false;
  double max_relmse = -1;  ///< < 0: no bound
};
int compare(const CompareArguments& arguments);

}  // namespace lucerna::app
