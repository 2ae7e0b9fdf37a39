// SPDX-License-Identifier: Apache-2.0
/// How long work reports how far it is, and how it is told to stop.
#pragma once

#include <functional>
#include <stop_token>

namespace vantage {

/// Passed by value into every call that may take long. Both members may be left empty.
struct Progress {
  /// Called between chunks of work, on the calling thread, with the share done in [0, 1]. May throw: that ends the
  /// call, and leaves it as it is.
  std::function<void(double done)> report;
  /// Checked between chunks of work. A call that was stopped says so in its result.
  std::stop_token stop;

  void operator()(double done) const {
    if (report) report(done);
  }
  bool stopped() const { return stop.stop_requested(); }
};

}  // namespace vantage
