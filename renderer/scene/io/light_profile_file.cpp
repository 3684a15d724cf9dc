#include "scene/io/light_profile_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/error.h"
#include "base/file.h"

namespace lucerna::scene {
namespace {

constexpr double k_degree = std::numbers::pi / 180;
constexpr size_t k_most_angles = 3601;  // a twentieth of a degree
constexpr uintmax_t k_most_bytes = 16u << 20;

/// Lines and numbers of a text, with the line's number for messages.
class Reader {
 public:
  Reader(std::string_view text, std::string where) : text_(text), where_(std::move(where)) {}

  bool at_end() const { return at_ >= text_.size(); }
  std::string place() const { return fmt::format("{}, line {}", where_, shown_); }
  const std::string& where() const { return where_; }

  std::string_view line() {
    shown_ = line_++;
    const size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
    const std::string_view found = text_.substr(at_, end - at_);
    at_ = end;
    if (at_ < text_.size()) at_ += text_.substr(at_, 2) == "\r\n" ? 2 : 1;
    return found;
  }

  /// The next number, over any line breaks. `what` says which for messages.
  double number(const char* what) {
    skip();
    shown_ = line_;
    if (at_end()) throw_error(place(), "the file ends before {}", what);
    const size_t end = std::min(text_.find_first_of(" \t\r\n,", at_), text_.size());
    const std::string_view word = text_.substr(at_, end - at_);
    at_ = end;
    return parse(word, what);
  }
  double parse(std::string_view word, const char* what) const {
    if (word.starts_with('+')) word.remove_prefix(1);
    std::string plain(word);
    std::replace(plain.begin(), plain.end(), ',', '.');
    double value = 0;
    const auto [end, error] = std::from_chars(plain.data(), plain.data() + plain.size(), value);
    if (error != std::errc() || end != plain.data() + plain.size() || !std::isfinite(value))
      throw_error(place(), "'{}' is no number, expected {}", word.substr(0, 32), what);
    return value;
  }
  /// A whole number from `least` to `most`.
  size_t count(const char* what, size_t least, size_t most) {
    const double value = number(what);
    return checked(value, what, least, most);
  }
  size_t checked(double value, const char* what, size_t least, size_t most) const {
    if (!(value >= double(least) && value <= double(most)) || value != std::floor(value))
      throw_error(place(), "{} {}, expected {} to {}", value, what, least, most);
    return size_t(value);
  }

 private:
  void skip() {
    for (; at_ < text_.size() && std::string_view(" \t\r\n,").find(text_[at_]) != std::string_view::npos;
         ++at_)
      if (text_[at_] == '\n' || (text_[at_] == '\r' && text_.substr(at_, 2) != "\r\n")) ++line_;
  }

  std::string_view text_;
  std::string where_;
  size_t at_ = 0, line_ = 1;
  size_t shown_ = 1;  // of what was read last
};

std::string_view trimmed(std::string_view s) {
  const size_t first = s.find_first_not_of(" \t"), last = s.find_last_not_of(" \t");
  return first == std::string_view::npos ? std::string_view() : s.substr(first, last - first + 1);
}

/// Angles in increasing order.
std::vector<double> read_angles(Reader& in, size_t count, const char* what) {
  std::vector<double> angles;
  for (size_t i = 0; i < count; ++i) {
    angles.push_back(in.number(what));
    if (std::abs(angles.back()) > 360 || (i > 0 && !(angles[i] > angles[i - 1])))
      throw_error(in.place(), "{} {} does not increase from the one before, or is beyond 360 degrees", what,
                  angles.back());
  }
  return angles;
}

/// Place of an angle among angles: the first of two neighbours, and the share of the way to the next.
/// Negative: it is outside.
struct Between {
  std::ptrdiff_t first;
  double share;
};
Between between(const std::vector<double>& angles, double angle) {
  constexpr double k_slack = 1e-9;
  if (angle < angles.front() - k_slack || angle > angles.back() + k_slack) return {-1, 0};
  if (angles.size() == 1) return {0, 0};
  const auto above = std::upper_bound(angles.begin(), angles.end(), angle);
  const auto i = std::clamp<std::ptrdiff_t>(above - angles.begin() - 1, 0, std::ptrdiff_t(angles.size()) - 2);
  return {i, std::clamp((angle - angles[size_t(i)]) / (angles[size_t(i) + 1] - angles[size_t(i)]), 0.0, 1.0)};
}

struct Web {
  std::vector<double> vertical, horizontal;
  std::vector<double> candela;  ///< by horizontal angle, then vertical

  double at(size_t h, Between v) const {
    const double* row = candela.data() + h * vertical.size() + v.first;
    return vertical.size() == 1 ? row[0] : std::lerp(row[0], row[1], v.share);
  }
  double at(Between h, Between v) const {
    if (h.first < 0 || v.first < 0) return 0;
    const auto first = size_t(h.first);
    return horizontal.size() == 1 ? at(first, v) : std::lerp(at(first, v), at(first + 1, v), h.share);
  }

