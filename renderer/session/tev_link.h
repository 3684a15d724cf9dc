#pragma once
// Sends the layers of a renderer's picture to a viewer with tev's protocol while it renders.
#include <string>

#include "base/timer.h"
#include "film/io/tev.h"

namespace lucerna::session {

class Renderer;

class TevLink {
 public:
  /// `scene`: its name, for the image's.
  TevLink(const film::TevAddress& address, const std::string& scene);

  /// Call after each step: sends the picture when its samples have doubled, at most once a second, and when
  /// it is finished; not while the one before is being sent. Logs a problem once, as a warning. False if the
  /// connection has ended.
  bool follow(Renderer& renderer);
  /// True if follow() has something to do although nothing is rendered: the picture is finished, and not sent
  /// yet or being sent.
  bool waits(const Renderer& renderer) const;
  /// Sends the present picture and waits until the viewer has it or a problem has occurred.
  void finish(Renderer& renderer);
  const std::string& address() const { return address_; }

 private:
  bool report();
  bool has(const Renderer& renderer) const;  ///< the present picture was the last to be sent

  std::string address_;
  film::TevSender sender_;
  Timer since_;
  bool begun_ = false;
  uint64_t restart_ = 0, paths_ = 0;  ///< of the picture sent last
};

}  // namespace lucerna::session
