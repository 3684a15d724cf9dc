#pragma once
// What a solver tells a person, as plain data: its state, its panel, the legends of what it has drawn over
// the picture, a card on what lies under the pointer. The window draws all of it without knowing whose it is.
// Made on the session's thread, published as a whole.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "base/math.h"

namespace lucerna::solvers {

enum class Tone { normal, dim, faint, accent, warning };

// What a panel consists of, from the top down.

/// A name and its value; help in a tooltip.
struct ValueRow {
  std::string name, value, help;
  Tone tone = Tone::normal;
};
/// Text over as many lines as it takes.
struct Paragraph {
  std::string text;
  Tone tone = Tone::dim;
};
/// The control of an option, with its label.
struct OptionRow {
  std::string key;
};
/// Buttons for the values of a choice, side by side.
struct ChoiceButtons {
  std::string key;
  std::vector<std::string> labels, short_labels;  ///< by value; the short ones where there is little room
  std::string help;                               ///< besides the option's
};
/// Buttons for commands of the solver, side by side.
struct CommandButtons {
  struct Button {
    std::string command;  ///< CommandInfo::name
    std::string help;     ///< as things stand; its key is added while it is enabled
    bool enabled = true;
  };
  std::vector<Button> buttons;
};
/// Buttons that turn views on and off, side by side, three in a row.
struct ViewButtons {
  std::vector<std::string> options;
};
/// Columns of a histogram.
struct Histogram {
  struct Column {
    float height = 0;  ///< 0..1 of the tallest
    vec3 ink{0};       ///< sRGB, 0..1
    float lower = 0;   ///< 0..1 of its height, from below, that has another ink
    vec3 lower_ink{0};
    std::string label, help;  ///< label below every fourth
  };
  std::vector<Column> columns;
};
/// A table: a row a thing. The first column is narrow and without a heading; where there is little room
/// `droppable` is left out.
struct Table {
  struct Row {
    std::vector<std::string> cells;
    float bar = 0;            ///< 0..1: length of a bar behind the row
    std::optional<vec3> ink;  ///< of a mark before it, sRGB
    Tone tone = Tone::normal;
    std::string help;
  };
  std::vector<std::string> columns;
  std::optional<size_t> droppable;
  std::vector<Row> rows;
};
/// Parts of a whole, as one bar and a row each.
struct Parts {
  struct Part {
    std::string name, value, help;
    float share = 0;    ///< 0..1
    bool host = false;  ///< done by the host, not the device: bluish
  };
  std::vector<Part> parts;
};
/// Steps in a row, of which one has come last.
struct StepStrip {
  struct Step {
    std::string name, help;
  };
  std::vector<Step> steps;
  int last = -1;  ///< -1: none yet
};
/// In design pixels.
struct Gap {
  float size = 4;
};

using PanelItem = std::variant<ValueRow, Paragraph, OptionRow, ChoiceButtons, CommandButtons, ViewButtons,
                               Histogram, Table, Parts, StepStrip, Gap>;

/// A section that can be folded.
struct PanelSection {
  std::string title, note;
  std::vector<PanelItem> items;
};

/// The legend of something drawn over the picture.
struct Legend {
  struct Mark {
    vec3 ink{0};       ///< sRGB, 0..1
    std::string text;  ///< "": the next mark stands close by, and its text is for both
  };
  struct Tick {
    float at = 0;  ///< 0..1 along the ramp
    std::string text;
  };
  /// Values along a logarithmic ramp; ticks are put where they are round.
  struct Range {
    float lo = 0.1f, hi = 1;
    enum class Unit { count, metres, plain } unit = Unit::plain;
  };
  std::string title;
  std::optional<uint32_t> ramp;  ///< shared::k_ramp_*
  std::vector<Tick> ticks;
  std::optional<Range> range;  ///< in place of `ticks`
  std::vector<Mark> marks;
  bool marks_in_line = true;  ///< side by side, as many as there is room for; else one below the other
  /// What is drawn and what its colours mean, in one to three sentences.
  std::string note = {};
};

/// What lies under the pointer, from the top down.
struct Card {
  struct Title {
    std::string left, right;
  };
  struct Row {
    std::string name, value;
  };
  struct Note {
    std::string text;
    Tone tone = Tone::dim;
  };
  /// A gap, with a line across it or without.
  struct Rule {
    bool line = false;
  };
  struct FigureHeads {
    std::string name;
    std::vector<std::string> columns;
  };
  /// Light of one component: its own colour, and figures in columns.
  struct Figures {
    int component = 0;
    std::string name;
    vec3 light{0};  ///< linear; its hue is shown
    std::vector<std::string> figures;
  };
  /// A share, 0..1, with a bar as long as it is of `of`, the greatest.
  struct Weight {
    std::string name;
    float part = 0, of = 1;
  };
  enum class Room { any, much, little };
  struct Line {
    std::variant<Title, Row, Note, Rule, FigureHeads, Figures, Weight> what;
    Room room = Room::any;  ///< where it is shown: in a large picture, in a small one
  };
  std::vector<Line> lines;
};

struct Report {
  std::string solver;    ///< SolverInfo::name
  bool ready = true;     ///< what paths read of it is complete
  bool waits = false;    ///< preparation waits for a command
  std::string to_go_on;  ///< where it waits: what it waits for, and which command goes on
  /// What is being made, "" when ready: "cache, pass 3: 2810 records". For the window's bar.
  std::string preparing;
  /// Of what is being made, 0..1, and the device time that it still takes [ms]; none: it cannot be told.
  struct Progress {
    double done = 0, left_ms = 0;
  };
  std::optional<Progress> progress;
  std::string state;  ///< one word for the panel's head: "building"
  std::vector<PanelSection> sections;
  std::vector<Legend> legends;
  std::optional<vec2> looked_at;  ///< where somebody looks, 0..1 to the right and down
  std::optional<Card> card;       ///< what is there
  /// Figures by name, for benches and tests: "records", "rays".
  std::vector<std::pair<std::string, double>> figures;
  /// 0 where there is none of that name.
  double figure(std::string_view name) const {
    for (const auto& [known, value] : figures)
      if (known == name) return value;
    return 0;
  }
};

}  // namespace lucerna::solvers