  /// Type C, angles in degrees.
  double type_c(double polar, double around) const {
    const Between v = between(vertical, polar);
    if (v.first < 0) return 0;
    const double first = horizontal.front(), last = horizontal.back();
    if (horizontal.size() == 1) return at(0, v);
    double h = around;
    if (last <= 90) {  // a quarter
      h = std::fmod(h, 180);
      if (h > 90) h = 180 - h;
    } else if (first >= 90 && last <= 270) {  // a half about the plane of 90 and 270 degrees
      if (h < 90) h = 180 - h;
      if (h > 270) h = 540 - h;
    } else if (last <= 180) {  // a half about the plane of 0 and 180 degrees
      if (h > 180) h = 360 - h;
    } else if (h > last || h < first) {  // from the last plane to the first
      const double gap = first + 360 - last;
      const double way = h > last ? h - last : h + 360 - last;
      return gap > 1e-9 ? std::lerp(at(horizontal.size() - 1, v), at(0, v), way / gap) : at(0, v);
    }
    return at(between(horizontal, h), v);
  }
  /// Types A and B, of which a half may be left out.
  double type_ab(bool is_a, double polar, double around) const {
    const double s = std::sin(polar * k_degree), z = -std::cos(polar * k_degree);
    const double x = s * std::cos(around * k_degree), y = s * std::sin(around * k_degree);
    double h = 0, v = 0;
    if (is_a)
      h = std::atan2(x, -z), v = std::asin(std::clamp(y, -1.0, 1.0));
    else
      v = std::atan2(y, -z), h = std::asin(std::clamp(x, -1.0, 1.0));
    h /= k_degree, v /= k_degree;
    if (horizontal.front() >= 0) h = std::abs(h);
    if (vertical.front() >= 0) v = std::abs(v);
    return at(between(horizontal, h), between(vertical, v));
  }
};

}  // namespace

LightProfile parse_ies(std::string_view text, const std::string& where) {
  Reader in(text, where);
  // The year says whether there is a factor of ballast and lamp.
  bool before_1995 = true;
  std::string_view tilt;
  for (bool first = true; tilt.empty(); first = false) {
    if (in.at_end()) throw_error(in.place(), "there is no line TILT=: no LM-63 file, or it is cut short");
    const std::string_view line = trimmed(in.line());
    if (const size_t at = line.find("LM-63-"); first && at != std::string_view::npos) {
      const std::string_view year = line.substr(at + 6);
      before_1995 = year.starts_with("19") ? year < "1995" : year.starts_with("8") || year.starts_with("91");
    }
    if (line.starts_with("TILT=")) tilt = line;
  }
  if (tilt.substr(5) == "INCLUDE") {
    in.number("the geometry of the tilt");
    const size_t pairs = in.count("angles of the tilt", 0, k_most_angles);
    for (size_t i = 0; i < 2 * pairs; ++i) in.number("an angle or factor of the tilt");
  }
  in.number("the number of lamps");
  in.number("the lumens of a lamp");
  const double multiplier = in.number("the multiplier of candela");
  const size_t verticals = in.count("vertical angles", 1, k_most_angles),
               horizontals = in.count("horizontal angles", 1, k_most_angles);
  const size_t type = in.count("as type of photometry", 1, 3);
  in.count("as unit of length", 1, 2);
  for (const char* size : {"the width", "the length", "the height"}) in.number(size);
  const double ballast = in.number("the factor of the ballast"),
               second = in.number("the factor of ballast and lamp");
  in.number("the watts");
  const double factor = multiplier * ballast * (before_1995 ? second : 1);
  if (!(factor > 0))
    throw_error(in.place(), "the candela's factors have the product {}, expected above 0", factor);
  Web web;
  web.vertical = read_angles(in, verticals, "vertical angle");
  web.horizontal = read_angles(in, horizontals, "horizontal angle");
  web.candela.reserve(verticals * horizontals);
  for (size_t i = 0; i < verticals * horizontals; ++i) {
    const double candela = in.number("a value of candela");
    if (candela < 0) throw_error(in.place(), "{} candela are negative", candela);
    web.candela.push_back(factor * candela);
  }
  LightProfile profile =
      type == 1
          ? sampled_profile([&](double polar, double around) { return web.type_c(polar, around); },
                            horizontals == 1)
          : sampled_profile(
                [&](double polar, double around) { return web.type_ab(type == 3, polar, around); }, false);
  if (!(profile.peak > 0 && std::isfinite(profile.peak)))
    throw_error(where, "all candela are 0, or too large");
  profile.text = std::string(text);
  return profile;
}

std::string ies_of_eulumdat(std::string_view text, const std::string& where) {
  Reader in(text, where);
  const auto line = [&](const char* what) {
    if (in.at_end()) throw_error(in.place(), "the file ends before {}", what);
    return trimmed(in.line());
  };
  const auto number = [&](const char* what) { return in.parse(line(what), what); };
  const auto skip = [&](int lines, const char* what) {
    for (int i = 0; i < lines; ++i) line(what);
  };
  skip(1, "its company");
  number("the type");
  const size_t symmetry = in.checked(number("the symmetry"), "as symmetry", 0, 4);
  const size_t planes = in.checked(number("the number of C planes"), "C planes", 1, k_most_angles);
  number("the distance of C planes");
  const size_t verticals = in.checked(number("the number of intensities"), "intensities", 2, k_most_angles);
  number("the distance of intensities");
  skip(5, "its names");
  skip(9, "its sizes");
  number("the share of light downwards");
  number("the light output ratio");
  const double conversion = number("the factor of intensities");
  number("the tilt");
  const size_t sets = in.checked(number("the number of lamp sets"), "lamp sets", 1, 20);
  double lumens = 0;
  for (size_t i = 0; i < sets; ++i) {
    number("the number of lamps");
    skip(1, "the type of lamps");
    lumens += number("the lumens of a lamp set");
    skip(3, "a lamp set");
  }
  skip(10, "the direct ratios");
  if (!(lumens > 0)) throw_error(in.place(), "the lamps have {} lumens, expected above 0", lumens);
  const double factor = (conversion > 0 ? conversion : 1) * lumens / 1000;
  std::vector<double> c, g;
  for (size_t i = 0; i < planes; ++i) c.push_back(number("the angle of a C plane"));
  for (size_t i = 0; i < verticals; ++i) g.push_back(number("an angle of intensities"));
  // Planes that are in the file: all, one, 0 to 180, 90 to 270, 0 to 90.
  const auto quarter = planes / 4 + 1, half = planes / 2 + 1;
  size_t first = 0, kept = planes;
  if (symmetry == 1) kept = 1;
  if (symmetry == 2) kept = half;
  if (symmetry == 3) first = 3 * planes / 4, kept = half;
  if (symmetry == 4) kept = quarter;
  // Values come in the order of planes 270, ..., 90 of symmetry 3.
  std::vector<double> angles, values;
  for (size_t i = 0; i < kept; ++i) {
    const size_t plane = symmetry == 3 ? (first + i) % planes : std::min(i, planes - 1);
    angles.push_back(kept == 1 ? 0 : c[plane]);
    for (size_t k = 0; k < verticals; ++k) {
      const double value = number("an intensity");
      if (value < 0) throw_error(in.place(), "{} candela are negative", value);
      values.push_back(factor * value);
    }
  }
  if (symmetry == 3) {
    // To 90 ... 270: mirrored, plane 270 + x is as 270 - x.
    for (double& angle : angles) angle = angle >= 270 ? 540 - angle : 180 - angle;
    std::vector<double> turned_angles(angles.rbegin(), angles.rend()), turned;
    for (size_t i = kept; i-- > 0;)
      turned.insert(turned.end(), values.begin() + std::ptrdiff_t(i * verticals),
                    values.begin() + std::ptrdiff_t((i + 1) * verticals));
    angles = std::move(turned_angles), values = std::move(turned);
  }
  std::string out = "IES:LM-63-2019\n[OTHER] From EULUMDAT\nTILT=NONE\n";
  out += fmt::format("1 {} 1 {} {} 1 2 0 0 0\n1 1 0\n", lumens, verticals, kept);
  const auto write = [&](const std::vector<double>& list) {
    for (size_t i = 0; i < list.size(); ++i)
      out += fmt::format("{}{}", list[i], i % 10 == 9 || i + 1 == list.size() ? "\n" : " ");
  };
  write(g), write(angles), write(values);
  return out;
}

std::shared_ptr<const LightProfile> light_profile_of(std::string_view bytes, const std::string& name,
                                                     const std::string& where) {
  std::string ending = name.size() > 4 ? name.substr(name.size() - 4) : "";
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  auto profile = std::make_shared<LightProfile>(
      ending == ".ldt" ? parse_ies(ies_of_eulumdat(bytes, where), where) : parse_ies(bytes, where));
  profile->name = name;
  return profile;
}

std::shared_ptr<const LightProfile> load_light_profile(const std::filesystem::path& file) {
  const std::string where = file.string();
  std::error_code error;
  const uintmax_t size = std::filesystem::file_size(file, error);
  if (error) throw_error(where, "cannot be read: {}", error.message());
  if (size > k_most_bytes) throw_error(where, "{} bytes are more than the limit of {}", size, k_most_bytes);
  return light_profile_of(lucerna::read_file(file), file.filename().string(), where);
}

}  // namespace lucerna::scene
