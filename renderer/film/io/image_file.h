#pragma once
// Image files in and out: the film's EXR, the tone-mapped PNG, and any image that OpenImageIO reads.
// A file that exists is never left half overwritten (base/output_file.h).
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"

namespace lucerna::film {

/// Named float planes of one size, top row first, row-major. The names of the film's own channels are
///   R G B                                  linear Rec.709 radiance, the sum of the components
///   primary.R .G .B, secondary., tertiary., caustic.   the components
///   albedo.R .G .B                         0..1
///   N.X .Y .Z                              world-space shading normal, unit or 0 where nothing was hit
///   Z                                      distance along the view axis in metres, infinity where nothing
///   was hit samples                                samples taken in the pixel
///   filtered.R .G .B  filtered.COMPONENT.R .G .B   the same without noise, where it is filtered
///   filtered.error                                 standard error of the luminance of filtered
/// Other names are allowed; a name occurs once. EXR sorts channels by name, so the order is not kept in a
/// file (OpenImageIO moves R, G, B to the front).
struct FilmImage {
  uint32_t width = 0, height = 0;
  std::vector<std::pair<std::string, std::vector<float>>> channels;  ///< each width * height values
  std::set<std::string> halves;  ///< channels that files hold as 16-bit floats
  /// Pixels that a file stores (EXR: data window): from left and top to before right and bottom, inside the
  /// picture; nullopt: all.
  struct Window {
    uint32_t left = 0, top = 0, right = 0, bottom = 0;
  };
  std::optional<Window> window = {};
  bool encoded = false;  ///< read from integers: 0..1 with the file's transfer curve
  std::map<std::string, std::string>
      metadata;  ///< string attributes; the film writes settings (JSON), seed, device, version

  /// Null when there is no such channel.
  const std::vector<float>* find(const std::string& name) const;
  /// Indices of the channels of a layer, in the order R G B (or X Y Z, or the file's order when it has
  /// neither).
  /// "" or "rgb" or "sum" is the unnamed layer R, G, B; a name with no channels under it, such as "Z" or
  /// "primary.R", is that single channel. Empty when there is no such layer.
  std::vector<size_t> layer(const std::string& name) const;
  /// Names that layer() accepts, in file order: "rgb", "primary", ..., "Z", "samples".
  std::vector<std::string> layers() const;
};

/// The largest width or height that is written or read.
inline constexpr uint32_t k_max_image_size = 32768;

/// Writes the window's 32-bit float channels, or 16-bit ones where `halves` says so, ZIP-compressed scan
/// lines. Values are stored bit for bit, NaN and infinity too. Throws Error located at `file` when the image
/// or its window is empty, a plane has the wrong length, a name is repeated, or the file cannot be written; a
/// file already there is then untouched.
void write_exr(const std::filesystem::path& file, const FilmImage& image);

/// How an image is read.
struct ReadOptions {
  /// True for the names of channels that are read; empty: all.
  std::function<bool(const std::string&)> wants = {};
  /// Called between parts of a large image with the share that is read, 0..1. True ends reading.
  std::function<bool(double)> stop = {};
};

/// Reads any image that OpenImageIO knows (its first subimage, full resolution), as float. An EXR's data
/// window is placed in its display window, 0 outside; a Radiance picture is turned upright, its exposure
/// divided out. EXR and HDR are linear as stored; integer formats are scaled to 0..1 and keep the file's
/// transfer curve. Channels that are named R, G, B, A or carry a layer name keep their names. Throws Error
/// located at `file` when it is missing, truncated, empty, larger than k_max_image_size, or stopped.
FilmImage read_exr(const std::filesystem::path& file, const ReadOptions& options = {});

/// The metadata of an image file, as FilmImage has them, without its pixels. Throws Error located at `file`
/// when it is no image that can be read.
std::map<std::string, std::string> read_metadata(const std::filesystem::path& file);

/// Writes 8-bit RGBA, sRGB-encoded, not premultiplied, top row first; `rgba` holds width * height * 4 bytes.
/// `metadata` becomes text chunks. Errors as write_exr.
void write_png(const std::filesystem::path& file, uint32_t width, uint32_t height,
               std::span<const uint8_t> rgba, const std::map<std::string, std::string>& metadata = {});

/// Throws the Error that writing `file` later would end in, if that can be known: lucerna::check_writable,
/// and an ending other than .exr or .png. For use before a long render; leaves no trace on disk.
void check_writable(const std::filesystem::path& file);

}  // namespace lucerna::film
