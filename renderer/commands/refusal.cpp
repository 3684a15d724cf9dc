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

}  // namespace

void take_back(Document& d, const Document& before, const Document& after) {
  for (auto& [key, value] : d.settings) {
    const auto old = before.settings.find(key), refused = after.settings.find(key);
    if (old != before.settings.end() && refused != after.settings.end())
      take_back_value(value, old->second, refused->second);
  }
  take_back_list(d.lights, before.lights, after.lights);
  take_back_list(d.materials, before.materials, after.materials);
  take_back(d.objects, before.objects, after.objects);
  take_back_value(d.environment_scale, before.environment_scale, after.environment_scale);
  take_back_value(d.environment_rotation, before.environment_rotation, after.environment_rotation);
  take_back_value(d.sky, before.sky, after.sky);
  take_back_value(d.environment_file, before.environment_file, after.environment_file);
}

void take_back(Objects& values, const Objects& before, const Objects& after) {
  const auto of = [](const Objects& list, uint32_t index) {
    const auto found = list.find(index);
    return found == list.end() ? std::nullopt : std::optional(found->second);
  };
  Objects all = before;
  all.insert(after.begin(), after.end());
  for (const auto& [index, place] : all) {
    const std::optional<scene::ObjectPlace> was = of(before, index), refused = of(after, index);
    if (was == refused || of(values, index) != refused) continue;
    if (was)
      values[index] = *was;
    else
      values.erase(index);
  }
}

}  // namespace lucerna::commands
