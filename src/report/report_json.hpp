// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "report/coverage_cells.hpp"
#include "report/report.hpp"

namespace vantage {

inline nlohmann::ordered_json point_json(const Vec3& v) { return {v.x, v.y, v.z}; }

// Returns words, tables and charts of the page. Stations are counted from 0 here, like arrays.
nlohmann::ordered_json report_json(const Report& report);

// One network of a report.
nlohmann::ordered_json network_json(const Evaluation& network, std::span<const Requirement> requirements = {});

// Returns the part of a view that does not depend on stations: mesh, storeys, and the places of cells, if any.
nlohmann::ordered_json site_json(Site& site, std::span<const PlacedStation> stations, const CoverageCells& cells);

// Returns the rest of the view in three dimensions: the mesh, the cells and their colours for each network.
nlohmann::ordered_json view_json(const Report& report, Site& site, const Progress& progress);

}  // namespace vantage
