// SPDX-License-Identifier: Apache-2.0
// Scanners of single stations, besides the site's.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "cli/site.hpp"

namespace vantage::cli {

// Index of a station's scanner in `site.scanners()`, to which it is appended if it is new. `name`: a preset, at the
// site's height; empty or the site's own: the site's. `step`: of azimuth and zenith; empty: its own. Throws Error
// invalid_argument.
std::uint32_t scanner_of(Site& site, const std::string& name, std::optional<Angle> step);

}  // namespace vantage::cli
