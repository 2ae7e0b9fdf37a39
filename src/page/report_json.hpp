// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "page/report.hpp"

namespace vantage {

// All that the page tells in words, tables and charts. Stations are counted from 0 here, as arrays are.
nlohmann::ordered_json report_json(const Report& report);

// All that the view in three dimensions shows besides: the mesh, the cells and their colours for each network.
nlohmann::ordered_json view_json(const Report& report, const ReportSite& site, const Progress& progress);

}  // namespace vantage
