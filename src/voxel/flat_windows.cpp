// SPDX-License-Identifier: Apache-2.0
#include "voxel/flat_windows.hpp"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "core/glm.hpp"
#include "core/parallel.hpp"
#include "scene/positions.hpp"
#include "voxel/clipped_polygon.hpp"
#include "voxel/triangle_cells.hpp"
#include "voxel/triangle_lists.hpp"
#include "voxel/voxel_bricks.hpp"
#include "voxel/voxel_surfaces.hpp"

namespace vantage {
namespace {

using glm::dvec3;
using Corners = std::array<dvec3, 3>;
using Cell = std::array<std::int64_t, 3>;

// Largest distance from the plane of surface that still belongs to it, in half windows. A surface that bends by one
// plane's 26° within half a window leaves the plane by tan 13° of it. A parallel surface further away is another sheet.
constexpr double kOtherSheet = 0.25;
// Triangles up to this share of a window, along any axis, count as a whole, by their middle.
constexpr double kSmallShare = 1.0 / 4;
// Voxels between two checks of a stop; as many keys and lists are kept at once.
constexpr std::size_t kVoxelsAtOnce = std::size_t{1} << 22;
// Windows of a cell that one thread takes. A cell of a fine grid has thousands, and thousands of triangles around it.
constexpr std::size_t kWindowsATask = 128;

bool is_small(const Corners& c, double at_most) {
  const dvec3 extent = max(c[0], max(c[1], c[2])) - min(c[0], min(c[1], c[2]));
  return std::max({extent.x, extent.y, extent.z}) <= at_most;
}

// Cells of 2^shift voxels per side, as in the lists of triangles.
struct Cells {
  Cells(const VoxelGrid& grid, int bits)
      : transform(GridTransform{{grid.min()[0], grid.min()[1], grid.min()[2]}, grid.inverse_size()}.coarser(bits)),
        shift(bits),
        a_side(std::int64_t{1} << (grid.depth() - bits)) {}

  // In units of cells.
  dvec3 place(const dvec3& p) const {
    return (p - dvec3(transform.min[0], transform.min[1], transform.min[2])) * transform.inverse_size;
  }
  Cell holding(const dvec3& p) const {
    const dvec3 q = place(p);
    Cell cell;
    for (int axis = 0; axis < 3; ++axis)
      cell[axis] = std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(q[axis])), 0, a_side - 1);
    return cell;
  }
  static std::uint64_t key(const Cell& c) {
    return morton_encode(static_cast<std::uint32_t>(c[0]), static_cast<std::uint32_t>(c[1]),
                         static_cast<std::uint32_t>(c[2]));
  }

  GridTransform transform;
  int shift;
  std::int64_t a_side;
};

// Returns cells about as wide as `wanted_m`, at least voxels and at most the grid.
Cells cells_of(const VoxelGrid& grid, double wanted_m) {
  const int shift = static_cast<int>(std::ceil(std::log2(wanted_m / grid.voxel_size())));
  return {grid, std::clamp(shift, 0, grid.depth())};
}

// Voxels in the same cell, or cells in the same block; these are consecutive in Morton order.
struct Runs {
  // `keys`: Morton keys, rising.
  Runs(std::span<const std::uint64_t> keys, int shift) {
    for (std::size_t i = 0; i < keys.size(); ++i)
      if (const std::uint64_t cell = keys[i] >> 3 * shift; cells.empty() || cell != cells.back()) {
        cells.push_back(cell);
        first.push_back(i);
      }
    first.push_back(keys.size());
  }

  std::vector<std::uint64_t> cells;  // Morton keys
  std::vector<std::size_t> first;    // cell number c has the keys first[c] … first[c + 1] − 1
};

using Numbers = std::unordered_map<std::uint64_t, std::uint32_t>;

// Window around one point of a surface.
struct Window {
  dvec3 point, normal;
  double half;  // metres
  double within = 0, other = 0;

  bool holds(const dvec3& p) const {
    return std::abs(p.x - point.x) <= half && std::abs(p.y - point.y) <= half && std::abs(p.z - point.z) <= half;
  }
  void add(const dvec3& middle, const dvec3& along, double area) {
    if (!(std::abs(dot(along, normal)) > kOnePlaneCosine))
      other += area;
    else if (std::abs(dot(middle - point, normal)) <= kOtherSheet * half)
      within += area;
  }
  float share() const { return within + other > 0 ? static_cast<float>(within / (within + other)) : 1; }
};

// A large triangle, local frame.
struct Large {
  Corners corners;
  dvec3 low, high, along;
  double area;
};

