// links: plan
// The option table: every option has a valid default and help; invalid values are refused with the key.
#include <catch2/catch.hpp>
#include <set>

#include "plan/settings.h"

namespace settings_tests {

using namespace lucerna;
using namespace lucerna::plan;

namespace {

std::string message(const std::string& key, const std::string& value) {
  Settings settings;
  const std::string before = settings.changed_json();
  try {
    settings.set(key, value, "here");
  } catch (const Error& e) {
    CHECK(e.where() == "here");
    CHECK(settings.changed_json() == before);  // a refused value changes nothing
    return e.what();
  }
  return "";
}

}  // namespace

TEST_CASE("every option: unique key, help that is a sentence, a valid default") {
  std::set<std::string> keys;
  for (const OptionInfo& o : options()) {
    INFO(o.key);
    CHECK(keys.insert(o.key).second);
    CHECK(o.help.size() > 10);
    CHECK(o.help.back() == '.');
    CHECK(message(o.key, o.fallback) == "");
    CHECK(find_option(o.key) == &o);
    if (o.type == OptionType::choice) CHECK(o.choices.size() > 1);
    if (o.type == OptionType::integer || o.type == OptionType::real) CHECK(o.lo < o.hi);
  }
  CHECK(find_option("no.such") == nullptr);
}

TEST_CASE("every option refuses values outside its range, and states the range") {
  for (const OptionInfo& o : options()) {
    INFO(o.key);
    switch (o.type) {
      case OptionType::choice: {
        // Names that another setting defines are checked with that one.
        if (o.other_names) {
          CHECK(message(o.key, "no such choice") == "");
          break;
        }
        const std::string text = message(o.key, "no such choice");
        for (const std::string& choice : o.choices) CHECK(text.find(choice) != std::string::npos);
        break;
      }
      case OptionType::boolean:
        CHECK(message(o.key, "1").find("true or false") != std::string::npos);
        break;
      case OptionType::integer:
        CHECK(message(o.key, fmt::format("{}", o.lo)) == "");
        CHECK(message(o.key, fmt::format("{:.0f}", o.hi)) == "");
        CHECK(message(o.key, fmt::format("{}", o.lo - 1)) != "");
        CHECK(message(o.key, fmt::format("{:.0f}", o.hi + 1)) != "");
        CHECK(message(o.key, "1.5").find("whole number") != std::string::npos);
        break;
      case OptionType::real:
        CHECK(message(o.key, fmt::format("{}", o.hi)) == "");
        CHECK(message(o.key, fmt::format("{}", o.hi + 1)) != "");
        for (const char* bad : {"", "nan", "inf", "-inf", "1e999", "1,5", "1 ", "0x10", "one"})
          CHECK(message(o.key, bad).find("a number") != std::string::npos);
        break;
      case OptionType::text:
        break;
    }
  }
  CHECK(message("colour", "red").find("unknown setting 'colour'") != std::string::npos);
}

TEST_CASE("values are read back typed, and only changes are written") {
  Settings s;
  CHECK(s.changed_json() == "{}");
  s.set("components.caustic", "off");
  s.set("film.ev", "-1.5");
  s.set("path.max_depth", "7");
  s.set("show.primary", "false");
  CHECK(s.text("components.caustic") == "off");
  CHECK(s.real("film.ev") == -1.5);
  CHECK(s.integer("path.max_depth") == 7);
  CHECK_FALSE(s.boolean("show.primary"));
  s.set("film.tone_curve", "agx");
  CHECK(s.choice("film.tone_curve") == 1);
  const std::string json = s.changed_json();
  for (const char* part :
       {"\"components.caustic\":\"off\"", "\"film.ev\":\"-1.5\"", "\"path.max_depth\":\"7\""})
    CHECK(json.find(part) != std::string::npos);
  CHECK(json.find("seed") == std::string::npos);
}

}  // namespace settings_tests
