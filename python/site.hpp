// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <vector>

#include "casters.hpp"
#include "simulator.hpp"

namespace vantage::python {

/// A site, which serves one plan or other long call at a time, and answers about places and networks beside it. Results
/// of its plans keep it alive.
struct GuardedSite {
  Site site;
  std::mutex mutex = {};
  std::shared_mutex settled = {};                       ///< Alone while a question may change the site's scanners.
  std::mutex making = {};                               ///< Guards `simulators`.
  std::optional<Simulators> simulators = std::nullopt;  ///< Made when it is first asked for.

  /// For the time of a call that no other of its kind runs beside. Throws Error invalid_argument if one does.
  std::unique_lock<std::mutex> taken() {
    std::unique_lock lock(mutex, std::try_to_lock);
    if (!lock)
      throw Error(Errc::invalid_argument,
                  "the site is in use by another call, beside which it answers place_heads, nearest_place and evaluate "
                  "alone: open a site for each thread");
    return lock;
  }
  /// For a call that runs beside others. REQUIRES: not the interpreter's lock, for which another of them may wait.
  std::shared_lock<std::shared_mutex> beside() { return std::shared_lock(settled); }
};

/// Places stations given by heads alone as the program does: on the ground below, with checks.
std::vector<PlacedStation> placed_on(Site& site, std::vector<PlacedStation> stations);

}  // namespace vantage::python
