#include "bench/interiors.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "base/file.h"
#include "base/json_text.h"
#include "bench/reference.h"

namespace lucerna::bench {

const std::vector<std::string> k_own_interiors = {"ajar",       "arcade", "atrium",    "classroom",
                                                  "conference", "hall",   "sun-patch", "window"};
const std::vector<std::string> k_own_showpieces = {"cornell", "glass", "pool", "ring", "studio", "teapot"};
const std::vector<std::string> k_interior_settings = {"path", "learned", "cache", "cache-learned"};
const std::vector<std::string> k_auto_settings = {"learned", "cache-learned", "photons", "cache-photons",
                                                  "auto"};
const std::vector<std::string> k_quick_interiors = {"classroom", "hall", "window"};

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Default amounts of measurements.
struct Form {
  const char* name;
  int repeats;
  std::vector<double> seconds;
  const char* size;
  uint32_t reference_samples;
};
const Form k_full = {"interiors", 3, {4, 15, 60}, "320x180", 2048};
const Form k_auto = {"auto", 1, {10, 60}, "320x180", 2048};
const Form k_quick = {"interiors-quick", 2, {0.8, 4}, "192x108", 1024};

struct Way {
  const char *name, *about;
  const char *indirect, *caustic, *lights;  ///< components.secondary and .tertiary, .caustic; lights.sampling
};
const std::vector<Way> k_ways = {
    {"path", "path tracing, lights chosen by their power", "path", "path", "power"},
    {"learned", "path tracing, lights chosen by what arrived nearby", "path", "path", "learned"},
    {"cache", "secondary and tertiary light cached, lights chosen by their power", "cache", "path", "power"},
    {"cache-learned", "secondary and tertiary light cached, lights chosen by what arrived nearby", "cache",
     "path", "learned"},
    {"photons", "caustics by photons, else as learned", "path", "photons", "learned"},
    {"cache-photons", "caustics by photons, else as cache-learned", "cache", "photons", "learned"},
    {"auto", "solvers chosen for the scene", "auto", "auto", "learned"}};

/// True if a program with this help has the setting, and the value if it lists values.
bool knows(const std::string& help, const std::string& key, const std::string& value) {
  const size_t at = help.find("  " + key + " ");
  if (at == std::string::npos) return false;
  return help.substr(at, help.find('\n', at) - at).find(value) != std::string::npos;
}

/// A method as an entry of a matrix's settings; `help`: that of another program, perhaps with fewer settings.
/// Null: a required setting is missing.
Json setting_of(const Way& way, const std::string& budget, const std::string* help) {
  // Overrides the scene's own settings.
  Json set{{"components.secondary", way.indirect},
           {"components.tertiary", way.indirect},
           {"components.caustic", way.caustic}};
  for (const char* key : {"components.secondary", "components.tertiary"})
    if (help && !knows(*help, key, way.indirect)) return nullptr;
  // Programs without this setting choose lights by power.
  const bool choice = !help || knows(*help, "lights.sampling", way.lights);
  if (!choice && way.lights != std::string("power")) return nullptr;
  if (choice) set["lights.sampling"] = way.lights;
  return {{"name", way.name}, {"about", way.about}, {"set", set}, {"budget", budget}};
}

/// Size for a scene: exchanged for one that is taller than wide.
std::string size_for(const fs::path& scene, const std::string& size) {
  const size_t at = size.find('x');
  const double aspect = camera_aspect(scene);
  if (at == std::string::npos || !(aspect > 0) || aspect >= 1) return size;
  return size.substr(at + 1) + "x" + size.substr(0, at);
}

/// A name reduced to letters, digits, '-' and '_', at most 36 characters.
std::string plain_name(const std::string& name) {
  std::string plain = name.substr(0, 36);
  for (char& c : plain)
    if (!isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '_') c = '-';
  return plain.empty() ? "room" : plain;
}

}  // namespace

double camera_aspect(const fs::path& scene) {
  const Json json = scene_json(scene);
  const Json::json_pointer at("/cameras/0/perspective/aspectRatio");
  if (!json.is_object() || !json.contains(at) || !json.at(at).is_number()) return 0;
  return json.at(at).get<double>();
}

