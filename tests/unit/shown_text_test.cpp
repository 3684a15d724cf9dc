// links: ui
// What the window says of the displayed picture's error.
#include <catch2/catch.hpp>

#include "ui/shown_text.h"

namespace shown_text_tests {

using namespace lucerna;
using Texts = std::vector<std::string>;

TEST_CASE("the displayed picture's error is said in words, and what is from before the edit") {
  session::Snapshot s;
  s.seconds = 2;
  CHECK(ui::shown_texts(s).empty());  // samples as they are
  CHECK(ui::usable_text(s) == "");
  s.stale = 0.42;
  CHECK(ui::shown_texts(s) == Texts{"42 % from before the edit"});
  s.shown_error = film::ShownError{0.3, 0.6};
  s.filtered = 0.5;
  CHECK(ui::shown_texts(s).front() == "30.0 % off, 42 % from before the edit");
  CHECK(ui::usable_text(s) == ", usable in about 6.0 s");  // noise falls by half in four times the time
  s.stale_is_preview = true;                               // solvers' data is complete; nothing was edited
  CHECK(ui::shown_texts(s).front() == "30.0 % off, 42 % from the preview");
  s.stale = 0;
  CHECK(ui::shown_texts(s).front() == "30.0 % off, worst tenth 60.0 %");
  CHECK(ui::shown_texts(s).back() == "30.0 % off");
}

TEST_CASE("a picture is usable if the median tile and the worst tenth are") {
  session::Snapshot s;
  s.seconds = 1;
  s.shown_error = film::ShownError{0.1, 0.29};
  CHECK(ui::usable_text(s) == ": usable");
  s.coarse = true;  // no sample at full resolution yet
  CHECK(ui::usable_text(s) == ": usable, still coarse");
  s.coarse = false;
  s.shown_error = film::ShownError{0.1, 0.5};
  CHECK(ui::usable_text(s) != ": usable");
  s.shown_error = film::ShownError{0.2, 0.25};
  CHECK(ui::usable_text(s) != ": usable");
}

TEST_CASE("a forecast counts the time after preparation only, and there is none during it") {
  session::Snapshot s;
  s.seconds = 100;
  s.shown_error = film::ShownError{0.3, 0.4};
  s.preparing = "cache, pass 1: 0 records";
  CHECK(ui::usable_text(s) == ", not usable yet");
  s.preparing.clear();
  s.prepared_seconds = 98;
  CHECK(ui::usable_text(s) == ", usable in about 6.0 s");
}

TEST_CASE("a pause before the first sample is said, because the picture shows nothing new") {
  session::Snapshot s;
  CHECK(ui::paused_text(s) == "");
  s.paused = true;
  CHECK(ui::paused_text(s) == "Paused before the first sample. Space resumes.");
  s.samples = 1;
  CHECK(ui::paused_text(s) == "");
  s.samples = 0, s.activity = "loading";
  CHECK(ui::paused_text(s) == "");
}

}  // namespace shown_text_tests
