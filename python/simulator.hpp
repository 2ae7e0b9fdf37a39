// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <optional>
#include <utility>

#include "long_call.hpp"

namespace vantage::python {

/// A simulator, of its own or of a site, and its companion over all surfaces.
struct Simulators {
  explicit Simulators(Simulator own) : owned(std::move(own)), simulator(*owned) {}
  /// Borrows the site's.
  explicit Simulators(Site& site) : simulator(site.simulator()) {}

  std::optional<Simulator> owned;
  Simulator& simulator;
  std::once_flag made = {};
  std::optional<Simulator> of_all_surfaces = std::nullopt;

  /// Made at first use.
  Simulator& surroundings() {
    std::call_once(made, [&] { of_all_surfaces = surroundings_of(simulator); });
    return *of_all_surfaces;
  }
};

}  // namespace vantage::python