std::vector<fs::path> find_interiors(const fs::path& folder, const fs::path& own) {
  std::error_code code;
  if (fs::equivalent(folder, own, code)) {
    std::vector<fs::path> rooms;
    for (const std::string& name : k_own_interiors) rooms.push_back(own / name / (name + ".gltf"));
    return rooms;
  }
  const auto is_scene = [](const fs::path& file) {
    return (file.extension() == ".gltf" || file.extension() == ".glb") && is_plain_file(file);
  };
  if (is_scene(folder)) return {folder};
  if (!is_folder(folder)) throw_error(folder.string(), "is no folder with scenes, nor a .gltf or .glb file");
  std::vector<fs::path> rooms;
  fs::recursive_directory_iterator entry(folder, fs::directory_options::skip_permission_denied, code), end;
  for (; !code && entry != end; entry.increment(code))
    if (is_scene(entry->path())) rooms.push_back(entry->path());
  if (rooms.empty()) throw_error(folder.string(), "there is no .gltf or .glb file in it");
  std::sort(rooms.begin(), rooms.end());
  return rooms;
}

Matrix interiors_matrix(const InteriorsOptions& o, const std::string& help_of_other,
                        std::vector<std::string>& left_out) {
  const Form& form = o.quick ? k_quick : o.every_solver ? k_auto : k_full;
  const std::string size = o.size.empty() ? form.size : o.size;
  Json m{
      {"name", form.name},
      {"as_seen", true},
      {"repeats", o.repeats > 0 ? o.repeats : form.repeats},
      {"reference", {{"samples", o.reference_samples > 0 ? o.reference_samples : form.reference_samples}}}};
  std::string budget = "seconds";
  if (!o.samples.empty())
    budget = "samples", m["budgets"] = {{"samples", o.samples}};
  else
    m["budgets"] = {{"seconds", o.seconds.empty() ? form.seconds : o.seconds}};

  // With every solver, the project's other scenes too.
  const auto find_scenes = [&](const fs::path& folder) {
    std::vector<fs::path> found = find_interiors(folder, o.own);
    std::error_code code;
    if (o.every_solver && fs::equivalent(folder, o.own, code))
      for (const std::string& name : k_own_showpieces) found.push_back(o.own / name / (name + ".gltf"));
    return found;
  };
  std::vector<fs::path> rooms;
  std::vector<fs::path> folders = o.folders;
  if (folders.empty()) folders.push_back(o.own);
  for (const fs::path& folder : folders)
    for (const fs::path& room : find_scenes(folder)) {
      const std::string name = room.stem().string();
      const bool left =
          o.quick && o.folders.empty() &&
          std::find(k_quick_interiors.begin(), k_quick_interiors.end(), name) == k_quick_interiors.end();
      const fs::path file = absolute_path(room);
      if (!left && std::find(rooms.begin(), rooms.end(), file) == rooms.end()) rooms.push_back(file);
    }
  std::set<std::string> names;
  m["scenes"] = Json::array();
  for (const fs::path& room : rooms) {
    const std::string plain = plain_name(room.stem().string());
    std::string name = plain;
    for (int n = 2; !names.insert(name).second; ++n) name = fmt::format("{}-{}", plain, n);
    m["scenes"].push_back({{"file", room.string()}, {"name", name}, {"size", size_for(room, size)}});
  }

  const auto wanted = [&](const Way& way) {
    const std::vector<std::string>& all = o.every_solver ? k_auto_settings : k_interior_settings;
    const std::vector<std::string>& some = o.settings.empty() ? all : o.settings;
    return std::find(some.begin(), some.end(), way.name) != some.end();
  };
  m["settings"] = Json::array();
  for (const Way& way : k_ways) {
    if (!wanted(way)) continue;
    Json here = setting_of(way, budget, nullptr);
    here["program"] = o.program.string();
    Json other = o.against.empty() ? Json() : setting_of(way, budget, &help_of_other);
    if (!o.against.empty() && other.is_null()) left_out.push_back(way.name);
    if (other.is_object()) {
      const std::string name = std::string("before-") + way.name;
      here["beside"] = name, other["name"] = name;
      other["about"] = std::string("the same by the other program");
      other["program"] = o.against.string();
    }
    m["settings"].push_back(std::move(here));
    if (other.is_object()) m["settings"].push_back(std::move(other));
  }
  return parse_matrix(json_text(m), form.name, o.own);
}

}  // namespace lucerna::bench
