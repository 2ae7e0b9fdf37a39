// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "vantage/on_site.hpp"
#include "vantage/scanner.hpp"

namespace vantage {

// Throws Error invalid_argument for crews without a day that they share, and for a day that is too short for a station
// with any of the scanners.
void check_day(const OnSiteOptions& options, std::span<const Scanner> scanners);

}  // namespace vantage
