// SPDX-License-Identifier: Apache-2.0
// Distance of a plan from the best with its number of stations.
#pragma once

#include <filesystem>

#include "cli/command.hpp"
#include "cli/site.hpp"

namespace vantage::cli {

// What candidates capture together of what is attainable, by their columns.
Estimate captured_by(const AttainableCounts& attainable, const CoverageMatrix& matrix,
                     std::span<const std::size_t> chosen);

// Bounds what any network of as many stations captures, the first `kept` of `stations` given, says how near these come,
// and writes it to `file` as JSON. Of what is attainable, or else coverage.
void prove(const std::filesystem::path& file, Site& site, std::span<const PlacedStation> stations, std::size_t kept,
           bool of_attainable, Program& program);

}  // namespace vantage::cli
