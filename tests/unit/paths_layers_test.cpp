// links: paths
// Layers by path expressions: their automaton against the direct matcher on all words, what stored light can
// and cannot tell apart, and texts that are refused.
#include <catch2/catch.hpp>

#include "paths/layers.h"

namespace paths_layers_tests {

using namespace lucerna;
using namespace lucerna::paths;

namespace {

LayerSet layers(const std::string& text) { return {compile_components(), text, {"beauty", "primary"}}; }

/// All words E...L with up to `most` events.
std::vector<std::string> all_words(size_t most) {
  std::vector<std::string> ways{""};
  for (size_t first = 0, length = 1; length <= most; ++length) {
    const size_t last = ways.size();
    for (size_t i = first; i < last; ++i)
      for (const char c : {'D', 'G', 'S'}) ways.push_back(ways[i] + c);
    first = last;
  }
  for (std::string& way : ways) way = "E" + way + "L";
  return ways;
}

}  // namespace

TEST_CASE("layers are found as the direct matcher finds them, on all words up to seven events") {
  const LayerSet set = layers(
      "all = E.*L, direct = EDL, mirrored = ES[DGS]*L, glow = ED(G|S)+D?L, odd = E(D.)*DL, end = E.*SSL, "
      "twice "
      "= E[DG]+SD*L");
  REQUIRE(set.size() == 7);
  size_t found = 0;
  for (const std::string& word : all_words(7)) {
    uint32_t wanted = 0;
    for (uint32_t l = 0; l < set.size(); ++l)
      if (matches(set.layers()[l].expression, word)) wanted |= 1u << l;
    found += wanted > 1 ? 1 : 0;
    if (set.classify(word) != wanted) FAIL_CHECK(word << " " << set.classify(word) << " " << wanted);
  }
  CHECK(found > 500);
  for (const char* none : {"", "E", "L", "DL", "ED", "EXL"}) CHECK(set.classify(none) == 0);
}

TEST_CASE("the table follows the automaton, whatever is looked up") {
  const LayerSet set = layers("mirrored = ES.*L, direct = E[SG]*DL");
  const Automaton automaton = compile_components();
  for (const uint32_t cached : {0u, k_secondary_bit | k_tertiary_bit, uint32_t{k_tertiary_bit}}) {
    const LookupRoutes routes = cached ? lookup_routes(automaton, 15, cached) : LookupRoutes{};
    const LayerSet::Routed routed = set.routed(routes, {});
    for (const std::string& word : all_words(5)) {
      uint32_t state = 0;
      for (const char c : word.substr(1, word.size() - 2))
        state = routed.table.states[state].next >> 8 * (c == 'D' ? 0 : c == 'G' ? 1 : 2) & 0xff;
      CHECK(routed.table.states[state].accept == set.classify(word));
    }
  }
}

TEST_CASE("a layer knows its part of stored light if all of its words agree") {
  const Automaton automaton = compile_components();
  const LookupRoutes cached = lookup_routes(automaton, 15, k_secondary_bit | k_tertiary_bit);
  const auto routed = [&](const char* text) { return layers(text).routed(cached, {}); };
  // By what comes before the record, and by component, stored light can be separated ...
  for (const char* known : {"a = E.*L", "a = ES.*L", "a = ED.*L", "a = E[SG]*D[SG]*DL", "a = E[SG]*DL",
                            "a = E[SG]*D[SG]+L", "a = E[SG]+D.*D.*L"}) {
    INFO(known);
    CHECK(routed(known).unknown == std::vector<uint32_t>{0});
  }
  // ... but not by what comes behind it.
  CHECK(routed("a = ED[SG]DL").unknown == std::vector<uint32_t>{k_secondary_bit});
  CHECK(routed("a = EDDDL").unknown == std::vector<uint32_t>{k_tertiary_bit});
  CHECK(routed("a = E.*SL").unknown == std::vector<uint32_t>{k_tertiary_bit});
  CHECK(routed("a = E.*L, b = E.*SL").unknown == std::vector<uint32_t>{0, k_tertiary_bit});
  // Paths know all of it.
  CHECK(layers("a = EDDDL").routed({}, {}).unknown == std::vector<uint32_t>{0});
  // Looked-up light of a component goes to the layers of its words.
  const LayerSet::Routed r = routed("bounce = ED[SG]*DL, far = ED.*D.*DL, mirrored = ES.*L");
  CHECK(r.table.states[0].looked_up[k_secondary] == 1);
  const uint32_t behind_mirror = r.table.states[0].next >> 16 & 0xff;
  CHECK(r.table.states[behind_mirror].looked_up[k_secondary] == 4);
  CHECK(r.table.states[behind_mirror].looked_up[k_tertiary] == 4);
  CHECK(unknown_text(k_secondary_bit | k_caustic_bit) == "secondary and caustic");
}

TEST_CASE("layers that cannot be read are refused, with the reason") {
  struct Case {
    const char *text, *message;
  };
  const std::string many = [] {
    std::string text;
    for (int i = 0; i < 17; ++i) text += (i ? ", a" : "a") + std::to_string(i) + " = EDL";
    return text;
  }();
  const Case cases[] = {{"mirrored", "expected NAME = EXPRESSION"},
                        {"a = EDL,", "expected NAME = EXPRESSION"},
                        {"= EDL", "is no name of a layer"},
                        {"1a = EDL", "is no name of a layer"},
                        {"a.b = EDL", "is no name of a layer"},
                        {"a234567890123456789012345678901234 = EDL", "is no name of a layer"},
                        {"primary = EDL", "a layer that every picture has"},
                        {"a = EDL, a = EGL", "two layers 'a'"},
                        {"a =", "has no expression"},
                        {"a = ED(L", "layer 'a': path expression 'ED(L', character 5: expected ')'"},
                        {"a = EDX", "expected one of E D G S L"},
                        {"a = DL", "no path is a word of 'DL'"},
                        {"a = ED", "no path is a word"},
                        {"a = EDLD", "no path is a word"},
                        {many.c_str(), "17 layers; at most 16"},
                        {"a = E.*D........L, b = E.*G........L", "more than 255 states"}};
  for (const Case& c : cases) {
    INFO(c.text);
    CHECK_THROWS_WITH(layers(c.text), Catch::Contains(c.message) && Catch::Contains("film.layers"));
  }
  CHECK(layers("").size() == 0);
  CHECK(layers("  ").size() == 0);
  CHECK(layers("a=EDL").index_of("a") == 0);
  CHECK(layers("a=EDL").index_of("b") == 1);
}

}  // namespace paths_layers_tests
