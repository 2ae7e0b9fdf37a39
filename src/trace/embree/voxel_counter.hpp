// SPDX-License-Identifier: Apache-2.0
// Counts points of stations in some voxels, from only those rays that can leave one there.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "trace/embree/sampled_voxels.hpp"
#include "trace/embree/seen_triangle.hpp"
#include "trace/embree/station_rays.hpp"
#include "trace/rays_of_box.hpp"

namespace vantage {

// Largest distance of a triangle from the noise's reach of a cube if a hit on it counts there. Allows for Embree's
// error at edges, stretched by slant.
inline double triangle_margin(double pad) { return 64 * pad; }

// Processes blocks of voxels, one station after the other: bounds are computed side by side, and many rays are traced
// at once. Not thread-safe.
class SampledVoxelCounter {
 public:
  static constexpr std::uint32_t kBlock = BoxBatch::kCapacity;

  // `scanners`: indexed by TraceStation::scanner. `pad`: rounding_pad() of everything in sight. Borrows both.
  SampledVoxelCounter(std::span<const StationRays> scanners, const SampledVoxels& voxels, double pad);

  // Counts voxels first, first + 1, …: points of all stations (saturating), and a bit for each station with a point
  // there. Unless `stop_at` is 0, counting stops once a voxel has that many points and its stations are known. `masks`
  // and `leave_out` are empty or as long as `counts`; voxels with a byte other than 0 in `leave_out` are not counted.
  // REQUIRES: at most `kBlock` voxels; counts and masks are 0.
  void count(std::span<const TraceStation> stations, std::size_t first, std::uint32_t stop_at,
             std::span<std::uint32_t> counts, std::span<std::uint64_t> masks,
             std::span<const std::uint8_t> leave_out = {});
  std::uint64_t traced() const { return traced_; }

 private:
  // Region of the hits whose points count in the voxel, up to the noise's reach from the cube. Relative to the
  // head.
  struct Cube {
    Float3 centre;
    float half;
    float nearest, farthest;  // bounds on the distance of such a hit
  };
  // Some of the rays that may cross a cube, as arrays.
  struct RayBatch {
    static constexpr std::uint32_t kCapacity = 64, kStep = 8;  // kStep: rays written at a time, even if fewer suffice
    std::uint32_t size = 0;
    alignas(64) std::array<float, kCapacity + kStep> x, y, z;
    alignas(64) std::array<std::uint32_t, kCapacity + kStep> row, column;
    alignas(64) std::array<float, kCapacity> nearest;  // no hit that counts is nearer; infinity: there is none
    alignas(64) std::array<float, kCapacity> px, py, pz, slant, candidate;  // of the current plane
  };
  // Facts about one voxel of the block, known before its rays are listed.
  struct Look {
    std::uint32_t voxel = 0;  // index in the block
    Cube cube;
    double reach = 0;                            // largest movement of its hits by noise
    Box hits;                                    // holds every hit that counts, relative to the head
    bool sure = false;                           // every hit that counts lies on a plane that crosses the voxel
    std::uint32_t occluder = RayBundle::kNoHit;  // triangle before the voxel that hides some of it
  };
  // A plane, and the head's height over it.
  struct Ahead {
    const SampledVoxels::Plane* plane;
    float height;
  };
  // Tiles of a window, up to 8 × 8, each of 2^row_shift rows and 2^unit_shift units of SpreadUnits. A bit is set for
  // each tile whose rays leave no point in the voxel.
  struct Tiles {
    std::uint32_t row_shift = 31, unit_shift = 31;
    std::uint64_t hidden = 0;
  };
  // A voxel of which the first `units` of SpreadUnits were listed: usually enough rays.
  struct Rest {
    Look look;
    RayRanges window;
    std::uint32_t units;
    std::uint32_t count;  // of the voxel, before its rays were traced
    Tiles tiles;
  };
  // Rays that may leave a point in one voxel: listed_ from `begin` to `end`.
  struct VoxelRays {
    std::uint32_t voxel = 0;  // index in the block
    std::uint32_t begin = 0, end = 0;
    float farthest = 0;   // no hit that counts is farther
    bool probed = false;  // its first ray was probed
    std::uint32_t occluder = RayBundle::kNoHit;
  };
  struct Ray {
    Float3 d;
    float nearest;  // no hit that counts is nearer
    std::uint32_t row, column;
  };

