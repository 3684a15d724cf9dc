#pragma once
// A small OpenColorIO configuration for tests, and the environment variable that names one.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace lucerna::test {

/// Views: Plain, the power 1/2.2 cut off at 1; Film, a smooth curve over 16 stops.
inline const std::string k_ocio = R"(ocio_profile_version: 1
search_path: ""
strictparsing: true
luma: [0.2126, 0.7152, 0.0722]
roles:
  default: lin_rec709
  scene_linear: lin_rec709
displays:
  Other:
    - !<View> {name: Plain, colorspace: gamma22}
  "Screen: sRGB":
    - !<View> {name: Film, colorspace: film}
    - !<View> {name: Plain, colorspace: gamma22}
active_displays: ["Screen: sRGB", Other]
active_views: [Film, Plain]
colorspaces:
  - !<ColorSpace>
    name: lin_rec709
    bitdepth: 32f
    isdata: false
  - !<ColorSpace>
    name: gamma22
    bitdepth: 32f
    isdata: false
    to_reference: !<ExponentTransform> {value: [2.2, 2.2, 2.2, 1]}
  - !<ColorSpace>
    name: film
    bitdepth: 32f
    isdata: false
    from_reference: !<AllocationTransform> {allocation: lg2, vars: [-10, 6, 0.001]}
)";

inline std::filesystem::path write_ocio(const std::filesystem::path& folder) {
  const auto file = folder / "config.ocio";
  std::ofstream(file) << k_ocio;
  return file;
}

/// Sets the environment variable OCIO; "": unset. The destructor restores it.
class OcioVariable {
 public:
  explicit OcioVariable(const std::string& file) {
    if (const char* before = std::getenv("OCIO")) before_ = before;
    set(file);
  }
  ~OcioVariable() { set(before_); }
  OcioVariable(const OcioVariable&) = delete;
  OcioVariable& operator=(const OcioVariable&) = delete;

 private:
  static void set(const std::string& file) {
    if (file.empty())
      unsetenv("OCIO");
    else
      setenv("OCIO", file.c_str(), 1);
  }
  std::string before_;
};

}  // namespace lucerna::test
