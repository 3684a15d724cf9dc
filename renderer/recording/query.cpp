#include "recording/query.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>

#include "base/error.h"

namespace lucerna::recording {
namespace {

using Test = std::function<bool(const Row&)>;

std::span<const Event> events_of(const Row& row) { return row.of.events_of(row.path); }

std::vector<std::string> materials_on_way(const Row& row) {
  std::set<std::string> names;
  const auto events = events_of(row);
  for (uint32_t at = row.event; at < events.size();) {
    if (const std::string name = material_name(row.of, events[at]); !name.empty()) names.insert(name);
    at = events[at].parent < at ? events[at].parent : shared::k_path_no_event;
  }
  return {names.begin(), names.end()};
}

std::string group_name(const Row& row) {
  const uint32_t group = group_of(row.at());
  return group < row.of.groups.size() ? row.of.groups[group] : "";
}

std::vector<Field> make_fields() {
  std::vector<Field> all;
  const auto text = [&](const char* name, const char* help,
                        std::function<std::vector<std::string>(const Row&)> read,
                        std::vector<std::string> values = {}) {
    all.push_back({.name = name, .help = help, .texts = std::move(read), .values = std::move(values)});
  };
  const auto number = [&](const char* name, const char* help, double (*read)(const Row&)) {
    all.push_back({.name = name, .help = help, .number = read});
  };
  using Texts = std::vector<std::string>;
  text("component", "component of the light",
       [](const Row& r) { return Texts{paths::k_component_names[component_of(r.at())]}; },
       {paths::k_component_names.begin(), paths::k_component_names.end()});
  text("event", "what brought it",
       [](const Row& r) { return Texts{k_kind_names[std::min(kind_of(r.at()), shared::k_path_kinds - 1)]}; },
       {k_kind_names.begin(), k_kind_names.end()});
  text("word", "way of the light, as EDSL; ~ compares it with a path expression",
       [](const Row& r) { return Texts{word_of(events_of(r), r.event)}; });
  text("light", "name of the lamp, emissive material or environment",
       [](const Row& r) { return Texts{light_name(r.of, r.at())}; });
  text("material", "a material on the way", materials_on_way);
  text("group", "light group", [](const Row& r) { return Texts{group_name(r)}; });
  number("contribution", "luminance", [](const Row& r) { return double(luminance(r.at().contribution)); });
  number("red", "red radiance", [](const Row& r) { return double(r.at().contribution.x); });
  number("green", "green radiance", [](const Row& r) { return double(r.at().contribution.y); });
  number("blue", "blue radiance", [](const Row& r) { return double(r.at().contribution.z); });
  number("x", "column of the pixel", [](const Row& r) { return double(r.path.pixel % r.of.width); });
  number("y", "row of the pixel", [](const Row& r) { return double(r.path.pixel / r.of.width); });
  number("sample", "sample of the pixel", [](const Row& r) { return double(r.path.sample); });
  number("depth", "scatterings on the way",
         [](const Row& r) { return double(depth_of(r.of.events_of(r.path), r.event)); });
  number("pdf", "density of the direction, of a light sample with its selection",
         [](const Row& r) { return double(r.at().pdf); });
  number("served", "records or photons that were read", [](const Row& r) { return double(r.at().served); });
  number("events", "events of the path", [](const Row& r) { return double(r.path.count); });
  number("cost", "rays of the path: to surfaces and to lights",
         [](const Row& r) { return double(rays_of(events_of(r))); });
  number("time", "microseconds of the path, by the mean time of a ray in the picture; 0: not measured",
         [](const Row& r) { return time_of(events_of(r), r.of.times); });
  using Read = double (*)(const Row&);
  const Read places[] = {[](const Row& r) { return double(lit_place(events_of(r), r.event).x); },
                         [](const Row& r) { return double(lit_place(events_of(r), r.event).y); },
                         [](const Row& r) { return double(lit_place(events_of(r), r.event).z); }};
  for (int k = 0; k < 3; ++k) {
    number(k == 0   ? "lit_x"
           : k == 1 ? "lit_y"
                    : "lit_z",
           "where the light is received, in the world [m]", places[k]);
    all.back().axis = k;
  }
  return all;
}

struct Token {
  enum class Kind { word, text, number, sign, end } kind = Kind::end;
  std::string text;
  double value = 0;
  size_t at = 0;
};

/// A part of a query: its test, and a box that has the places of all rows that pass.
struct Part {
  Test test;
  Box places{vec3(-k_infinity), vec3(k_infinity)};
};

class Parser {
 public:
  Parser(const std::string& text, const std::string& where) : text_(text), where_(where) { advance(); }

