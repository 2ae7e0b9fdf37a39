// SPDX-License-Identifier: Apache-2.0
// Surveyed voxels from above in colours, with the stations: what a legend beside it explains.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>

#include "export/canvas.hpp"
#include "vantage/placement.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

struct ColouredVoxel {
  std::uint32_t rank;
  Colour colour;
};

// Later ones lie over earlier ones; each stands for its neighbours too where there are fewer than the site has.
// `legend` draws below `at` and returns where it ends; the mark of a station is put there. REQUIRES: voxels.
void draw_voxel_map(const std::filesystem::path& file, const Simulator& simulator,
                    std::span<const ColouredVoxel> voxels, std::span<const PlacedStation> stations,
                    const std::string& title, const std::string& subtitle,
                    const std::function<Point(Canvas& canvas, Point at)>& legend);

}  // namespace vantage
