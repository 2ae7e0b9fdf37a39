// SPDX-License-Identifier: Apache-2.0
// Distance of a plan from the best with its number of stations.
#pragma once

#include <filesystem>

#include "cli/command.hpp"
#include "cli/site.hpp"

namespace vantage::cli {

// Bounds the coverage of any network of as many stations with the first `kept` of `stations`, reports how near the plan
// comes, and writes the result to `file` as JSON.
void prove(const std::filesystem::path& file, Site& site, Simulator& simulator, std::span<const PlacedStation> stations,
           std::size_t kept, Program& program);

}  // namespace vantage::cli
