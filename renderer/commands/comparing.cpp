#include "commands/comparing.h"

#include "base/error.h"
#include "base/figures.h"
#include "base/future.h"
#include "base/log.h"

namespace lucerna::commands {

void Comparing::read(const std::string& file, const std::string& name) {
  const auto reading = std::make_shared<Reading>();
  reading->file = file;
  std::shared_future picture =
      std::async(std::launch::async, [reading] {
        const auto stop = [&](double done) {
          reading->done = done;
          return reading->cancelled.load();
        };
        return std::make_shared<const session::HeldPicture>(session::read_held_picture(reading->file, stop));
      }).share();
  holding = Holding{std::move(picture), name, "", reading};
}

bool Comparing::cancel() {
  if (!holding || !holding->reading) return false;
  holding->reading->cancelled = true;
  return true;
}

void Comparing::take_held(const OpenScene& open) {
  if (!holding || !is_ready(holding->picture)) return;
  const Holding held = *holding;
  holding.reset();
  if (held.reading && held.reading->cancelled)
    return log::info("{}: not held: cancelled", held.reading->file);
  try {
    const std::shared_ptr<const session::HeldPicture> picture = held.picture.get();
    const session::Snapshot* s = open.snapshot.get();
    if (held.reading && s && s->width > 0 && (s->width != picture->width || s->height != picture->height))
      throw_error(held.reading->file, "{} x {} pixels, the picture has {} x {}; they must be of one size",
                  picture->width, picture->height, s->width, s->height);
    results.add(held.name, "result", held.camera, picture);
  } catch (const std::exception& error) {
    return log::error("{}: {}", held.reading ? "compare.load" : "compare.hold", error.what());
  }
  const HeldResult& added = results.list().back();
  const session::HeldPicture& p = *added.picture;
  std::string facts;
  const auto add = [&](const std::string& part) { facts += (facts.empty() ? "" : ", ") + part; };
  if (p.samples > 0) add(fmt::format("{:.0f} samples", p.samples));
  if (p.seconds > 0) add(seconds_text(p.seconds));
  if (p.error) add(fmt::format("error {:.3g}", *p.error));
  if (p.displayed)
    add("display colours of a file, compared as they are");
  else if (p.is_foreign)
    add("of a file without methods, time and error");
  log::info("held as '{}': {}", added.name, facts);
}

void Comparing::refresh(const OpenScene& open) {
  take_held(open);
  live.follow(open, results.compared());
}

}  // namespace lucerna::commands
