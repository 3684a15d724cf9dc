// The panel of the irradiance cache, on the right in the scene's place: what it holds, how it was built and
// what that took, what of it lies over the picture, its options. And the titles by which the right panel is
// told what to show.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "chart.h"
#include "shaders/shared/ramp.h"
#include "state.h"
#include "widgets.h"

namespace lucerna::ui {
namespace {

using irradiance_cache::CachePass;
using irradiance_cache::CacheStatus;
using irradiance_cache::StopReason;
using session::CacheReport;

constexpr float k_tabs_height = 32;

ImU32 ink(const vec3& encoded) {
  return IM_COL32(static_cast<int>(255 * encoded.x + 0.5f), static_cast<int>(255 * encoded.y + 0.5f),
                  static_cast<int>(255 * encoded.z + 0.5f), 255);
}

/// Counts that may be large, in no more than five figures.
std::string amount(double n) {
  if (n < 1e5) return count_text(n);
  if (n < 1e8) return fmt::format("{:.2f} M", 1e-6 * n);
  return fmt::format("{:.2f} G", 1e-9 * n);
}

std::string share(double part, double of) {
  if (of <= 0) return "\xE2\x80\x93";
  const double percent = 100 * part / of;
  return fmt::format("{:.{}f} %", percent, percent > 99.94 ? 0 : percent > 9.994 ? 1 : 2);
}

/// Text over as many lines as it takes.
void paragraph(const std::string& text, ImU32 colour = colour::text_dim) {
  ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + ImGui::CalcItemWidth());
  label(text, colour);
  ImGui::PopTextWrapPos();
}

/// Steps of building in greys, as stages are; what the host does is bluish.
ImU32 step_colour(size_t step) {
  static constexpr int steps[] = {178, 140, 160, 118, 152, 98};
  const int v = steps[step % 6];
  return step == size_t(irradiance_cache::BuildStep::choose) ? IM_COL32(v * 2 / 3, v * 5 / 6, v, 255)
                                                             : colour::grey(v);
}

const char* step_help(size_t step) {
  static constexpr const char* texts[] = {
      "Paths from the camera, to find where records are missing.",
      "Which of the places asked for get a record. On the host.",
      "A few rays from each of these, to see how wide its record would be and whether it is needed.",
      "Rays over the records' hemispheres, and their sums.",
      "How far each new record serves.",
      "The octree by which records are found.",
  };
  return texts[step % 6];
}

double building_ms(const CacheStatus& s) {
  double sum = 0;
  for (const CachePass& p : s.passes) sum += p.total_ms();
  return sum;
}

void numbers(const Ui& ui, const CacheReport& r) {
  const CacheStatus& s = r.status;
  const bool building = s.stop == StopReason::building;
  value_row("Records", fmt::format("{} of {}", count_text(s.records), count_text(r.room)),
            "Complete records, and how many there is room for (cache.max_records).");
  value_row("Passes", fmt::format("{} of {}", s.pass, ui.setting("cache.passes")),
            "Passes that have placed records, since the building began or the camera has moved, and how many "
            "there may be.");
  uint64_t rays = 0;  // of the records that are complete
  for (const CachePass& p : s.passes) rays += p.complete ? p.rays : 0;
  value_row("Rays of records",
            s.records > 0 ? fmt::format("{}, {} each", amount(double(s.rays)),
                                        count_text(std::round(double(rays) / s.records)))
                          : amount(double(s.rays)),
            "Rays over the records' hemispheres, without those of the paths that they begin; on average.");
  value_row(
      "Memory", megabytes_text(double(s.bytes) / (1 << 20)),
      fmt::format("Device memory, taken for as many records as there is room for: {} bytes each with its "
                  "sphere, and the octree, in whose leaves a record is listed {:.1f} times on average.",
                  shared::k_record_bytes, s.references));
  if (r.overlap && r.overlap->pixels > 0) {
    const irradiance_cache::Overlap& o = *r.overlap;
    value_row(
        "Overlap", fmt::format("{:.1f} on average, {} at most", o.mean, o.most),
        "Records that serve a point, over the pixels that one serves at least, as the camera sees them.");
    value_row(
        "Gathered by paths", share(double(o.gathered), double(o.pixels)),
        "Pixels so near to something else that light is not interpolated there: paths gather it, and end "
        "in records one vertex later (cache.gather).");
    value_row("Not served", share(double(o.pixels - o.served - o.gathered), double(o.pixels)),
              "Pixels showing something diffuse that no record serves: it is path traced there.");
  } else {
    value_row("Overlap", "\xE2\x80\x93", "Known when the picture has its first samples.", colour::text_faint);
    value_row("Gathered by paths", "\xE2\x80\x93", "Known when the picture has its first samples.",
              colour::text_faint);
    value_row("Not served", "\xE2\x80\x93", "Known when the picture has its first samples.",
              colour::text_faint);
  }
  if (!s.passes.empty()) {
    const CachePass& last = s.passes.back();
    value_row("Asked in the last pass", share(double(last.asked), double(last.paths)),
              fmt::format("{} of {} paths found no record and asked for one, {} of them behind the first "
                          "surface. Building stops when no more ask than {:.2f} %.",
                          count_text(double(last.asked)), count_text(double(last.paths)),
                          count_text(double(last.asked_world)), 100 * ui.setting_real("cache.stop")));
  }
  gap(4);
  if (s.waits)
    paragraph("Building waits: X goes on to the next stage, J to the end.", colour::accent);
  else if (building)
    paragraph("Still building\xE2\x80\xA6", colour::accent);
  else
    paragraph(fmt::format("Building has stopped: {}.", irradiance_cache::words(s.stop)),
              s.stop == StopReason::covered ? colour::text_dim : colour::warning);
}

/// How many pixels 0, 1, 2 ... records serve, in the colours of the overlay.
void overlap_bars(const CacheReport& r) {
  if (!r.overlap || r.overlap->pixels == 0) return;
  const std::vector<uint32_t>& bins = r.overlap->histogram;
  size_t used = 1;
  for (size_t i = 0; i < bins.size(); ++i)
    if (bins[i] > 0) used = std::max(used, i + 1);
  const auto shown = static_cast<float>(std::clamp<size_t>(used, 13, bins.size()));
  const uint32_t most = std::max(1u, *std::max_element(bins.begin(), bins.end()));
  gap(8);
  const float width = ImGui::CalcItemWidth(), height = px(36), pitch = width / shown;
  const ImVec2 lo = ImGui::GetCursorScreenPos(), hi(lo.x + width, lo.y + height);
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddLine({lo.x, hi.y}, hi, colour::hairline);
  ImFont* font = theme().fonts.small;
  for (size_t i = 0; i < static_cast<size_t>(shown); ++i) {
    const float x = std::floor(lo.x + pitch * static_cast<float>(i)), part = float(bins[i]) / float(most);
    const float top = bins[i] > 0 ? std::min(hi.y - 1, hi.y - height * part) : hi.y;
    const vec3 c = i == 0 ? shared::k_unserved_ink
                          : shared::ramp_color(shared::k_ramp_viridis, float(i) / shared::k_overlap_scale);
    list->AddRectFilled({x, top}, {std::floor(x + pitch) - 1, hi.y}, ink(c));
    if (i == 0 && bins[0] > 0) {
      const float gathered = (hi.y - top) * float(r.overlap->gathered) / float(bins[0]);
      list->AddRectFilled({x, hi.y - gathered}, {std::floor(x + pitch) - 1, hi.y},
                          ink(shared::k_gathered_ink));
    }
    const std::string n = i + 1 == bins.size() ? fmt::format("\xE2\x89\xA5{}", i) : fmt::format("{}", i);
    if (i % 4 == 0)
      draw_text(list, {x - pitch, hi.y + px(1)}, {x + 2 * pitch, hi.y + px(15)}, n, colour::text_faint,
                Align::centre, font);
    ImGui::SetCursorScreenPos({x, lo.y});
    ImGui::PushID(static_cast<int>(i));
    ImGui::InvisibleButton("##bin", {std::max(1.0f, pitch), height});
    const double pixels = double(r.overlap->pixels);
    std::string told = fmt::format("{} of the pixels: served by {} record{}.", share(bins[i], pixels),
                                   i == 0 ? "no" : n, i == 1 ? "" : "s");
    if (i == 0)
      told += fmt::format(" In {} paths gather the light.", share(double(r.overlap->gathered), pixels));
    tooltip(told);
    ImGui::PopID();
  }
  ImGui::SetCursorScreenPos({lo.x, hi.y + px(18)});
}

/// What each step of building took, as one bar and a row each.
void times(const CacheStatus& s) {
  const double total = building_ms(s);
  std::array<double, irradiance_cache::k_build_steps.size()> ms{};
  for (const CachePass& p : s.passes)
    for (size_t i = 0; i < ms.size(); ++i) ms[i] += p.ms[i];
  value_row("Building took", ms_text(total),
            "Device time of all passes, and wall time of what the host did (its tracer too).");
  std::vector<Part> parts;
  for (size_t i = 0; total > 0 && i < ms.size(); ++i)
    parts.push_back({static_cast<float>(ms[i] / total), step_colour(i)});
  stacked_bar(parts, 8, ImGui::CalcItemWidth());
  gap(6);
  const float width = ImGui::CalcItemWidth(), row = px(18);
  ImDrawList* list = ImGui::GetWindowDrawList();
  ImFont* font = theme().fonts.small;
  for (size_t i = 0; i < ms.size(); ++i) {
    const ImVec2 lo = ImGui::GetCursorScreenPos(), hi(lo.x + width, lo.y + row);
    const float middle = std::floor(0.5f * (lo.y + hi.y));
    ImGui::PushID(static_cast<int>(i));
    ImGui::InvisibleButton("##step", {width, row});
    tooltip(step_help(i));
    ImGui::PopID();
    list->AddRectFilled({lo.x, middle - px(4)}, {lo.x + px(8), middle + px(4)}, step_colour(i), px(2));
    draw_text(list, {lo.x + px(14), lo.y}, hi, irradiance_cache::k_build_steps[i], colour::text_dim,
              Align::left, font);
    draw_text(list, lo, {hi.x - px(56), hi.y}, ms_text(ms[i]), colour::text, Align::right, font);
    draw_text(list, lo, hi, fmt::format("{:.1f} %", total > 0 ? 100 * ms[i] / total : 0), colour::text_dim,
              Align::right, font);
    ImGui::SetCursorScreenPos({lo.x, hi.y});
  }
}

/// A row a pass: what it placed and what that took.
void passes(const CacheStatus& s) {
  const float width = ImGui::CalcItemWidth(), row = px(18);
  ImDrawList* list = ImGui::GetWindowDrawList();
  ImFont* font = theme().fonts.small;
  // Where there is little room the rays are left to the tooltip.
  const bool narrow = width < px(236);
  const float first = px(30), each = std::floor((width - first) / (narrow ? 3 : 4));
  const auto cells = [&](const ImVec2& lo, const std::array<std::string, 5>& texts, ImU32 colour) {
    draw_text(list, {lo.x + px(14), lo.y}, {lo.x + first, lo.y + row}, texts[0], colour, Align::left, font);
    float right = lo.x + first;
    for (size_t i = 1; i < texts.size(); ++i) {
      if (narrow && i == 3) continue;
      right += each;
      draw_text(list, {right - each, lo.y}, {right, lo.y + row}, texts[i], colour, Align::right, font);
    }
  };
  const ImVec2 head = ImGui::GetCursorScreenPos();
  cells(head, {"", "records", "asked", "rays", "time"}, colour::text_faint);
  ImGui::SetCursorScreenPos({head.x, head.y + row});
  uint32_t most = 1;
  for (const CachePass& p : s.passes) most = std::max(most, p.records);
  // The newest sixteen: a camera that moves much adds many.
  const size_t from = s.passes.size() > 16 ? s.passes.size() - 16 : 0;
  for (size_t i = from; i < s.passes.size(); ++i) {
    const CachePass& p = s.passes[i];
    const ImVec2 lo = ImGui::GetCursorScreenPos(), hi(lo.x + width, lo.y + row);
    const float middle = std::floor(0.5f * (lo.y + hi.y));
    ImGui::PushID(static_cast<int>(i));
    ImGui::InvisibleButton("##pass", {width, row});
    std::string text = fmt::format(
        "Pass {}: {} of {} paths asked for a record, {} of them behind the first surface; {} were placed, "
        "with "
        "{} rays.",
        i + 1, count_text(double(p.asked)), count_text(double(p.paths)), count_text(double(p.asked_world)),
        count_text(p.records), count_text(double(p.rays)));
    for (size_t k = 0; k < p.ms.size(); ++k)
      text += fmt::format("\n{}: {}", irradiance_cache::k_build_steps[k], ms_text(p.ms[k]));
    tooltip(text);
    ImGui::PopID();
    const float bar = (width - first) * float(p.records) / float(most);
    list->AddRectFilled({lo.x + first, lo.y + px(2)}, {lo.x + first + bar, hi.y - px(2)}, colour::field,
                        px(2));
    if (p.records > 0)
      list->AddRectFilled({lo.x, middle - px(4)}, {lo.x + px(8), middle + px(4)},
                          ink(shared::ramp_hue(p.number)), px(2));
    cells(lo,
          {fmt::format("{}", i + 1), p.records > 0 ? count_text(p.records) : "\xE2\x80\x93",
           share(double(p.asked), double(p.paths)), p.rays > 0 ? amount(double(p.rays)) : "\xE2\x80\x93",
           ms_text(p.total_ms())},
          p.complete ? colour::text : colour::accent);
    ImGui::SetCursorScreenPos({lo.x, hi.y});
  }
}

/// The stages of a pass in a row: what is done, and what has ended last.
void stage_strip(const CacheReport& r) {
  const CacheStatus& s = r.status;
  constexpr int n = static_cast<int>(irradiance_cache::k_build_stages.size());
  static constexpr const char* texts[] = {
      "Paths from the camera ask where they find no record: candidates.",
      "Candidates in Morton order are cut into clusters; of each, points are tried until all are covered.",
      "A few rays from what is tried: how wide would its records be?",
      "What a wider one makes superfluous is rejected, the rest chosen.",
      "Rays over the hemispheres of the records, a level of four times as many after the other.",
      "Records have got their radii, and an octree in which they are found.",
  };
  const int last = s.last ? static_cast<int>(s.last->stage) : -1;
  const float width = ImGui::CalcItemWidth(), height = px(20);
  // What the names leave over is shared out.
  ImFont* font = theme().fonts.small;
  float left = width - px(2) * static_cast<float>(n - 1);
  for (const char* name : irradiance_cache::k_build_stages) left -= text_width(name, font);
  const ImVec2 lo = ImGui::GetCursorScreenPos();
  float x = lo.x;
  ImDrawList* list = ImGui::GetWindowDrawList();
  for (int i = 0; i < n; ++i) {
    const char* name = irradiance_cache::k_build_stages[static_cast<size_t>(i)];
    const float end = x + text_width(name, font) + left / static_cast<float>(n);
    const ImVec2 a(std::floor(x), lo.y), b(std::floor(end), lo.y + height);
    x = end + px(2);
    ImGui::SetCursorScreenPos(a);
    ImGui::PushID(i);
    ImGui::InvisibleButton("##stage", {b.x - a.x, height});
    tooltip(texts[i]);
    ImGui::PopID();
    const bool now = i == last;
    list->AddRectFilled(a, b, now ? colour::accent_dim : i < last ? colour::fill : colour::field, px(2));
    if (now) list->AddRectFilled({a.x, b.y - px(2)}, b, colour::accent, px(1));
    // Where there is no room for all, only the one that matters is named.
    if (left < 0 && !now) continue;
    draw_text(list, a, b, name,
              now        ? colour::text
              : i < last ? colour::text_dim
                         : colour::text_faint,
              Align::centre, theme().fonts.small);
  }
  ImGui::SetCursorScreenPos({lo.x, lo.y + height + px(6)});
}

/// Leads building from stage to stage.
void steps(Ui& ui, const CacheReport& r) {
  const CacheStatus& s = r.status;
  const float width = ImGui::CalcItemWidth();
  const OptionInfo& pause = *plan::find_option("cache.pause");
  static constexpr const char* names[2][3] = {{"No pause", "Each pass", "Each stage"},
                                              {"Off", "Pass", "Stage"}};
  const bool narrow = width < px(236);
  const float third = std::floor((width - px(8)) / 3);
  for (size_t i = 0; i < pause.choices.size(); ++i) {
    if (i > 0) ImGui::SameLine(0, px(4));
    if (button(("##pause" + pause.choices[i]).c_str(), names[narrow][i],
               ui.setting(pause.key) == pause.choices[i], third))
      ui.act("set", pause.key, pause.choices[i]);
    tooltip(pause.help + " R builds anew.");
  }
  gap(4);
  const bool building = s.stop == StopReason::building;
  const float half = std::floor((width - px(4)) / 2);
  ImGui::BeginDisabled(!building);
  if (button("##step", "Next stage", false, half)) ui.act("cache.step");
  tooltip(building ? "Goes on to the end of the next stage and waits there. X."
                   : "The cache is complete. R builds it anew, a turn of the camera adds what is missing.");
  ImGui::SameLine(0, px(4));
  if (button("##run", "Go on", false, half)) ui.act("cache.run");
  tooltip(building ? "Goes on without a pause until the cache is complete. J." : "The cache is complete.");
  ImGui::EndDisabled();
  gap(8);
  stage_strip(r);
  const std::string none = "\xE2\x80\x93";
  if (s.last) {
    const irradiance_cache::StageDone& last = *s.last;
    value_row(s.waits ? "Waits after" : "Ended last", irradiance_cache::stage_words(last),
              "The stage of building that has ended last.", s.waits ? colour::accent : colour::text);
    value_row("It took",
              last.rays > 0 ? fmt::format("{}, {} rays", ms_text(last.ms), amount(double(last.rays)))
                            : ms_text(last.ms),
              "Device time, and wall time of what the host did; rays from records.");
  } else {
    value_row("Ended last", none, "No stage of building has ended yet.", colour::text_faint);
    value_row("It took", none, "", colour::text_faint);
  }
  const CachePass* pass = s.passes.empty() ? nullptr : &s.passes.back();
  const auto count = [&](const char* name, double n, bool known, const char* help) {
    value_row(name, known ? count_text(n) : none, help, known ? colour::text : colour::text_faint);
  };
  const bool chosen = pass && pass->clusters > 0;
  count("Candidates", pass ? double(pass->asked) : 0, pass != nullptr,
        "Places where paths of this pass found no record.");
  count("Clusters", pass ? pass->clusters : 0, chosen, "That they were cut into.");
  count("Tried", pass ? pass->tried : 0, chosen, "Of the candidates.");
  count("Chosen", pass ? pass->records : 0, pass && pass->records > 0, "Of what was tried: new records.");
}

void overlays(Ui& ui) {
  const float width = ImGui::CalcItemWidth(), each = std::floor((width - px(8)) / 3);
  const auto toggle = [&](const char* name, const char* key, const std::string& option) {
    if (button(("##" + option).c_str(), name, ui.setting_on(option), each)) ui.toggle(option);
    tooltip(plan::find_option(option)->help + " " + key + ".");
  };
  toggle("Records", "C", "overlay.records");
  ImGui::SameLine(0, px(4));
  toggle("Overlap", "V", "overlay.overlap");
  ImGui::SameLine(0, px(4));
  toggle("Normals", "N", "overlay.normals");
  gap(4);
  option_control(ui, "overlay.records_by", "Coloured by");
  option_control(ui, "overlay.placement", "Placement");
  option_control(ui, "overlay.discontinuity", "Detail of");
  if (ui.setting("overlay.discontinuity") != "off")
    option_control(ui, "overlay.discontinuity_level", "Level");
  if (!ui.shows_cache()) return;
  gap(4);
  paragraph("Rest the pointer in the picture to see which records serve there.", colour::text_faint);
}

std::string option_name(const std::string& key) {
  static const std::map<std::string, std::string> names{{"cache.metric", "Metric"},
                                                        {"cache.error", "Error bound"},
                                                        {"cache.min_radius", "Radius \xE2\x89\xA5"},
                                                        {"cache.max_radius", "Radius \xE2\x89\xA4"},
                                                        {"cache.rays", "First rays"},
                                                        {"cache.max_rays", "Most rays"},
                                                        {"cache.noise", "More rays above"},
                                                        {"cache.max_records", "Room"},
                                                        {"cache.passes", "Most passes"},
                                                        {"cache.stop", "Stop at"},
                                                        {"cache.candidates", "Candidates"},
                                                        {"cache.candidates_falloff", "Falling off"},
                                                        {"cache.depth_weight", "Steps weigh"},
                                                        {"cache.normal_weight", "Turns weigh"},
                                                        {"cache.irradiance_weight", "Light weighs"}};
  if (const auto found = names.find(key); found != names.end()) return found->second;
  std::string name = key.substr(key.find('.') + 1);
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '.' || c == '_'; }, ' ');
  if (!name.empty()) name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  return name;
}

