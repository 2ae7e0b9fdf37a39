// SPDX-License-Identifier: Apache-2.0
// What is known of poses and surfaces before scans are registered, from options.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>

#include "vantage/measure.hpp"

namespace vantage::cli {

struct RegistrationCliOptions {
  std::optional<double> rho_m, patch_m, position_m, heading_deg, tilt_deg;
  RegistrationSurfaces surfaces = RegistrationSurfaces::surveyed;

  void add(CLI::App& command);
  RegistrationOptions settle() const;
};

}  // namespace vantage::cli
