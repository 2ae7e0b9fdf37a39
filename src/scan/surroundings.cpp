// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>
#include <vector>

#include "scene/all_surveyed.hpp"
#include "vantage/simulator.hpp"

namespace vantage {
namespace {

// Voxels of a hundredth to a two-hundredth of the site distinguish a door from a desk, but not bolts. Above half a
// metre, rooms of a large site would merge.
constexpr double kExtentShare = 0.01, kLargestVoxel_m = 0.5;
// Two rays cross a voxel at the far end of the site. Near surfaces get more; oblique ones get fewer, as in a survey.
constexpr double kRaysAcross = 2, kFewestRays = 16;

double extent_of(const Scene& scene) {
  const Vec3 size = scene.bounds().size();
  return std::max({size.x, size.y, size.z});
}

// Returns directions of a list that are a step apart on average, or all if they are no denser.
std::vector<RayAngles> thinned(const Scanner& scanner, Angle step) {
  const double part = step.in_radians() / scanner.azimuth_step.in_radians();
  const auto stride = static_cast<std::size_t>(std::max(part * part, 1.0));
  std::vector<RayAngles> some;
  for (std::size_t k = 0; k < scanner.directions.size(); k += stride) some.push_back(scanner.directions[k]);
  return some;
}

}  // namespace

Simulator surroundings_of(const Simulator& simulator, bool through_glass) {
  const Scene scene = all_surveyed(simulator.scene(), through_glass);
  const double extent = extent_of(scene);
  SimulatorConfig config = simulator.config();
  if (config.devices.empty()) {
    config.engine = simulator.engine().engine;
    config.device_index = simulator.engine().device_index;
  }
  config.user_size_m = std::max(simulator.voxel_size_m(), std::min(kExtentShare * extent, kLargestVoxel_m));
  config.point_spacing_m = config.user_size_m / 4;  // the goal is not used here, but must be at least 1
  config.noise = false;
  config.max_incidence = std::nullopt;
  if (through_glass) config.shared = nullptr;  // other processes make one simulator of the surroundings

  std::vector<Scanner> scanners(simulator.scanners().begin(), simulator.scanners().end());
  for (Scanner& scanner : scanners) {
    const double reach = std::min(scanner.max_range_m, extent);
    if (!(reach > 0)) continue;
    const Angle step = Angle::radians(config.user_size_m / 2 / (kRaysAcross * reach));
    // At least a few rays, even if the sweep is narrow.
    const auto coarser = [&](Angle own, Angle sweep) {
      return std::max(own, std::min(step, Angle::radians(sweep.in_radians() / kFewestRays)));
    };
    if (!scanner.directions.empty()) {
      scanner.set_directions(thinned(scanner, coarser(scanner.azimuth_step, scanner.horizontal_angle)));
      continue;
    }
    scanner.set_steps(coarser(scanner.azimuth_step, scanner.horizontal_angle),
                      coarser(scanner.zenith_step, Angle::radians(scanner.vertical_angle.in_radians() / 2)));
  }
  Simulator surroundings(scene, scanners, config);
  surroundings.stand_for(simulator.scanners());
  return surroundings;
}

}  // namespace vantage