void add_clipped(Window& window, const Large& large) {
  const dvec3 low = window.point - window.half, high = window.point + window.half;
  for (int axis = 0; axis < 3; ++axis)
    if (large.low[axis] > high[axis] || large.high[axis] < low[axis]) return;
  // A triangle that no face of the window cuts lies entirely within it.
  ClippedPolygon polygon;
  for (const dvec3& corner : large.corners) polygon.add(corner - window.point);
  for (int axis = 0; axis < 3; ++axis) {
    if (large.low[axis] < low[axis]) polygon.clip(axis, -window.half, -1);
    if (large.high[axis] > high[axis]) polygon.clip(axis, window.half, 1);
  }
  if (!polygon.empty()) window.add(window.point + polygon.centroid(), large.along, length(polygon.area()));
}

// Finds pairs of a cell with a sampled voxel and a large triangle that a window from that cell may reach.
class LargeFinder {
 public:
  LargeFinder(const SceneData& scene, std::span<const std::uint32_t> larges, const Cells& cells, const Runs& runs,
              double half_m)
      : scene_(scene), larges_(larges), cells_(cells), margin_(half_m * cells.transform.inverse_size) {
    for (std::size_t c = 0; c < runs.cells.size(); ++c) number_.emplace(runs.cells[c], static_cast<std::uint32_t>(c));
  }
  template <class Found>
  void for_each(const Found& found) const {
    parallel::for_all(std::size_t{0}, larges_.size(), [&](std::size_t k) {
      const std::uint32_t t = larges_[k];
      TriangleCells(cells_.transform.corners(scene_.corners(t)), cells_.a_side, margin_).for_each([&](const Cell& c) {
        if (const auto cell = number_.find(Cells::key(c)); cell != number_.end()) found(cell->second, t);
      });
    });
  }

 private:
  const SceneData& scene_;
  std::span<const std::uint32_t> larges_;
  const Cells& cells_;
  double margin_;  // in cells
  Numbers number_;
};

std::vector<Large> large_triangles(const SceneData& scene, std::span<const std::uint32_t> list) {
  std::vector<Large> larges;
  for (const std::uint32_t t : list) {
    const Corners p = corners_of(scene, t);
    const dvec3 twice = cross(p[1] - p[0], p[2] - p[0]);
    const double area = 0.5 * length(twice);
    if (area > 0)
      larges.push_back({p, min(p[0], min(p[1], p[2])), max(p[0], max(p[1], p[2])), twice / (2 * area), area});
  }
  return larges;
}

// Cells of a block, per side, as a power of two. Windows from one block share the cells around it.
constexpr int kBlockBits = 3;
constexpr std::int64_t kBlockSide = std::int64_t{1} << kBlockBits;

// Calls visit(block) for each block within `reach` blocks of one, along every axis, that the grid has.
template <class Visit>
void for_each_near(const Cell& block, std::int64_t reach, std::int64_t a_side, const Visit& visit) {
  for (std::int64_t x = std::max<std::int64_t>(block[0] - reach, 0); x <= std::min(block[0] + reach, a_side - 1); ++x)
    for (std::int64_t y = std::max<std::int64_t>(block[1] - reach, 0); y <= std::min(block[1] + reach, a_side - 1); ++y)
      for (std::int64_t z = std::max<std::int64_t>(block[2] - reach, 0); z <= std::min(block[2] + reach, a_side - 1);
           ++z)
        visit(Cell{x, y, z});
}

Cell cell_of_key(std::uint64_t key) {
  const auto [x, y, z] = morton_decode(key);
  return {x, y, z};
}

// A small triangle, local frame.
struct Small {
  Float3 middle, along;
  float area;
  std::uint32_t cell;  // Morton key within its block
};

