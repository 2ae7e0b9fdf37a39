// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "casters.hpp"
#include "simulator.hpp"

namespace vantage::python {

/// A site, which serves one call at a time. Results of its plans keep it alive.
struct GuardedSite {
  Site site;
  std::mutex mutex = {};
  std::optional<Simulators> simulators = std::nullopt;  ///< Made when it is first asked for.

  /// For the time of one call, since a site makes its parts at first use. Throws Error invalid_argument if another call
  /// uses it.
  std::unique_lock<std::mutex> taken() {
    std::unique_lock lock(mutex, std::try_to_lock);
    if (!lock) throw Error(Errc::invalid_argument, "the site is in use by another call: open one for each thread");
    return lock;
  }
};

/// Places stations given by heads alone as the program does: on the ground below, with checks.
std::vector<PlacedStation> placed_on(Site& site, const py::object& stations);

}  // namespace vantage::python