void options(Ui& ui) {
  for (const OptionInfo& option : plan::options())
    if (option.key.rfind("cache.", 0) == 0 && option.key != "cache.pause" && option.type != OptionType::text)
      option_control(ui, option.key, option_name(option.key));
}

void empty_state(Ui& ui) {
  paragraph("No component takes its light from the irradiance cache.");
  gap(8);
  if (button("##use", "Use it for secondary and tertiary light", false, ImGui::CalcItemWidth())) {
    ui.act("set", "components.secondary", "cache");
    ui.act("set", "components.tertiary", "cache");
  }
  tooltip(
      "Sets components.secondary and components.tertiary to cache; the panel of light chooses each alone.");
}

}  // namespace

Area draw_side_tabs(Ui& ui, const Area& area) {
  if (!ui.layout.right_open) {
    begin_panel("##side_folded", area, colour::panel, false);
    if (folded_strip(ui.cache_panel ? "Cache" : "Scene", area.lo, area.hi, false))
      ui.act("window.fold", "right", false);
    ImGui::End();
    return area;
  }
  const Area strip{area.lo, {area.hi.x, area.lo.y + px(k_tabs_height)}};
  begin_panel("##side_tabs", strip, colour::panel, false);
  ImDrawList* list = ImGui::GetWindowDrawList();
  const float half = std::floor(0.5f * strip.width());
  for (const bool cache : {false, true}) {
    const ImVec2 lo(strip.lo.x + (cache ? half : 0), strip.lo.y),
        hi(cache ? strip.hi.x : strip.lo.x + half, strip.hi.y);
    const bool on = ui.cache_panel == cache;
    ImGui::SetCursorScreenPos(lo);
    if (ImGui::InvisibleButton(cache ? "##cache" : "##scene", {hi.x - lo.x, hi.y - lo.y}))
      ui.act("window.side", cache ? "cache" : "scene");
    const bool hovered = ImGui::IsItemHovered();
    tooltip(cache ? "The irradiance cache: its building, its records, its options. K."
                  : "Cameras, lights, environment, materials.");
    if (!on) list->AddRectFilled(lo, hi, colour::surround);
    draw_text(list, lo, hi, cache ? "CACHE" : "SCENE",
              on        ? colour::text
              : hovered ? colour::text_dim
                        : colour::text_faint,
              Align::centre, theme().fonts.caps);
    if (on)
      list->AddRectFilled({lo.x, lo.y}, {hi.x, lo.y + px(2)}, colour::accent);
    else
      list->AddRectFilled({lo.x, hi.y - 1}, hi, colour::hairline);
  }
  ImGui::End();
  return {{area.lo.x, strip.hi.y}, area.hi};
}

