#pragma once
// Report of a solver as plain data: state, panel, overlay legends, and the card for the inspected place. The
// window draws it without knowing the solver. Made on the session's thread and published as a whole.
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

// Items of a panel, from top to bottom.

/// A name and its value; the help is a tooltip.
struct ValueRow {
  std::string name, value, help;
  Tone tone = Tone::normal;
};
/// Wrapped text.
struct Paragraph {
  std::string text;
  Tone tone = Tone::dim;
};
/// The control of an option with its label.
struct OptionRow {
  std::string key;
};
/// Buttons for the values of a choice, side by side.
struct ChoiceButtons {
  std::string key;
  std::vector<std::string> labels, short_labels;  ///< by value; the short ones if room is scarce
  std::string help;                               ///< added to the option's help
};
/// Buttons for solver commands, side by side.
struct CommandButtons {
  struct Button {
    std::string command;  ///< CommandInfo::name
    std::string help;     ///< for the current state; the key is added while enabled
    bool enabled = true;
  };
  std::vector<Button> buttons;
};
/// Toggle buttons for views, three in a row.
struct ViewButtons {
  std::vector<std::string> options;
};
/// A histogram.
struct Histogram {
  struct Column {
    float height = 0;  ///< 0..1 of the tallest column
    vec3 ink{0};       ///< sRGB, 0..1
    float lower = 0;   ///< 0..1 of its height: lower part with a second colour
    vec3 lower_ink{0};
    std::string label, help;  ///< labels are shown below every fourth column
  };
  std::vector<Column> columns;
};
/// A table. The first column is narrow and has no heading. Column `droppable` is hidden if room is scarce.
struct Table {
  struct Row {
    std::vector<std::string> cells;
    float bar = 0;            ///< 0..1: length of a bar behind the row
    std::optional<vec3> ink;  ///< colour of a mark before the row, sRGB
    Tone tone = Tone::normal;
    std::string help;
  };
  std::vector<std::string> columns;
  std::optional<size_t> droppable;
  std::vector<Row> rows;
};
/// Parts of a whole: one bar, and a row for each.
struct Parts {
  struct Part {
    std::string name, value, help;
    float share = 0;    ///< 0..1
    bool host = false;  ///< host time, not device time: bluish
  };
  std::vector<Part> parts;
};
/// A row of steps with the most recent one marked.
struct StepStrip {
  struct Step {
    std::string name, help;
  };
  std::vector<Step> steps;
  int last = -1;  ///< -1: none yet
};
/// Vertical space [design pixels].
struct Gap {
  float size = 4;
};

using PanelItem = std::variant<ValueRow, Paragraph, OptionRow, ChoiceButtons, CommandButtons, ViewButtons,
                               Histogram, Table, Parts, StepStrip, Gap>;

/// A collapsible section.
struct PanelSection {
  std::string title, note;
  std::vector<PanelItem> items;
};

/// Legend of an overlay.
struct Legend {
  struct Mark {
    vec3 ink{0};       ///< sRGB, 0..1
    std::string text;  ///< "": shares the text of the next mark
  };
  struct Tick {
    float at = 0;  ///< 0..1 along the ramp
    std::string text;
  };
  /// A logarithmic ramp; ticks are placed at round values.
  struct Range {
    float lo = 0.1f, hi = 1;
    enum class Unit { count, metres, plain } unit = Unit::plain;
  };
  std::string title;
  std::optional<uint32_t> ramp;  ///< shared::k_ramp_*
  std::vector<Tick> ticks;
  std::optional<Range> range;  ///< replaces `ticks`
  std::vector<Mark> marks;
  bool marks_in_line = true;  ///< side by side, as many as there is room for; else one below the other
  /// What is drawn and what its colours mean, in one to three sentences.
  std::string note = {};
};

/// Card for the inspected place, from top to bottom.
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
  /// A gap, optionally with a line across it.
  struct Rule {
    bool line = false;
  };
  struct FigureHeads {
    std::string name;
    std::vector<std::string> columns;
  };
  /// Light of one component: its colour, and values in columns.
  struct Figures {
    int component = 0;
    std::string name;
    vec3 light{0};  ///< linear; only its hue is shown
    std::vector<std::string> figures;
  };
  /// A share, 0..1, with a bar relative to `of`, the largest share.
  struct Weight {
    std::string name;
    float part = 0, of = 1;
  };
  enum class Room { any, much, little };
  struct Line {
    std::variant<Title, Row, Note, Rule, FigureHeads, Figures, Weight> what;
    Room room = Room::any;  ///< shown in any, only in a large, or only in a small picture
  };
  std::vector<Line> lines;
};

struct Report {
  std::string solver;    ///< SolverInfo::name
  bool ready = true;     ///< the data that paths read is complete
  bool waits = false;    ///< preparation waits for a command
  std::string to_go_on;  ///< if it waits: the reason, and the command that continues
  /// Work in progress, for the window's bar: "cache, pass 3: 2810 records"; "" if ready.
  std::string preparing;
  /// Work on complete data while the samples of the picture wait: "refining records"; "" if there is none.
  std::string refining;
  /// Progress of that work, 0..1, and its remaining device time [ms]; nullopt: no estimate.
  struct Progress {
    double done = 0, left_ms = 0;
  };
  std::optional<Progress> progress;
  std::string state;  ///< one word for the panel's title: "building"
  std::vector<PanelSection> sections;
  std::vector<Legend> legends;
  std::optional<vec2> looked_at;  ///< inspected place, 0..1 to the right and down
  std::optional<Card> card;       ///< card for that place
  /// Values by name, for benches and tests: "records", "rays".
  std::vector<std::pair<std::string, double>> figures;
  /// The value of that name; 0 if there is none.
  double figure(std::string_view name) const {
    for (const auto& [known, value] : figures)
      if (known == name) return value;
    return 0;
  }
};

}  // namespace lucerna::solvers
