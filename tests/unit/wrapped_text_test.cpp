// links: ui
// Text broken into lines of a width.
#include <imgui.h>

#include <catch2/catch.hpp>

#include "ui/widgets.h"

namespace wrapped_text_tests {

using namespace lucerna;

TEST_CASE("text is broken at spaces into lines that fit; only a word without room is cut") {
  ImGui::CreateContext();
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  ImFont* font = atlas.AddFontDefault();  // of a fixed width
  atlas.Build();
  const float letter = ui::text_width("m", font);
  using Lines = std::vector<std::string>;
  const auto lines = [&](const std::string& text, float letters) {
    return ui::wrapped(text, letters * letter, font);
  };
  CHECK(lines("usable in about 3.4 s", 21) == Lines{"usable in about 3.4 s"});
  CHECK(lines("usable in about 3.4 s", 16) == Lines{"usable in about", "3.4 s"});
  CHECK(lines("usable in about 3.4 s", 9) == Lines{"usable in", "about 3.4", "s"});
  CHECK(lines("", 9).empty());
  const Lines cut = lines("a components.secondary b", 8);
  REQUIRE(cut.size() == 3);
  CHECK(cut.front() == "a");
  CHECK(ui::text_width(cut[1], font) <= 8 * letter);
  CHECK(cut.back() == "b");
  ImGui::DestroyContext();
}

}  // namespace wrapped_text_tests
