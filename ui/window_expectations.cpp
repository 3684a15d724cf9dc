#include "window_expectations.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/error.h"
#include "film/io/picture_match.h"
#include "shown_lines.h"

namespace lucerna::ui {
namespace {

using commands::Check;
using commands::ExpectContext;
using commands::Verdict;
using commands::WordReader;

/// Takes "in PART"; "" without.
std::string read_part(WordReader& words, bool with_dialog) {
  std::vector<std::string> parts = k_parts;
  if (!with_dialog) std::erase(parts, "dialog");
  if (!words.take("in")) return "";
  for (const std::string& part : parts)
    if (words.take(part)) return part;
  words.refuse(fmt::format("one of {}", fmt::join(parts, ", ")));
}

void add_text(Actions& actions, commands::Expectations& expectations) {
  expectations.add(
      {.name = "text",
       .usage = "text [not] TEXT [in PART]",
       .help = fmt::format("a text in the window, also if it is cut for lack of room; PART is one of {}",
                           fmt::join(k_parts, ", ")),
       .needs_window = true,
       .read = [&actions](WordReader& words, const ExpectContext&) -> Check {
         const bool negated = words.take("not");
         const std::string text = words.text("a text");
         const std::string part = read_part(words, true);
         words.end("in PART");
         return [&actions, negated, text, part,
                 since = std::optional<uint64_t>()]() mutable -> std::optional<Verdict> {
           ShownLines& shown = ShownLines::instance();
           shown.record(true);
           if (!since) since = shown.frames();
           actions.wake(3);
           // The first frame may be the one during which a change arrives.
           constexpr uint64_t k_frames = 3;
           if (shown.frames() < *since + k_frames) return std::nullopt;
           shown.record(false);
           std::string all;
           for (const std::string& line : shown.lines(part)) all += (all.empty() ? "" : " | ") + line;
           const bool found = all.find(text) != std::string::npos;
           constexpr size_t k_longest = 600;
           if (all.size() > k_longest) {
             // Not within a code point.
             size_t end = k_longest;
             while (end > 0 && (static_cast<unsigned char>(all[end]) & 0xC0) == 0x80) --end;
             all = all.substr(0, end) + " ...";
           }
           return Verdict{
               found != negated,
               fmt::format("'{}' is {}in {}{}", text, found ? "" : "not ", part.empty() ? "the window" : part,
                           found != negated ? "" : ", which shows: " + all),
               {}};
         };
       },
       .names =
           [](const std::vector<std::string>& before) {
             if (before.empty()) return std::vector<std::string>{"not"};
             return before.back() == "in" ? k_parts : std::vector<std::string>{"in"};
           }});
}

/// The area of a part in the last frame [window pixels].
Area area_of(const Areas& areas, const std::string& part) {
  return part == "bar"        ? areas.bar
         : part == "left"     ? areas.left
         : part == "toolbar"  ? areas.toolbar
         : part == "picture"  ? areas.picture
         : part == "right"    ? areas.right
         : part == "accuracy" ? areas.accuracy
         : part == "passes"   ? areas.passes
                              : areas.log;
}

/// The part of a picture of the window that an area covers.
Requests::Grab cut(const Requests::Grab& window, const Area& area) {
  const auto clamped = [](float v, uint32_t most) {
    return std::min(static_cast<uint32_t>(std::max(0.0f, std::floor(v))), most);
  };
  const uint32_t x0 = clamped(area.lo.x, window.width), x1 = clamped(area.hi.x, window.width),
                 y0 = clamped(area.lo.y, window.height), y1 = clamped(area.hi.y, window.height);
  Requests::Grab part{.rgba = {}, .width = x1 - x0, .height = y1 - y0};
  for (uint32_t y = y0; y < y1; ++y) {
    const auto row = window.rgba.begin() + (static_cast<std::ptrdiff_t>(y) * window.width + x0) * 4;
    part.rgba.insert(part.rgba.end(), row, row + static_cast<std::ptrdiff_t>(part.width) * 4);
  }
  return part;
}

void add_window(Actions& actions, Requests& requests, const Areas& areas,
                commands::Expectations& expectations) {
  expectations.add(
      {.name = "window",
       .usage = "window FILE.png [in PART] [within DIFFERENCE] [share SHARE]",
       .help = "the window with its panels, or a PART of it, as 'expect picture' compares the picture",
       .needs_window = true,
       .read = [&actions, &requests, &areas](WordReader& words, const ExpectContext& context) -> Check {
         const std::string file = words.text("a PNG file");
         const std::string part = read_part(words, false);
         double within = film::MatchOptions{}.within, share = film::MatchOptions{}.share;
         while (!words.done())
           if (words.take("within"))
             within = words.number("a difference from 0 to 1", 0, 1);
           else if (words.take("share"))
             share = words.number("a share from 0 to 1", 0, 1);
           else
             words.refuse("in PART, within DIFFERENCE or share SHARE");
         return [&actions, &requests, &areas, context, file, part, within, share,
                 begun = false]() mutable -> std::optional<Verdict> {
           if (!std::exchange(begun, true)) {
             requests.grab = Requests::Grab{};
             requests.shot.settle = 3;
           }
           actions.wake(4);
           if (!requests.grab || requests.grab->rgba.empty()) return std::nullopt;
           Requests::Grab grabbed = *requests.grab;
           requests.grab.reset();
           if (!part.empty()) {
             const Area area = area_of(areas, part);
             if (area.width() < 1 || area.height() < 1) throw Error("", fmt::format("{} is not shown", part));
             grabbed = cut(grabbed, area);
           }
           return commands::expect_display(context, file, part.empty() ? "window" : part, grabbed.width,
                                           grabbed.height, grabbed.rgba, within, share);
         };
       }});
}

}  // namespace

void add_window_expectations(Actions& actions, Requests& requests, const Areas& areas,
                             commands::Expectations& expectations) {
  add_text(actions, expectations);
  add_window(actions, requests, areas, expectations);
}

}  // namespace lucerna::ui