  Part parse() {
    Part part = any();
    if (token_.kind != Token::Kind::end) refuse(token_, "expected 'and', 'or' or the end");
    return part;
  }

 private:
  [[noreturn]] void refuse(const Token& token, const std::string& what) const {
    const std::string found = token.kind == Token::Kind::end ? "the end" : fmt::format("'{}'", token.text);
    throw Error(where_, fmt::format("position {}: {}, found {}\n  {}\n  {}^", token.at + 1, what, found,
                                    text_, std::string(token.at, ' ')));
  }

  void advance() {
    size_t& at = next_;
    while (at < text_.size() && std::isspace(static_cast<unsigned char>(text_[at]))) ++at;
    token_ = {.at = at};
    if (at >= text_.size()) return;
    const auto c = static_cast<unsigned char>(text_[at]);
    if (c == '"' || c == '\'') {
      const size_t end = text_.find(char(c), at + 1);
      token_.text = text_.substr(at);
      if (end == std::string::npos) refuse(token_, "a text without its closing quote");
      token_.kind = Token::Kind::text, token_.text = text_.substr(at + 1, end - at - 1);
      at = end + 1;
      return;
    }
    if (std::isalpha(c) || c == '_') {
      const size_t begin = at;
      while (at < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at])) || text_[at] == '_'))
        ++at;
      token_.kind = Token::Kind::word, token_.text = text_.substr(begin, at - begin);
      return;
    }
    if (std::isdigit(c) || c == '-' || c == '+' || c == '.') {
      const char* begin = text_.c_str() + at;
      char* end = nullptr;
      token_.value = std::strtod(begin, &end);
      token_.text = std::string(begin, std::max<const char*>(end, begin + 1));
      if (end == begin || !std::isfinite(token_.value)) refuse(token_, "expected a number");
      token_.kind = Token::Kind::number;
      at += size_t(end - begin);
      return;
    }
    for (const char* sign : {"==", "!=", "<=", ">=", "<", ">", "~", "(", ")"})
      if (text_.compare(at, std::string_view(sign).size(), sign) == 0) {
        token_.kind = Token::Kind::sign, token_.text = sign;
        at += token_.text.size();
        return;
      }
    token_.text = text_.substr(at, 1);
    refuse(token_, token_.text == "=" ? "'==' compares" : "expected a field, a value or an operator");
  }
  Token take() {
    Token token = token_;
    advance();
    return token;
  }
  bool accept(Token::Kind kind, const char* text) {
    if (token_.kind != kind || token_.text != text) return false;
    advance();
    return true;
  }

  Part any() {
    Part left = all();
    while (accept(Token::Kind::word, "or")) {
      Part right = all();
      left.places.grow(right.places);
      left.test = [a = std::move(left.test), b = std::move(right.test)](const Row& row) {
        return a(row) || b(row);
      };
    }
    return left;
  }
  Part all() {
    Part left = one();
    while (accept(Token::Kind::word, "and")) {
      Part right = one();
      left.places = {glm::max(left.places.lo, right.places.lo), glm::min(left.places.hi, right.places.hi)};
      left.test = [a = std::move(left.test), b = std::move(right.test)](const Row& row) {
        return a(row) && b(row);
      };
    }
    return left;
  }
  Part one() {
    constexpr int k_deepest = 200;
    if (++depth_ > k_deepest) refuse(token_, "too many parentheses");
    Part part;
    if (accept(Token::Kind::word, "not")) {
      part.test = [a = one().test](const Row& row) { return !a(row); };
    } else if (accept(Token::Kind::sign, "(")) {
      part = any();
      if (!accept(Token::Kind::sign, ")")) refuse(token_, "expected ')'");
    } else {
      part = comparison();
    }
    --depth_;
    return part;
  }

  Part comparison() {
    const Token name = take();
    const Field* field = name.kind == Token::Kind::word ? find_field(name.text) : nullptr;
    if (!field) {
      std::vector<std::string> known;
      for (const Field& f : fields()) known.push_back(f.name);
      refuse(name, fmt::format("expected a field: {}", fmt::join(known, ", ")));
    }
    const Token sign = take();
    if (sign.kind != Token::Kind::sign || sign.text == "(" || sign.text == ")")
      refuse(sign, "expected == != < <= > >= or ~");
    const Token value = take();
    if (value.kind == Token::Kind::end || value.kind == Token::Kind::sign) refuse(value, "expected a value");
    if (sign.text == "~") return {matching(*field, sign, value)};
    if (!field->number) return {texts(*field, sign, value)};
    Part part{numbers(*field, sign, value)};
    if (field->axis >= 0 && sign.text != "!=") {
      // Places are of single precision: the box is one step larger.
      if (sign.text[0] != '<') part.places.lo[field->axis] = std::nextafter(float(value.value), -k_infinity);
      if (sign.text[0] != '>') part.places.hi[field->axis] = std::nextafter(float(value.value), k_infinity);
    }
    return part;
  }

  Test numbers(const Field& field, const Token& sign, const Token& value) const {
    if (value.kind != Token::Kind::number) refuse(value, fmt::format("expected a number for {}", field.name));
    const auto with = [&](auto compare) -> Test {
      return
          [read = field.number, compare, v = value.value](const Row& row) { return compare(read(row), v); };
    };
    if (sign.text == "==") return with(std::equal_to<double>());
    if (sign.text == "!=") return with(std::not_equal_to<double>());
    if (sign.text == "<") return with(std::less<double>());
    if (sign.text == "<=") return with(std::less_equal<double>());
    if (sign.text == ">") return with(std::greater<double>());
    return with(std::greater_equal<double>());
  }

  Test texts(const Field& field, const Token& sign, const Token& value) const {
    if (sign.text != "==" && sign.text != "!=")
      refuse(sign, fmt::format("{} is a text: expected == or !=", field.name));
    if (!field.values.empty() &&
        std::find(field.values.begin(), field.values.end(), value.text) == field.values.end())
      refuse(value, fmt::format("expected one of {}", fmt::join(field.values, ", ")));
    const bool equal = sign.text == "==";
    return [read = field.texts, text = value.text, equal](const Row& row) {
      const std::vector<std::string> found = read(row);
      return (std::find(found.begin(), found.end(), text) != found.end()) == equal;
    };
  }

  Test matching(const Field& field, const Token& sign, const Token& value) const {
    if (field.name != "word") refuse(sign, "only a word is compared with ~");
    try {
      return [read = field.texts, automaton = paths::compile({value.text})](const Row& row) {
        const std::string word = read(row)[0];
        // Of looked-up light no single word is known.
        return !is_open(word) && automaton.classify(word) == 0;
      };
    } catch (const Error& e) {
      refuse(value, fmt::format("not a path expression: {}", e.what()));
    }
  }

  const std::string& text_;
  const std::string& where_;
  size_t next_ = 0;
  Token token_;
  int depth_ = 0;
};

}  // namespace

const std::vector<Field>& fields() {
  static const std::vector<Field> all = make_fields();
  return all;
}

const Field* find_field(const std::string& name) {
  for (const Field& field : fields())
    if (field.name == name) return &field;
  return nullptr;
}

std::string text_of(const Field& field, const Row& row) {
  if (field.number) return fmt::format("{:.6g}", field.number(row));
  return fmt::format("{}", fmt::join(field.texts(row), "+"));
}

Query::Query(const std::string& text, const std::string& where) {
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) return;
  Part part = Parser(text, where).parse();
  test_ = std::move(part.test), places_ = part.places;
}

std::optional<Box> Query::places() const {
  for (int k = 0; k < 3; ++k)
    if (places_.lo[k] > -k_infinity || places_.hi[k] < k_infinity) return places_;
  return std::nullopt;
}

void visit_rows(const Recording& recording, const std::function<void(const Row&)>& f) {
  for (const Path& path : recording.paths)
    for (uint32_t i = 0; i < path.count; ++i)
      if (shared::is_component(component_of(recording.events[path.first + i]))) f({recording, path, i});
}

}  // namespace lucerna::recording
