// SPDX-License-Identifier: Apache-2.0
// Visits all cells of a grid that triangles touch, in parallel, in steps with progress and cancellation between them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "vantage/progress.hpp"
#include "voxel/triangle_cells.hpp"
#include "voxel/voxel_bricks.hpp"

namespace vantage {

class TriangleWalk {
 public:
  // Borrows the scene; `meshes` are some of its ranges, and `grid` is the finest grid that will be walked.
  TriangleWalk(const SceneData& scene, std::span<const MeshRange> meshes, const GridTransform& grid);

  // Returns the area of all triangles in faces of cells, a lower bound on the cells except for slivers. Coincident
  // triangles count several times.
  double area() const { return area_; }

  // Calls visit(cell) for each cell that a triangle touches, once per triangle. `make_visit(mesh)` makes a visitor for
  // some triangles of a mesh, on the visiting thread. Reports on the calling thread. Returns false if stopped.
  template <class MakeVisit>
  bool for_each(const GridTransform& grid, std::int64_t cells_per_side, const Progress& progress,
                const MakeVisit& make_visit) const {
    double done = 0;
    for (std::size_t first = 0; first < pieces_.size();) {
      if (progress.stopped()) return false;
      std::size_t end = first;
      for (double area = 0; end < pieces_.size() && area < step_; ++end) area += pieces_[end].area;
      parallel::for_all(first, end, [&](std::size_t p) {
        const Piece& piece = pieces_[p];
        auto visit = make_visit(piece.mesh);
        for (std::uint32_t t = piece.first; t < piece.end; ++t)
          TriangleCells(grid.corners(scene_.corners(t)), cells_per_side).for_each(visit, piece.part, piece.parts);
      });
      for (; first < end; ++first) done += pieces_[first].area;
      progress(done / total_);
    }
    return true;
  }

 private:
  // Consecutive triangles of a mesh; or, of a large triangle, part number `part` of `parts`.
  struct Piece {
    std::size_t mesh;
    std::uint32_t first, end;
    double area;
    std::int64_t part = 0, parts = 1;
  };

  const SceneData& scene_;
  std::vector<Piece> pieces_;
  double area_ = 0;
  double total_ = 0;  // of the pieces, with about a cell extra per triangle
  double step_ = 0;
};

}  // namespace vantage
