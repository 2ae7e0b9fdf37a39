// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include "formats/voxel_ply.hpp"
#include "map/voxel_errors.hpp"
#include "vantage/export.hpp"

namespace vantage {

void write_registration_ply(const std::filesystem::path& file, const Simulator& simulator, const VoxelField& field,
                            const RegistrationError& error, PlyCoordinates coordinates) {
  require_stations_of(simulator, field);
  std::vector<std::uint32_t> voxels;
  for (std::uint32_t voxel = 0; voxel < simulator.voxel_count(); ++voxel) {
    bool seen = false;
    field.stations.for_each_station(voxel, [&](std::size_t) { seen = true; });
    if (seen) voxels.push_back(voxel);
  }
  const std::vector<float> errors = voxel_errors_mm(simulator, field, error, voxels);
  const double most = largest_error_mm(errors);
  write_voxel_ply(file, coordinates, simulator, {{"float", "error_mm"}}, voxels.size(),
                  [&](std::uint64_t k, std::string& bytes) {
                    append(bytes, errors[k]);
                    return VoxelVertex{voxels[k], ramp(kRisingRamp, static_cast<double>(errors[k]) / most)};
                  });
}

}  // namespace vantage
