// SPDX-License-Identifier: Apache-2.0
#include "export/voxel_ply.hpp"

#include "core/atomic_file.hpp"

namespace vantage {

void write_voxel_ply(const std::filesystem::path& file, const Simulator& simulator,
                     const std::vector<PlyProperty>& more, std::uint64_t voxels,
                     const std::function<VoxelVertex(std::uint64_t k, std::string& bytes)>& vertex) {
  constexpr std::size_t kChunk = 1u << 20;
  std::vector<PlyProperty> properties{{"double", "x"},  {"double", "y"},    {"double", "z"},
                                      {"uchar", "red"}, {"uchar", "green"}, {"uchar", "blue"}};
  properties.insert(properties.end(), more.begin(), more.end());
  AtomicFile out(file);
  out.write(PlyHeader(properties).text(voxels));
  std::string bytes, own;
  for (std::uint64_t k = 0; k < voxels; ++k) {
    own.clear();
    const auto [rank, colour] = vertex(k, own);
    const Vec3 centre = simulator.voxel_centre(rank);
    append(bytes, centre.x), append(bytes, centre.y), append(bytes, centre.z);
    for (const std::uint8_t channel : to_bytes(colour)) append(bytes, channel);
    bytes += own;
    if (bytes.size() > kChunk) out.write(bytes), bytes.clear();
  }
  out.write(bytes);
  out.commit();
}

}  // namespace vantage
