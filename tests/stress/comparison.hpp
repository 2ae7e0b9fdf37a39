// SPDX-License-Identifier: Apache-2.0
// Compares an engine with the double-precision brute force of support/reference_tracer.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "support/reference_tracer.hpp"
#include "trace/tracer.hpp"
#include "vantage/objective.hpp"

namespace vantage::test {

// Largest differences over all rays that hit the same triangle in both.
struct Comparison {
  std::uint64_t rays = 0, hits = 0;
  std::uint64_t differing = 0;    // in hit, mesh or voxel
  std::uint64_t unexplained = 0;  // of these, further than 1e-4 m from an edge, an end of the range or a voxel face
  std::uint64_t broken = 0;       // not a number, or a hit outside the range
  double range_m = 0, relative_range = 0, sigma_m = 0;
  void add(const Comparison& other);
};

std::shared_ptr<Tracer> make_tracer(const EngineInfo& engine, const TraceScene& scene);

// One station without noise.
Comparison compare(Tracer& tracer, const TraceScene& scene, const TraceStation& station,
                   std::span<const ReferenceHit> reference);
Comparison compare(Tracer& tracer, const TraceScene& scene, const TraceStation& station);

// Largest difference between the σ that moved the engine's points and the model's σ for the reference's distance and
// reflectivity. `noisy` and `clean` trace the same scene with and without `noise`.
double sigma_difference(Tracer& noisy, Tracer& clean, const NoiseModel& noise, const TraceStation& station,
                        std::span<const ReferenceHit> reference);

// Equations 8, 11 and 13 term by term, in double.
struct BruteForce {
  double coverage = 0, clustering = 0;
  OverlapMatrix overlap;
};
BruteForce brute_force_objectives(const VoxelGrid& grid, double goal_density,
                                  std::span<const std::vector<ReferenceHit>> stations);

}  // namespace vantage::test
