// SPDX-License-Identifier: Apache-2.0
#include "stress/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/normal_table.hpp"
#include "core/philox.hpp"
#include "scan/noise_model.hpp"

namespace vantage::test {
namespace {

// Closer than this to an edge or a face, rounding may decide: 1e-4 m up to 100 m, 64 ulp beyond.
double undecided_m(const ReferenceHit& hit) {
  return std::max(1e-4, hit.triangle == ReferenceHit::none ? 0.0 : 64 * 0x1p-24 * hit.t);
}

std::uint64_t all_rays(const RayPattern& pattern) { return std::uint64_t{pattern.rows()} * pattern.columns(); }

int mesh_of(const SceneData& scene, std::uint32_t triangle) {
  return triangle == ReferenceHit::none ? -1 : static_cast<int>(scene.mesh_of(triangle));
}

}  // namespace

void Comparison::add(const Comparison& other) {
  rays += other.rays;
  hits += other.hits;
  differing += other.differing;
  unexplained += other.unexplained;
  broken += other.broken;
  range_m = std::max(range_m, other.range_m);
  relative_range = std::max(relative_range, other.relative_range);
  sigma_m = std::max(sigma_m, other.sigma_m);
}

std::shared_ptr<Tracer> make_tracer(const EngineInfo& engine, const TraceScene& scene) {
  return vantage::make_tracer(engine.engine, engine.device_index, scene);
}

Comparison compare(Tracer& tracer, const TraceScene& scene, const TraceStation& station,
                   std::span<const ReferenceHit> reference) {
  Tracer::RawChunk chunk;
  tracer.scan(station, 0, all_rays(*scene.scanners[0].pattern),
              Tracer::range | Tracer::position | Tracer::primitive | Tracer::voxel, chunk);
  Comparison c;
  c.rays = reference.size();
  const float least = scene.scanners[0].pattern->min_range, most = scene.scanners[0].pattern->max_range;
  for (std::size_t k = 0; k < reference.size(); ++k) {
    const ReferenceHit& expected = reference[k];
    const bool hit = chunk.primitive[k] != ReferenceHit::none;
    const float range = chunk.range[k];
    const Float3& p = chunk.position[k];
    c.hits += hit;
    if (hit && (!(range >= least * (1 - 1e-6f) && range <= most * (1 + 1e-6f)) || !std::isfinite(p.x + p.y + p.z)))
      ++c.broken;
    if (hit != std::isfinite(range)) ++c.broken;
    if (mesh_of(*scene.scene, chunk.primitive[k]) != mesh_of(*scene.scene, expected.triangle) ||
        chunk.voxel[k] != expected.voxel) {
      ++c.differing;
      c.unexplained += std::min({expected.edge_distance, expected.face_distance, expected.gap}) > undecided_m(expected);
      continue;
    }
    if (!hit || chunk.primitive[k] != expected.triangle) continue;
    const double off = std::abs(static_cast<double>(range) - expected.range);
    c.range_m = std::max(c.range_m, off);
    c.relative_range = std::max(c.relative_range, off / std::max(expected.range, 1e-3));
  }
  return c;
}

Comparison compare(Tracer& tracer, const TraceScene& scene, const TraceStation& station) {
  return compare(tracer, scene, station, ReferenceTracer(scene).scan(station));
}

double sigma_difference(Tracer& noisy, Tracer& clean, const NoiseModel& noise, const TraceStation& station,
                        std::span<const ReferenceHit> reference) {
  Tracer::RawChunk with, without;
  noisy.scan(station, 0, reference.size(), Tracer::range | Tracer::primitive, with);
  clean.scan(station, 0, reference.size(), Tracer::range | Tracer::primitive, without);
  double largest = 0;
  for (std::size_t k = 0; k < reference.size(); ++k) {
    if (with.primitive[k] == ReferenceHit::none || with.primitive[k] != reference[k].triangle) continue;
    const std::uint32_t bits =
        philox4x32(noise.seed, {static_cast<std::uint32_t>(k), 0, station.place, noise_stream})[0];
    const double z = normal_from_bits(bits, normal_table());
    if (std::abs(z) < 1) continue;  // dividing by less would show the rounding of the range
    const double sigma = (static_cast<double>(with.range[k]) - static_cast<double>(without.range[k])) / z;
    largest = std::max(largest, std::abs(sigma - model_sigma(noise, reference[k].t, reference[k].reflectivity)));
  }
  return largest;
}

BruteForce brute_force_objectives(const VoxelGrid& grid, double goal_density,
                                  std::span<const std::vector<ReferenceHit>> stations) {
  std::vector<double> points(grid.size());
  std::vector<std::set<std::uint32_t>> visible(stations.size());
  for (std::size_t s = 0; s < stations.size(); ++s) {
    for (const ReferenceHit& hit : stations[s]) {
      if (hit.voxel == kNoVoxel) continue;
      points[hit.voxel] += 1;
      visible[s].insert(hit.voxel);
    }
  }
  BruteForce result;
  double weights = 0;
  for (std::uint32_t v = 0; v < points.size(); ++v) {
    const auto weight = static_cast<double>(grid.demands().weight(v));
    const VoxelDemands& demands = grid.demands();
    const double goal = goal_density * demands.least_point_weight() / demands.point_weight(v);
    result.coverage += weight * std::min(points[v] / goal, 1.0);
    weights += weight;
  }
  result.coverage /= weights;

  const std::size_t n = stations.size();
  result.overlap = OverlapMatrix(n);
  double largest = 0;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      double both = 0;
      for (const std::uint32_t v : visible[i]) both += visible[j].contains(v) ? 1 : 0;
      const double either = static_cast<double>(visible[i].size() + visible[j].size()) - both;
      result.overlap.set(i, j, either > 0 ? both / either : 0);
      largest = std::max(largest, result.overlap(i, j));
    }
  }
  for (std::size_t i = 0; i < n && largest > 0; ++i) {
    double triangles = 0, pairs = 0;
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t k = 0; k < n; ++k) {
        if (j == i || k == i || j == k) continue;
        triangles += result.overlap(i, j) * result.overlap(j, k) * result.overlap(k, i);
        pairs += result.overlap(i, j) * result.overlap(i, k);
      }
    }
    if (pairs > 0) result.clustering += triangles / pairs / largest / static_cast<double>(n);
  }
  return result;
}

}  // namespace vantage::test
