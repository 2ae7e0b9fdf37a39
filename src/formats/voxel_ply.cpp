// SPDX-License-Identifier: Apache-2.0
#include "formats/voxel_ply.hpp"

#include <algorithm>

#include "core/atomic_file.hpp"
#include "core/parallel.hpp"

namespace vantage {

void write_voxel_ply(const std::filesystem::path& file, PlyCoordinates coordinates, const Simulator& simulator,
                     const std::vector<PlyProperty>& more, std::uint64_t voxels,
                     const std::function<VoxelVertex(std::uint64_t k, std::string& bytes)>& vertex) {
  constexpr std::uint64_t kChunk = 1u << 14, kChunksAtOnce = 64;  // vertices; chunks that are made side by side
  std::vector<PlyProperty> properties{{"uchar", "red"}, {"uchar", "green"}, {"uchar", "blue"}};
  properties.insert(properties.end(), more.begin(), more.end());
  AtomicFile out(file);
  const PlyHeader header(coordinates, simulator.origin(), properties);
  out.write(header.text(voxels));
  std::vector<std::string> chunks(kChunksAtOnce);
  for (std::uint64_t first = 0; first < voxels; first += kChunk * kChunksAtOnce) {
    parallel::for_all(std::uint64_t{0}, kChunksAtOnce, [&](std::uint64_t c) {
      std::string &bytes = chunks[c], own;
      bytes.clear();
      const std::uint64_t begin = first + c * kChunk;
      for (std::uint64_t k = begin; k < std::min(begin + kChunk, voxels); ++k) {
        own.clear();
        const auto [voxel, colour] = vertex(k, own);
        header.append_place(bytes, simulator.voxel_centre(voxel));
        for (const std::uint8_t channel : to_bytes(colour)) append(bytes, channel);
        bytes += own;
      }
    });
    for (const std::string& bytes : chunks) out.write(bytes);
  }
  out.commit();
}

}  // namespace vantage
