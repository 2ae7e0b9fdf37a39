// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "report/coverage_cells.hpp"
#include "report/report.hpp"

namespace vantage {

inline nlohmann::ordered_json point_json(const Vec3& v) { return {v.x, v.y, v.z}; }

// All that the page tells in words, tables and charts. Stations are counted from 0 here, as arrays are.
nlohmann::ordered_json report_json(const Report& report);

// One network of it.
nlohmann::ordered_json network_json(const Evaluation& network, std::span<const Requirement> requirements = {});

// What a view of a site shows whatever its stations: mesh, storeys, and the cells' places where there are any.
nlohmann::ordered_json site_json(const Simulator& simulator, const SearchArea& area,
                                 std::span<const PlacedStation> stations, const CoverageCells& cells);

// All that the view in three dimensions shows besides: the mesh, the cells and their colours for each network.
nlohmann::ordered_json view_json(const Report& report, Simulator& simulator, const SearchArea& area,
                                 const Progress& progress);

}  // namespace vantage
