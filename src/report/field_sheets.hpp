// SPDX-License-Identifier: Apache-2.0
// The maps that a crew carries: each storey at a round ratio.
#pragma once

#include <stop_token>
#include <string>
#include <vector>

#include "report/report.hpp"
#include "report/sheet.hpp"
#include "report/station_facts.hpp"

namespace vantage {

struct FieldSheets {
  std::vector<Sheet> sheets = {};
  std::vector<std::string> names = {};       // of each sheet: "Level 1 of 2, sheet B1"
  std::vector<std::size_t> of_station = {};  // the sheet that shows it best, from 1; 0: none does
};

// Draws each level that has a station, from the lowest, with an overview before several sheets of one level. A stop
// leaves out sheets not yet begun.
FieldSheets field_sheets(const Report& report, const std::vector<StationFacts>& facts,
                         const std::vector<TargetFacts>& of_targets, Site& site, const std::stop_token& stop);

}  // namespace vantage
