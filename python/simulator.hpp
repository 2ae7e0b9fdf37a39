// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <optional>

#include "long_call.hpp"

namespace vantage::python {

/// A simulator, and its companion over all surfaces.
struct Simulators {
  Simulator simulator;
  std::once_flag made = {};
  std::optional<Simulator> of_all_surfaces = std::nullopt;

  /// Made at first use.
  Simulator& surroundings() {
    std::call_once(made, [&] { of_all_surfaces = surroundings_of(simulator); });
    return *of_all_surfaces;
  }
};

}  // namespace vantage::python
