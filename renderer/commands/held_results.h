#pragma once
// Results that are held for comparison, and how one of them is compared with the live picture. View state:
// nothing of it changes a picture.
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "session/held_picture.h"
#include "session/session.h"

namespace lucerna::commands {

struct HeldResult {
  std::string name;    ///< unique
  std::string camera;  ///< name of the scene's camera that it was rendered with; "": another view
  std::shared_ptr<const session::HeldPicture> picture;
  uint64_t id = 0;  ///< no other result has or had it
};

/// Why the held result cannot be laid over the picture, as a sentence: another size, scene or view. "" if it
/// can. Scene and view of a file are compared if they are known.
std::string why_not_comparable(const HeldResult& held, const session::Snapshot& picture,
                               const std::string& scene);

enum class CompareView { off, wipe, flip, difference };
/// Their names, in that order.
extern const std::vector<std::string> k_compare_views;

class HeldResults {
 public:
  static constexpr size_t k_most = 8;  ///< results that can be held; each takes a vec3 per pixel

  /// In the order in which they were held.
  const std::vector<HeldResult>& list() const { return list_; }
  /// The result of that name. Throws Error, with a suggestion, if there is none.
  const HeldResult& named(const std::string& name) const;
  /// Throws Error if as many are held as can be, or if the name is taken.
  void needs_room(const std::string& name = "") const;

  /// Holds a picture; without a name, under that of its file, its methods or `fallback`, with a number if
  /// that name is taken.
  /// The first one is compared with the live picture. Throws Error like needs_room().
  void add(std::string name, const std::string& fallback, const std::string& camera,
           std::shared_ptr<const session::HeldPicture> picture);
  void forget(const std::string& name);  ///< throws Error like named()
  void forget_all();
  void rename(const std::string& from, const std::string& to);  ///< throws Error: not there, or taken

  /// The result that is compared with the live picture; null: none.
  const HeldResult* compared() const;
  void compare_with(const std::string& name);  ///< "": none. Throws Error like named()
  CompareView view() const { return view_; }
  /// Throws Error if a view other than off has no result to show.
  void set_view(CompareView view);

  float wipe_at = 0.5f;  ///< place of the wipe's line, 0..1 to the right; the held result is to its left
  float difference_times = 10.0f;  ///< factor of the difference

 private:
  size_t index_of(const std::string& name) const;
  bool taken(const std::string& name) const;
  void needs_free(const std::string& name) const;  ///< throws Error if the name is taken

  std::vector<HeldResult> list_;
  uint64_t compared_ = 0;  ///< id; 0: none
  uint64_t ids_ = 0;
  CompareView view_ = CompareView::off;
};

}  // namespace lucerna::commands
