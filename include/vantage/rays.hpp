// SPDX-License-Identifier: Apache-2.0
/// Rays of a caller's own: arrays of origins and directions in; what each ray meets, out.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "vantage/progress.hpp"
#include "vantage/scene.hpp"
#include "vantage/trace.hpp"
#include "vantage/types.hpp"

namespace vantage {

/// Rays as arrays, borrowed for a call. An array of one element is for all rays, e.g. one origin of many directions.
struct Rays {
  std::span<const Vec3> origins;     ///< Survey frame, metres.
  std::span<const Vec3> directions;  ///< Survey frame, of any finite length above 0.
  /// A hit further away does not count; metres, above 0. Empty: any distance.
  std::span<const double> ranges_m = {};
};

/// Hits that count.
struct RayOptions {
  double from_m = 0;   ///< Only hits further from the origin than this count: 0 or more.
  bool glass = false;  ///< Glass stops rays, as any other surface. False: they pass it, as those of a scan do.
};

/// The first hit of each ray; element k belongs to ray k. Arrays have the names of `ScanPoints`.
struct RayHits {
  std::vector<double> range_m;               ///< Distance from the origin, metres; +infinity without a hit.
  std::vector<Vec3> position;                ///< Survey frame; NaN without a hit.
  std::vector<std::array<float, 3>> normal;  ///< Unit, turned towards the origin; (0, 0, 0) without a hit.
  std::vector<float> reflectivity;           ///< R·(I·(−N)), as of a scan's point; 0 without a hit.
  std::vector<float> diffuse;                ///< R alone (`MeshInfo::diffuse`); 0 without a hit.
  std::vector<std::int32_t> mesh;            ///< Index into `Scene::meshes()`; −1 without a hit.
  std::vector<std::uint32_t> primitive;      ///< Triangle of the scene (all meshes in order); 2³²−1 without a hit.
  std::size_t size() const { return range_m.size(); }  ///< Number of rays.
};

/// Traces rays of any origins and directions in a scene, in double precision: on the processor, or on a graphics card.
/// Every engine gives the same answers, to the bit. The triangles that a ray passes through are decided exactly for the
/// rounded coordinates of the scene, and no ray passes between two triangles that share an edge. A mirror is a surface
/// like any other. Search areas are never hit.
///
/// A graphics card answers in float, with bounds of all its errors, and the processor decides what these leave open:
/// rays that pass an edge within some millionths of the scene's size and of the distance, that begin or end as near to
/// a surface, or that meet two surfaces as near to each other. Distances, positions and normals are the processor's.
/// Rays that are near each other in the scene should be so in the arrays. If most rays begin on surfaces, `from_m` has
/// to take them off, or else the processor has to answer them all.
///
/// Shares ownership of the scene. Immutable; copies share storage; safe to use from any thread. Calls on one tracer's
/// graphics card take turns.
class RayTracer {
 public:
  /// `Engine::automatic` takes the best graphics card, or else the processor. A graphics card that fails is set up anew
  /// once, and its work repeated; fewer rays are taken at once where its memory is short. Throws Error:
  /// no_suitable_device with every refusal, out_of_memory, device_failure.
  explicit RayTracer(const Scene& scene, const DeviceChoice& device = {.engine = Engine::embree});

  const Scene& scene() const noexcept;        ///< The scene that it traces in.
  const EngineInfo& engine() const noexcept;  ///< Engine and device in use.

  /// The nearest hit of each ray; of equally near triangles, that with the lowest number. All calls return empty arrays
  /// if stopped, and throw Error invalid_argument, with the row, for an origin that is not finite or further than
  /// 1000 km from the scene, a direction that is not finite or 0, a range that is not above 0, arrays that do not fit
  /// together, and a call on a graphics card from the progress of another. A graphics card that fails twice throws
  /// out_of_memory or device_failure.
  RayHits nearest(const Rays& rays, const RayOptions& options = {}, const Progress& progress = {}) const;
  /// 1 for a ray that meets anything, else 0. Faster than `nearest`.
  std::vector<std::uint8_t> blocked(const Rays& rays, const RayOptions& options = {},
                                    const Progress& progress = {}) const;
  /// The number of triangles that each ray passes through; on an edge that triangles share, each of them counts.
  std::vector<std::uint32_t> count(const Rays& rays, const RayOptions& options = {},
                                   const Progress& progress = {}) const;

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

}  // namespace vantage