// All surveyed triangles: the large ones, and the small ones by the block that holds their middle.
class SortedTriangles {
 public:
  SortedTriangles(const SceneData& scene, const Cells& cells, double small_m) {
    struct Placed {
      std::uint64_t cell;  // Morton key
      std::uint32_t triangle;
    };
    struct Own {
      std::vector<std::uint32_t> large;
      std::vector<Placed> small;
    };
    tbb::enumerable_thread_specific<Own> found;
    for_each_surveyed(scene, [&](std::uint32_t t) {
      const Corners p = corners_of(scene, t);
      if (is_small(p, small_m))
        found.local().small.push_back({Cells::key(cells.holding((p[0] + p[1] + p[2]) / 3.0)), t});
      else
        found.local().large.push_back(t);
    });
    std::vector<Placed> placed;
    for (Own& own : found) {
      large_.insert(large_.end(), own.large.begin(), own.large.end());
      placed.insert(placed.end(), own.small.begin(), own.small.end());
      own = {};
    }
    // In ascending order within a block, so that the result does not depend on the threads.
    parallel::sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) {
      const std::uint64_t of_a = a.cell >> 3 * kBlockBits, of_b = b.cell >> 3 * kBlockBits;
      return of_a != of_b ? of_a < of_b : a.triangle < b.triangle;
    });
    for (std::size_t k = 0; k < placed.size(); ++k)
      if (const std::uint64_t block = placed[k].cell >> 3 * kBlockBits; blocks_.empty() || block != blocks_.back())
        blocks_.push_back(block), first_.push_back(k);
    first_.push_back(placed.size());
    small_.resize(placed.size());
    parallel::for_all(std::size_t{0}, placed.size(), [&](std::size_t k) {
      const Corners p = corners_of(scene, placed[k].triangle);
      const dvec3 twice = cross(p[1] - p[0], p[2] - p[0]), middle = (p[0] + p[1] + p[2]) / 3.0;
      const double area = 0.5 * length(twice);
      small_[k] = {rounded(middle), area > 0 ? rounded(twice / (2 * area)) : Float3{}, static_cast<float>(area),
                   static_cast<std::uint32_t>(placed[k].cell & ((1u << 3 * kBlockBits) - 1))};
    });
  }

  std::span<const std::uint32_t> large() const { return large_; }
  bool any_small() const { return !small_.empty(); }
  // Returns the small triangles of a block, by its Morton key.
  std::span<const Small> small_in(std::uint64_t block) const {
    const auto found = std::ranges::lower_bound(blocks_, block);
    if (found == blocks_.end() || *found != block) return {};
    const auto k = static_cast<std::size_t>(found - blocks_.begin());
    return std::span(small_).subspan(first_[k], first_[k + 1] - first_[k]);
  }

 private:
  static Float3 rounded(const dvec3& p) {
    return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
  }
  std::vector<std::uint32_t> large_;
  std::vector<std::uint64_t> blocks_;  // that hold some, rising
  std::vector<std::size_t> first_;     // of each block, then the end
  std::vector<Small> small_;
};

// The small triangles in and around one block, by cell.
class SmallsAround {
 public:
  // The cube reaches `reach` cells beyond the block on every side.
  SmallsAround(const Cell& block, std::int64_t reach) : side_(kBlockSide + 2 * reach) {
    for (int axis = 0; axis < 3; ++axis) low_[axis] = block[axis] * kBlockSide - reach;
  }
  // In ascending order of triangles, so that the result does not depend on the other windows.
  void add(const Cell& block, std::span<const Small> smalls) {
    for (const Small& small : smalls) {
      const Cell within = cell_of_key(small.cell);
      std::int64_t place = 0;
      bool around = true;
      for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t at = block[axis] * kBlockSide + within[axis] - low_[axis];
        around = around && at >= 0 && at < side_;
        place = place * side_ + at;
      }
      if (around) found_.push_back({static_cast<std::uint32_t>(place), &small});
    }
  }
  bool empty() const { return found_.empty(); }
  void sort() {
    first_.assign(static_cast<std::size_t>(side_ * side_ * side_) + 1, 0);
    for (const Found& one : found_) ++first_[one.place + 1];
    for (std::size_t cell = 1; cell < first_.size(); ++cell) first_[cell] += first_[cell - 1];
    sorted_.resize(found_.size());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (const Found& one : found_) sorted_[next[one.place]++] = one.small;
  }
  // REQUIRES: sorted; the cell lies in the cube.
  std::span<const Small* const> in(const Cell& cell) const {
    std::int64_t place = 0;
    for (int axis = 0; axis < 3; ++axis) place = place * side_ + cell[axis] - low_[axis];
    const std::uint32_t first = first_[static_cast<std::size_t>(place)];
    return std::span(sorted_).subspan(first, first_[static_cast<std::size_t>(place) + 1] - first);
  }

 private:
  struct Found {
    std::uint32_t place;
    const Small* small;
  };
  std::int64_t side_;
  Cell low_;  // first cell of the cube, also below 0
  std::vector<Found> found_;
  std::vector<std::uint32_t> first_;  // of each cell, then the end
  std::vector<const Small*> sorted_;
};

// Adds the small triangles around a block to the window of a voxel of it. `own`: the cell of the voxel.
void add_small(Window& window, const SmallsAround& around, const Cells& cells, const Cell& own, std::int64_t reach) {
  const dvec3 low = cells.place(window.point - window.half), high = cells.place(window.point + window.half);
  Cell from, to;
  for (int axis = 0; axis < 3; ++axis) {
    const auto within = [&](double at) {
      return std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(at)), own[axis] - reach, own[axis] + reach);
    };
    from[axis] = within(low[axis]), to[axis] = within(high[axis]);
  }
  for (std::int64_t a = from[0]; a <= to[0]; ++a)
    for (std::int64_t b = from[1]; b <= to[1]; ++b)
      for (std::int64_t c = from[2]; c <= to[2]; ++c)
        for (const Small* small : around.in({a, b, c}))
          if (const dvec3 middle = to_glm(small->middle); window.holds(middle))
            window.add(middle, to_glm(small->along), static_cast<double>(small->area));
}

}  // namespace

