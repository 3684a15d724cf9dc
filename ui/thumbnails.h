#pragma once
// Small pictures of image files, made in the background.
#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "texture_cache.h"

namespace lucerna::ui {

class Thumbnails {
 public:
  /// `made`: called on another thread when one more is there.
  explicit Thumbnails(std::function<void()> made);
  ~Thumbnails();
  Thumbnails(const Thumbnails&) = delete;
  Thumbnails& operator=(const Thumbnails&) = delete;

  /// The picture; null: it is not there yet, or cannot be read. The one requested last is made first. A file
  /// that is changed later keeps its picture.
  const PictureBytes* get(const std::string& file);

 private:
  void run();

  std::function<void()> made_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool quit_ = false;
  std::deque<std::string> wanted_;                                 ///< the newest last
  std::map<std::string, std::unique_ptr<PictureBytes>> pictures_;  ///< null: wanted, or cannot be read
  std::thread thread_;                                             ///< from the first request on
};

}  // namespace lucerna::ui
