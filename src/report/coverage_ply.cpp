// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "core/atomic_file.hpp"
#include "report/colour.hpp"
#include "report/ply_header.hpp"
#include "report/point_sink.hpp"
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
  std::vector<PlyProperty> properties{{"double", "x"},    {"double", "y"},   {"double", "z"},    {"uchar", "red"},
                                      {"uchar", "green"}, {"uchar", "blue"}, {"float", "ratio"}, {"uint", "count"}};
  // PLY knows no 64-bit integer: a bit a station, 1 to 32, and 33 to 64; of larger networks 65 to 96 and so on.
  for (std::size_t w = 0; w < words; ++w) {
    const std::string of = w == 0 ? "" : "_" + std::to_string(w + 1);
    properties.push_back({"uint", "stations" + of + "_low"}), properties.push_back({"uint", "stations" + of + "_high"});
  }

  AtomicFile out(file);
  out.write(PlyHeader(properties).text(voxels));
  constexpr std::uint64_t kChunk = 65'536;
  std::string bytes;
  for (std::uint64_t first = 0; first < voxels; first += kChunk) {
    bytes.clear();
    for (std::uint64_t rank = first; rank < std::min(voxels, first + kChunk); ++rank) {
      const Vec3 centre = simulator.voxel_centre(rank);
      const double ratio = std::min(field.count[rank] / simulator.goal_density(), 1.0);
      append(bytes, centre.x), append(bytes, centre.y), append(bytes, centre.z);
      for (const std::uint8_t channel : to_bytes(ramp(kCoverageRamp, ratio))) append(bytes, channel);
      append(bytes, static_cast<float>(ratio));
      append(bytes, field.count[rank]);
      for (std::size_t w = 0; w < words; ++w) {
        append(bytes, static_cast<std::uint32_t>(field.stations[w * voxels + rank]));
        append(bytes, static_cast<std::uint32_t>(field.stations[w * voxels + rank] >> 32));
      }
    }
    out.write(bytes);
  }
  out.commit();
}

}  // namespace vantage
