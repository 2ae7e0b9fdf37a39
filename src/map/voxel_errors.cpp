// SPDX-License-Identifier: Apache-2.0
#include "map/voxel_errors.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/parallel.hpp"
#include "vantage/error.hpp"

namespace vantage {

void require_stations_of(const Simulator& simulator, const VoxelField& field) {
  const std::uint64_t voxels = simulator.voxel_count();
  if (field.stations.voxels() != voxels)
    throw Error(Errc::invalid_argument, "registration map: the voxel field has stations of " +
                                            std::to_string(field.stations.voxels()) + " voxels, the scene " +
                                            std::to_string(voxels) + " surveyed ones");
}

std::vector<float> voxel_errors_mm(const Simulator& simulator, const VoxelField& field, const RegistrationError& error,
                                   std::span<const std::uint32_t> voxels) {
  std::vector<float> found(voxels.size());
  parallel::for_all(std::size_t{0}, voxels.size(), [&](std::size_t k) {
    const Vec3 place = simulator.voxel_centre(voxels[k]) - simulator.origin();
    double squares = 0;
    int seen = 0;
    field.stations.for_each_station(voxels[k], [&](std::size_t station) {
      const double one = error.at(station, place);
      squares += one * one;
      ++seen;
    });
    found[k] = seen > 0 ? static_cast<float>(1000 * std::sqrt(squares / seen)) : -1;
  });
  return found;
}

double largest_error_mm(std::span<const float> errors) {
  const double most = errors.empty() ? 0 : static_cast<double>(*std::ranges::max_element(errors));
  return most > 0 ? most : 1;
}

}  // namespace vantage
