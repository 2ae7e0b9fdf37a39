// SPDX-License-Identifier: Apache-2.0
// Scanners of single stations, besides the one that the options are of.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cli/site.hpp"

namespace vantage::cli {

// Index of a station's scanner in `site.scanners`, where it is added if need be. `name`: a preset, at the site's
// height; empty or the site's own: the site's. `step`: of azimuth and zenith; empty: its own. Throws Error
// invalid_argument.
std::uint32_t scanner_of(LoadedSite& site, const std::string& name, std::optional<Angle> step);

// Of the site's scanner with each of these steps: in degrees, or as a setting of the preset that `site_preset` names.
std::vector<std::uint32_t> scanners_with(LoadedSite& site, const std::string& site_preset,
                                         std::span<const std::string> steps);

}  // namespace vantage::cli
