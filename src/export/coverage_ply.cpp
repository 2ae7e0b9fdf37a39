// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "export/voxel_ply.hpp"
#include "vantage/error.hpp"
#include "vantage/export.hpp"

namespace vantage {

void write_coverage_ply(const std::filesystem::path& file, const Simulator& simulator, const VoxelField& field) {
  if (file.extension() != ".ply")
    throw Error(Errc::invalid_argument,
                "the cartography's counts and stations of each voxel need a .ply file, not " + file.string());
  const std::uint64_t voxels = simulator.voxel_count();
  if (field.count.size() != voxels || (voxels > 0 && field.stations.size() % voxels != 0))
    throw Error(Errc::invalid_argument, "the voxel field has " + std::to_string(field.count.size()) +
                                            " counts, the scene " + std::to_string(voxels) + " surveyed voxels");
  const std::size_t words = voxels > 0 ? field.stations.size() / voxels : 0;
  std::vector<PlyProperty> more{{"float", "ratio"}, {"uint", "count"}};
  // PLY has no 64-bit integer: one word has bits of stations 1 to 32, the next of 33 to 64, and so on.
  for (std::size_t w = 0; w < words; ++w) {
    const std::string of = w == 0 ? "" : "_" + std::to_string(w + 1);
    more.push_back({"uint", "stations" + of + "_low"}), more.push_back({"uint", "stations" + of + "_high"});
  }
  write_voxel_ply(file, simulator, more, voxels, [&](std::uint64_t rank, std::string& bytes) {
    const double ratio = std::min(field.count[rank] / simulator.goal_density(rank), 1.0);
    append(bytes, static_cast<float>(ratio));
    append(bytes, field.count[rank]);
    for (std::size_t w = 0; w < words; ++w) {
      append(bytes, static_cast<std::uint32_t>(field.stations[w * voxels + rank]));
      append(bytes, static_cast<std::uint32_t>(field.stations[w * voxels + rank] >> 32));
    }
    return VoxelVertex{static_cast<std::uint32_t>(rank), ramp(kCoverageRamp, ratio)};
  });
}

}  // namespace vantage
