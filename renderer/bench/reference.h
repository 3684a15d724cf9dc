#pragma once
// Reference pictures: long plain path-traced renders, stored as EXR with their settings.
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "bench/folder.h"
#include "bench/matrix.h"
#include "film/film.h"
#include "film/io/reference.h"
#include "film/io/relative_mse.h"

namespace lucerna::bench {

/// The JSON of a .gltf, or of a .glb's first chunk; discarded if it does not parse. Throws Error if the file
/// cannot be read.
nlohmann::ordered_json scene_json(const std::filesystem::path& file);

/// A short hash (16 hexadecimal digits) of all files of a scene: the .gltf or .glb, its buffers and images,
/// settings.json beside it and the environment named there. A missing file counts as missing. Throws Error if
/// the scene itself cannot be read.
std::string scene_hash(const std::filesystem::path& file);

/// Hash of everything that a reference of that scene depends on: scene, settings, size, camera, seed and
/// program version. Without the number of samples, because more are always better, and without options of
/// solvers, because references are path traced.
std::string reference_key(const Matrix& matrix, const SceneEntry& scene, const std::string& scene_hash);

/// "cornell-128x128.exr".
std::filesystem::path reference_file(const std::filesystem::path& folder, const SceneEntry& scene);

/// Description of a reference; in the EXR's metadata as bench.*.
struct ReferenceInfo {
  std::filesystem::path file;
  std::string key;
  uint32_t samples = 0, seed = 0;
  double seconds = 0;          ///< rendering time
  film::LayerFigures noise{};  ///< its own, rms over mean luminance
  double relmse_noise = 0;     ///< film::relative_mse_noise() of its halves
  double seen_noise = 0;       ///< film::seen_mse_noise() of its halves
};

/// The reference if it is usable: its key matches, it has at least the wanted samples, and the picture is
/// complete and finite. Otherwise nullopt; an unusable file is reported and renamed to NAME.exr.old (.old2,
/// ...), because it may still be needed.
std::optional<ReferenceInfo> find_reference(const std::filesystem::path& folder, const SceneEntry& scene,
                                            const std::string& key, const Message& message);

/// Metadata to write with the picture of a new reference.
void describe_reference(std::map<std::string, std::string>& metadata, const ReferenceInfo& info);

/// Adds the layer "odd" of a reference: the mean over its odd samples, all components together. Odd samples
/// are a separate sequence (film.h), so each half of the samples is an independent reference.
void add_odd_half(film::FilmImage& reference, const film::Image& image);

/// Fills in a reference's own noise, from its picture. Throws Error as read_halves() and
/// film::read_reference().
void find_noise(ReferenceInfo& info, const film::FilmImage& image, const SceneEntry& scene);

/// Both halves. Throws Error located at `where` when the layer "odd" or the samples are missing, or a pixel
/// has fewer than two samples.
film::ReferencePair read_halves(const film::FilmImage& reference, const std::string& where);

}  // namespace lucerna::bench
