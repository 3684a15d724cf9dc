#include "window.h"

#include <epoxy/gl.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>
#include <set>
#include <utility>

#include "base/error.h"
#include "key_queue.h"
#include "theme.h"

namespace lucerna::ui {

struct Window::Events {
  bool any = false, rescaled = false;
  std::vector<std::string> dropped;
  std::vector<Key> keys;
  KeyQueue queue;                   // pressed since the last frame, possibly released already
  std::vector<ImWchar> later_text;  // typed after keys that are still in the queue
  std::string error;
  bool scripted = false;  // a script controls the pointer
  float x = 0, y = 0;
  bool down[3] = {};
  std::set<int> held;                            // by a script
  std::vector<int> lifted;                       // of these, released ones that no real key holds
  std::optional<std::array<bool, 3>> modifiers;  // Ctrl, Shift, Alt that are held, if the frame has others
  float wheel = 0;

  /// Modifier bits of keys that a script holds.
  int held_mods() const {
    return (held.contains(GLFW_KEY_LEFT_CONTROL) ? GLFW_MOD_CONTROL : 0) |
           (held.contains(GLFW_KEY_LEFT_SHIFT) ? GLFW_MOD_SHIFT : 0) |
           (held.contains(GLFW_KEY_LEFT_ALT) ? GLFW_MOD_ALT : 0);
  }

  /// Stores dropped files, for GLFW's callback and for a script.
  void take(int count, const char** files) {
    for (int i = 0; i < count; ++i) dropped.push_back(files[i]);
    any = true;
  }
  void take_key(int key, int mods) {
    keys.push_back({key, mods});
    queue.press(key, mods | held_mods(),
                later_text.size() + static_cast<size_t>(ImGui::GetIO().InputQueueCharacters.Size));
    any = true;
  }
};

namespace {

std::string& last_error() {
  static std::string text;
  return text;
}

}  // namespace

Window::Window(int width, int height, bool hidden, float scale) : events_(new Events), asked_scale_(scale) {
  glfwSetErrorCallback([](int, const char* text) { last_error() = text; });
  const auto give_up = [&](const char* what) {
    const std::string why = last_error();
    glfwTerminate();
    delete events_;
    throw_error("window", "{}{}{}", what, why.empty() ? "" : ": ", why);
  };
  if (!glfwInit()) give_up("no display could be opened (is DISPLAY or WAYLAND_DISPLAY set?)");
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_VISIBLE, hidden ? GLFW_FALSE : GLFW_TRUE);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  window_ = glfwCreateWindow(width, height, "Lucerna", nullptr, nullptr);
  if (!window_) give_up("no window with OpenGL 3.3 could be created");
  glfwSetWindowSizeLimits(window_, 640, 400, GLFW_DONT_CARE, GLFW_DONT_CARE);
  glfwMakeContextCurrent(window_);
  glfwSwapInterval(1);
  if (GLFWmonitor* monitor = glfwGetPrimaryMonitor())
    if (const GLFWvidmode* mode = glfwGetVideoMode(monitor); mode && mode->refreshRate > 0)
      refresh_seconds_ = 1.0 / mode->refreshRate;

  // A software display shares the CPU with the renderer: it gets half the frame rate.
  const char* renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  for (const char* software : {"llvmpipe", "softpipe", "swrast"})
    if (renderer && std::strstr(renderer, software)) refresh_seconds_ = std::max(refresh_seconds_, 1.0 / 30);

  // Own callbacks first; ImGui's backend chains them.
  glfwSetWindowUserPointer(window_, events_);
  const auto mark = [](GLFWwindow* w) { static_cast<Events*>(glfwGetWindowUserPointer(w))->any = true; };
  static auto note = mark;
  glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double, double) { note(w); });
  glfwSetCursorEnterCallback(window_, [](GLFWwindow* w, int) { note(w); });
  glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int, int, int) { note(w); });
  glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double) { note(w); });
  glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int, int action, int mods) {
    if (action == GLFW_PRESS) static_cast<Events*>(glfwGetWindowUserPointer(w))->take_key(key, mods);
    note(w);
  });
  glfwSetCharCallback(window_, [](GLFWwindow* w, unsigned) { note(w); });
  glfwSetWindowFocusCallback(window_, [](GLFWwindow* w, int) { note(w); });
  glfwSetWindowSizeCallback(window_, [](GLFWwindow* w, int, int) { note(w); });
  glfwSetWindowRefreshCallback(window_, [](GLFWwindow* w) { note(w); });
  glfwSetWindowCloseCallback(window_, [](GLFWwindow* w) { note(w); });
  glfwSetWindowContentScaleCallback(window_, [](GLFWwindow* w, float, float) {
    static_cast<Events*>(glfwGetWindowUserPointer(w))->rescaled = true;
    note(w);
  });
  glfwSetDropCallback(window_, [](GLFWwindow* w, int count, const char** files) {
    static_cast<Events*>(glfwGetWindowUserPointer(w))->take(count, files);
  });

  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.LogFilename = nullptr;
  io.ConfigWindowsMoveFromTitleBarOnly = true;
  follow_scale();
  ImGui_ImplGlfw_InitForOpenGL(window_, true);
  ImGui_ImplOpenGL3_Init("#version 330 core");
}

