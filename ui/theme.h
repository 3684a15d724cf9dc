#pragma once
// Colours, fonts, metrics. Greys are neutral (no hue), so that the picture is judged against them; the only
// colours are one accent and those with a meaning.
#include <imgui.h>

#include <array>
#include <string>

namespace lucerna::ui {

namespace colour {
inline constexpr ImU32 grey(int v, int a = 255) { return IM_COL32(v, v, v, a); }
inline constexpr ImU32 surround = grey(30);  ///< around the picture; linear 0.013
inline constexpr ImU32 panel = grey(34);     ///< linear 0.016
inline constexpr ImU32 bar = grey(38);       ///< menu bar, toolbar, popups; linear 0.020
inline constexpr ImU32 field = grey(46);     ///< what can be changed
inline constexpr ImU32 field_hover = grey(54);
inline constexpr ImU32 field_active = grey(62);
inline constexpr ImU32 fill = grey(74);  ///< the filled part of a slider
inline constexpr ImU32 hairline = grey(52);
inline constexpr ImU32 text = IM_COL32(226, 225, 223, 255);
inline constexpr ImU32 text_dim = IM_COL32(160, 159, 157, 255);
inline constexpr ImU32 text_faint = IM_COL32(112, 112, 111, 255);
inline constexpr ImU32 accent = IM_COL32(112, 164, 222, 255);
inline constexpr ImU32 accent_dim = IM_COL32(112, 164, 222, 64);
inline constexpr ImU32 error = IM_COL32(232, 96, 88, 255);
inline constexpr ImU32 error_field = IM_COL32(74, 36, 34, 245);
inline constexpr ImU32 warning = IM_COL32(222, 178, 88, 255);
/// primary amber, secondary teal, tertiary violet, caustic coral
inline constexpr std::array<ImU32, 4> component = {IM_COL32(235, 168, 66, 255), IM_COL32(64, 184, 172, 255),
                                                   IM_COL32(156, 128, 224, 255), IM_COL32(242, 116, 94, 255)};
/// Layers by path expressions, in turn: apart from the components, and from each other.
inline constexpr std::array<ImU32, 4> own_layer = {IM_COL32(126, 192, 92, 255), IM_COL32(226, 130, 180, 255),
                                                   IM_COL32(110, 190, 226, 255),
                                                   IM_COL32(200, 190, 110, 255)};
ImU32 with_alpha(ImU32 c, float alpha);
/// Halfway steps between two colours, 0..1, in display values.
ImU32 mix(ImU32 a, ImU32 b, float t);
}  // namespace colour

struct Fonts {
  ImFont* regular = nullptr;  ///< 14 px
  ImFont* strong = nullptr;   ///< 14 px, semi-bold
  ImFont* small = nullptr;    ///< 12 px
  ImFont* caps = nullptr;     ///< 11 px semi-bold, for headings in capitals
  ImFont* large = nullptr;    ///< 22 px; the empty window
};

struct Theme {
  float scale = 1;
  Fonts fonts;
  std::string font_note;  ///< set when the fonts were not found, for the log
  /// Design pixels to window pixels, rounded so that hairlines stay sharp.
  float px(float design) const {
    return static_cast<float>(static_cast<int>(design * scale + (design < 0 ? -0.5f : 0.5f)));
  }
};

Theme& theme();
inline float px(float design) { return theme().px(design); }

/// Loads the fonts at that scale and sets ImGui's style. Call with an ImGui context before its first frame,
/// and again when the scale changes (outside a frame, after dropping the backend's font texture).
void apply_theme(float scale);

}  // namespace lucerna::ui
