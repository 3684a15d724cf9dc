// links: ui film_io
// Every control of every panel, without a display: each has a unique id in its frame, and receives a click on
// it. ImGui's items pass through this file (tests/CMakeLists.txt wraps them), so panels need no changes.
#include "fake_session.h"
#include "support.h"
#include "ui/theme.h"
#include "ui/viewer.h"

#define IMGUI_DEFINE_MATH_OPERATORS
#include <imgui_internal.h>

#include <chrono>
#include <set>
#include <thread>

#include "commands/material_words.h"
#include "commands/registry.h"
#include "solvers/registry.h"
#include "ui/assets.h"
#include "ui/state.h"

using namespace lucerna;

namespace {

struct Item {
  ImGuiID id;
  ImGuiWindow* window;
  ImRect box;
};

/// A button or an entry of a list, as drawn in the last frame.
struct Control {
  std::string name;  ///< its own part of the id
  ImGuiID id;
  ImGuiWindow* window;
  ImRect box, seen;  ///< complete; and the part its window shows
  bool disabled, pressed;
};

/// The last frame's content.
struct Frame {
  std::vector<Item> items;
  std::vector<Control> controls;
  std::string tooltip;  ///< text of the displayed tooltip
} g_frame;
/// The control whose press is passed on; all other presses are recorded and withheld, so nothing changes.
std::optional<ImGuiID> g_answered;

bool withheld(const char* name, ImGuiID id, bool pressed) {
  const ImGuiLastItemData& item = GImGui->LastItemData;
  ImGuiWindow* window = ImGui::GetCurrentWindow();
  ImRect seen = item.Rect;
  seen.ClipWithFull(window->ClipRect);
  g_frame.controls.push_back({name, id, window, item.Rect, seen,
                              (GImGui->CurrentItemFlags & ImGuiItemFlags_Disabled) != 0, pressed});
  return pressed && g_answered == id;
}

}  // namespace

bool real_item_add(const ImRect& box, ImGuiID id, const ImRect* nav,
                   ImGuiItemFlags flags) asm("__real__ZN5ImGui7ItemAddERK6ImRectjPS1_i");
bool wrap_item_add(const ImRect& box, ImGuiID id, const ImRect* nav,
                   ImGuiItemFlags flags) asm("__wrap__ZN5ImGui7ItemAddERK6ImRectjPS1_i");
bool wrap_item_add(const ImRect& box, ImGuiID id, const ImRect* nav, ImGuiItemFlags flags) {
  if (id != 0) g_frame.items.push_back({id, ImGui::GetCurrentWindow(), box});
  return real_item_add(box, id, nav, flags);
}

bool real_button(const char* name, const ImVec2& size,
                 int flags) asm("__real__ZN5ImGui15InvisibleButtonEPKcRK6ImVec2i");
bool wrap_button(const char* name, const ImVec2& size,
                 int flags) asm("__wrap__ZN5ImGui15InvisibleButtonEPKcRK6ImVec2i");
bool wrap_button(const char* name, const ImVec2& size, int flags) {
  const ImGuiID id = ImGui::GetID(name);
  const bool pressed = real_button(name, size, flags);
  return withheld(name, id, pressed);
}

bool real_entry(const char* name, bool on, int flags,
                const ImVec2& size) asm("__real__ZN5ImGui10SelectableEPKcbiRK6ImVec2");
bool wrap_entry(const char* name, bool on, int flags,
                const ImVec2& size) asm("__wrap__ZN5ImGui10SelectableEPKcbiRK6ImVec2");
bool wrap_entry(const char* name, bool on, int flags, const ImVec2& size) {
  const ImGuiID id = ImGui::GetID(name);
  const bool pressed = real_entry(name, on, flags | ImGuiSelectableFlags_DontClosePopups, size);
  return withheld(name, id, pressed);
}

void real_text(const char* begin, const char* end) asm("__real__ZN5ImGui15TextUnformattedEPKcS1_");
void wrap_text(const char* begin, const char* end) asm("__wrap__ZN5ImGui15TextUnformattedEPKcS1_");
void wrap_text(const char* begin, const char* end) {
  if (ImGui::GetCurrentWindow()->Flags & ImGuiWindowFlags_Tooltip)
    g_frame.tooltip += end ? std::string(begin, end) : std::string(begin);
  real_text(begin, end);
}

