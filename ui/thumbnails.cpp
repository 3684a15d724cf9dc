#include "thumbnails.h"

#include <algorithm>
#include <utility>

#include "film/exposure.h"
#include "film/io/small_image.h"
#include "film/tonemap.h"

namespace lucerna::ui {
namespace {

/// 8- and 16-bit files as they are, others exposed and mapped by the neutral tone curve.
PictureBytes thumbnail(const std::string& file) {
  constexpr uint32_t k_most = 240;  // pixels a side
  const film::SmallImage image = film::read_small_image(file, k_most);
  PictureBytes result{image.width, image.height, {}};
  if (!image.encoded) {
    const float ev = film::measure_picture(image.colours, image.width, image.height).ev.value_or(0.0f);
    result.rgba = film::tone_map_picture(image.colours, ev, film::ToneCurve::neutral);
    return result;
  }
  result.rgba.assign(image.colours.size() * 4, 255);
  for (size_t i = 0; i < image.colours.size(); ++i)
    for (int c = 0; c < 3; ++c)
      result.rgba[4 * i + size_t(c)] = uint8_t(std::clamp(image.colours[i][c] * 255 + 0.5f, 0.0f, 255.0f));
  return result;
}

}  // namespace

Thumbnails::Thumbnails(std::function<void()> made) : made_(std::move(made)) {}

Thumbnails::~Thumbnails() {
  {
    std::lock_guard lock(mutex_);
    quit_ = true;
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
}

const PictureBytes* Thumbnails::get(const std::string& file) {
  std::lock_guard lock(mutex_);
  const auto [place, fresh] = pictures_.try_emplace(file);
  if (fresh) {
    if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
    wanted_.push_back(file);
    wake_.notify_one();
  }
  return place->second.get();
}

void Thumbnails::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    wake_.wait(lock, [this] { return quit_ || !wanted_.empty(); });
    if (quit_) return;
    const std::string file = std::move(wanted_.back());
    wanted_.pop_back();
    lock.unlock();
    std::unique_ptr<PictureBytes> picture;
    try {
      picture = std::make_unique<PictureBytes>(thumbnail(file));
    } catch (const std::exception&) {
      // It has no picture; choosing it says why.
    }
    lock.lock();
    pictures_[file] = std::move(picture);
    lock.unlock();
    made_();
    lock.lock();
  }
}

}  // namespace lucerna::ui
