// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/hits.hpp"

#include <algorithm>

#include "core/target_clones.hpp"

namespace vantage {
namespace {

constexpr std::uint32_t lanes = Hits::lanes;
// Deviations that noise moves a point by at most: it is truncated at five, and rounded.
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

// True if eight hits stay in their voxels, however far noise of these deviations moves them. A coordinate of a point,
// rounded as everywhere, grows or falls with the range, so what ends in one cell at both ends of the noise lies in it
// between them.
[[gnu::always_inline]] inline bool stay_in_voxels(const Floats8& sigmas, const Float3& origin, const VoxelGrid& grid,
                                                  const Hits& hits, std::uint32_t first) {
  Floats8 t;
  load(t, hits.t + first);
  const Floats8 reach = kFarthest * sigmas, near = t - reach, far = t + reach;
  const float cells = static_cast<float>(1u << grid.depth());
  Ints8 differ{};
  const auto along = [&](const float* directions, float from, float min) __attribute__((always_inline)) {
    Floats8 d;
    load(d, directions + first);
    const Floats8 a = ((from + near * d) - min) * grid.inverse_size(),
                  b = ((from + far * d) - min) * grid.inverse_size();
    const Ints8 inside = (a >= 0.0f) & (a < cells) & (b >= 0.0f) & (b < cells);
    const Floats8 one = inside ? a : Floats8{}, other = inside ? b : 1.0f - Floats8{};
    differ |= __builtin_convertvector(one, Ints8) ^ __builtin_convertvector(other, Ints8);
  };
  along(hits.x, origin.x, grid.min()[0]);
  along(hits.y, origin.y, grid.min()[1]);
  along(hits.z, origin.z, grid.min()[2]);
  return !any(differ);
}

VANTAGE_TARGET_CLONES
void add_noise(const Surface& surface, const RangeNoise& noise, const Float3& origin, std::uint32_t place, Hits& hits,
               const VoxelGrid* grid) {
  for (std::uint32_t first = 0; first < hits.size; first += lanes) {
    alignas(32) float reflectivity[2 * lanes];
    const std::uint32_t last = std::min(first + lanes, hits.size);
    for (std::uint32_t k = first; k < last;) {
      const std::uint32_t triangle = hits.primitive[k];
      // Runs past the triangle's hits; those values are overwritten by the next triangle's, or never read.
      shade(surface.facet(triangle), origin, hits.x + k, hits.y + k, hits.z + k, hits.t + k,
            reflectivity + (k - first));
      while (k < last && hits.primitive[k] == triangle) ++k;
    }
    Floats8 sigmas;
    noise.find_sigmas(hits.t + first, reflectivity, sigmas);
    if (grid && stay_in_voxels(sigmas, origin, *grid, hits, first)) {
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
