// SPDX-License-Identifier: Apache-2.0
#include "voxel/triangle_walk.hpp"

#include <algorithm>
#include <cmath>

#include "core/glm.hpp"
#include "core/parallel.hpp"

namespace vantage {
namespace {

// Large enough to make handing out a piece cheap, small enough for all threads to end together.
constexpr double kCellsAPiece = 1 << 16;
// Least number of steps, for work of a second or more.
constexpr double kLeastSteps = 64, kLeastCellsAStep = 1 << 25;
constexpr std::uint32_t kTrianglesAChunk = 1 << 16;
constexpr double kOwnCells = 4;  // fixed cost of a triangle, in cells

}  // namespace

TriangleWalk::TriangleWalk(const SceneData& scene, std::span<const MeshRange> meshes, const GridTransform& grid)
    : scene_(scene) {
  struct Chunk {
    std::size_t mesh;
    std::uint32_t first, end;
    double area = 0;
    std::vector<Piece> pieces = {};
  };
  std::vector<Chunk> chunks;
  for (std::size_t m = 0; m < meshes.size(); ++m)
    for (std::uint32_t t = 0; t < meshes[m].triangle_count; t += kTrianglesAChunk)
      chunks.push_back({m, meshes[m].first_triangle + t,
                        meshes[m].first_triangle + std::min(meshes[m].triangle_count, t + kTrianglesAChunk)});
  parallel::for_all(std::size_t{0}, chunks.size(), [&](std::size_t k) {
    Chunk& chunk = chunks[k];
    Piece open{chunk.mesh, chunk.first, chunk.first, 0};
    const auto close = [&] {
      if (open.end > open.first) chunk.pieces.push_back(open);
      open = {chunk.mesh, open.end, open.end, 0};
    };
    for (std::uint32_t t = chunk.first; t < chunk.end; ++t) {
      const auto c = grid.corners(scene.corners(t));
      const glm::dvec3 a = glm::make_vec3(c[0].data());
      const double area = 0.5 * length(cross(glm::make_vec3(c[1].data()) - a, glm::make_vec3(c[2].data()) - a));
      chunk.area += area;
      if (area > 2 * kCellsAPiece) {
        close();
        // Caps the pieces; an excessive area is rejected before it is walked.
        const auto parts = static_cast<std::int64_t>(std::min(std::ceil(area / kCellsAPiece), 1e6));
        for (std::int64_t part = 0; part < parts; ++part)
          chunk.pieces.push_back({chunk.mesh, t, t + 1, area / static_cast<double>(parts), part, parts});
        open = {chunk.mesh, t + 1, t + 1, 0};
        continue;
      }
      open.end = t + 1;
      open.area += area + kOwnCells;
      if (open.area > kCellsAPiece) close();
    }
    close();
  });
  for (const Chunk& chunk : chunks) {
    area_ += chunk.area;
    pieces_.insert(pieces_.end(), chunk.pieces.begin(), chunk.pieces.end());
  }
  for (const Piece& piece : pieces_) total_ += piece.area;
  step_ = std::max(total_ / kLeastSteps, kLeastCellsAStep);
}

}  // namespace vantage
