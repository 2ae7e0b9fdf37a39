// SPDX-License-Identifier: Apache-2.0
// Shared by all ways of tracing on the CPU: a scanner's rays, and the conversion of hits to points. Each way gives the
// same bits for a ray's point.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "trace/embree/glass_panes.hpp"
#include "trace/embree/hits.hpp"
#include "trace/embree/occluding_patch.hpp"
#include "trace/embree/point_judge.hpp"
#include "trace/embree/range_noise.hpp"
#include "trace/embree/ray_caster.hpp"
#include "trace/embree/surface.hpp"
#include "trace/embree/voxel_lookup.hpp"
#include "trace/tracer.hpp"

namespace vantage {

// Rays that are traced together: at most `kSide` rows and columns, or as many rays of a list.
struct RayTile {
  static constexpr std::uint32_t kSide = 16;
  static_assert(kSide * kSide <= RayBundle::kCapacity);
  std::uint32_t row = 0, column = 0, rows = 0, columns = 0;
  static std::uint32_t rows_of(const RayPattern& pattern) { return pattern.list ? kSide * kSide : kSide; }
};

// The scene, common to all scanners.
struct EmbreeScene {
  explicit EmbreeScene(const TraceScene& traced)
      : scene(traced.scene),
        grid(traced.grid),
        sample_triangles(traced.sample_triangles ? traced.sample_triangles
                                                 : std::make_shared<SampleTriangles>(scene, grid)),
        planes(std::make_shared<Planes>(scene)),
        caster(scene, planes),
        surface(scene, planes),
        prefixes(*grid),
        patches(std::in_place, *scene),
        glass(weakens_through_glass(traced) ? std::make_unique<const GlassPanes>(scene, planes) : nullptr),
        whole_scans(traced.whole_scans) {}

  // Takes a changed scene, as Tracer::take().
  bool take(const TraceScene& traced, const SceneDifference& difference);

  std::shared_ptr<const SceneData> scene;
  std::shared_ptr<const VoxelGrid> grid;
  std::shared_ptr<SampleTriangles> sample_triangles;
  std::shared_ptr<Planes> planes;
  RayCaster caster;
  Surface surface;
  BrickPrefixes prefixes;
  std::optional<OccludingPatches> patches;
  std::unique_ptr<const GlassPanes> glass;  // null: no glass weakens echoes
  WholeScans whole_scans;
};

// Turns directions of a pattern for a turned station.
inline void turn_all(const Turn& turn, float* __restrict x, float* __restrict y, float* __restrict z, std::size_t n) {
  for (std::size_t k = 0; k < n; ++k) {
    const Float3 d = turn({x[k], y[k], z[k]});
    x[k] = d.x;
    y[k] = d.y;
    z[k] = d.z;
  }
}

// Rays of one scanner.
class StationRays {
 public:
  StationRays(std::shared_ptr<const EmbreeScene> scene, const TraceScanner& scanner)
      : scene_(std::move(scene)),
        pattern_(scanner.pattern),
        noise_(scanner.noise),
        judge_(scanner.limits),
        glass_(scanner.limits && scanner.limits->glass ? scene_->glass.get() : nullptr),
        echo_alone_(judge_.judges_echo_alone() && scene_->scene->normals.empty()) {}

  const SceneData& scene() const { return *scene_->scene; }
  const VoxelGrid& grid() const { return *scene_->grid; }
  SampleTriangles& sample_triangles() const { return *scene_->sample_triangles; }
  const RayPattern& pattern() const { return *pattern_; }
  const RangeNoise& noise() const { return noise_; }
  const Planes& planes() const { return *scene_->planes; }
  const RayCaster& caster() const { return scene_->caster; }
  const Surface& surface() const { return scene_->surface; }
  const OccludingPatches& patches() const { return *scene_->patches; }
  WholeScans whole_scans() const { return scene_->whole_scans; }
  VoxelLookup voxels() const { return {grid(), scene_->prefixes}; }

  std::uint64_t ray(std::uint32_t row, std::uint32_t column) const {
    return std::uint64_t{row} * pattern_->columns() + column;
  }

