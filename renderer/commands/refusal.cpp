#include "commands/refusal.h"

#include <map>
#include <optional>

namespace lucerna::commands {
namespace {

template <class T>
void take_back_value(T& value, const T& before, const T& after) {
  if (value == after) value = before;
}

template <class T>
void take_back_list(std::vector<T>& values, const std::vector<T>& before, const std::vector<T>& after) {
  if (values.size() != before.size() || values.size() != after.size()) return;
  for (size_t i = 0; i < values.size(); ++i) take_back_value(values[i], before[i], after[i]);
}

template <class Map>
void take_back_map(Map& values, const Map& before, const Map& after) {
  const auto of = [](const Map& list, const auto& key) {
    const auto found = list.find(key);
    return found == list.end() ? std::nullopt : std::optional(found->second);
  };
  Map all = before;
  all.insert(after.begin(), after.end());
  for (const auto& [key, value] : all) {
    const auto was = of(before, key), refused = of(after, key);
    if (was == refused || of(values, key) != refused) continue;
    if (was)
      values[key] = *was;
    else
      values.erase(key);
  }
}

}  // namespace

void take_back(Document& d, const Document& before, const Document& after) {
  take_back_map(d.settings, before.settings, after.settings);
  take_back_list(d.lights, before.lights, after.lights);
  take_back_list(d.materials, before.materials, after.materials);
  take_back(d.objects, before.objects, after.objects);
  take_back_value(d.environment_scale, before.environment_scale, after.environment_scale);
  take_back_value(d.environment_rotation, before.environment_rotation, after.environment_rotation);
  take_back_value(d.sky, before.sky, after.sky);
  take_back_value(d.environment_file, before.environment_file, after.environment_file);
}

void take_back(Objects& values, const Objects& before, const Objects& after) {
  take_back_map(values, before, after);
}

}  // namespace lucerna::commands
