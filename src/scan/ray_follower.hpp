// SPDX-License-Identifier: Apache-2.0
// Rays of scans that the processor follows for all engines alike: off mirrors, and those of a wide beam.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "scene/scene_data.hpp"
#include "trace/embree/glass_panes.hpp"
#include "trace/embree/ray_caster.hpp"
#include "trace/embree/surface.hpp"
#include "trace/tracer.hpp"

namespace vantage {

// Returns a ray's direction in the local frame, bit for bit as engines compute it.
Float3 direction_of(const RayPattern& pattern, const TraceStation& station, std::uint64_t ray);

// Safe to use from any thread.
class RayFollower {
 public:
  // Shares ownership of `scene`.
  explicit RayFollower(std::shared_ptr<const SceneData> scene);

  // The surface that a ray meets, with its distance along the whole way.
  struct Seen {
    std::uint32_t triangle;  // RayBundle::kNoHit: nothing, or mirrors without end
    float t, reflectivity;
    double cosine;  // of incidence
    Float3 normal;  // as seen in the mirrors
    Float2 weights;
    double passed = 1;  // share of the echo that panes on the way let pass; 0 also if one reflects the beam
  };
  // Returns a hit as seen.
  Seen seen(const Float3& origin, const Float3& direction, float t, std::uint32_t triangle) const;
  // Returns the surface that a ray from start to end meets, also by way of mirrors. Glass counts from the origin on.
  Seen follow(const Float3& origin, const Float3& direction, float start, float end) const;

  // Moves the points of rays that met a mirror to where the scanner sees them: along the ray, at the length of the
  // whole way. Removes points whose echo is too weak, and those of rays that meet nothing. Sets `ghost` to 1 for the
  // others. REQUIRES: raw.primitive is filled.
  void show_ghosts(const TraceScanner& scanner, const TraceStation& station, std::uint64_t first_ray,
                   Tracer::RawChunk& raw, std::span<std::uint8_t> ghost) const;

  std::uint32_t mesh(std::uint32_t triangle) const { return surface_.mesh(triangle); }
  bool is_mirror(std::uint32_t triangle) const { return scene_->meshes[mesh(triangle)].mirror; }
  double distance_from_plane(std::uint32_t triangle, const Vec3& point) const;
  const RayCaster& caster() const { return caster_; }
  const GlassPanes* glass() const { return glass_.get(); }  // null: the scene has none

 private:
  std::shared_ptr<const SceneData> scene_;
  std::shared_ptr<const Planes> planes_;
  RayCaster caster_;
  Surface surface_;
  std::unique_ptr<const GlassPanes> glass_;
};

}  // namespace vantage
