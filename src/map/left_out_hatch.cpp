// SPDX-License-Identifier: Apache-2.0
#include "map/left_out_hatch.hpp"

#include <array>
#include <atomic>
#include <cmath>

namespace vantage {
namespace {

constexpr std::size_t kPeriod = 22, kStripe = 4;  // pixels, along a row

}  // namespace

bool hatch_left_out(std::vector<std::uint32_t>& pixels, const HeightBuffer& heights, double origin_z,
                    std::span<const LeftOut> left_out, const PlanLevel* level, const SearchMesh& ground) {
  const MapWindow& window = heights.window;
  std::vector<std::uint8_t> shows(pixels.size(), 0);
  std::atomic<bool> any = false;
  for_row_bands(window, [&](const RowBand& band) {
    const auto mark = [&](const auto& mesh, std::uint8_t as) {
      const auto put = [&](std::size_t pixel, double z) {
        if (std::abs(double{heights.z[pixel]} - z) <= kHidden_m) shows[pixel] = as;
      };
      for (const auto& t : mesh.triangles) {
        const double middle = (mesh.positions[t[0]].z + mesh.positions[t[1]].z + mesh.positions[t[2]].z) / 3;
        if (!level || level->holds(middle)) for_each_pixel(window, mesh, t, -origin_z, put, band);
      }
    };
    for (const LeftOut& part : left_out) mark(part, 1);
    mark(ground, 0);
    for (std::size_t k = band.first * window.columns; k < band.end * window.columns; ++k) {
      if (!shows[k]) continue;
      any = true;
      if ((k % window.columns + k / window.columns) % kPeriod < kStripe)
        pixels[k] = laid_over(pixels[k], kLeftOutTint, kLeftOutOpacity);
    }
  });
  return any;
}

}  // namespace vantage