struct FlatWindows::Impl {
  Impl(const SceneData& s, const VoxelGrid& g, double side_m)
      : scene(s),
        grid(g),
        window_m(side_m),
        wide(cells_of(grid, 0.7 * window_m)),
        narrow(cells_of(grid, window_m / 4)),
        triangles(scene, narrow, window_m * kSmallShare) {}

  const SceneData& scene;
  const VoxelGrid& grid;
  double window_m;
  // Narrower cells would repeat almost the same lists of large triangles; wider ones would list many that none of their
  // windows holds. A block holds whole cells of both kinds.
  Cells wide, narrow;
  SortedTriangles triangles;
};

FlatWindows::FlatWindows(const SceneData& scene, const VoxelGrid& grid, double window_m)
    : impl_(std::make_unique<const Impl>(scene, grid, window_m)) {}
FlatWindows::~FlatWindows() = default;
double FlatWindows::window_m() const { return impl_->window_m; }

std::vector<float> FlatWindows::shares(std::span<const std::uint32_t> voxel_indices,
                                       std::span<const VoxelSurface> surfaces, const std::stop_token& stop) const {
  const SceneData& scene = impl_->scene;
  const VoxelGrid& grid = impl_->grid;
  const Cells &wide = impl_->wide, &narrow = impl_->narrow;
  const SortedTriangles& triangles = impl_->triangles;
  const double window_m = impl_->window_m;
  const auto reach = std::min(static_cast<std::int64_t>(std::ceil(window_m / 2 * narrow.transform.inverse_size)),
                              narrow.a_side - 1);  // in narrow cells
  std::vector<float> shares(voxel_indices.size(), 1);
  std::vector<std::uint64_t> keys;
  for (std::size_t begin = 0; begin < voxel_indices.size(); begin += kVoxelsAtOnce) {
    if (stop.stop_requested()) return {};
    keys.resize(std::min(kVoxelsAtOnce, voxel_indices.size() - begin));
    parallel::for_all(std::size_t{0}, keys.size(),
                      [&](std::size_t i) { keys[i] = grid.key(voxel_indices[begin + i]); });
    const Runs cells(keys, wide.shift);
    const VoxelTriangles lists =
        triangle_lists(LargeFinder(scene, triangles.large(), wide, cells, window_m / 2), cells.cells.size());
    const auto larges_of = [&](std::size_t cell) {
      return large_triangles(
          scene, std::span(lists.triangle).subspan(lists.offset[cell], lists.offset[cell + 1] - lists.offset[cell]));
    };
    // Windows of one cell, with the small triangles around its block.
    const auto measure = [&](std::size_t cell, const SmallsAround& around) {
      const std::vector<Large> larges = larges_of(cell);
      parallel::for_all(tbb::blocked_range<std::size_t>(cells.first[cell], cells.first[cell + 1], kWindowsATask),
                        [&](const tbb::blocked_range<std::size_t>& range) {
                          for (std::size_t i = range.begin(); i != range.end(); ++i) {
                            const VoxelSurface& surface = surfaces[begin + i];
                            if (!(surface.area > 0)) continue;
                            Window window{to_glm(surface.point), to_glm(surface.normal), window_m / 2};
                            for (const Large& large : larges) add_clipped(window, large);
                            if (!around.empty())
                              add_small(window, around, narrow, cell_of_key(keys[i] >> 3 * narrow.shift), reach);
                            shares[begin + i] = window.share();
                          }
                        });
    };
    const Runs blocks(cells.cells, narrow.shift + kBlockBits - wide.shift);
    parallel::for_all(std::size_t{0}, blocks.cells.size(), [&](std::size_t run) {
      if (stop.stop_requested()) return;
      const Cell block = cell_of_key(blocks.cells[run]);
      SmallsAround around(block, reach);
      if (triangles.any_small())
        for_each_near(block, (reach + kBlockSide - 1) / kBlockSide, (narrow.a_side + kBlockSide - 1) / kBlockSide,
                      [&](const Cell& near) { around.add(near, triangles.small_in(Cells::key(near))); });
      if (!around.empty()) around.sort();
      parallel::for_all(blocks.first[run], blocks.first[run + 1], [&](std::size_t cell) { measure(cell, around); });
    });
  }
  if (stop.stop_requested()) shares.clear();
  return shares;
}

}  // namespace vantage
