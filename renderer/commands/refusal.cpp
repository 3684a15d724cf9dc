#include "commands/refusal.h"

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
  take_back_value(d.environment_scale, before.environment_scale, after.environment_scale);
  take_back_value(d.environment_rotation, before.environment_rotation, after.environment_rotation);
  take_back_value(d.sky, before.sky, after.sky);
  take_back_value(d.environment_file, before.environment_file, after.environment_file);
}

}  // namespace lucerna::commands
