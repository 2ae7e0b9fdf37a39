// SPDX-License-Identifier: Apache-2.0
// A beam with a width: sub-rays over its footprint, whose echoes merge into returns (docs/method.md).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "scan/ray_follower.hpp"
#include "scene/scene_data.hpp"
#include "trace/tracer.hpp"
#include "vantage/simulator.hpp"
#include "voxel/voxel_grid.hpp"

namespace vantage {

// Works alike for all engines, since the processor traces everything here. Safe to use from any thread.
class WideBeam {
 public:
  // Shares ownership of both.
  WideBeam(std::shared_ptr<const SceneData> scene, std::shared_ptr<const VoxelGrid> grid);

  // One return of one ray.
  struct Return {
    std::uint64_t ray;
    std::uint8_t number, of;  // from 1
    bool detected;            // false: all echoes of the ray are too weak, and there is no point
    bool ghost;
    bool mixed;              // away from all surfaces that contributed to it
    bool wrong_voxel;        // mixed, and in a surveyed voxel that none of its echoes came from
    float t, reflectivity;   // t with noise
    std::uint32_t triangle;  // of the strongest echo in it
    std::uint32_t voxel;     // kNoVoxel if the point does not count
    DroppedPoints dropped;   // limits that alone keep it from counting
    Float3 point, normal;
    Float2 weights;
  };
  // Returns the wanted returns of `ray_count` rays that the scanner detects, in order of ray and number.
  std::vector<Return> returns(const Scanner& scanner, const TraceScanner& traced, const TraceStation& station,
                              const BeamOptions& options, std::uint64_t first_ray, std::uint64_t ray_count) const;

  // Fills all arrays of `raw`, and `ghost` and `count`, with return `number` of each ray.
  static void fill(const std::vector<Return>& returns, std::uint8_t number, std::uint64_t first_ray,
                   std::uint64_t ray_count, Tracer::RawChunk& raw, std::vector<std::uint8_t>& ghost,
                   std::vector<std::uint8_t>& count, ScanSummary& summary);

  // Figures of a station, as in NetworkCounts.
  struct Totals {
    std::uint64_t points = 0, points_on_surveyed = 0;
    DroppedPoints dropped;
    MixedPoints mixed;
    friend Totals operator+(const Totals& a, const Totals& b) {
      return {a.points + b.points, a.points_on_surveyed + b.points_on_surveyed, a.dropped + b.dropped,
              a.mixed + b.mixed};
    }
  };
  // Counts all rays of a station into `points`, one element for each surveyed voxel. Returns nothing if stopped.
  std::optional<Totals> count(const Scanner& scanner, const TraceScanner& traced, const TraceStation& station,
                              const BeamOptions& options, std::span<std::uint32_t> points,
                              const Progress& progress) const;

 private:
  struct Echo;
  class Follower;
  static MixedPoints mixed_points(const Return& own);

  std::shared_ptr<const SceneData> scene_;
  std::shared_ptr<const VoxelGrid> grid_;
  RayFollower rays_;
};

}  // namespace vantage
