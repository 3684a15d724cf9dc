#include "commands/held_results.h"

#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "commands/text.h"
#include "scene/view_text.h"

namespace lucerna::commands {

const std::vector<std::string> k_compare_views{"off", "wipe", "flip", "difference"};

std::string why_not_comparable(const HeldResult& held, const session::Snapshot& picture,
                               const std::string& scene) {
  const session::HeldPicture& other = *held.picture;
  if (!other.scene.empty() && other.scene != scene)
    return fmt::format("'{}' is of the scene '{}', the picture of '{}'", held.name, other.scene, scene);
  if (other.width != picture.width || other.height != picture.height)
    return fmt::format("'{}' has {} x {} pixels, the picture {} x {}; they must be of one size", held.name,
                       other.width, other.height, picture.width, picture.height);
  if (!other.view.empty() && other.view != scene::view_text(picture.camera))
    return fmt::format("'{}' shows another view{}", held.name,
                       held.camera.empty() ? "" : fmt::format(" (camera '{}')", held.camera));
  return "";
}

size_t HeldResults::index_of(const std::string& name) const {
  const auto found =
      std::find_if(list_.begin(), list_.end(), [&](const HeldResult& held) { return held.name == name; });
  return static_cast<size_t>(found - list_.begin());
}

bool HeldResults::taken(const std::string& name) const { return index_of(name) < list_.size(); }

const HeldResult& HeldResults::named(const std::string& name) const {
  if (list_.empty()) throw Error("", "no result is held; compare.hold holds the picture");
  if (!taken(name))
    throw Error("",
                fmt::format("no held result is named '{}'{}", name, suggestion(name, given_names(list_))));
  return list_[index_of(name)];
}

void HeldResults::needs_room(const std::string& name) const {
  if (list_.size() >= k_most)
    throw Error("", fmt::format("{} results are held already; forget one of them first (compare.forget {})",
                                k_most, quote(list_.front().name)));
  if (!name.empty()) needs_free(name);
}

void HeldResults::needs_free(const std::string& name) const {
  if (taken(name))
    throw Error("", fmt::format("a held result is named '{}' already; choose another name", name));
}

void HeldResults::add(std::string name, const std::string& fallback, const std::string& camera,
                      std::shared_ptr<const session::HeldPicture> picture) {
  needs_room(name);
  if (name.empty()) {
    const std::string methods = session::methods_text(picture->methods);
    const std::string base = !picture->file.empty() ? std::filesystem::path(picture->file).stem().string()
                             : methods.empty()      ? fallback
                                                    : methods;
    name = base;
    for (int number = 2; taken(name); ++number) name = fmt::format("{} {}", base, number);
  }
  list_.push_back({name, camera, std::move(picture), ++ids_});
  if (compared_ == 0) compared_ = ids_;
}

void HeldResults::forget(const std::string& name) {
  const uint64_t id = named(name).id;
  std::erase_if(list_, [&](const HeldResult& held) { return held.id == id; });
  if (compared_ == id) compared_ = 0, view_ = CompareView::off;
}

void HeldResults::forget_all() { list_.clear(), compared_ = 0, view_ = CompareView::off; }

void HeldResults::rename(const std::string& from, const std::string& to) {
  const size_t index = static_cast<size_t>(&named(from) - list_.data());
  if (to.empty()) throw Error("", "expected a name");
  if (to != from) needs_free(to);
  list_[index].name = to;
}

const HeldResult* HeldResults::compared() const {
  const auto found =
      std::find_if(list_.begin(), list_.end(), [&](const HeldResult& held) { return held.id == compared_; });
  return found == list_.end() ? nullptr : &*found;
}

void HeldResults::compare_with(const std::string& name) {
  if (name.empty()) {
    compared_ = 0, view_ = CompareView::off;
    return;
  }
  compared_ = named(name).id;
}

void HeldResults::set_view(CompareView view) {
  if (view != CompareView::off && !compared()) {
    if (list_.empty()) throw Error("", "no result is held; compare.hold holds the picture");
    throw Error("", "no held result is chosen; compare.with NAME chooses one");
  }
  view_ = view;
}

}  // namespace lucerna::commands
