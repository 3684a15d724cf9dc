#pragma once
// How good the displayed picture is, in words: one text for the menu bar and the Accuracy panel.
#include <string>
#include <vector>

#include "session/session.h"

namespace lucerna::ui {

/// True if a part of the picture that counts is light from before the last edit.
bool shows_former(const session::Snapshot& snapshot);

/// "7.2 % off, worst tenth 18 %": the median tile's error and the error that a tenth of the tiles exceed.
/// With light from before the last edit "12 % off, 42 % from before the edit", with light of the preview
/// during preparation "12 % off, 42 % from the preview". Shorter texts follow, for less room. Empty: the
/// picture is its samples, whose noise the Accuracy panel plots.
std::vector<std::string> shown_texts(const session::Snapshot& snapshot);
/// ": usable"; ": usable, still coarse" before the first sample at full resolution; ", usable in about 3 s",
/// as errors fall with the square root of the time after preparation;
/// ", not usable yet" during preparation; "" without an error.
std::string usable_text(const session::Snapshot& snapshot);
/// Why the picture stays black or as it was before an edit: rendering is paused without a sample. ""
/// otherwise.
std::string paused_text(const session::Snapshot& snapshot);

}  // namespace lucerna::ui
