// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>
#include <thread>

namespace vantage::cli {

// Turns the first SIGINT or SIGTERM into a stop request, after which work ends in good order; the second ends the program at once.
// Make it before any other thread: threads inherit the blocked signals.
class Interrupts {
 public:
  Interrupts();
  std::stop_token token() const { return source_.get_token(); }

 private:
  std::stop_source source_;
  std::jthread watcher_;
};

}  // namespace vantage::cli
