// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "vantage/station_files.hpp"

namespace vantage {

// DXF (release 12, ASCII), metres, survey frame. Layers: STATIONS, STATIONS_KEPT and STATIONS_LEFT_OUT (a point and a
// circle below the tripod), STATION_NAMES (text), LINKS (lines between the grounds of linked stations), SEARCH_AREA
// (closed polylines: its outline and its holes). `links`: of these stations, or without values. Throws Error: io,
// invalid_argument (sizes that do not match).
void write_stations_dxf(const std::filesystem::path& file, const NamedStations& stations, const StationLinks& links,
                        const SearchArea& area);

}  // namespace vantage
