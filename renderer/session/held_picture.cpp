#include "session/held_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <string_view>

#include "base/color.h"
#include "film/io/planes.h"

namespace lucerna::session {

std::string methods_text(const ComponentMethods& methods) {
  constexpr ByComponent<const char*> k_light = {"primary light", "secondary light", "tertiary light",
                                                "caustics"};
  constexpr ByComponent<size_t> k_by_weight = {paths::k_secondary, paths::k_tertiary, paths::k_caustic,
                                               paths::k_primary};
  const auto known = [&](size_t c) { return !methods[c].empty(); };
  if (std::none_of(k_by_weight.begin(), k_by_weight.end(), known)) return "";
  const auto main = std::find_if(k_by_weight.begin(), k_by_weight.end(),
                                 [&](size_t c) { return known(c) && methods[c] != "off"; });
  if (main == k_by_weight.end()) return "no light";
  std::string text = methods[*main];
  for (size_t c = 0; c < methods.size(); ++c) {
    const bool usual = (c == paths::k_primary || c == paths::k_caustic) && methods[c] == "path";
    if (!known(c) || methods[c] == methods[*main] || usual) continue;
    text += methods[c] == "off" ? ", without " + std::string(k_light[c])
                                : ", " + methods[c] + " for " + k_light[c];
  }
  return text;
}

namespace {

constexpr const char *k_methods = "methods", *k_seconds = "seconds", *k_error = "error",
                     *k_accuracy = "accuracy";

/// A finite number > 0 as all of the text; 0: it is none.
double positive(std::string_view text) {
  double number = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), number);
  return code == std::errc() && end == text.data() + text.size() && std::isfinite(number) && number > 0
             ? number
             : 0;
}

/// Calls f with the parts between separators.
void for_parts(std::string_view text, std::string_view separator,
               const std::function<void(std::string_view)>& f) {
  while (!text.empty()) {
    const size_t end = std::min(text.find(separator), text.size());
    f(text.substr(0, end));
    text.remove_prefix(std::min(text.size(), end + separator.size()));
  }
}

ComponentMethods read_methods(std::string_view text) {
  ComponentMethods methods;
  for_parts(text, ", ", [&](std::string_view part) {
    for (size_t c = 0; c < methods.size(); ++c)
      if (const std::string head = std::string(paths::k_component_names[c]) + " "; part.starts_with(head))
        methods[c] = part.substr(head.size());
  });
  return methods;
}

stats::Ledger read_accuracy(std::string_view text) {
  stats::Ledger ledger;
  double before = 0;
  for_parts(text, ", ", [&](std::string_view part) {
    const size_t blank = std::min(part.find(' '), part.size() - 1);
    const double seconds = positive(part.substr(0, blank)), error = positive(part.substr(blank + 1));
    if (seconds <= before || error <= 0) return;
    stats::Entry entry;
    entry.wall_s = before = seconds, entry.error[0] = error, entry.has_error = true;
    entry.paths = ledger.entries().size() + 1;  // an entry of as many paths would replace the last
    ledger.add(entry);
  });
  return ledger;
}

}  // namespace

void describe(const HeldPicture& picture, std::map<std::string, std::string>& metadata) {
  std::string methods, accuracy;
  const auto add = [](std::string& list, const std::string& part) {
    list += (list.empty() ? "" : ", ") + part;
  };
  for (size_t c = 0; c < picture.methods.size(); ++c)
    if (!picture.methods[c].empty())
      add(methods, std::string(paths::k_component_names[c]) + " " + picture.methods[c]);
  for (const stats::Entry& e : picture.ledger.entries())
    if (e.has_error && e.sum() > 0 && e.wall_s > 0)
      add(accuracy, fmt::format("{:.4g} {:.4g}", e.wall_s, e.sum()));
  if (!methods.empty()) metadata[k_methods] = methods;
  if (!accuracy.empty()) metadata[k_accuracy] = accuracy;
  if (picture.seconds > 0) metadata[k_seconds] = fmt::format("{:.4g}", picture.seconds);
  if (picture.error && *picture.error > 0) metadata[k_error] = fmt::format("{:.4g}", *picture.error);
}

HeldPicture read_held_picture(const std::string& file, const std::function<bool(double)>& stop) {
  const std::set<std::string> wanted{"R", "G", "B", "samples"};
  const film::FilmImage image = film::read_exr(
      file, {.wants = [&](const std::string& channel) { return wanted.contains(channel); }, .stop = stop});
  const film::RgbPlanes planes = film::rgb_planes(image, file, "a picture with R, G and B");
  HeldPicture held;
  held.file = file;
  held.displayed = image.encoded;
  held.width = image.width, held.height = image.height;
  held.light.resize(size_t{image.width} * image.height);
  for (size_t i = 0; i < held.light.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const float value = (*planes[size_t(k)])[i];
      if (!std::isfinite(value))
        throw_error(file, "the value of pixel {} {} is not finite", i % image.width, i / image.width);
      held.light[i][k] = held.displayed ? linear_from_srgb(value) : value;
    }
  if (const std::vector<float>* samples = image.find("samples")) {
    double sum = 0;
    for (const float n : *samples) sum += n;
    held.samples = std::isfinite(sum) && sum > 0 ? sum / double(samples->size()) : 0;
  }
  const auto text = [&](const char* key) {
    const auto found = image.metadata.find(key);
    return found == image.metadata.end() ? std::string() : found->second;
  };
  held.scene = text("scene"), held.view = text("view");
  held.methods = read_methods(text(k_methods));
  held.seconds = positive(text(k_seconds));
  if (const double error = positive(text(k_error)); error > 0) held.error = error;
  held.ledger = read_accuracy(text(k_accuracy));
  held.is_foreign = methods_text(held.methods).empty() && held.seconds <= 0 && !held.error;
  return held;
}

}  // namespace lucerna::session
