// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <stop_token>
#include <thread>

namespace vantage::cli {

// Turns SIGINT, SIGTERM and SIGHUP into requests, SIGPIPE and SIGXFSZ into errors of the write. The first signal asks
// work to end in good order, the second to drop the confirmation as well. A third, or ten seconds without an end after
// the second, kills the program. Make it before any other thread: threads inherit the blocked signals.
class Interrupts {
 public:
  Interrupts();
  std::stop_token stop() const { return stop_.get_token(); }
  std::stop_token abort() const { return abort_.get_token(); }
  // If one of several ranks dies, the others are told to end.
  void one_of_several() { several_ = true; }

 private:
  std::atomic<bool> several_ = false;
  std::stop_source stop_, abort_;
  std::jthread watcher_;
};

}  // namespace vantage::cli