void draw_cache_panel(Ui& ui, const Area& area) {
  if (!ui.layout.right_open) return;
  begin_panel("##cache_panel", area, colour::panel, true);
  const auto block = [&](const char* title, const std::string& note, auto&& draw) {
    if (panel_section(ui, title, true, note)) {
      begin_padded();
      draw();
      end_padded();
      gap(10);
    }
  };
  const CacheReport* r = ui.snapshot && ui.scene ? ui.snapshot->cache.get() : nullptr;
  if (!ui.cached()) {
    block("Cache", "", [&] { empty_state(ui); });
  } else if (!r) {
    block("Cache", "", [&] {
      paragraph(ui.scene ? "Nothing has been asked of it yet." : "No scene is open.", colour::text_faint);
    });
  } else {
    const char* state = r->status.waits                          ? "waits"
                        : r->status.stop == StopReason::building ? "building"
                                                                 : "complete";
    block("Cache", state, [&] {
      numbers(ui, *r);
      overlap_bars(*r);
    });
    block("Steps of building", "", [&] { steps(ui, *r); });
    block("Overlays", "", [&] { overlays(ui); });
    if (!r->status.passes.empty())
      block("Passes of building", "", [&] {
        passes(r->status);
        gap(8);
        times(r->status);
      });
  }
  block("Options", "", [&] { options(ui); });
  hairline();
  ImGui::End();
}

}  // namespace lucerna::ui
