#pragma once
// Displays and views of an OpenColorIO configuration, through OpenImageIO.
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/math.h"

namespace lucerna::film {

struct OcioDisplay {
  std::string name;
  std::vector<std::string> views;  ///< the default one first
};

class OcioConfig {
 public:
  /// Reads a configuration (.ocio, .ocioz). Throws Error located at `file`: missing, damaged, without
  /// displays, or no linear colour space is known to take radiance from.
  explicit OcioConfig(const std::filesystem::path& file);
  ~OcioConfig();

  const std::string& file() const { return file_; }
  /// The default one first.
  const std::vector<OcioDisplay>& displays() const { return displays_; }
  /// The colour space that linear Rec.709 radiance is taken as: one for that by its name, otherwise the role
  /// scene_linear.
  const std::string& source() const { return source_; }
  bool source_is_rec709() const { return rec709_; }
  /// Turns exposed linear Rec.709 radiance into encoded colours of a display, in place. Throws Error located
  /// at the file: there is no such display or view (the message lists all), or its files cannot be read.
  void show(const std::string& display, const std::string& view, std::span<vec3> colors) const;
  /// The display and the view that ocio_text() has joined; a view "" is the default one. A text that fits no
  /// display is split at its first ": ", for the message of show().
  std::pair<std::string, std::string> split(const std::string& text) const;
  /// Exposed luminance from which on a view shows grey as white: from there on less than a tenth of its
  /// relative change is seen, the displayed colours decoded by the sRGB curve. Errors like show().
  float white(const std::string& display, const std::string& view) const;
  /// show() of all nodes of a table (shaders/shared/display_lut.h), clamped to 0..1.
  std::vector<vec4> table(const std::string& display, const std::string& view) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  std::string file_, source_;
  bool rec709_ = false;
  std::vector<OcioDisplay> displays_;
};

/// The configuration that the environment variable OCIO names; null if it is empty or not set. Read once and
/// again if the variable names another file. Throws Error like the constructor, located at the file with the
/// variable's name. Thread-safe.
std::shared_ptr<const OcioConfig> ocio_config();

/// A choice of display and view as text: "DISPLAY: VIEW", or "DISPLAY" for its default view.
std::string ocio_text(const std::string& display, const std::string& view);

}  // namespace lucerna::film
