#include "theme.h"

#include <imgui_freetype.h>

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "assets.h"

namespace fs = std::filesystem;

namespace lucerna::ui {
namespace colour {

ImU32 with_alpha(ImU32 c, float alpha) {
  const auto a = static_cast<ImU32>(std::clamp(alpha, 0.0f, 1.0f) * 255 + 0.5f);
  return (c & ~IM_COL32_A_MASK) | (a << IM_COL32_A_SHIFT);
}

ImU32 mix(ImU32 a, ImU32 b, float t) {
  const ImVec4 x = ImGui::ColorConvertU32ToFloat4(a), y = ImGui::ColorConvertU32ToFloat4(b);
  return ImGui::ColorConvertFloat4ToU32(
      {x.x + t * (y.x - x.x), x.y + t * (y.y - x.y), x.z + t * (y.z - x.z), x.w + t * (y.w - x.w)});
}

}  // namespace colour

namespace {

/// Inter's line height over its em; ImGui sizes fonts by line height, designers by em.
constexpr float k_line_over_em = 1.21f;

std::vector<fs::path> font_folders() {
  std::vector<fs::path> folders;
  for (const fs::path& assets : asset_folders()) folders.push_back(assets / "fonts");
  folders.push_back("/usr/share/fonts/opentype/inter");
  return folders;
}

fs::path find_font(const char* weight) {
  std::error_code error;
  for (const fs::path& folder : font_folders())
    for (const char* ending : {".ttf", ".otf"}) {
      const fs::path file = folder / fmt::format("Inter-{}{}", weight, ending);
      if (fs::is_regular_file(file, error)) return file;
    }
  return {};
}

/// Latin with accents (names of lights and files), units, arrows and punctuation that the window uses.
const ImWchar* glyph_ranges() {
  static const ImWchar ranges[] = {0x0020, 0x024F, 0x0370, 0x03FF, 0x0400, 0x045F, 0x2007, 0x2027,
                                   0x2030, 0x205F, 0x20AC, 0x20AC, 0x2190, 0x2193, 0x2212, 0x2212,
                                   0x221E, 0x221E, 0x2248, 0x2265, 0x25B8, 0x25BE, 0};
  return ranges;
}

/// Gives all digits, the figure space and the signs one width, so numbers do not jitter.
void make_tabular(ImFont* font) {
  if (!font) return;
  float width = 0;
  for (ImWchar c = '0'; c <= '9'; ++c)
    if (const ImFontGlyph* glyph = font->FindGlyphNoFallback(c)) width = std::max(width, glyph->AdvanceX);
  const auto set = [&](ImWchar c) {
    auto* glyph = const_cast<ImFontGlyph*>(font->FindGlyphNoFallback(c));
    if (!glyph) return;
    const float shift = 0.5f * (width - glyph->AdvanceX);
    glyph->X0 += shift, glyph->X1 += shift;
    glyph->AdvanceX = width;
    font->IndexAdvanceX[c] = width;
  };
  for (ImWchar c = '0'; c <= '9'; ++c) set(c);
  set(0x2212), set(0x2007), set('+');
}

ImFont* add_font(const char* weight, float em, float scale) {
  ImGuiIO& io = ImGui::GetIO();
  const fs::path file = find_font(weight);
  if (file.empty()) {
    ImFontConfig config;
    config.SizePixels = std::round(em * scale);
    return io.Fonts->AddFontDefault(&config);
  }
  ImFontConfig config;
  config.OversampleH = config.OversampleV = 1;
  config.PixelSnapH = true;
  config.FontBuilderFlags = ImGuiFreeTypeBuilderFlags_LightHinting;
  return io.Fonts->AddFontFromFileTTF(file.c_str(), std::round(em * scale * k_line_over_em), &config,
                                      glyph_ranges());
}

void set_style(float scale) {
  ImGuiStyle style;
  style.WindowPadding = {0, 0};
  style.FramePadding = {8, 4};
  style.ItemSpacing = {8, 4};
  style.ItemInnerSpacing = {8, 4};
  style.CellPadding = {4, 2};
  style.IndentSpacing = 12;
  style.ScrollbarSize = 10;
  style.GrabMinSize = 10;
  style.WindowRounding = style.ChildRounding = 0;
  style.FrameRounding = style.PopupRounding = style.GrabRounding = style.ScrollbarRounding =
      style.TabRounding = 3;
  style.WindowBorderSize = style.ChildBorderSize = style.FrameBorderSize = 0;
  style.PopupBorderSize = 1;
  style.WindowMinSize = {16, 16};
  style.SelectableTextAlign = {0, 0.5f};
  style.ScaleAllSizes(scale);
  style.PopupBorderSize = 1;
  style.AntiAliasedLinesUseTex = true;

  const auto set = [&](ImGuiCol index, ImU32 c) { style.Colors[index] = ImGui::ColorConvertU32ToFloat4(c); };
  using namespace colour;
  set(ImGuiCol_Text, text), set(ImGuiCol_TextDisabled, text_faint);
  set(ImGuiCol_WindowBg, panel), set(ImGuiCol_ChildBg, IM_COL32(0, 0, 0, 0)), set(ImGuiCol_PopupBg, bar);
  set(ImGuiCol_Border, grey(64)), set(ImGuiCol_BorderShadow, IM_COL32(0, 0, 0, 0));
  set(ImGuiCol_FrameBg, field), set(ImGuiCol_FrameBgHovered, field_hover),
      set(ImGuiCol_FrameBgActive, field_active);
  set(ImGuiCol_TitleBg, bar), set(ImGuiCol_TitleBgActive, bar), set(ImGuiCol_MenuBarBg, bar);
  set(ImGuiCol_ScrollbarBg, IM_COL32(0, 0, 0, 0)), set(ImGuiCol_ScrollbarGrab, grey(60));
  set(ImGuiCol_ScrollbarGrabHovered, grey(76)), set(ImGuiCol_ScrollbarGrabActive, grey(92));
  set(ImGuiCol_CheckMark, text), set(ImGuiCol_SliderGrab, grey(120)),
      set(ImGuiCol_SliderGrabActive, grey(150));
  set(ImGuiCol_Button, field), set(ImGuiCol_ButtonHovered, field_hover),
      set(ImGuiCol_ButtonActive, field_active);
  set(ImGuiCol_Header, field), set(ImGuiCol_HeaderHovered, field_hover),
      set(ImGuiCol_HeaderActive, field_active);
  set(ImGuiCol_Separator, colour::hairline), set(ImGuiCol_SeparatorHovered, accent),
      set(ImGuiCol_SeparatorActive, accent);
  set(ImGuiCol_TextSelectedBg, accent_dim), set(ImGuiCol_NavHighlight, accent);
  set(ImGuiCol_PlotHistogram, accent), set(ImGuiCol_ModalWindowDimBg, IM_COL32(16, 16, 16, 150));
  ImGui::GetStyle() = style;
}

}  // namespace

Theme& theme() {
  static Theme instance;
  return instance;
}

void apply_theme(float scale) {
  Theme& t = theme();
  t.scale = scale;
  t.font_note = find_font("Regular").empty()
                    ? "the Inter fonts were found neither in assets/fonts nor on the system"
                    : "";
  ImFontAtlas* atlas = ImGui::GetIO().Fonts;
  atlas->Clear();
  atlas->FontBuilderIO = ImGuiFreeType::GetBuilderForFreeType();
  atlas->TexGlyphPadding = 1;
  t.fonts.regular = add_font("Regular", 14, scale);
  t.fonts.strong = add_font("SemiBold", 14, scale);
  t.fonts.small = add_font("Regular", 12, scale);
  t.fonts.caps = add_font("SemiBold", 11, scale);
  t.fonts.large = add_font("Regular", 22, scale);
  atlas->Build();
  for (ImFont* font : {t.fonts.regular, t.fonts.strong, t.fonts.small, t.fonts.caps, t.fonts.large})
    make_tabular(font);
  set_style(scale);
}

}  // namespace lucerna::ui
