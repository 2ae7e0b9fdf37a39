// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/hits.hpp"

#include <algorithm>

#include "core/target_clones.hpp"

namespace vantage {
namespace {

constexpr std::uint32_t lanes = Hits::lanes;

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

VANTAGE_TARGET_CLONES
void add_noise(const Surface& surface, const RangeNoise& noise, const Float3& origin, std::uint32_t place, Hits& hits) {
  alignas(64) float reflectivity[Hits::capacity];
  alignas(64) std::uint32_t bits[Hits::capacity];
  for (std::uint32_t first = 0; first < hits.size;) {
    std::uint32_t end = first + 1;
    while (end < hits.size && hits.primitive[end] == hits.primitive[first]) ++end;
    const Facet facet = surface.facet(hits.primitive[first]);
    // The last vector may run past the triangle's hits; those values are overwritten later.
    for (std::size_t k = first; k < end; k += lanes)
      shade(facet, origin, hits.x + k, hits.y + k, hits.z + k, hits.t + k, reflectivity + k);
    first = end;
  }
  for (std::uint32_t first = 0; first < hits.size; first += lanes)
    noise.draw<lanes>(hits.ray_low + first, hits.ray_high + first, place, bits + first);
  for (std::uint32_t first = 0; first < hits.size; first += lanes)
    noise.displace_eight(hits.t + first, reflectivity + first, bits + first, hits.range + first);
}

}  // namespace

void find_ranges(const Surface& surface, const RangeNoise& noise, const Float3& origin, std::uint32_t place,
                 Hits& hits) {
  if (!noise.enabled()) {
    std::copy_n(hits.t, hits.size, hits.range);
    return;
  }
  // The last vector may run past the last hit; those values are never read.
  for (float* values : {hits.x, hits.y, hits.z, hits.t}) std::fill_n(values + hits.size, std::size_t{lanes}, 1.0f);
  for (std::uint32_t* values : {hits.ray_low, hits.ray_high}) std::fill_n(values + hits.size, std::size_t{lanes}, 0u);
  add_noise(surface, noise, origin, place, hits);
}

}  // namespace vantage
