// SPDX-License-Identifier: Apache-2.0
// Draws the predicted registration error on the surface.

#include <algorithm>
#include <string>
#include <vector>

#include "core/text.hpp"
#include "map/voxel_errors.hpp"
#include "map/voxel_map.hpp"
#include "vantage/pictures.hpp"

namespace vantage {
namespace {

constexpr Colour kUnseen{0.86, 0.86, 0.87};
// More voxels than a picture has pixels for.
constexpr std::uint64_t kMostDrawn = 200'000;

}  // namespace

void draw_registration(const std::filesystem::path& file, Site& site, const VoxelField& field,
                       const RegistrationError& error, std::span<const PlacedStation> stations,
                       const std::string& title) {
  const Simulator& simulator = site.simulator();
  require_stations_of(simulator, field);
  const std::vector<std::uint32_t> sample = simulator.sampled_voxels(std::min(kMostDrawn, simulator.voxel_count()));
  const std::vector<float> errors = voxel_errors_mm(simulator, field, error, sample);
  const double most = largest_error_mm(errors);
  // The worst on top, so that nothing hides it.
  std::vector<std::size_t> order(sample.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return errors[k]; });
  std::vector<ColouredVoxel> voxels;
  for (const std::size_t k : order)
    voxels.push_back({sample[k], errors[k] < 0 ? kUnseen : ramp(kRisingRamp, static_cast<double>(errors[k]) / most)});
  const auto legend = [&](Canvas& canvas, Point at) {
    canvas.text(at, "Predicted error", {.size = 12.5, .bold = true});
    canvas.text({at.x, at.y + 17}, "one sigma, after registration", {.size = 12.5});
    at.y += 38;
    constexpr int kSteps = 60;
    constexpr double kHeight = 150;
    for (int step = 0; step < kSteps; ++step)
      canvas.fill({at.x, at.y + kHeight * (kSteps - 1 - step) / kSteps, 24, kHeight / kSteps + 0.5},
                  ramp(kRisingRamp, (step + 0.5) / kSteps));
    for (const double share : {0.0, 0.5, 1.0})
      canvas.text({at.x + 34, at.y + kHeight * (1 - share)}, fixed(share * most, most < 10 ? 1 : 0) + " mm",
                  {.size = 12.5});
    at.y += kHeight + 24;
    canvas.fill({at.x, at.y - 7, 24, 14}, kUnseen);
    canvas.text({at.x + 34, at.y}, "not seen", {.size = 12.5});
    return Point{at.x, at.y + 24};
  };
  constexpr double kLegend = 230;
  draw_voxel_map(file, site, voxels, stations, title, "Surveyed surfaces from above, the largest error on top", kLegend,
                 legend);
}

}  // namespace vantage
