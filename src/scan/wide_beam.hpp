// SPDX-License-Identifier: Apache-2.0
// A beam that has a width: sub-rays over its footprint, whose echoes merge into returns (docs/method.md).
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "scan/ray_follower.hpp"
#include "scene/scene_data.hpp"
#include "trace/embree/glass_panes.hpp"
#include "trace/tracer.hpp"
#include "vantage/simulator.hpp"
#include "voxel/voxel_grid.hpp"

namespace vantage {

// The same for all engines: everything is traced here, on the processor. Safe to use from any thread.
class WideBeam {
 public:
  // Shares ownership of both.
  WideBeam(std::shared_ptr<const SceneData> scene, std::shared_ptr<const VoxelGrid> grid);

  // One return of one ray.
  struct Return {
    std::uint64_t ray;
    std::uint8_t number, of;  // from 1
    bool ghost, mixed;
    float t, reflectivity;   // t without noise
    std::uint32_t triangle;  // of the strongest echo in it
    double cosine;
    Float3 direction, normal;
    Float2 weights;
  };
  // Wanted returns of `ray_count` rays, in order of ray and number.
  std::vector<Return> returns(const Scanner& scanner, const TraceScanner& traced, const TraceStation& station,
                              const BeamOptions& options, std::uint64_t first_ray, std::uint64_t ray_count) const;

  // Fills all arrays of `raw`, and `ghost` and `count`, with return `number` of each ray.
  void fill(const TraceScanner& traced, const TraceStation& station, const std::vector<Return>& returns,
            std::uint8_t number, std::uint64_t first_ray, std::uint64_t ray_count, Tracer::RawChunk& raw,
            std::vector<std::uint8_t>& ghost, std::vector<std::uint8_t>& count, ScanSummary& summary) const;

 private:
  struct Echo;
  std::vector<Return> returns_of(const Scanner& scanner, const TraceStation& station, const BeamOptions& options,
                                 const RayPattern& pattern, std::uint64_t ray, std::uint64_t seed) const;

  std::shared_ptr<const SceneData> scene_;
  std::shared_ptr<const VoxelGrid> grid_;
  RayFollower rays_;
  std::unique_ptr<const GlassPanes> glass_;  // null: the scene has none
};

}  // namespace vantage
