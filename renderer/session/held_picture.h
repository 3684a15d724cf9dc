#pragma once
// A picture kept as light, with how it was computed and what that took, for comparing it with another one.
#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "paths/automaton.h"
#include "scene/scene.h"
#include "stats/ledger.h"

namespace lucerna::session {

using ComponentMethods = ByComponent<std::string>;

struct HeldPicture {
  uint32_t width = 0, height = 0;
  /// Linear Rec.709 radiance of the shown components, top row first: what the window shows, that is the
  /// preview while there are few samples, then the result of its filter (WindowFilter), else the means of the
  /// samples.
  std::vector<vec3> light;
  bool filtered = false;     ///< it is a preview or filtered
  double former = 0;         ///< share of light from before an edit, or from before data was complete, 0..1
  std::string shows;         ///< "", or which components if not all: "secondary + tertiary"
  ComponentMethods methods;  ///< solver of each component, or "off"; all empty: not known
  double samples = 0;        ///< a pixel, on average; 0: not known
  double seconds = 0;        ///< of rendering (Snapshot::seconds); 0: not known
  /// Estimated error of the samples as seen, like Entry::sum(); nullopt: not known.
  std::optional<double> error;
  /// Estimated error of a filtered picture: of the median tile (film::ShownError); nullopt: not known.
  std::optional<double> shown_error;
  stats::Ledger ledger;  ///< error over time until then
  std::string scene;     ///< its name; "": not known
  /// The camera as text, as in the metadata of files; "": not known. Equal texts: the same view.
  std::string view;
  std::string file;         ///< it was read from; "": it was rendered here
  bool is_foreign = false;  ///< read from a file that does not say how it was computed
  /// `light` is no light, but display colours 0..1 decoded by the sRGB curve: of an 8-bit picture.
  bool displayed = false;
};

/// Methods in words: "path", "cache, photons for caustics". The method of secondary light is named first,
/// those of other components if they differ; primary light and caustics by path tracing are not named. "" if
/// they are not known.
std::string methods_text(const ComponentMethods& methods);

/// Writes methods, time, error and accuracy over time into the metadata of a file; what is unknown is left
/// out.
void describe(const HeldPicture& picture, std::map<std::string, std::string>& metadata);

/// The picture of an image file: its channels R, G, B, the samples, and what describe(), scene and view have
/// written into its metadata; unreadable entries count as unknown. `stop`: as in film::ReadOptions. Throws
/// Error located at `file`: it cannot be read, has no such channels, values that are not finite, or it is
/// stopped.
HeldPicture read_held_picture(const std::string& file, const std::function<bool(double)>& stop = {});

}  // namespace lucerna::session
