// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "formats/voxel_ply.hpp"
#include "scan/captured_share.hpp"
#include "vantage/error.hpp"
#include "vantage/export.hpp"

namespace vantage {

void write_coverage_ply(const std::filesystem::path& file, const Simulator& simulator, const VoxelField& field,
                        PlyCoordinates coordinates) {
  if (file.extension() != ".ply")
    throw Error(Errc::invalid_argument,
                "the cartography's counts and stations of each voxel need a .ply file, not " + file.string());
  const std::uint64_t voxels = simulator.voxel_count();
  if (field.count.size() != voxels || (!field.stations.empty() && field.stations.voxels() != voxels))
    throw Error(Errc::invalid_argument, "the voxel field has " + std::to_string(field.count.size()) +
                                            " counts, the scene " + std::to_string(voxels) + " surveyed voxels");
  const std::size_t words = field.stations.words();
  std::vector<PlyProperty> more{{"float", "ratio"}, {"uint", "count"}};
  // PLY has no 64-bit integer: one word has bits of stations 1 to 32, the other of 33 to 64. Bits of a thousand
  // stations would be gigabytes.
  if (words == 1) more.push_back({"uint", "stations_low"}), more.push_back({"uint", "stations_high"});
  if (words > 1) more.push_back({"uint", "stations"});
  write_voxel_ply(file, coordinates, simulator, more, voxels, [&](std::uint64_t voxel, std::string& bytes) {
    const double ratio = captured_share(simulator, static_cast<std::uint32_t>(voxel), field.count[voxel]);
    append(bytes, static_cast<float>(ratio));
    append(bytes, field.count[voxel]);
    if (words == 1) {
      append(bytes, static_cast<std::uint32_t>(field.stations.word(0, voxel)));
      append(bytes, static_cast<std::uint32_t>(field.stations.word(0, voxel) >> 32));
    } else if (words > 1) {
      std::uint32_t seen = 0;
      field.stations.for_each_station(voxel, [&](std::size_t) { ++seen; });
      append(bytes, seen);
    }
    return VoxelVertex{static_cast<std::uint32_t>(voxel), ramp(kCoverageRamp, ratio)};
  });
}

}  // namespace vantage
