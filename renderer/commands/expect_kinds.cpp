// The kinds of expectations that need no window (expectation.h).
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/file.h"
#include "base/future.h"
#include "commands/expectation.h"
#include "commands/script.h"
#include "commands/values.h"
#include "commands/view_transform.h"
#include "commands/workspace.h"
#include "film/io/compare.h"
#include "film/io/picture_match.h"
#include "film/io/stochastic.h"

namespace lucerna::commands {
namespace {

const std::vector<std::string> k_relations{"is", "<", "<=", ">", ">=", "contains"};

/// What a value is compared with.
struct Comparison {
  std::string relation;
  bool negated = false;
  std::string expected;
  double within = 0;

  std::string text() const {
    return fmt::format("{}{} {}{}", relation, negated ? " not" : "", quote(expected),
                       within > 0 ? " within " + number_text(within) : "");
  }
};

Comparison read_comparison(WordReader& words) {
  Comparison c;
  for (const std::string& relation : k_relations)
    if (c.relation.empty() && words.take(relation)) c.relation = relation;
  if (c.relation.empty()) words.refuse(fmt::format("one of {}", fmt::join(k_relations, ", ")));
  const bool ordered = c.relation[0] == '<' || c.relation[0] == '>';
  if (!ordered) c.negated = words.take("not");
  if (ordered)
    c.expected = number_text(words.number("a number", -1e300, 1e300));
  else
    c.expected = words.text("the expected value");
  if (c.relation == "is" && words.take("within")) {
    double number = 0;
    vec3 vector{0};
    if (!read_number(c.expected, number) && !read_vector(c.expected, vector))
      words.refuse("no 'within' behind a text");
    c.within = words.number("a tolerance of at least 0", 0, 1e300);
  }
  words.end("the end of the line");
  return c;
}

/// Numbers that are printed alike are equal.
bool equal(double a, double b, double within) {
  return std::abs(a - b) <= std::max(within, 1e-6 * std::max(std::abs(a), std::abs(b)));
}

bool is_equal(const std::string& a, const std::string& b, double within) {
  double x = 0, y = 0;
  if (read_number(a, x) && read_number(b, y)) return equal(x, y, within);
  vec3 v{0}, w{0};
  if (read_vector(a, v) && read_vector(b, w)) {
    for (int i = 0; i < 3; ++i)
      if (!equal(double{v[i]}, double{w[i]}, within)) return false;
    return true;
  }
  const auto truth = [](const std::string& text) {
    return text == "on" ? std::string("true") : text == "off" ? std::string("false") : text;
  };
  return a == b || truth(a) == truth(b);
}

bool holds(const Comparison& c, const std::string& found) {
  if (c.relation == "is") return is_equal(found, c.expected, c.within) != c.negated;
  if (c.relation == "contains") return (found.find(c.expected) != std::string::npos) != c.negated;
  double x = 0, y = 0;
  if (!read_number(found, x)) throw Error("", fmt::format("'{}' is no number", found));
  read_number(c.expected, y);
  return c.relation == "<" ? x < y : c.relation == "<=" ? x <= y : c.relation == ">" ? x > y : x >= y;
}

void add_value(Workspace& work, Expectations& expectations) {
  expectations.add({.name = "",
                    .usage = "VALUE is|contains [not] X [within T], or VALUE <|<=|>|>= NUMBER",
                    .help = "a setting by its key, or a value of 'help values'",
                    .read = [&work](WordReader& words, const ExpectContext&) -> Check {
                      std::vector<std::string> rest = words.remaining();
                      const size_t before = rest.size();
                      const ValueWords value = work.values.take(rest);
                      words.skip(before - rest.size());
                      const Comparison comparison = read_comparison(words);
                      return [&work, value, comparison]() -> std::optional<Verdict> {
                        std::string name = value.name;
                        for (const std::string& word : value.words) name += " " + quote(word);
                        const std::string found = work.values.read(work, value);
                        const bool passed = holds(comparison, found);
                        return Verdict{passed, fmt::format("{} is {}{}", name, quote(found),
                                                           passed ? "" : ", expected " + comparison.text())};
                      };
                    },
                    .names =
                        [&work](const std::vector<std::string>& before) {
                          const std::vector<std::string> list = work.values.suggestions(before);
                          return list.empty() && !before.empty() ? k_relations : list;
                        }});
}

void add_log(Workspace& work, Expectations& expectations) {
  expectations.add(
      {.name = "log",
       .usage = "log TEXT",
       .help = "an error or a warning since the script began that contains the text; such an error then does "
               "not fail the script",
       .read = [&work](WordReader& words, const ExpectContext&) -> Check {
         const std::string text = words.text("a text");
         words.end("the end of the line");
         // Errors of the last command arrive a moment after it.
         return [&work, text, polls = 0]() mutable -> std::optional<Verdict> {
           constexpr int k_polls = 4;
           for (LoggedProblem& line : work.problems)
             if (line.text.find(text) != std::string::npos) {
               line.expected = true;
               return Verdict{true, line.text};
             }
           if (++polls < k_polls) return std::nullopt;
           std::string found;
           for (const LoggedProblem& line : work.problems) found += (found.empty() ? "" : "; ") + line.text;
           return Verdict{false, fmt::format("no error or warning contains '{}'; found {}", text,
                                             found.empty() ? "none" : found)};
         };
       }});
}

/// The command that makes a written picture the reference.
std::string accept_command(const std::filesystem::path& written, const std::string& reference) {
  return fmt::format("cp {} {}", shell_word(absolute_path(written).string()),
                     shell_word(absolute_path(reference).string()));
}

std::vector<uint8_t> bytes_of(const film::FilmImage& display) {
  const size_t n = size_t{display.width} * display.height;
  std::vector<uint8_t> rgba(4 * n, 255);
  for (size_t k = 0; k < 3; ++k)
    if (const std::vector<float>* plane = display.find(std::string(1, "RGB"[k])))
      for (size_t i = 0; i < n; ++i)
        rgba[4 * i + k] = static_cast<uint8_t>(std::clamp(255 * (*plane)[i] + 0.5f, 0.0f, 255.0f));
  return rgba;
}

std::string write_png(const ExpectContext& context, const std::string& name, uint32_t width, uint32_t height,
                      const std::vector<uint8_t>& rgba) {
  const std::filesystem::path file = context.report.file(name, ".png");
  film::write_png(file, width, height, rgba);
  return file.filename().string();
}

void add_picture(Workspace& work, Expectations& expectations) {
  expectations.add(
      {.name = "picture",
       .usage = "picture FILE.png [within DIFFERENCE] [share SHARE]",
       .help = "the shown picture with its overlays, by the means of cells of 4x4 pixels: at most a SHARE "
               "(0.002) of them differs by more than a DIFFERENCE (0.04 of 1)",
       .read = [&work](WordReader& words, const ExpectContext& context) -> Check {
         const std::string file = words.text("a PNG file");
         double within = film::MatchOptions{}.within, share = film::MatchOptions{}.share;
         while (!words.done())
           if (words.take("within"))
             within = words.number("a difference from 0 to 1", 0, 1);
           else if (words.take("share"))
             share = words.number("a share from 0 to 1", 0, 1);
           else
             words.refuse("within DIFFERENCE or share SHARE");
         return [&work, context, file, within, share]() -> std::optional<Verdict> {
           const session::Snapshot* s = work.open.snapshot.get();
           if (!s || s->rgba.empty()) throw Error("", "there is no picture yet");
           return expect_display(context, file, "picture", s->width * s->scale, s->height * s->scale, s->rgba,
                                 within, share);
         };
       }});
}

/// A layer as the picture is shown: exposure, tone curve or view of OpenColorIO.
std::vector<uint8_t> displayed(const Workspace& work, const film::FilmImage& image,
                               const std::string& layer) {
  const std::vector<size_t> channels = image.layer(layer);
  std::vector<vec3> radiance(size_t{image.width} * image.height, vec3(0));
  for (size_t i = 0; i < radiance.size(); ++i)
    for (int k = 0; k < 3; ++k)
      radiance[i][k] = image.channels[channels[std::min(size_t(k), channels.size() - 1)]].second[i];
  return film::shown_picture(view_transform(work.open), radiance);
}

Verdict judge_image(const Workspace& work, const ExpectContext& context, const std::string& file,
                    const film::StochasticOptions& options, const film::FilmImage& all) {
  const film::FilmImage now = film::stochastic_layers(all, options.layer);
  const std::string path = beside_script(context.folder, file);
  Verdict verdict;
  film::StochasticComparison compared;
  film::FilmImage reference;
  try {
    reference = film::read_exr(path);
    compared = film::compare_stochastic(now, reference, options, path);
    verdict = {!compared.different, film::to_text(compared), {}};
    const auto view = [](const film::FilmImage& image) {
      const auto found = image.metadata.find("view");
      return found == image.metadata.end() ? std::string() : found->second;
    };
    if (compared.different && view(now) != view(reference))
      verdict.message += "; the reference shows another view";
  } catch (const Error& error) {
    verdict.message = error.what();
  }
  if (verdict.passed || !context.keeps) return verdict;
  context.report.next();
  const std::filesystem::path exr = context.report.file("now", ".exr");
  film::write_exr(exr, now);
  DifferentPicture picture{.accept = accept_command(exr, path)};
  picture.now = write_png(context, "now", now.width, now.height, displayed(work, now, options.layer));
  if (compared.width > 0) {
    picture.reference = write_png(context, "reference", reference.width, reference.height,
                                  displayed(work, reference, options.layer));
    picture.difference = write_png(context, "difference", compared.width, compared.height,
                                   film::tile_picture(compared, options.significance));
  }
  verdict.pictures.push_back(picture);
  return verdict;
}

void add_image(Workspace& work, Expectations& expectations) {
  expectations.add(
      {.name = "image",
       .usage = "image FILE.exr [layer LAYER] [significance P] [within RELATIVE]",
       .help =
           "the light before exposure, within the noise of both pictures: tiles of 16x16 pixels are compared "
           "by t-tests, corrected for their number; equal pictures fail with probability P (0.001); means "
           "that differ by less than RELATIVE (0.002) count as equal",
       .read = [&work](WordReader& words, const ExpectContext& context) -> Check {
         const std::string file = words.text("an EXR file");
         film::StochasticOptions options;
         while (!words.done())
           if (words.take("layer"))
             options.layer = words.text("a layer, such as caustic");
           else if (words.take("significance"))
             options.significance = words.number("a probability from 1e-12 to 0.5", 1e-12, 0.5);
           else if (words.take("within"))
             options.tolerance = words.number("a relative difference from 0 to 1", 0, 1);
           else
             words.refuse("layer LAYER, significance P or within RELATIVE");
         return [&work, context, file, options,
                 layers = std::shared_future<film::FilmImage>()]() mutable -> std::optional<Verdict> {
           if (!layers.valid()) layers = work.session.layers(work.open.id());
           if (!is_ready(layers)) return std::nullopt;
           return judge_image(work, context, file, options, layers.get());
         };
       }});
}

}  // namespace

Verdict expect_display(const ExpectContext& context, const std::string& file, const std::string& name,
                       uint32_t width, uint32_t height, const std::vector<uint8_t>& rgba, double within,
                       double share) {
  const std::string path = beside_script(context.folder, file);
  const film::FilmImage now = film::display_picture(width, height, rgba);
  Verdict verdict;
  film::FilmImage reference;
  bool compared = false;
  try {
    reference = film::read_exr(path);
    const film::PictureMatch match =
        film::match_pictures(now, reference, {.within = within, .share = share}, path);
    compared = true;
    verdict = {match.matches, film::to_text(match), {}};
  } catch (const Error& error) {
    verdict.message = error.what();
  }
  if (verdict.passed || !context.keeps) return verdict;
  context.report.next();
  const std::string written = write_png(context, name, width, height, rgba);
  DifferentPicture picture{.now = written, .accept = accept_command(context.report.file(name, ".png"), path)};
  if (!reference.channels.empty() && reference.layer("").size() >= 3)
    picture.reference =
        write_png(context, "reference", reference.width, reference.height, bytes_of(reference));
  if (compared)
    picture.difference =
        write_png(context, "difference", width, height, film::difference_picture(now, reference, "", 4));
  verdict.pictures.push_back(picture);
  return verdict;
}

void add_expectations(Workspace& work, Expectations& expectations) {
  add_value(work, expectations);
  add_log(work, expectations);
  add_picture(work, expectations);
  add_image(work, expectations);
}

}  // namespace lucerna::commands