namespace {

/// A window's panels without a window: frames are drawn into lists that are not displayed.
class Walk {
 public:
  explicit Walk(float width = 1600, float height = 1000) : ui_(session_) {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = {width, height};
    io.DeltaTime = 1.0f / 30;
    io.MouseDoubleClickTime = 0;
    io.KeyMap[ImGuiKey_Escape] = 256;
    ui::apply_theme(1);
    ui_.scripted = true;
    ui_.viewport.texture = 1, ui_.viewport.texture_width = 64, ui_.viewport.texture_height = 48;
  }
  ~Walk() {
    ui_.work.session.on_publish({});
    ImGui::DestroyContext();
  }

  ui::Ui& ui() { return ui_; }

  /// Runs a command and draws until the session has executed it and has all samples: nothing moves while
  /// controls are clicked.
  void act(const std::string& line) {
    ui_.act_line(line);
    settle();
  }
  void settle() {
    const auto begin = std::chrono::steady_clock::now();
    const auto busy = [&] {
      const auto s = session_.snapshot();
      return !s || s->commands < session_.commands() || (ui_.open.scene && !s->finished);
    };
    for (frames(1); busy(); frames(1)) {
      REQUIRE(std::chrono::steady_clock::now() - begin < std::chrono::seconds(20));
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    frames(3);
  }

  void frames(int n) {
    for (int i = 0; i < n; ++i) frame();
  }

  /// Checks that no id is used twice in a frame. `where`: the tested part of the window.
  void check_ids(const std::string& where) {
    frame();
    std::map<std::pair<ImGuiWindow*, ImGuiID>, int> uses;
    for (const Item& item : g_frame.items) ++uses[{item.window, item.id}];
    for (const Item& item : g_frame.items)
      if (const int n = std::exchange(uses[{item.window, item.id}], 1); n > 1) {
        std::string names;
        for (const Control& c : g_frame.controls)
          if (c.id == item.id) names += " " + c.name;
        INFO(where << ": " << n << " items of one id:" << names << " at " << item.box.Min.x << " "
                   << item.box.Min.y << " in " << item.window->Name);
        CHECK(n == 1);
      }
  }

  /// Clicks every control that `of` accepts and checks that it receives the press. Lists and pickers are
  /// opened, and their controls are clicked too. Returns the number of clicks.
  template <class Of>
  int click_all(const std::string& where, const Of& of) {
    check_ids(where);
    std::vector<Control> controls;
    for (const Control& c : g_frame.controls)
      if (of(c) && !c.disabled && c.name != "##view") controls.push_back(c);
    int clicked = 0;
    std::map<ImGuiID, int> seen;
    for (const Control& c : controls) {
      const int nth = seen[c.id]++;
      INFO(where << ": " << c.name << " at " << c.box.Min.x << " " << c.box.Min.y << " in "
                 << c.window->Name);
      if (!bring_into_view(c.id, nth)) continue;
      CHECK(click(c.id, nth));
      ++clicked;
      if (c.name == "##open" && !(c.window->Flags & ImGuiWindowFlags_Popup)) {
        g_answered = c.id;
        click(c.id, nth);
        g_answered.reset();
        frames(2);
        clicked += click_all(where + ": " + c.name, in_popup);
        close();
      }
    }
    return clicked;
  }

  static bool in_popup(const Control& c) {
    return (c.window->RootWindow->Flags & ImGuiWindowFlags_Popup) != 0;
  }
  static bool anywhere(const Control&) { return true; }

  /// Opens a menu by its index among those of the bar, or among those in the open menu.
  bool open_menu(size_t n, bool in_bar) {
    frame();
    std::vector<Item> menus;
    for (const Item& item : g_frame.items) {
      const bool popup = (item.window->Flags & ImGuiWindowFlags_Popup) != 0;
      if ((in_bar ? std::string(item.window->Name) == "##bar" : popup) &&
          std::none_of(g_frame.controls.begin(), g_frame.controls.end(),
                       [&](const Control& c) { return c.id == item.id; }))
        menus.push_back(item);
    }
    if (n >= menus.size()) return false;
    press(menus[n].box.GetCenter());
    frames(2);
    return true;
  }

  /// The tooltip at a place where the pointer rests, with this many seconds between frames.
  std::string tooltip_at(const ImVec2& at, float between_frames) {
    ImGuiIO& io = ImGui::GetIO();
    io.MousePos = {-1, -1};
    frames(2);
    io.MousePos = at;
    const float before = std::exchange(io.DeltaTime, between_frames);
    frames(between_frames < 0.5f ? 20 : 3);
    io.DeltaTime = before;
    return g_frame.tooltip;
  }

  std::vector<std::pair<int, int>> keys;  ///< GLFW's and their modifiers, pressed in the next frame

  void close() {
    if (!GImGui->OpenPopupStack.empty()) ImGui::ClosePopupToLevel(0, true);
    ui_.dialog = {}, ui_.help = false;
    ImGui::GetIO().MousePos = {-1, -1};
    frames(2);
  }

  /// The controls of that name.
  std::vector<Control> named(const std::string& name) const {
    std::vector<Control> list;
    for (const Control& c : g_frame.controls)
      if (c.name == name) list.push_back(c);
    return list;
  }
  bool click(ImGuiID id, int nth) {
    const Control* c = find(id, nth);
    if (!c) return false;
    press(c->seen.GetCenter());
    c = find(id, nth);
    return c && c->pressed;
  }

  /// Scrolls the control's window if necessary; false: it cannot be visible (folded away).
  bool bring_into_view(ImGuiID id, int nth) {
    frame();
    const Control* c = find(id, nth);
    if (!c) return false;
    ImGuiWindow* window = c->window;
    if (c->seen.GetHeight() < c->box.GetHeight() && window->ScrollMax.y > 0) {
      ImGui::SetScrollY(window, window->Scroll.y + c->box.GetCenter().y - window->InnerRect.GetCenter().y);
      frames(3);
      c = find(id, nth);
    }
    return c && c->seen.GetWidth() >= 1 && c->seen.GetHeight() >= 1;
  }

 private:
  void frame() {
    ui_.work.now = ui_.time();
    ui_.work.refresh(ui_.work.now);
    ui_.keys.list = std::exchange(keys, {});
    g_frame = {};
    ImGui::NewFrame();
    ImGui::PushFont(ui::theme().fonts.regular);
    ui_.actions.follow_gesture();
    ui::draw_parts(ui_);
    ImGui::PopFont();
    ImGui::Render();
  }

  const Control* find(ImGuiID id, int nth) const {
    for (const Control& c : g_frame.controls)
      if (c.id == id && nth-- == 0) return &c;
    return nullptr;
  }

  /// The button goes down and up at a place; the last frame is that of the release.
  void press(const ImVec2& at) {
    ImGuiIO& io = ImGui::GetIO();
    io.MousePos = {std::floor(at.x), std::floor(at.y)};
    frames(2);
    io.MouseDown[0] = true;
    frame();
    io.MouseDown[0] = false;
    frame();
  }

  session::FakeSession session_;
  ui::Ui ui_;
};

const std::vector<std::string> k_sections{"Light",       "Light mix", "Render",  "Camera", "Lights",
                                          "Environment", "Materials", "Objects", "Options"};

/// The hall with all sections open.
void open_hall(Walk& walk) {
  walk.act("samples 4");
  walk.ui().work.session.set_size(64, 48);
  walk.act("scene.open hall.gltf");
  walk.settle();
  REQUIRE(walk.ui().open.scene);
  REQUIRE(walk.ui().viewport.has_picture());
  for (const std::string& section : k_sections) walk.ui().sections[section] = true;
  walk.frames(3);
}

}  // namespace

TEST_CASE("no id is used twice in a frame, and every control of every panel receives a click") {
  Walk walk;
  open_hall(walk);
  ui::Ui& ui = walk.ui();
  int clicked = 0;
  SECTION("the scene's panel, with no selection, then a lamp, a surface and a material") {
    clicked += walk.click_all("scene", Walk::anywhere);
    for (const char* selected : {"light 1", "light 3", "material 5", "material 1"}) {
      walk.act(std::string("select ") + selected);
      clicked +=
          walk.click_all(selected, [](const Control& c) { return std::string(c.window->Name) == "##scene"; });
    }
    CHECK(clicked > 150);
  }
  SECTION("every solver's panel, in use or not") {
    for (const bool used : {false, true})
      for (const solvers::SolverInfo* solver : solvers::registered()) {
        if (!solver->has_panel()) continue;
        if (used)
          for (size_t c = 0; c < solver->serves.size(); ++c)
            if (solver->serves[c])
              walk.act("set components." + std::string(session::k_component_names[c]) + " " + solver->name);
        walk.act("window.side " + solver->name);
        const std::string panel = "##solver_" + solver->name;
        clicked += walk.click_all(panel, [&](const Control& c) { return c.window->Name == panel; });
      }
    CHECK(clicked > 20);
  }
  SECTION("the panel of held results") {
    walk.act("compare.hold first");
    walk.act("compare.hold second");
    walk.act("compare.view difference");
    walk.act("window.side compare");
    REQUIRE(ui.work.compare.results.list().size() == 2);
    const std::string panel = "##side_compare";
    clicked += walk.click_all(panel, [&](const Control& c) { return c.window->Name == panel; });
    CHECK(clicked >= 10);
  }
  SECTION("the menus") {
    for (const char* line : {"set components.secondary cache", "set components.tertiary photons",
                             "set components.caustic light"})
      walk.act(line);
    size_t n = 0, inner = 0;
    for (; walk.open_menu(n, true); ++n) {
      clicked += walk.click_all(fmt::format("menu {}", n + 1), Walk::in_popup);
      walk.close();
      for (size_t m = 0; walk.open_menu(n, true) && walk.open_menu(m, false); ++m, ++inner) {
        ImGuiWindow* first = GImGui->OpenPopupStack[0].Window;
        clicked += walk.click_all(fmt::format("menu {}, menu {}", n + 1, m + 1),
                                  [&](const Control& c) { return Walk::in_popup(c) && c.window != first; });
        walk.close();
      }
      walk.close();
    }
    CHECK(n == 6);
    CHECK(inner == 4);
    CHECK(clicked > 45);
  }
  SECTION("the dialogs, the keys and the cards") {
    for (const char* dialog : {"dialog.open", "dialog.save", "dialog.scene", "dialog.reference",
                               "dialog.script", "dialog.test", "dialog.held"}) {
      walk.act(dialog);
      if (std::string(dialog) == "dialog.save") ui.dialog.path = "a.png";
      clicked += walk.click_all(dialog, Walk::in_popup);
      walk.close();
    }
    CHECK(clicked >= 8);
    walk.act("window.keys");
    walk.check_ids("keys");
    walk.close();
    ui.cards.welcome = true, ui.cards.errors = {"first", "second"};
    walk.frames(2);
    clicked = walk.click_all("cards",
                             [](const Control& c) { return c.name == "##begin" || c.name == "##dismiss"; });
    CHECK(clicked == 2);
  }
  SECTION("folded panels, and a window of minimum size") {
    for (const char* panel : {"left", "right", "bottom"}) walk.act(fmt::format("window.fold {} true", panel));
    clicked = walk.click_all("folded", Walk::anywhere);
    CHECK(clicked > 10);
    for (const char* panel : {"left", "right", "bottom"})
      walk.act(fmt::format("window.fold {} false", panel));
    ImGui::GetIO().DisplaySize = {640, 400};
    walk.frames(3);
    CHECK(walk.click_all("small", Walk::anywhere) > 100);
  }
}

namespace {

/// Presses the first control of that name, for what it does.
void use(Walk& walk, const std::string& name) {
  INFO(name);
  walk.frames(2);
  const std::vector<Control> found = walk.named(name);
  REQUIRE_FALSE(found.empty());
  REQUIRE(walk.bring_into_view(found[0].id, 0));
  g_answered = found[0].id;
  CHECK(walk.click(found[0].id, 0));
  g_answered.reset();
  walk.settle();
}

}  // namespace

TEST_CASE("the panel's buttons add, copy, move and delete lights, each in one step") {
  Walk walk;
  open_hall(walk);
  const auto& open = walk.ui().open;
  const auto count = [&] { return open.lights().size(); };
  REQUIRE(count() == 3);
  // The list of objects is open below: the panel stays where the new light's row is.
  walk.ui().sections["Objects"] = true;
  use(walk, "##add_spot");
  CHECK(ImGui::FindWindowByName("##scene")->Scroll.y < 300);
  walk.ui().sections["Objects"] = false;
  REQUIRE(count() == 4);
  CHECK(walk.ui().camera.selection == commands::Selection{commands::Kind::light, 3});
  const vec3 place = open.light(3).position;
  walk.act("camera.orbit 0.5 0.1");
  use(walk, "##here");  // aims it
  CHECK(open.light(3).position == place);
  use(walk, "##duplicate");
  REQUIRE(count() == 5);
  CHECK(open.light(4).name == "Spot 2");
  CHECK(open.light(4).position != place);
  use(walk, "##delete");
  CHECK(count() == 4);
  CHECK(walk.ui().camera.selection.kind == commands::Kind::none);
  for (int i = 0; i < 2; ++i) walk.act("undo");
  CHECK(count() == 4);
  use(walk, "##add_sun");
  use(walk, "##by_date");
  REQUIRE(open.light(4).sun);
  CHECK(open.light(4).sun->latitude == 48);
  use(walk, "##daylight");
  CHECK(luminance(open.light(4).intensity) > 50e3);
  walk.act("environment.sky preetham");
  REQUIRE(open.sky());
  use(walk, "##own");
  CHECK_FALSE(open.sky());
}

TEST_CASE("the panel copies materials, gives them swatches, and keeps swatches") {
  Walk walk;
  open_hall(walk);
  const auto& open = walk.ui().open;
  const scene::Material first = open.material(0);
  walk.act("select material 1");
  use(walk, "##copy");
  walk.act("select material 2");
  CHECK_FALSE(static_cast<const scene::MaterialFactors&>(open.material(1)) == first);
  use(walk, "##paste");
  CHECK(static_cast<const scene::MaterialFactors&>(open.material(1)) == first);
  CHECK(open.material(1).name != first.name);
  use(walk, "##swatches");
  use(walk, "##swatch");  // the first one
  CHECK(walk.ui().history.undo_text() == "material.set 2 like=plain " + commands::swatches().front().words);
  walk.act("material.set 2 roughness=0.125");
  walk.ui().scene_view.swatch_name = "Mine";
  use(walk, "##swatches");
  use(walk, "##keep");
  REQUIRE(walk.ui().scene_view.swatches.size() == 1);
  CHECK_THAT(walk.ui().scene_view.swatches["Mine"], Catch::Contains("roughness=0.125"));
  use(walk, "##forget");
  CHECK(walk.ui().scene_view.swatches.empty());
  walk.act("dismiss");
  // Every swatch of the program can be carried out, and is the same when it is kept.
  for (const commands::Swatch& swatch : commands::swatches()) {
    INFO(swatch.name);
    walk.act("material.set 2 like=plain " + swatch.words);
    walk.settle();
    const commands::Document::Material made = open.material_state(1);
    walk.act("material.set 2 like=plain");
    walk.act("material.set 2 like=plain " + commands::material_words(made));
    walk.settle();
    CHECK(open.material_state(1) == made);
    CHECK(commands::material_words(made).size() > 5);
  }
}

TEST_CASE("the panel of held results holds, compares, and forgets") {
  Walk walk;
  open_hall(walk);
  const commands::HeldResults& results = walk.ui().work.compare.results;
  walk.act("window.side compare");
  use(walk, "##hold");
  REQUIRE(results.list().size() == 1);
  CHECK(results.compared() == &results.list()[0]);
  for (const auto& [button, view] : {std::pair{"##wipe", commands::CompareView::wipe},
                                     {"##flip", commands::CompareView::flip},
                                     {"##difference", commands::CompareView::difference}}) {
    use(walk, button);
    CHECK(results.view() == view);
  }
  use(walk, "##difference");
  CHECK(results.view() == commands::CompareView::off);
  use(walk, "##held");
  CHECK_FALSE(results.compared());
  use(walk, "##held");
  CHECK(results.compared());
  use(walk, "##forget");
  CHECK(results.list().empty());
}

TEST_CASE("closing asks if there is something to save") {
  Walk walk;
  open_hall(walk);
  walk.act("window.close");
  CHECK(walk.ui().requests.status == 0);
  walk.ui().requests.status.reset();
  walk.act("light.set 1 intensity=2");
  walk.keys = {{'Q', 2}};
  walk.frames(3);
  CHECK_FALSE(walk.ui().requests.status);
  REQUIRE(walk.ui().leaving.step == ui::Leaving::Step::asks);
  use(walk, "##stay");
  CHECK(walk.ui().leaving.step == ui::Leaving::Step::no);
  CHECK_FALSE(walk.ui().requests.status);
  // It cannot be saved: the window stays, with the reason.
  walk.act("window.close");
  use(walk, "##save_scene");
  const auto begin = std::chrono::steady_clock::now();
  while (walk.ui().leaving.step != ui::Leaving::Step::no) {
    REQUIRE(std::chrono::steady_clock::now() - begin < std::chrono::seconds(20));
    walk.frames(1);
  }
  CHECK_FALSE(walk.ui().requests.status);
  walk.act("window.close");
  use(walk, "##discard");
  CHECK(walk.ui().requests.status == 0);
}

TEST_CASE("opening another scene asks if there is something to save") {
  Walk walk;
  open_hall(walk);
  const auto steps = [&] { return walk.ui().leaving.step; };
  const std::string before = walk.ui().open.scene->name;
  walk.act("light.set 1 intensity=2");
  walk.ui().drop("sheen-other.gltf");
  walk.frames(3);
  REQUIRE(steps() == ui::Leaving::Step::asks);
  CHECK(walk.ui().leaving.opens == "sheen-other.gltf");
  // A second file while the question is open does not answer it.
  walk.act("window.open other.gltf");
  walk.frames(2);
  REQUIRE(steps() == ui::Leaving::Step::asks);
  CHECK(walk.ui().leaving.opens == "other.gltf");
  CHECK(walk.ui().open.scene->name == before);
  use(walk, "##stay");
  CHECK(steps() == ui::Leaving::Step::no);
  CHECK(walk.ui().open.scene->name == before);
  CHECK_FALSE(walk.ui().requests.status);
  walk.act("window.open other.gltf");
  use(walk, "##discard");
  CHECK(steps() == ui::Leaving::Step::no);
  const auto begin = std::chrono::steady_clock::now();
  while (walk.ui().open.scene->name == before) {
    REQUIRE(std::chrono::steady_clock::now() - begin < std::chrono::seconds(20));
    walk.frames(1);
  }
  CHECK_FALSE(walk.ui().requests.status);
}

TEST_CASE("solo of the first light group mutes the others") {
  Walk walk;
  open_hall(walk);
  const std::vector<Control> solos = walk.named("##solo");
  const size_t groups = walk.ui().open.light_groups().groups.size();
  REQUIRE(groups > 0);
  REQUIRE(solos.size() == k_components.size() + groups);
  // The mix is below the components.
  const Control& first = solos[k_components.size()];
  int nth = 0;
  for (const size_t i : k_components) nth += solos[i].id == first.id;
  g_answered = first.id;
  walk.click(first.id, nth);
  g_answered.reset();
  walk.frames(2);
  const auto mix = walk.ui().open.light_mix();
  const auto found = mix.find(walk.ui().open.light_groups().groups[0].name);
  REQUIRE(found != mix.end());
  CHECK(found->second.solo);
}

TEST_CASE("components, solvers and list entries have tooltips, at any frame rate") {
  Walk walk;
  open_hall(walk);
  std::vector<Control> names = walk.named("##name");
  names.resize(k_components.size());
  // The field of a component's solver is the first list below its name.
  for (const float between : {1.0f / 30, 0.8f}) {
    INFO(between << " s between frames");
    CHECK_THAT(walk.tooltip_at(names[0].box.GetCenter(), between), Catch::StartsWith("Primary: "));
    CHECK_THAT(walk.tooltip_at(names[3].box.GetCenter(), between), Catch::StartsWith("Caustic: "));
    const ImVec2 below(names[1].box.Min.x + 40, names[1].box.Max.y + 14);
    CHECK_THAT(walk.tooltip_at(below, between),
               Catch::StartsWith("Solver of the secondary component") && Catch::Contains("Path tracing: "));
  }
  const auto field = std::find_if(names.begin() + 1, names.end(), [](const Control&) { return true; });
  const ImVec2 below(field->box.Min.x + 40, field->box.Max.y + 14);
  for (const Control& c : walk.named("##open"))
    if (c.box.Contains(below)) {
      g_answered = c.id;
      walk.click(c.id, 0);
      g_answered.reset();
      break;
    }
  walk.frames(2);
  std::vector<std::string> helps;
  for (const Control& c : walk.named("##entry"))
    if (Walk::in_popup(c)) helps.push_back(walk.tooltip_at(c.box.GetCenter(), 0.8f));
  const OptionInfo* option = plan::find_option("components.secondary");
  REQUIRE(helps.size() == option->choices.size());
  for (size_t i = 0; i < helps.size(); ++i) {
    INFO(option->choices[i]);
    const solvers::SolverInfo* solver = solvers::find(option->choices[i]);
    CHECK_THAT(helps[i], Catch::StartsWith(solver                         ? solver->help.substr(0, 12)
                                           : option->choices[i] == "auto" ? "Auto: "
                                                                          : "Off: "));
  }
  walk.close();
}

TEST_CASE("Ctrl+S pressed and released within a frame, or released after Ctrl, does not move the camera") {
  Walk walk;
  open_hall(walk);
  REQUIRE(walk.ui().camera.view);
  ImGuiIO& io = ImGui::GetIO();
  io.MousePos = {800, 300};
  walk.frames(3);
  const auto eye = [&] { return commands::eye_of(walk.ui().camera.view->camera); };
  const vec3 before = eye();
  const auto press = [&](int key, int mods) {
    walk.keys = {{key, mods}};
    io.KeysDown[key] = true;
    walk.frames(3);
    io.KeysDown[key] = false;
    walk.frames(3);
  };
  press('S', 2);
  CHECK(walk.ui().dialog.purpose == ui::Dialog::Purpose::save);
  CHECK(eye() == before);
  walk.close();
  io.MousePos = {800, 300};
  walk.frames(3);
  press('B', 2), press('D', 2), press('W', 2);
  CHECK(eye() == before);
  press('S', 0);
  CHECK(eye() != before);
}

TEST_CASE("unsupported features of a scene are reported over the picture") {
  Walk walk;
  open_hall(walk);
  CHECK(walk.ui().cards.note.text.empty());
  walk.act("scene.open sheen.gltf");
  CHECK_THAT(walk.ui().cards.note.text,
             Catch::Contains("Not supported") && Catch::Contains("KHR_materials_sheen"));
}

TEST_CASE("a saved file is named over the picture, with its form") {
  Walk walk;
  open_hall(walk);
  for (const auto& [line, said] : {std::pair{"image.save a.png as=shown", "Saved a.png, as shown"},
                                   {"image.save a.png", "Saved a.png, unfiltered"},
                                   {"image.save a.exr", "Saved a.exr"}}) {
    walk.act(line);
    walk.settle();
    CHECK(walk.ui().cards.note.text == said);
  }
  walk.ui().cards.note.text.clear();
  walk.act("image.save missing/a.png");
  CHECK(walk.ui().cards.note.text.empty());
}

TEST_CASE(
    "the Open dialog goes to the parent folder and to places, and shows an empty folder without an error") {
  const test::Folder folder;
  const auto inner = folder.path / "inner";
  std::filesystem::create_directory(inner);
  std::ofstream(folder.path / "a.gltf") << "{}";
  Walk walk;
  open_hall(walk);
  walk.ui().recent = {(folder.path / "a.gltf").string()};
  walk.act("dialog.open");
  ImGui::ClearActiveID();  // the field has its own text while it has the keyboard
  walk.ui().dialog.pictures = false, walk.ui().dialog.path = inner.string() + "/";
  walk.frames(3);
  const auto press = [&](const char* name, int nth = 0) {
    std::vector<Control> found = walk.named(name);
    REQUIRE(found.size() > static_cast<size_t>(nth));
    g_answered = found[static_cast<size_t>(nth)].id;
    CHECK(walk.click(*g_answered, 0));
    g_answered.reset();
    walk.frames(3);
  };
  CHECK(walk.named("##entry").empty());
  press("##parent");
  CHECK(walk.ui().dialog.path == folder.path.string() + "/");
  CHECK(walk.named("##entry").size() == 2);
  press("##working");
  CHECK(walk.ui().dialog.path == std::filesystem::current_path().string() + "/");
  press("##root");
  CHECK(walk.ui().dialog.path == "/");
  CHECK(walk.named("##parent").empty());
  press("##scenes");
  CHECK(walk.named("##picture").size() == ui::gallery().size());
  CHECK(ui::gallery().size() >= 10);
  press("##recent");
  CHECK(walk.ui().dialog.purpose == ui::Dialog::Purpose::none);
}
