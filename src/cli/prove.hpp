// SPDX-License-Identifier: Apache-2.0
// Distance of a plan from the best with its number of stations.
#pragma once

#include <filesystem>

#include "cli/command.hpp"
#include "cli/site.hpp"

namespace vantage::cli {

// Returns the captured share of attainable coverage of a choice of candidates, by their columns.
Estimate captured_by(const AttainableCounts& attainable, const CoverageMatrix& matrix,
                     std::span<const std::size_t> chosen);

// Bounds the captured share of any network with as many stations, the first `kept` of them given, or else its coverage.
// Logs how near these stations come, and writes it to `file` as JSON.
void prove(const std::filesystem::path& file, Site& site, std::span<const PlacedStation> stations, std::size_t kept,
           bool of_attainable, Program& program);

}  // namespace vantage::cli
