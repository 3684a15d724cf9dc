#pragma once
// Lines for every command of a registry, made from its parameters' types, and the check that each is
// unchanged after read, write and read.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "commands/registry.h"
#include "plan/settings.h"

namespace lucerna::test {

/// Values of a parameter, including the ends of its range.
inline std::vector<std::string> samples(const commands::Parameter& p) {
  using commands::Type;
  const double lo = std::isfinite(p.lo) ? p.lo : -1e6, hi = std::isfinite(p.hi) ? p.hi : 1e6;
  switch (p.type) {
    case Type::boolean:
      return {"true", "false"};
    case Type::integer:
      return {commands::number_text(std::ceil(lo)), commands::number_text(std::floor(hi))};
    case Type::real:
      return {commands::number_text(lo), commands::number_text(hi),
              commands::number_text(lo + (hi - lo) / 3)};
    case Type::vector:
      return {commands::vector_text(vec3(static_cast<float>(lo) + 0.1f)),
              commands::vector_text({1, 0.5f, 1e-7f})};
    case Type::choice:
      return p.choices;
    case Type::file:
      if (p.writes) {
        std::vector<std::string> names;
        for (const std::string& ending : p.choices) names.push_back("/tmp/a \"b\" #c" + ending);
        return names;
      }
      return {"/tmp/a b.png", "scene.gltf", "name=with #signs \"and\" \\.exr"};
    case Type::rest:
      return {};  // below
    case Type::text:
      return {"lamp", "a \"lamp\" = \\ # 2", "12"};
  }
  return {};
}

/// Checks each parameter's samples with the others at their first one. Returns the number of lines.
inline size_t round_trip(const commands::Registry& registry) {
  size_t lines = 0;
  const auto check = [&](const std::string& line) {
    INFO(line);
    const commands::Line first = registry.parse(line);
    const std::string printed = registry.print(first);
    INFO(printed);
    const commands::Line second = registry.parse(printed);
    CHECK(first.command == second.command);
    CHECK(first.arguments == second.arguments);
    CHECK(registry.print(second) == printed);
    ++lines;
  };
  for (const auto& [name, command] : registry.all()) {
    // Parameters that exclude each other are given one by one; settings are below.
    const bool refuses = command.check != nullptr;
    if (name == "set" || name == "reset" || name == "key" || name == "key.hold") continue;
    if (!command.parameters.empty() && command.parameters.back().type == commands::Type::rest) continue;
    std::string all = name;
    for (const auto& p : command.parameters) all += " " + p.name + "=" + commands::quote(samples(p)[0]);
    if (!refuses) check(all);
    for (const auto& varied : command.parameters)
      for (const std::string& value : samples(varied)) {
        std::string line = name;
        for (const auto& p : command.parameters)
          if (!p.optional) line += " " + commands::quote(&p == &varied ? value : samples(p)[0]);
        if (varied.optional) line += " " + varied.name + "=" + commands::quote(value);
        check(line);
      }
  }
  for (const char* line :
       {"get film.ev", "get light \"a \\\"lamp\\\"\" on", "wait samples 4 within 2", "expect film.ev is 1",
        "expect picture \"a b.png\" within 0.1", "fails \"a # b\" light.set 2 on=off"}) {
    const std::string head(line, std::string(line).find(' '));
    if (registry.find(head)) check(line);
  }
  for (const OptionInfo& option : plan::options()) {
    std::vector<std::string> values{option.fallback};
    if (option.type == OptionType::choice) values = option.choices;
    if (option.type == OptionType::text) values = {"two words", "", "\"quoted\""};
    for (const std::string& value : values) {
      check(commands::line("set", option.key, value));
      check(commands::line(option.key, value));
      CHECK(registry.print(registry.parse(option.key + "=" + commands::quote(value))) ==
            registry.print(registry.parse(commands::line("set", option.key, value))));
    }
    check(commands::line("reset", option.key));
  }
  return lines;
}

}  // namespace lucerna::test
