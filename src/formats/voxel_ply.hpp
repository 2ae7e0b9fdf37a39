// SPDX-License-Identifier: Apache-2.0
// Voxels as a binary PLY: centre and colour of each, then further properties.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "formats/ply_header.hpp"
#include "formats/point_sink.hpp"
#include "map/colour.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

// `vertex` returns the k-th voxel's colour and appends the properties named in `more`, in that order. Throws Error io.
struct VoxelVertex {
  std::uint32_t voxel;
  Colour colour;
};
void write_voxel_ply(const std::filesystem::path& file, PlyCoordinates coordinates, const Simulator& simulator,
                     const std::vector<PlyProperty>& more, std::uint64_t voxels,
                     const std::function<VoxelVertex(std::uint64_t k, std::string& bytes)>& vertex);

}  // namespace vantage