Window::~Window() {
  if (texture_) glDeleteTextures(1, &texture_);
  for (const unsigned texture : textures_) glDeleteTextures(1, &texture);
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
  glfwDestroyWindow(window_);
  glfwTerminate();
  delete events_;
}

void Window::follow_scale() {
  float x = 1, y = 1;
  glfwGetWindowContentScale(window_, &x, &y);
  float scale = asked_scale_ > 0 ? asked_scale_ : x;
  // If window units are not pixels, ImGui works in window units and scales its drawing.
  int units = 0, pixels = 0, ignored = 0;
  glfwGetWindowSize(window_, &units, &ignored);
  glfwGetFramebufferSize(window_, &pixels, &ignored);
  if (asked_scale_ <= 0 && units > 0 && pixels > units)
    scale *= static_cast<float>(units) / static_cast<float>(pixels);
  scale = std::clamp(std::round(scale * 4) / 4, 0.75f, 4.0f);
  if (scale == scale_) return;
  const bool again = scale_ > 0;
  scale_ = scale;
  if (again) ImGui_ImplOpenGL3_DestroyFontsTexture();
  apply_theme(scale);
  if (again) ImGui_ImplOpenGL3_CreateFontsTexture();
}

bool Window::take_closing() {
  const bool closing = glfwWindowShouldClose(window_);
  if (closing) glfwSetWindowShouldClose(window_, GLFW_FALSE);
  return closing;
}

bool Window::wait(double seconds) {
  // A script's input since the last call counts like a user's.
  if (events_->any) seconds = 0;
  if (seconds > 0)
    glfwWaitEventsTimeout(seconds);
  else
    glfwPollEvents();
  return std::exchange(events_->any, false);
}

void Window::begin_frame() {
  if (std::exchange(events_->rescaled, false)) follow_scale();
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGuiIO& io = ImGui::GetIO();
  if (events_->scripted) {
    io.MousePos = {events_->x, events_->y};
    std::copy(std::begin(events_->down), std::end(events_->down), io.MouseDown);
  }
  io.MouseWheel += std::exchange(events_->wheel, 0.0f);
  // A key that was pressed and released between two frames is down for this frame, so its press is not lost.
  // Keys and text that came after it under other modifiers are for the next frame.
  std::vector<ImWchar> text = std::exchange(events_->later_text, {});
  text.insert(text.end(), io.InputQueueCharacters.begin(), io.InputQueueCharacters.end());
  const KeyQueue::Frame frame = events_->queue.next(text.size());
  io.InputQueueCharacters.resize(0);
  for (size_t i = 0; i < frame.text; ++i) io.InputQueueCharacters.push_back(text[i]);
  events_->later_text.assign(text.begin() + static_cast<std::ptrdiff_t>(frame.text), text.end());
  if (!events_->queue.empty() || !events_->later_text.empty()) events_->any = true;
  if (!events_->held.empty() || frame.mods) events_->modifiers = {{io.KeyCtrl, io.KeyShift, io.KeyAlt}};
  if (frame.mods) {
    io.KeyCtrl = *frame.mods & GLFW_MOD_CONTROL;
    io.KeyShift = *frame.mods & GLFW_MOD_SHIFT;
    io.KeyAlt = *frame.mods & GLFW_MOD_ALT;
  }
  io.KeyCtrl |= events_->held.contains(GLFW_KEY_LEFT_CONTROL);
  io.KeyShift |= events_->held.contains(GLFW_KEY_LEFT_SHIFT);
  io.KeyAlt |= events_->held.contains(GLFW_KEY_LEFT_ALT);
  std::vector<int> postponed;
  for (const int key : frame.later)
    if (std::exchange(io.KeysDown[key], false)) postponed.push_back(key);
  std::vector<int> revived;
  for (int key : events_->held)
    if (!io.KeysDown[key]) io.KeysDown[key] = true, revived.push_back(key);
  for (const int key : frame.keys)
    if (!io.KeysDown[key]) io.KeysDown[key] = true, revived.push_back(key);
  // A field that becomes active again would undo steps of a text that it no longer has.
  ImGuiContext& context = *ImGui::GetCurrentContext();
  if (context.InputTextState.ID != context.ActiveId) context.InputTextState.ID = 0;
  ImGui::NewFrame();
  for (const int key : postponed) io.KeysDown[key] = true;
  // A script's held keys are down for the whole frame; its parts read the keys while they are drawn.
  std::erase_if(revived, [&](int key) {
    if (events_->held.contains(key)) return events_->lifted.push_back(key), true;
    io.KeysDown[key] = false;
    return true;
  });
}

