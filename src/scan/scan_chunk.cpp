// SPDX-License-Identifier: Apache-2.0
#include "scan/scan_chunk.hpp"

#include <cmath>
#include <functional>
#include <limits>

#include "core/parallel.hpp"
#include "scene/surface_colour.hpp"

namespace vantage {
namespace {

constexpr std::uint32_t kNoPrimitive = 0xFFFFFFFFu;
constexpr std::size_t kGrain = 4096;

// Neighbouring rays mostly hit the same mesh, so the last one is tried before searching.
class MeshLookup {
 public:
  explicit MeshLookup(const SceneData& scene) : scene_(scene) {}
  std::uint32_t operator()(std::uint32_t primitive) {
    const MeshRange& range = scene_.ranges[last_];
    if (primitive - range.first_triangle >= range.triangle_count) last_ = scene_.mesh_of(primitive);
    return last_;
  }

 private:
  const SceneData& scene_;
  std::uint32_t last_ = 0;
};

struct Sums {
  std::uint64_t points = 0, counted = 0, surveyed = 0, ghosts = 0;
  friend Sums operator+(const Sums& a, const Sums& b) {
    return {a.points + b.points, a.counted + b.counted, a.surveyed + b.surveyed, a.ghosts + b.ghosts};
  }
};

Sums sum_rays(const Tracer::RawChunk& raw, const std::vector<std::uint8_t>& ghost, std::size_t count,
              const SceneData& scene) {
  return parallel::reduce(
      tbb::blocked_range<std::size_t>(0, count, kGrain), Sums{},
      [&](const tbb::blocked_range<std::size_t>& range, Sums sums) {
        MeshLookup mesh_of(scene);
        for (std::size_t k = range.begin(); k != range.end(); ++k) {
          if (raw.primitive[k] == kNoPrimitive) continue;
          ++sums.points;
          if (ghost[k] != 0) {
            ++sums.ghosts;
            continue;
          }
          sums.counted += raw.voxel[k] != kNoVoxel;
          sums.surveyed += scene.meshes[mesh_of(raw.primitive[k])].role == Role::surveyed;
        }
        return sums;
      },
      std::plus<>());
}

// Makes one element for each ray and output; arrays that are not wanted stay empty.
template <class To, class Make>
void fill(std::vector<To>& to, std::size_t count, Make make) {
  to.resize(count);
  parallel::for_all(tbb::blocked_range<std::size_t>(0, count, kGrain),
                    [&](const tbb::blocked_range<std::size_t>& range) { make(range.begin(), range.end()); });
}

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr std::array<float, 3> kNowhere{kNan, kNan, kNan};

std::array<float, 3> array_of(const Float3& v) { return {v.x, v.y, v.z}; }

}  // namespace

std::uint32_t raw_outputs(const ScanOptions& options) {
  const std::uint32_t outputs = options.outputs;
  std::uint32_t raw = Tracer::primitive | Tracer::voxel;
  if ((outputs & scan_range) || options.instrument) raw |= Tracer::range;
  if (outputs & scan_position) raw |= Tracer::position;
  if (outputs & scan_normal) raw |= Tracer::normal;
  if (outputs & scan_reflectivity) raw |= Tracer::reflectivity;
  if ((outputs & scan_colour) && !options.colour) raw |= Tracer::barycentric;
  return raw;
}

void fill_chunk(ScanChunk& chunk, Tracer::RawChunk& raw, const std::vector<std::uint8_t>& ghost,
                const std::vector<std::uint8_t>& returns, const ScanOptions& options, const SceneData& scene,
                const Scanner& scanner, ScanSummary& summary) {
  const std::uint32_t outputs = options.outputs;
  const auto count = static_cast<std::size_t>(chunk.ray_count);
  const Sums sums = sum_rays(raw, ghost, count, scene);
  if (chunk.return_number == 1) summary.rays += chunk.ray_count;
  summary.points += sums.points;
  summary.points_on_surveyed += sums.counted;
  summary.hits_on_surveyed += sums.surveyed;
  summary.ghosts += sums.ghosts;
  if (outputs & scan_ghost) chunk.ghost = ghost;
  if (outputs & scan_returns) chunk.returns = returns;

  if (outputs & scan_position) {
    fill(chunk.position, count, [&](std::size_t k, std::size_t end) {
      for (; k != end; ++k) chunk.position[k] = raw.primitive[k] == kNoPrimitive ? kNowhere : array_of(raw.position[k]);
    });
  }
  if (outputs & scan_normal) {
    fill(chunk.normal, count, [&](std::size_t k, std::size_t end) {
      for (; k != end; ++k) chunk.normal[k] = array_of(raw.normal[k]);
    });
  }
  if (outputs & scan_ids) {
    fill(chunk.mesh, count, [&](std::size_t k, std::size_t end) {
      MeshLookup mesh_of(scene);
      for (; k != end; ++k)
        chunk.mesh[k] = raw.primitive[k] == kNoPrimitive ? -1 : static_cast<std::int32_t>(mesh_of(raw.primitive[k]));
    });
  }
  if (outputs & scan_colour) {
    fill(chunk.colour, count, [&](std::size_t k, std::size_t end) {
      MeshLookup mesh_of(scene);
      for (; k != end; ++k) {
        if (raw.primitive[k] == kNoPrimitive) {
          chunk.colour[k] = 0;
        } else if (options.colour) {
          const RayAngles angles = scanner.angles(chunk.first_ray + k);
          chunk.colour[k] = options.colour(angles.zenith, angles.azimuth);
        } else {
          chunk.colour[k] = surface_colour(scene, mesh_of(raw.primitive[k]), raw.primitive[k], raw.barycentric[k]);
        }
      }
    });
  }
  // Passes on the other arrays by swapping, so that both sides keep their memory between chunks.
  if (outputs & scan_ids) {
    chunk.primitive.swap(raw.primitive);
    chunk.primitive.resize(count);
  }
  if (outputs & scan_range) {
    chunk.range_m.swap(raw.range);
    chunk.range_m.resize(count);
  }
  if (outputs & scan_reflectivity) {
    chunk.reflectivity.swap(raw.reflectivity);
    chunk.reflectivity.resize(count);
  }
  if (outputs & scan_voxel) {
    chunk.voxel.swap(raw.voxel);
    chunk.voxel.resize(count);
  }
}

}  // namespace vantage
