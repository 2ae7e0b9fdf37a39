// SPDX-License-Identifier: Apache-2.0
/// Files of the next stations, as `vantage next` writes them.
#pragma once

#include <filesystem>
#include <string>

#include "vantage/site.hpp"
#include "vantage/taken_scans.hpp"

namespace vantage {

/// Returns the text of `next.json`. `found`: the site as it was found, from which the answer came.
std::string next_json(const Day& day, const Site& found);

/// Writes next.json, stations.csv and stations.dxf of the next stations, and plan.png with the scans as existing
/// stations, and makes the folder if needed. Throws Error io.
void write_next(const std::filesystem::path& folder, const Day& day, Site& found);

}  // namespace vantage
