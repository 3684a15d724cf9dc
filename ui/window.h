#pragma once
// The operating system's side of the window: GLFW, an OpenGL 3.3 context, Dear ImGui's backends, the
// picture's texture.
#include <filesystem>
#include <string>
#include <vector>

struct GLFWwindow;

namespace lucerna::ui {

class Window {
 public:
  /// Throws Error if there is no display or no OpenGL 3.3. `scale` 0: the desktop's.
  Window(int width, int height, bool hidden, float scale);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// True once if the user has asked to close the window; it stays open.
  bool take_closing();
  /// Sleeps until something happens, or for at most `seconds` (0: only collects events). Returns whether
  /// there was input.
  bool wait(double seconds);
  void begin_frame();
  /// Draws ImGui's content. Then read() may be called, then present().
  void end_frame();
  void present();
  /// The window as drawn, RGBA, top row first.
  std::vector<uint8_t> read(uint32_t& width, uint32_t& height) const;
  void set_size(int width, int height);
  /// Scale of text and controls; 0: the desktop's.
  void set_scale(float scale);
  void set_title(const std::string& title);
  /// Uploads a picture to the texture (recreated if the size changes). Returns its OpenGL name.
  unsigned upload(const std::vector<uint8_t>& rgba, uint32_t width, uint32_t height);
  /// Creates a permanent texture, enlarged smoothly or in squares. Returns its OpenGL name.
  unsigned make_texture(const std::vector<uint8_t>& rgba, uint32_t width, uint32_t height,
                        bool smooth = true);
  /// Removes such a texture.
  void drop_texture(unsigned texture);
  /// A key that went down, with its modifiers (GLFW_MOD_*).
  struct Key {
    int key, mods;
  };
  /// Keys pressed since the last call, in order. (ImGui samples keys once per frame and misses quick ones.)
  std::vector<Key> pressed();
  /// Files dropped since the last call.
  std::vector<std::string> dropped();

  // Input made by a script. It takes the same path as real input; once used, the script owns the pointer.
  void move_mouse(float x, float y);  ///< window units
  void press_mouse(int button, bool down);
  void press_key(int key, int mods);
  void hold_key(int key, bool down);  ///< GLFW's; a modifier's too
  void turn_wheel(float notches);     ///< upwards
  void type(const std::string& text);
  void drop(const std::string& file);

  double refresh_seconds() const { return refresh_seconds_; }  ///< least time between frames
  /// Ends a wait(); callable from any thread.
  static void wake();

 private:
  struct Events;
  void follow_scale();

  GLFWwindow* window_ = nullptr;
  Events* events_ = nullptr;
  float asked_scale_ = 0, scale_ = 0;
  double refresh_seconds_ = 1.0 / 60;
  unsigned texture_ = 0;
  std::vector<unsigned> textures_;  ///< of make_texture()
  uint32_t texture_width_ = 0, texture_height_ = 0;
};

}  // namespace lucerna::ui
