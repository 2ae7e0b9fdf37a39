// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "long_call.hpp"

namespace vantage::python {

/// A simulator, of its own or of a site, and its companion over all surfaces.
struct Simulators {
  explicit Simulators(Simulator own) : owned(std::move(own)), simulator(*owned) {}
  /// Borrows the site's.
  explicit Simulators(Site& of) : site(&of), simulator(of.simulator()) {}

  Site* site = nullptr;
  std::optional<Simulator> owned;
  Simulator& simulator;
  std::mutex making = {};
  std::optional<Simulator> of_all_surfaces = std::nullopt;

  /// Made at first use.
  Simulator& surroundings() {
    if (site) return site->surroundings();
    const std::lock_guard lock(making);
    if (!of_all_surfaces) of_all_surfaces = surroundings_of(simulator);
    return *of_all_surfaces;
  }
  bool set_scene(const Scene& scene) {
    refuse_of_site("scene");
    const bool kept = simulator.set_scene(scene);
    of_all_surfaces.reset();
    return kept;
  }
  void set_scanners(const std::vector<Scanner>& scanners) {
    refuse_of_site("scanners");
    simulator.set_scanners(scanners);
    of_all_surfaces.reset();
  }

 private:
  void refuse_of_site(const std::string& what) const {
    if (site)
      throw Error(Errc::invalid_argument, "the simulator of a site keeps the site's " + what +
                                              "; make a Simulator of the scene, or another Site");
  }
};

}  // namespace vantage::python
