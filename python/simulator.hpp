// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "long_call.hpp"

namespace vantage::python {

/// A simulator, and who is using it: see `Busy`.
struct GuardedSimulator {
  Simulator simulator;
  std::mutex mutex = {};
  std::optional<Simulator> of_all_surfaces = std::nullopt;

  /// The same over all surfaces, made when it is first asked for. Only while `mutex` is held.
  Simulator& surroundings() {
    if (!of_all_surfaces) of_all_surfaces = surroundings_of(simulator);
    return *of_all_surfaces;
  }
};

}  // namespace vantage::python
