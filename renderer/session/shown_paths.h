#pragma once
// Which recorded paths are drawn over the picture.
#include <memory>

#include "recording/recording.h"

namespace lucerna::session {

/// What is shown of a recording.
struct ShownPaths {
  std::shared_ptr<const recording::Recording> of = {};  ///< null: nothing
  int path = -1;                                        ///< followed one, index in the recording; -1: none
  int vertex = -1;                                      ///< its marked event; -1: none
};

}  // namespace lucerna::session
