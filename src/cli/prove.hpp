// SPDX-License-Identifier: Apache-2.0
// How near a plan comes to the best that its number of stations can do.
#pragma once

#include <filesystem>

#include "cli/command.hpp"
#include "cli/site.hpp"

namespace vantage::cli {

// Bounds what any network of as many stations captures, the first `kept` of `stations` given, says how near these come,
// and writes it to `file` as JSON.
void prove(const std::filesystem::path& file, Site& site, Simulator& simulator, std::span<const PlacedStation> stations,
           std::size_t kept, Program& program);

}  // namespace vantage::cli
