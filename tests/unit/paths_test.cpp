// links: paths
#include "paths/automaton.h"

#include <catch2/catch.hpp>

using namespace lucerna;
using namespace lucerna::paths;

namespace {

/// The partition as METHODS words it, by counting letters: no expression, no automaton.
int classify_by_counting(const std::string& word) {
  const std::string middle = word.substr(1, word.size() - 2);
  const auto diffuse = std::count(middle.begin(), middle.end(), 'D');
  if (diffuse == 0) return 0;
  const std::string after_first = middle.substr(middle.find('D') + 1);
  if (diffuse == 1) return after_first.empty() ? 0 : 3;
  return diffuse == 2 && middle.back() == 'D' ? 1 : 2;
}

std::vector<std::string> all_words(size_t longest) {
  std::vector<std::string> middles{""};
  for (size_t first = 0, length = 1; length <= longest - 2; ++length) {
    const size_t last = middles.size();
    for (size_t i = first; i < last; ++i)
      for (char c : {'D', 'G', 'S'}) middles.push_back(middles[i] + c);
    first = last;
  }
  for (auto& m : middles) m = "E" + m + "L";
  return middles;
}

}  // namespace

TEST_CASE("the automaton agrees with a brute-force classifier on all words up to length 9") {
  const Automaton automaton = compile_components();
  const auto words = all_words(9);
  REQUIRE(words.size() == 1 + 3 + 9 + 27 + 81 + 243 + 729 + 2187);
  for (const auto& word : words) {
    INFO(word);
    int owners = 0;
    for (const char* expression : k_component_expressions) owners += matches(expression, word);
    CHECK(owners == 1);  // disjoint and complete
    CHECK(int(automaton.classify(word)) == classify_by_counting(word));
    CHECK(matches(k_component_expressions[automaton.classify(word)], word));
  }
}

TEST_CASE("the component automaton is small and knows what is still reachable") {
  const Automaton automaton = compile_components();
  CHECK(automaton.states.size() == 5);
  CHECK(automaton.states[0].reachable == 0b1111);
  const uint8_t d = automaton.after(0, Event::diffuse), dg = automaton.after(d, Event::glossy),
                dd = automaton.after(d, Event::diffuse), ddd = automaton.after(dd, Event::diffuse);
  CHECK(automaton.states[d].reachable == 0b1111);
  CHECK(automaton.states[dg].reachable == 0b1110);
  CHECK(automaton.states[dd].reachable == 0b0110);
  CHECK(automaton.states[ddd].reachable == 0b0100);
  CHECK(automaton.accounted_to(ddd) == 2);
  CHECK(automaton.accounted_to(0) == 0);
}

TEST_CASE("packing switches components off without moving states") {
  const Automaton automaton = compile_components();
  const auto all = pack(automaton, 0b1111), no_tertiary = pack(automaton, 0b1011), none = pack(automaton, 0);
  REQUIRE(all.size() == automaton.states.size());
  for (size_t i = 0; i < all.size(); ++i) {
    CHECK((all[i] & 0xffffff) == (no_tertiary[i] & 0xffffff));
    CHECK((all[i] >> 24 & 7) == automaton.states[i].accept);
    CHECK((all[i] >> 27 & 1) == 1);
    CHECK((none[i] >> 24 & 7) == k_component_count);
    CHECK((none[i] >> 27 & 1) == 0);
    CHECK((all[i] >> 28 & 1) == (i == 0));
  }
  const uint8_t ddd =
      automaton.after(automaton.after(automaton.after(0, Event::diffuse), Event::diffuse), Event::diffuse);
  CHECK((no_tertiary[ddd] >> 27 & 1) == 0);  // nothing to be gained there: the path stops
}

TEST_CASE("wrong expressions are refused with their place") {
  const auto message = [](std::vector<std::string> expressions) {
    try {
      compile(expressions);
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  CHECK(message({"E[SGL"}).find("character 6: expected ']'") != std::string::npos);
  CHECK(message({"EXL"}).find("character 2") != std::string::npos);
  CHECK(message({"E(D|GL"}).find("expected ')'") != std::string::npos);
  CHECK(message({"E[]L"}).find("class needs a letter") != std::string::npos);
  CHECK(message({"E.*L", "E[SG]DL"}).find("both hold the word EGDL") != std::string::npos);
  CHECK(message({"ED?(G|S)+L", "EDL"}) == "accepted");
}
