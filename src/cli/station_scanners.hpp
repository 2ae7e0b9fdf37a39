// SPDX-License-Identifier: Apache-2.0
// Scanners of single stations, besides the site's.
#pragma once

#include <cstdint>
#include <string>

#include "cli/parse.hpp"
#include "cli/site.hpp"
#include "import/scans.hpp"

namespace vantage::cli {

// Index of a station's scanner in `site.scanners()`, to which it is appended if it is new. `station.scanner`: a preset,
// at the site's height; empty or the site's own: the site's. `station.step`: of azimuth and, if the view has no other,
// zenith; empty: its own. Throws Error invalid_argument.
std::uint32_t scanner_of(Site& site, const StationText& station);

// The scans of an E57 file as stations, each with the settings that its points tell as far as they differ from its
// scanner's: that of its preset if the file names one, otherwise the site's. Tells in the log what each scan was made
// with, and what is assumed. Throws Error as importers::taken_scans().
std::vector<StationText> stations_of_scans(Site& site, const std::string& file, Program& program);

}  // namespace vantage::cli
