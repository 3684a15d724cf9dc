#pragma once
// A cell that another lucerna renders: the command line of its verb `render`, and the result from its files.
#include <filesystem>
#include <string>
#include <vector>

#include "bench/matrix.h"
#include "bench/program.h"
#include "bench/reference.h"
#include "bench/result.h"
#include "scene/io/load.h"

namespace lucerna::bench {

/// Output folder of the other program.
struct OutsideFiles {
  std::filesystem::path picture, stats;
  std::filesystem::path shown;  ///< PNG; "": none is wanted
};

/// Arguments of `PROGRAM render` for a cell; `values`: settings of all levels except samples, seed and target
/// error. Only the cell's budget ends it, whatever limits the scene sets; a budget in seconds is multiplied
/// by `times`.
std::vector<std::string> outside_arguments(const Matrix& matrix, const Cell& cell,
                                           const SettingValues& values, const std::string& device,
                                           const scene::LoadOptions& scenes, const OutsideFiles& files,
                                           double times = 1);

/// True if it ended because no pixel had a sample within its time.
bool out_of_time(const ProgramResult& result);

/// The figures of the picture that it has written, which are a curve of one point; names and budget of the
/// result are left to the caller. Throws Error located at a file that is not as `render` writes it, or of
/// another size than the scene's.
Result read_outside(const OutsideFiles& files, const SceneEntry& scene, const ReferenceInfo& reference,
                    const film::FilmImage& truth);

/// The colours of a picture's layer "" as one list. Throws Error located at `where` when there are none.
std::vector<vec3> colours(const film::FilmImage& picture, const std::string& where);

}  // namespace lucerna::bench
