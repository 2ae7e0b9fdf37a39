// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/hits.hpp"

#include <algorithm>

#include "core/target_clones.hpp"

namespace vantage {
namespace {

constexpr std::uint32_t lanes = Hits::lanes;
// Largest number of standard deviations by which noise moves a point. It is truncated at five, and rounded.
constexpr float kFarthest = 5.01f;

// Shades several hits of one triangle. Each kind of normal has its own loop, since a branch would prevent
// vectorisation.
[[gnu::always_inline]] inline void shade(const Facet& facet, const Float3& o, const float* x, const float* y,
                                         const float* z, const float* t, float* __restrict reflectivity) {
  if (facet.smooth) {
    for (std::size_t k = 0; k < lanes; ++k) {
      const Float3 d{x[k], y[k], z[k]};
      reflectivity[k] = facet.reflectivity(d, facet.smooth_normal(d, facet.weights(o, d, t[k])));
    }
  } else {
    for (std::size_t k = 0; k < lanes; ++k) {
      const Float3 d{x[k], y[k], z[k]};
      reflectivity[k] = facet.reflectivity(d, facet.flat_normal(d));
    }
  }
}

// True if eight hits stay in their voxels, however they are moved within this reach. Along each axis, all sides of
// their cells must be farther away than that, with all roundings of a coordinate.
[[gnu::always_inline]] inline bool stay_in_voxels(const Floats8& reach, const Float3& origin, const VoxelGrid& grid,
                                                  const Hits& hits, std::uint32_t first) {
  Floats8 t;
  load(t, hits.t + first);
  const float cells = static_cast<float>(1u << grid.depth()), inverse = grid.inverse_size();
  // Three roundings of the largest coordinate, and as many of what is moved.
  const auto doubt_of = [&](float from, float min) {
    return 0x1p-20f * ((std::abs(from) + std::abs(min)) * inverse + cells);
  };
  Ints8 leaves{};
  const auto along = [&](const float* directions, float from, float min) __attribute__((always_inline)) {
    Floats8 d;
    load(d, directions + first);
    const Floats8 at = ((from + t * d) - min) * inverse;
    const Floats8 inside = at >= 0.0f & at < cells ? at : Floats8{};  // others are as near to a side as can be
    const Floats8 part = inside - __builtin_convertvector(__builtin_convertvector(inside, Ints8), Floats8),
                  nearest = part < 1.0f - part ? part : 1.0f - part, size = d < 0.0f ? -d : d;
    leaves |= nearest <= reach * inverse * size + doubt_of(from, min);
  };
  along(hits.x, origin.x, grid.min()[0]);
  along(hits.y, origin.y, grid.min()[1]);
  along(hits.z, origin.z, grid.min()[2]);
  return !any(leaves);
}

// Bound on how far noise moves hits of a facet, without their normals.
[[gnu::always_inline]] inline float reach_of(const RangeNoise& noise, const Facet& facet, const Hits& hits,
                                             std::uint32_t first, std::uint32_t end) {
  const Float3 n = narrow(facet.plane);
  Floats8 least = 1.0f - Floats8{}, farthest{};
  for (std::uint32_t k = first; k < end; k += lanes) {
    Floats8 x, y, z, t;
    load(x, hits.x + k);
    load(y, hits.y + k);
    load(z, hits.z + k);
    load(t, hits.t + k);
    const Floats8 slope = n.x * x + n.y * y + n.z * z, cosine = slope < 0.0f ? -slope : slope;
    least = cosine < least ? cosine : least;
    farthest = t > farthest ? t : farthest;
  }
  for (int k = 1; k < 8; ++k) least[0] = std::min(least[0], least[k]), farthest[0] = std::max(farthest[0], farthest[k]);
  const double darkest = facet.diffuse * std::max(static_cast<double>(least[0]) - facet.tilt, 0.0);
  return noise.reach_within(farthest[0], static_cast<float>(darkest));
}

VANTAGE_TARGET_CLONES
void add_noise(const Surface& surface, const RangeNoise& noise, const Float3& origin, std::uint32_t place, Hits& hits,
               const VoxelGrid* grid) {
  Facet facet;
  std::uint32_t known = RayBundle::no_hit;  // the facet's triangle
  const auto facet_of = [&](std::uint32_t triangle) -> const Facet& {
    if (triangle != known) facet = surface.facet(triangle), known = triangle;
    return facet;
  };
  float reach = 0;
  std::uint32_t of_one = 0;  // hits before this one are of one triangle, and noise moves them less than `reach`
  for (std::uint32_t first = 0; first < hits.size; first += lanes) {
    alignas(32) float reflectivity[2 * lanes];
    const std::uint32_t last = std::min(first + lanes, hits.size);
    // Hits in a row are mostly those of one triangle, and their noise mostly matters to no voxel.
    if (grid && first >= of_one) {
      of_one = first;
      while (of_one < hits.size && hits.primitive[of_one] == hits.primitive[first]) ++of_one;
      if (of_one >= last) reach = reach_of(noise, facet_of(hits.primitive[first]), hits, first, of_one);
    }
    if (grid && last <= of_one && stay_in_voxels(reach - Floats8{}, origin, *grid, hits, first)) {
      std::copy_n(hits.t + first, lanes, hits.range + first);
      continue;
    }
    for (std::uint32_t k = first; k < last;) {
      const std::uint32_t triangle = hits.primitive[k];
      // Runs past the triangle's hits; those values are overwritten by the next triangle's, or never read.
      shade(facet_of(triangle), origin, hits.x + k, hits.y + k, hits.z + k, hits.t + k, reflectivity + (k - first));
      while (k < last && hits.primitive[k] == triangle) ++k;
    }
    Floats8 sigmas;
    noise.find_sigmas(hits.t + first, reflectivity, sigmas);
    if (grid && stay_in_voxels(kFarthest * sigmas, origin, *grid, hits, first)) {
      std::copy_n(hits.t + first, lanes, hits.range + first);
      continue;
    }
    alignas(32) std::uint32_t bits[lanes];
    noise.draw<lanes>(hits.ray_low + first, hits.ray_high + first, place, bits);
    noise.displace_eight(hits.t + first, sigmas, bits, hits.range + first);
  }
}

}  // namespace

void find_ranges(const Surface& surface, const RangeNoise& noise, const Float3& origin, std::uint32_t place, Hits& hits,
                 const VoxelGrid* grid) {
  if (!noise.enabled()) {
    std::copy_n(hits.t, hits.size, hits.range);
    return;
  }
  // The last vector may run past the last hit; those values are never read.
  for (float* values : {hits.x, hits.y, hits.z, hits.t}) std::fill_n(values + hits.size, std::size_t{lanes}, 1.0f);
  for (std::uint32_t* values : {hits.ray_low, hits.ray_high}) std::fill_n(values + hits.size, std::size_t{lanes}, 0u);
  add_noise(surface, noise, origin, place, hits, grid);
}

}  // namespace vantage
