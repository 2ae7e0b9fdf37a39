// SPDX-License-Identifier: Apache-2.0
/// Progress reports of long work, and how to stop it.
#pragma once

#include <functional>
#include <stop_token>

namespace vantage {

/// Passed by value to every call that may take long. Both members may be empty.
struct Progress {
  /// Called between chunks of work, on the calling thread, with the share done in [0, 1]. An exception from it ends the
  /// call and is passed on.
  std::function<void(double done)> report = {};
  /// Checked between chunks of work. A stopped call says so in its result.
  std::stop_token stop = {};

  /// Reports the share done, if anybody listens.
  void operator()(double done) const {
    if (report) report(done);
  }
  bool stopped() const { return stop.stop_requested(); }  ///< True once the caller wants the work to stop.
};

}  // namespace vantage