void Window::end_frame() {
  ImGuiIO& io = ImGui::GetIO();
  for (int key : std::exchange(events_->lifted, {})) io.KeysDown[key] = false;
  // ImGui asserts that a frame ends with the modifiers that it began with.
  ImGui::Render();
  if (const auto before = std::exchange(events_->modifiers, std::nullopt))
    io.KeyCtrl = (*before)[0], io.KeyShift = (*before)[1], io.KeyAlt = (*before)[2];
  int width = 0, height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  glViewport(0, 0, width, height);
  const ImVec4 c = ImGui::ColorConvertU32ToFloat4(colour::surround);
  glClearColor(c.x, c.y, c.z, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void Window::present() { glfwSwapBuffers(window_); }

std::vector<uint8_t> Window::read(uint32_t& width, uint32_t& height) const {
  int w = 0, h = 0;
  glfwGetFramebufferSize(window_, &w, &h);
  width = static_cast<uint32_t>(w), height = static_cast<uint32_t>(h);
  const size_t row = size_t{width} * 4;
  std::vector<uint8_t> upside_down(row * height), rgba(row * height);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadBuffer(GL_BACK);
  glReadPixels(0, 0, w, h, GL_RGBA, GL_UNSIGNED_BYTE, upside_down.data());
  for (size_t y = 0; y < height; ++y) std::memcpy(&rgba[y * row], &upside_down[(height - 1 - y) * row], row);
  for (size_t i = 3; i < rgba.size(); i += 4) rgba[i] = 255;
  return rgba;
}

void Window::set_size(int width, int height) { glfwSetWindowSize(window_, width, height); }
void Window::set_scale(float scale) {
  asked_scale_ = scale;
  events_->rescaled = events_->any = true;
}
void Window::set_title(const std::string& title) { glfwSetWindowTitle(window_, title.c_str()); }

unsigned Window::upload(const std::vector<uint8_t>& rgba, uint32_t width, uint32_t height) {
  if (!texture_) glGenTextures(1, &texture_);
  glBindTexture(GL_TEXTURE_2D, texture_);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  const auto w = static_cast<GLsizei>(width), h = static_cast<GLsizei>(height);
  if (width != texture_width_ || height != texture_height_) {
    texture_width_ = width, texture_height_ = height;
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, w, h, 0, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  } else {
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, w, h, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  }
  return texture_;
}

unsigned Window::make_texture(const std::vector<uint8_t>& rgba, uint32_t width, uint32_t height,
                              bool smooth) {
  unsigned texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, static_cast<GLsizei>(width), static_cast<GLsizei>(height), 0,
               GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, smooth ? GL_LINEAR : GL_NEAREST);
  for (const unsigned wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    glTexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
  textures_.push_back(texture);
  return texture;
}

void Window::drop_texture(unsigned texture) {
  std::erase(textures_, texture);
  glDeleteTextures(1, &texture);
}

void Window::move_mouse(float x, float y) {
  events_->scripted = events_->any = true;
  events_->x = x, events_->y = y;
}
void Window::press_mouse(int button, bool down) {
  events_->scripted = events_->any = true;
  events_->down[button] = down;
}
void Window::press_key(int key, int mods) { events_->take_key(key, mods); }
void Window::hold_key(int key, bool down) {
  if (down)
    events_->held.insert(key);
  else
    events_->held.erase(key);
  events_->any = true;
}
void Window::turn_wheel(float notches) { events_->wheel += notches, events_->any = true; }
void Window::type(const std::string& text) { ImGui::GetIO().AddInputCharactersUTF8(text.c_str()); }
void Window::drop(const std::string& file) {
  const char* name = file.c_str();
  events_->take(1, &name);
}

std::vector<Window::Key> Window::pressed() { return std::exchange(events_->keys, {}); }
std::vector<std::string> Window::dropped() { return std::exchange(events_->dropped, {}); }
void Window::wake() { glfwPostEmptyEvent(); }

}  // namespace lucerna::ui
