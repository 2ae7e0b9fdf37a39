// SPDX-License-Identifier: Apache-2.0
// Surveyed voxels in colours in plan view, with the stations and a legend beside them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>

#include "map/canvas.hpp"
#include "vantage/site.hpp"

namespace vantage {

struct ColouredVoxel {
  std::uint32_t index;
  Colour colour;
};

// Draws a map for each level of the site, side by side. On a cut level, surfaces over the heads are left out, walls are
// lines, and surfaces below the floor are covered by all others. Otherwise later voxels cover earlier ones; each stands
// for its neighbours too if there are fewer than the site has. `legend` draws below `at`, `legend_width` wide at most,
// and returns where it ends; the mark of a station follows there. REQUIRES: voxels.
void draw_voxel_map(const std::filesystem::path& file, Site& site, std::span<const ColouredVoxel> voxels,
                    std::span<const PlacedStation> stations, const std::string& title, const std::string& subtitle,
                    double legend_width, const std::function<Point(Canvas& canvas, Point at)>& legend);

}  // namespace vantage