  void look_from(std::size_t first, std::size_t n);
  // Returns true if the current station can skip voxel number i of the block.
  bool full(std::uint32_t i) const {
    if (!leave_out_.empty() && leave_out_[i] != 0) return true;
    return stop_at_ != 0 && counts_[i] >= stop_at_ && (masks_.empty() || (masks_[i] >> station_->place & 1) != 0);
  }
  bool look_at(std::uint32_t i, Look& look);
  double reach_of(std::uint32_t i, double far) const;
  bool crosses(const SampledVoxels::Plane& plane, const Cube& cube) const;
  float height_over(const SampledVoxels::Plane& plane, std::uint32_t i) const;
  Box hits_of(const Look& look) const;
  void find_windows();
  SeenTriangle seen(std::uint32_t triangle) const;  // from the current head
  void find_open(std::size_t n);
  void drop_hidden_groups(std::size_t level, std::size_t n);
  Box box_of(const SampledVoxels::Cells& cells) const;
  void drop_hidden_boxes();
  // Remembers a triangle that a ray met. If it hides a group of voxels, it likely hides neighbours, too.
  void meet(std::uint32_t triangle);
  bool is_hidden(const SeenBox& box);
  // Returns true if the triangle, alone or with others, hides the whole box.
  bool hides(std::uint32_t triangle, const Box& box);
  bool any_ray_near(const Vec3& point, double radius) const;
  // Returns an upper bound on the points still to be counted in voxel number i of the block.
  std::uint32_t wanted(std::uint32_t i) const;
  RayRanges window_of(std::size_t k) const;
  void list_rays(Rest rest, std::uint32_t enough);
  void list_directions(std::size_t k);
  Tiles find_hidden(const Look& look, const RayRanges& window);
  std::span<const Ahead> planes_of(const Look& look);
  void fill_nearest(std::span<const Ahead> planes, const Cube& cube);
  std::uint32_t list_batch(VoxelRays& rays);
  void end_rays(VoxelRays& rays);
  void settle();
  void drop_hidden(VoxelRays& rays, std::uint32_t by);
  void cast();
  void cast(VoxelRays& rays, std::uint32_t many);
  void finish();

  std::span<const StationRays> scanners_;
  const SampledVoxels& voxels_;
  double pad_;
  const TraceStation* station_ = nullptr;
  const StationRays* rays_ = nullptr;  // of its scanner
  double reach_ = 0;                   // of its noise
  Vec3 head_;
  std::size_t first_ = 0;
  std::uint32_t stop_at_ = 0;
  std::span<std::uint32_t> counts_;
  std::span<std::uint64_t> masks_;
  std::span<const std::uint8_t> leave_out_;
  std::uint64_t traced_ = 0;

  BoxBatch boxes_;                                               // around the points that count, of looks_
  alignas(64) std::array<double, kBlock> x_, y_, z_, distance_;  // middles of the cubes, relative to the head
  std::array<bool, kBlock> open_;  // by voxel of the block: true if the current station must check it
  std::vector<std::pair<std::uint32_t, SeenTriangle>> met_;
  RayBatch batch_;
  std::vector<SeenTriangle> hiders_;                      // of tiles of the current window
  std::array<Ahead, SampledVoxels::kMostPlanes> planes_;  // of the current voxel
  std::vector<Ray> listed_;
  std::uint32_t listed_size_ = 0;
  std::vector<Look> looks_;
  std::vector<Rest> rest_, again_;
  std::vector<VoxelRays> voxel_rays_, visible_;
  std::vector<Probe> probes_;
  RayBundle bundle_;
  Hits hits_;                                                              // of the bundle
  std::array<std::uint32_t, RayBundle::kCapacity> cast_ray_, cast_voxel_;  // of the bundle
};

}  // namespace vantage
