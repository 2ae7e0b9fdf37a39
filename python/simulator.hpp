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
  std::mutex making = {};
  std::optional<Simulator> of_all_surfaces = std::nullopt;

  /// Made at first use.
  Simulator& surroundings() {
    const std::lock_guard lock(making);
    if (!of_all_surfaces) of_all_surfaces = surroundings_of(simulator);
    return *of_all_surfaces;
  }
  bool set_scene(const Scene& scene) {
    if (!owned)
      throw Error(Errc::invalid_argument,
                  "the simulator of a site keeps the site's scene; make a Simulator of the scene, or another Site");
    const bool kept = simulator.set_scene(scene);
    of_all_surfaces.reset();
    return kept;
  }
};

}  // namespace vantage::python
