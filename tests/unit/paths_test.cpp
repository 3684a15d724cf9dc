// links: paths
#include "paths/automaton.h"
#include "paths/light_paths.h"

#include <catch2/catch.hpp>
#include <cmath>

namespace paths_tests {

using namespace lucerna;
using namespace lucerna::paths;

namespace {

/// The state after the events of a word of D, G and S.
uint8_t state_after(const paths::Automaton& a, const char* word) {
  uint8_t state = 0;
  for (const char* e = word; *e; ++e)
    state = a.after(state, static_cast<paths::Event>(*e == 'D' ? 0 : *e == 'G' ? 1 : 2));
  return state;
}

/// The partition by counting letters: no expression, no automaton.
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

TEST_CASE("the component automaton is small and knows which components are still reachable") {
  const Automaton automaton = compile_components();
  CHECK(automaton.states.size() == 8);  // as many as a path can store
  CHECK(automaton.states[0].reachable == 0b1111);
  const uint8_t d = automaton.after(0, Event::diffuse), dg = automaton.after(d, Event::glossy),
                dd = automaton.after(d, Event::diffuse), ddd = automaton.after(dd, Event::diffuse);
  CHECK(automaton.states[d].reachable == 0b1111);
  CHECK(automaton.states[dg].reachable == 0b1110);
  CHECK(automaton.states[dd].reachable == 0b0110);
  CHECK(automaton.states[ddd].reachable == 0b0100);
  const auto account = [&](uint8_t state) { return pack(automaton, 0b1111)[state] >> 29 & 3; };
  CHECK(account(ddd) == 2);
  CHECK(account(0) == 0);
}

TEST_CASE("packing switches components off without moving states") {
  const Automaton automaton = compile_components();
  const auto all = pack(automaton, 0b1111), no_tertiary = pack(automaton, 0b1011), none = pack(automaton, 0);
  REQUIRE(all.size() == automaton.states.size());
  for (size_t i = 0; i < all.size(); ++i) {
    CHECK((all[i] & 0xffffff) == (no_tertiary[i] & 0xffffff));
    CHECK((all[i] >> 24 & 7) == automaton.states[i].accept);
    CHECK((all[i] >> 27 & 1) == 1);
    CHECK((none[i] >> 24 & 7) == shared::k_component_none);
    CHECK((none[i] >> 27 & 1) == 0);
    CHECK((all[i] >> 28 & 1) == (i == 0 || i == automaton.after(0, Event::specular)));
  }
  const uint8_t ddd =
      automaton.after(automaton.after(automaton.after(0, Event::diffuse), Event::diffuse), Event::diffuse);
  CHECK((no_tertiary[ddd] >> 27 & 1) == 0);  // nothing left to find: the path stops
}

TEST_CASE("invalid expressions are refused with the location of the error") {
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

TEST_CASE("lookups replace paths where only cached components continue, one part for each component") {
  const paths::Automaton a = paths::compile_components();
  const auto after = [&](const char* word) { return state_after(a, word); };
  const uint8_t none = paths::k_no_component;
  const auto nothing = std::array<uint8_t, 4>{none, none, none, none};
  // Both: at the first diffuse vertex, also behind mirrors; nothing continues behind it, and caustics stay
  // with the path.
  const auto both = paths::lookup_routes(a, 15, 0b0110);
  CHECK(both.traced == 0b1001);
  CHECK(both.parts == 0b0110);
  CHECK(both.component[after("")] == std::array<uint8_t, 4>{none, 1, 2, none});
  CHECK(both.component[after("GS")] == both.component[after("")]);
  for (const char* word : {"D", "DS", "DD", "DDD"}) CHECK(both.component[after(word)] == nothing);
  // Secondary light from records includes tertiary light, unless that is off.
  CHECK(paths::lookup_routes(a, 15, 0b0010).component == both.component);
  CHECK(paths::lookup_routes(a, 0b1011, 0b0010).component[0] == std::array<uint8_t, 4>{none, 1, none, none});
  // Tertiary light alone: at the second diffuse vertex all indirect light belongs to it.
  const auto tertiary = paths::lookup_routes(a, 15, 0b0100);
  CHECK(tertiary.traced == 0b1011);
  CHECK(tertiary.parts == 0b1110);
  CHECK(tertiary.component[after("")] == nothing);
  CHECK(tertiary.component[after("D")] == std::array<uint8_t, 4>{none, 2, 2, 2});
  CHECK(tertiary.component[after("SDG")] == tertiary.component[after("D")]);
  CHECK(tertiary.component[after("DD")] == nothing);
  // With secondary light off nothing continues from the first vertex: tertiary light is looked up there.
  const auto alone = paths::lookup_routes(a, 0b0100, 0b0100);
  CHECK(alone.component[0] == std::array<uint8_t, 4>{none, none, 2, none});
  // Direct environment light is included in every lookup, in the component that it belongs to there, unless
  // that is off; without a lookup there is none.
  const auto sky = paths::lookup_routes(a, 15, 0b0110, true);
  CHECK(sky.traced == both.traced);
  CHECK(sky.parts == 0b0111);
  CHECK(sky.component[after("")] == std::array<uint8_t, 4>{0, 1, 2, none});
  CHECK(sky.component[after("D")] == nothing);
  CHECK(paths::lookup_routes(a, 15, 0b0100, true).component[after("SDG")] ==
        std::array<uint8_t, 4>{1, 2, 2, 2});
  CHECK(paths::lookup_routes(a, 0b1110, 0b0110, true).component[0] == both.component[0]);
  CHECK(paths::lookup_routes(a, 15, 0, true).parts == 0);
  // Rays of records that end in records also read the environment there, in the part that it belongs to.
  const auto rays = paths::record_routes(a, sky.parts, true, false);
  CHECK(rays.component[after("D")] == std::array<uint8_t, 4>{1, 2, 2, none});
  CHECK(rays.parts == 0b0111);
  // No cached component, no lookup.
  const auto plain = paths::lookup_routes(a, 15, 0);
  CHECK(plain.parts == 0);
  CHECK(plain.traced == 15);
}

TEST_CASE("rays of records read records again where only tertiary light remains, and gather it") {
  const paths::Automaton a = paths::compile_components();
  const uint8_t none = paths::k_no_component, d = a.after(0, paths::Event::diffuse);
  const auto plain = paths::record_routes(a, 0b0110, false, true);
  CHECK(plain.component.empty());
  CHECK(plain.parts == 0b0110);
  CHECK(plain.traced == 0b0110);
  const auto own = paths::record_routes(a, 0b0110, true, true);
  CHECK(own.parts == 0b1110);  // caustics on surfaces seen by a record are tertiary light for it
  CHECK(own.traced == 0b1010);
  CHECK(own.component[d] == std::array<uint8_t, 4>{none, 2, 2, 2});
  CHECK(own.component[0] == std::array<uint8_t, 4>{none, none, none, none});
  const auto matt = paths::record_routes(a, 0b0110, true, false);
  CHECK(matt.parts == 0b0110);
  CHECK(matt.component[d] == std::array<uint8_t, 4>{none, 2, 2, none});
  // Without tertiary light there is nothing to read.
  CHECK(paths::record_routes(a, 0b0010, true, true).component.empty());
}

TEST_CASE("paths that skip a lookup read tertiary light at every later vertex") {
  const paths::Automaton a = paths::compile_components();
  const uint8_t none = paths::k_no_component, d = a.after(0, paths::Event::diffuse),
                dd = a.after(d, paths::Event::diffuse);
  const std::array<uint8_t, 4> nothing{none, none, none, none};
  const auto own = paths::record_routes(a, 0b0111, true, true);
  // The picture's paths: they trace secondary light themselves, and direct environment light at the next
  // vertex belongs to it.
  const auto picture = paths::gather_routes(a, 15, own);
  CHECK(picture.traced == 0b1011);
  CHECK(picture.component[0] == nothing);
  CHECK(picture.component[d] == std::array<uint8_t, 4>{1, 2, 2, 2});
  CHECK(picture.component[dd] == std::array<uint8_t, 4>{2, 2, 2, 2});
  // The records' rays look up at the first vertex that they hit, and may skip that lookup too.
  const auto records = paths::gather_routes(a, own.parts, own);
  CHECK(records.component[d] == own.component[d]);
  CHECK(records.component[dd] == std::array<uint8_t, 4>{2, 2, 2, 2});
  CHECK(records.traced == own.traced);
  // If records are path traced, there are no lookups.
  CHECK(paths::gather_routes(a, 15, paths::record_routes(a, 0b0110, false, true)).component.empty());
}

TEST_CASE("a path continues as long as a light or a lookup can contribute") {
  const paths::Automaton a = paths::compile_components();
  const uint8_t d = a.after(0, paths::Event::diffuse), dd = a.after(d, paths::Event::diffuse);
  const auto live = [](uint32_t packed) { return (packed >> 27 & 1u) != 0; };
  const auto account = [](uint32_t packed) { return packed >> 29 & 3u; };
  // Everything is looked up: mirrors lead to lookups, diffuse lobes to nothing further.
  const auto routes = paths::lookup_routes(a, 0b0110, 0b0110);
  REQUIRE(routes.traced == 0);
  const auto looked = paths::pack(a, routes.traced, routes);
  CHECK(live(looked[0]));
  CHECK(account(looked[0]) == 1);
  CHECK(live(looked[a.after(0, paths::Event::specular)]));
  CHECK_FALSE(live(looked[d]));
  CHECK_FALSE(live(paths::pack(a, 0)[0]));
  // Behind a record's second diffuse event only hits of lights are needed: nothing if none can be hit.
  const auto own = paths::record_routes(a, 0b0110, true, false);
  CHECK(live(paths::pack(a, own.traced, own, true)[d]));
  CHECK(live(paths::pack(a, own.traced, own, true)[dd]));
  CHECK(live(paths::pack(a, own.traced, own, false)[d]));
  CHECK_FALSE(live(paths::pack(a, own.traced, own, false)[dd]));
  // A path tracer of all components always has a further vertex.
  for (const uint32_t packed : paths::pack(a, 15, {}, false)) CHECK(live(packed));
}

TEST_CASE("diffuse surfaces end paths where they neither read stored light nor lead to other light") {
  const paths::Automaton a = paths::compile_components();
  const uint8_t d = a.after(0, paths::Event::diffuse), dg = a.after(d, paths::Event::glossy);
  const auto ends = [](uint32_t packed) { return (packed & shared::k_ends_on_diffuse) != 0; };
  for (const uint32_t packed : paths::pack(a, 15)) CHECK_FALSE(ends(packed));
  // Interreflection is looked up at the first diffuse surface; behind it there are emitters and caustics.
  const auto routes = paths::lookup_routes(a, 0b1111, 0b0110);
  REQUIRE(routes.traced == 0b1001);
  const auto looked = paths::pack(a, routes.traced, routes);
  CHECK_FALSE(ends(looked[0]));
  CHECK_FALSE(ends(looked[a.after(0, paths::Event::specular)]));
  CHECK(ends(looked[d]));
  CHECK(ends(looked[dg]));
  // Tertiary light alone is looked up at the second one.
  const auto deep = paths::lookup_routes(a, 0b1111, 0b0100);
  const auto later = paths::pack(a, deep.traced, deep);
  CHECK_FALSE(ends(later[d]));
  CHECK(ends(later[a.after(d, paths::Event::diffuse)]));
}

TEST_CASE("a light path and a camera path form the word of the connected path") {
  const paths::Automaton a = paths::compile_components();
  const paths::LightAutomaton light = paths::reverse(a);
  CHECK(light.states.size() < 8);
  const char* letters = "DGS";
  // All words of up to six events, split at every place.
  for (int length = 0; length <= 6; ++length)
    for (int number = 0, all = int(std::pow(3, length)); number < all; ++number) {
      std::string events;
      for (int k = 0, rest = number; k < length; ++k, rest /= 3) events += letters[rest % 3];
      const uint8_t component = a.classify("E" + events + "L");
      for (int cut = 0; cut <= length; ++cut) {
        uint8_t eye = 0, from_light = 0;
        for (int k = 0; k < cut; ++k)
          eye = a.after(eye, paths::Event(std::string(letters).find(events[size_t(k)])));
        for (int k = length; k-- > cut;)
          from_light = light.after(from_light, paths::Event(std::string(letters).find(events[size_t(k)])));
        REQUIRE(light.states[from_light].component[eye] == component);
      }
      if (length > 0 && events[0] == 'D') {
        uint8_t from_light = 0;
        for (int k = length; k-- > 1;)
          from_light = light.after(from_light, paths::Event(std::string(letters).find(events[size_t(k)])));
        CHECK(light.states[from_light].part == component);
      }
    }
}

TEST_CASE("photons are stored where camera paths read them, and light paths end where none can") {
  const paths::Automaton a = paths::compile_components();
  const paths::LightAutomaton light = paths::reverse(a);
  const auto after = [&](const char* word) {
    uint8_t state = 0;
    for (const char* e = word; *e; ++e)
      state = light.after(state, paths::Event(*e == 'D' ? 0 : *e == 'G' ? 1 : 2));
    return state;
  };
  const auto part = [](uint32_t packed) { return packed >> 24 & 7u; };
  const auto live = [](uint32_t packed) { return (packed >> 27 & 1u) != 0; };
  // Caustics alone: light after mirrors and glass, without diffuse events.
  const auto caustics = paths::pack(light, 0b1000, 3);
  CHECK(part(caustics[after("")]) == shared::k_component_none);
  CHECK(live(caustics[after("")]));
  CHECK(part(caustics[after("SG")]) == 3);
  CHECK_FALSE(live(caustics[after("SD")]));
  CHECK_FALSE(live(caustics[after("D")]));
  CHECK((caustics[0] >> 29 & 3u) == 3);
  const auto all = paths::pack(light, 0b1110, 1);
  CHECK(part(all[after("")]) == shared::k_component_none);  // excludes direct light
  CHECK(part(all[after("DS")]) == 1);
  CHECK(part(all[after("SD")]) == 2);
  for (const uint32_t packed : all) CHECK(live(packed));
  for (const uint32_t packed : paths::pack(light, 0, 0)) CHECK_FALSE(live(packed));
}

TEST_CASE(
    "photons are looked up at the first diffuse vertex, or where secondary light is traced at the next") {
  const paths::Automaton a = paths::compile_components();
  const auto after = [&](const char* word) { return state_after(a, word); };
  const uint8_t none = paths::k_no_component;
  const std::array<uint8_t, 4> nothing{none, none, none, none};
  const auto caustic = paths::photon_routes(a, 15, 0b1000);
  CHECK(caustic.traced == 0b0111);
  CHECK(caustic.parts == 0b1000);
  CHECK(caustic.component[after("")] == std::array<uint8_t, 4>{none, none, none, 3});
  CHECK(caustic.component[after("GS")] == caustic.component[0]);
  for (const char* word : {"D", "DS", "DD"}) CHECK(caustic.component[after(word)] == nothing);
  const auto all = paths::photon_routes(a, 15, 0b1110);
  CHECK(all.traced == 0b0001);
  CHECK(all.component[0] == std::array<uint8_t, 4>{none, 1, 2, 3});
  for (const char* word : {"D", "DS", "DD", "DDD"}) CHECK(all.component[after(word)] == nothing);
  // Secondary light alone: the path continues for tertiary light.
  const auto secondary = paths::photon_routes(a, 15, 0b0010);
  CHECK(secondary.traced == 0b1101);
  CHECK(secondary.component[0] == std::array<uint8_t, 4>{none, 1, none, none});
  CHECK(secondary.component[after("D")] == nothing);
  // Final gathering: all indirect light at the second diffuse vertex.
  const auto gathered = paths::photon_routes(a, 15, 0b1100);
  CHECK(gathered.traced == 0b0011);
  CHECK(gathered.component[0] == std::array<uint8_t, 4>{none, none, none, 3});
  CHECK(gathered.component[after("SDG")] == std::array<uint8_t, 4>{none, 2, 2, 2});
  CHECK(gathered.component[after("DD")] == nothing);
  CHECK(paths::photon_routes(a, 0b1101, 0b0100).component[0] == std::array<uint8_t, 4>{none, none, 2, none});
  CHECK(paths::photon_routes(a, 15, 0).parts == 0);
  // Direct light at the first diffuse vertex; paths compute emitters that are seen without a diffuse event.
  const auto direct = paths::photon_routes(a, 15, 0b0001);
  CHECK(direct.traced == 15);
  CHECK(direct.component[after("GS")] == std::array<uint8_t, 4>{0, none, none, none});
  CHECK(direct.replaced[after("D")] == 1);
  for (const char* word : {"", "S", "GS", "DS", "DD"}) CHECK(direct.replaced[after(word)] == 0);
  // Every word is computed exactly once: by the path that traces it, or by its first lookup.
  const paths::LightAutomaton light = paths::reverse(a);
  const char* letters = "DGS";
  for (uint32_t own = 0; own < 16; ++own) {
    const auto routes = paths::photon_routes(a, 15, own);
    for (int number = 0; number < 729; ++number) {
      std::string events;
      for (int k = 0, rest = number; k < 6; ++k, rest /= 3) events += letters[rest % 3];
      events.resize(size_t(number % 7));
      const uint8_t component = a.classify("E" + events + "L");
      int times = 0;
      uint8_t eye = 0;
      for (size_t k = 0; k < events.size(); ++k) {
        const auto event = paths::Event(std::string(letters).find(events[k]));
        if (event == paths::Event::diffuse) {
          uint8_t from_light = 0;
          for (size_t j = events.size(); j-- > k + 1;)
            from_light = light.after(from_light, paths::Event(std::string(letters).find(events[j])));
          const uint8_t part = light.states[from_light].part;
          if (routes.component[eye][part] == component)
            ++times;
          else
            CHECK(routes.component[eye][part] == none);
        }
        eye = a.after(eye, event);
      }
      const bool replaced = !routes.replaced.empty() && routes.replaced[eye] != 0;
      times += (routes.traced >> component & 1u) != 0 && !replaced;
      INFO("E" << events << "L, own " << own);
      CHECK(times == 1);
    }
  }
}

TEST_CASE("a path continues through a lookup towards another lookup") {
  const paths::Automaton a = paths::compile_components();
  const uint8_t d = a.after(0, paths::Event::diffuse);
  // Secondary light from photons at the first diffuse vertex, tertiary light from records at the second.
  auto routes = paths::photon_routes(a, 0b0110, 0b0010);
  const auto records = paths::lookup_routes(a, 0b0110, 0b0100);
  for (size_t s = 0; s < routes.component.size(); ++s)
    for (size_t p = 0; p < 4; ++p)
      if (routes.component[s][p] == paths::k_no_component) routes.component[s][p] = records.component[s][p];
  const auto packed = paths::pack(a, 0, routes);
  CHECK((packed[d] >> 27 & 1u) == 1);
  CHECK((packed[a.after(d, paths::Event::diffuse)] >> 27 & 1u) == 0);
}

TEST_CASE(
    "paths skip the light of light tracing, and each word is computed once whichever solver has the rest") {
  const paths::Automaton a = paths::compile_components();
  const paths::LightAutomaton light = paths::reverse(a);
  const paths::LookupRoutes camera = paths::camera_routes(a, 15, 0b1000);
  CHECK(camera.parts == 0b1000);
  CHECK(camera.traced == 15);
  CHECK(paths::camera_routes(a, 0b0111, 0b1000).parts == 0);
  CHECK(paths::camera_routes(a, 15, 0b0111).parts == 0);
  const char* letters = "DGS";
  for (const bool photons : {false, true}) {
    paths::LookupRoutes routes = photons ? paths::photon_routes(a, 15, 0b1000, 0b1000)
                                         : paths::LookupRoutes{.component = {}, .traced = 15};
    if (photons) {
      CHECK(routes.component[0][3] == paths::k_no_component);
      CHECK(routes.component[state_after(a, "S")][3] == 3);
    }
    routes.replaced = camera.replaced;
    const std::vector<uint32_t> packed = paths::pack(a, routes.traced, routes);
    for (int length = 0; length <= 5; ++length)
      for (int number = 0, all = int(std::pow(3, length)); number < all; ++number) {
        std::string events;
        for (int k = 0, rest = number; k < length; ++k, rest /= 3) events += letters[rest % 3];
        INFO("E" << events << "L, photons " << photons);
        const uint8_t component = a.classify("E" + events + "L");
        const bool direct = length > 1 && events[0] == 'D' && events.find('D', 1) == std::string::npos;
        int times = direct;
        uint8_t eye = 0;
        bool live = true;
        for (size_t k = 0; k < events.size(); ++k) {
          if (photons && events[k] == 'D') {
            uint8_t from_light = 0;
            for (size_t j = events.size(); j-- > k + 1;)
              from_light = light.after(from_light, paths::Event(std::string(letters).find(events[j])));
            times += routes.component[eye][light.states[from_light].part] == component;
          }
          eye = a.after(eye, paths::Event(std::string(letters).find(events[k])));
          live = live && (packed[eye] >> 27 & 1u) != 0;
        }
        const bool traced = (packed[eye] >> 24 & 7u) == component;
        CHECK((!traced || live));
        CHECK(times + traced == 1);
      }
  }
  // Alone: paths end where they could only continue for light that light tracing computes.
  const paths::LookupRoutes alone = paths::camera_routes(a, 0b1000, 0b1000);
  const std::vector<uint32_t> packed = paths::pack(a, alone.traced, alone);
  CHECK((packed[state_after(a, "D")] >> 27 & 1u) == 0);
  CHECK((packed[state_after(a, "SD")] >> 27 & 1u) == 1);
}

}  // namespace paths_tests
