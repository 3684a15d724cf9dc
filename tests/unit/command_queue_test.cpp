// links: session
// The queue of a session's commands.
#include "session/command_queue.h"

#include <catch2/catch.hpp>

namespace command_queue_tests {

using lucerna::session::Command;
using lucerna::session::CommandQueue;

TEST_CASE("of the steps of a drag only the last is carried out, under one number") {
  CommandQueue<int> queue;
  const auto push = [&](int adds, uint64_t replaces, uint64_t scene = 1) {
    queue.push({.run = [adds](int& sum) { sum = 10 * sum + adds; }, .scene = scene, .replaces = replaces});
    return queue.given();
  };
  CHECK(push(1, 7) == 1);
  CHECK(push(2, 7) == 1);     // replaces it
  CHECK(push(3, 8) == 2);     // of another thing
  CHECK(push(4, 7) == 3);     // no longer consecutive
  CHECK(push(5, 7, 2) == 4);  // for another scene
  CHECK(push(6, 0) == 5);
  CHECK(push(7, 0) == 6);
  int sum = 0;
  while (!queue.empty()) queue.pop().run(sum);
  CHECK(sum == 234567);
}

}  // namespace command_queue_tests