  // Gathers the tile's rays, row by row, into a bundle that ends at `end`.
  void gather(const TraceStation& station, const RayTile& tile, float end, RayBundle& rays) const {
    const RayPattern& p = *pattern_;
    rays.origin = station.origin;
    rays.start = p.min_range;
    rays.size = tile.rows * tile.columns;
    const bool listed = p.list != nullptr;  // one column, whose azimuth is that of the row
    const std::vector<float>&all_cosines = listed ? p.list->cos_azimuth : p.cos_azimuth,
          &all_sines = listed ? p.list->sin_azimuth : p.sin_azimuth;
    for (std::uint32_t i = 0; i < tile.rows; ++i) {
      const std::uint32_t azimuth = listed ? tile.row + i : tile.column;
      const float *const cosines = all_cosines.data() + azimuth, *const sines = all_sines.data() + azimuth;
      const float sine = p.sin_zenith[tile.row + i], cosine = p.cos_zenith[tile.row + i];
      float* __restrict const x = rays.x + i * tile.columns;
      float* __restrict const y = rays.y + i * tile.columns;
      float* __restrict const z = rays.z + i * tile.columns;
      for (std::uint32_t j = 0; j < tile.columns; ++j) {
        x[j] = sine * cosines[j];
        y[j] = sine * sines[j];
        z[j] = cosine;
      }
    }
    if (station.turn) turn_all(*station.turn, rays.x, rays.y, rays.z, rays.size);
    std::fill_n(rays.end, rays.size, end);
  }

  // Fills hits.range, noise included; with `for_voxels` only as far as noise moves points to other voxels.
  void find_ranges(const TraceStation& station, Hits& hits, bool for_voxels) const {
    vantage::find_ranges(surface(), noise_, station.origin, station.place, hits, for_voxels ? &grid() : nullptr);
  }

  bool limited() const { return judge_.enabled(); }
  // Returns true if noise or lost echoes are drawn by the ray's number.
  bool draws() const { return noise_.enabled() || judge_.loses_echoes(); }
  // Returns true if the echo of this ray is lost at random.
  bool lost(std::uint64_t ray, std::uint32_t place) const { return judge_.lost(ray, place); }
  // Returns the glass that weakens echoes of this scanner; null if there is none.
  const GlassPanes* glass() const { return glass_; }
  // Returns true if all hits certainly count when no glass is before them; else dropped() decides.
  [[gnu::always_inline]] bool all_count(const Hits& hits) const {
    if (!echo_alone_) return false;
    for (std::uint32_t k = 0; k < hits.size;) {
      const std::uint32_t triangle = hits.primitive[k];
      std::uint32_t end = k + 1;
      while (end < hits.size && hits.primitive[end] == triangle) ++end;
      const Vec3 n = planes().normal(triangle);
      const double reach_square = judge_.reach_square(surface().mesh(triangle));
      std::uint32_t missed = 0;
      for (; k < end; ++k)
        missed |= PointJudge::detected(reach_square, dot(n, widen(Float3{hits.x[k], hits.y[k], hits.z[k]})), hits.t[k])
                      ? 0u
                      : 1u;
      if (missed && reach_square > 0) return false;
    }
    return true;
  }
  // Returns true if all hits on a triangle certainly count, with no glass before them, at cosines of incidence from
  // `cosine` on and distances up to t.
  bool all_count(std::uint32_t triangle, double cosine, double t) const {
    if (!limited()) return true;
    if (!echo_alone_) return false;
    const double reach_square = judge_.reach_square(surface().mesh(triangle));
    return reach_square == 0 || t * t * (1 + 0x1p-20) <= reach_square * cosine;
  }
  // Returns the limits for which a ray's point is dropped; none if it counts. `passed`: share of its echo that passes
  // glass. REQUIRES: limited(); rays.primitive[slot] is a hit.
  DroppedPoints dropped(const TraceStation& station, std::uint64_t ray, const RayBundle& rays, std::uint32_t slot,
                        double passed) const {
    return dropped(station, ray, {rays.x[slot], rays.y[slot], rays.z[slot]}, rays.t[slot], rays.primitive[slot],
                   passed);
  }
  DroppedPoints dropped(const TraceStation& station, std::uint64_t ray, const Float3& d, float t,
                        std::uint32_t triangle, double passed) const {
    DroppedPoints dropped = missed(station.origin, d, t, triangle, passed);
    if (lost(ray, station.place)) dropped.echo = dropped.points = 1;
    return dropped;
  }

 private:
  DroppedPoints missed(const Float3& origin, const Float3& d, float t, std::uint32_t triangle, double passed) const {
    if (echo_alone_)
      return judge_.missed(surface().mesh(triangle), dot(planes().normal(triangle), widen(d)), t, 0, passed);
    const Facet facet = surface().facet(triangle);
    const Vec3 normal = facet.smooth ? facet.smooth_normal(d, facet.weights(origin, d, t)) : facet.flat_normal(d);
    return judge_.missed(surface().mesh(triangle), dot(normal, widen(d)), t, facet.reflectivity(d, normal), passed);
  }

  std::shared_ptr<const EmbreeScene> scene_;
  std::shared_ptr<const RayPattern> pattern_;
  RangeNoise noise_;
  PointJudge judge_;
  const GlassPanes* glass_;
  bool echo_alone_;  // only echoes are limited, and planes' normals decide
};

}  // namespace vantage
