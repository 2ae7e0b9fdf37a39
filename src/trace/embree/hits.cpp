// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/hits.hpp"

#include <algorithm>

#include "core/target_clones.hpp"

namespace vantage {
namespace {

constexpr std::uint32_t kLanes = Hits::kLanes;
// Fewer hits in a row of one triangle are tested with others, as a bound for them alone costs as much as their noise.
constexpr std::uint32_t kFew = 4;
// Largest number of standard deviations by which noise moves a point: truncated at five, plus rounding.
constexpr float kFarthest = 5.01f;

// Shades several hits of one triangle. Each kind of normal has its own loop, since a branch would prevent
// vectorisation.
[[gnu::always_inline]] inline void shade(const Facet& facet, const Float3& o, const float* x, const float* y,
                                         const float* z, const float* t, float* __restrict reflectivity) {
  if (facet.smooth) {
    for (std::size_t k = 0; k < kLanes; ++k) {
      const Float3 d{x[k], y[k], z[k]};
      reflectivity[k] = facet.reflectivity(d, facet.smooth_normal(d, facet.weights(o, d, t[k])));
    }
  } else {
    for (std::size_t k = 0; k < kLanes; ++k) {
      const Float3 d{x[k], y[k], z[k]};
      reflectivity[k] = facet.reflectivity(d, facet.flat_normal(d));
    }
  }
}

// Marks those of eight hits that may leave their voxels if moved within this reach. Otherwise all sides of a cell along
// each axis are farther away, with all roundings of a coordinate.
[[gnu::always_inline]] inline void leave_voxels(const Floats8& reach, const Float3& origin, const VoxelGrid& grid,
                                                const float* x, const float* y, const float* z, const float* distance,
                                                Ints8& leaves) {
  Floats8 t;
  load(t, distance);
  const float cells = static_cast<float>(1u << grid.depth()), inverse = grid.inverse_size();
  // Three roundings of the largest coordinate, and as many of the shifted one.
  const auto doubt_of = [&](float from, float min) {
    return 0x1p-20f * ((std::abs(from) + std::abs(min)) * inverse + cells);
  };
  leaves = Ints8{};
  const auto along = [&](const float* directions, float from, float min) __attribute__((always_inline)) {
    Floats8 d;
    load(d, directions);
    const Floats8 at = ((from + t * d) - min) * inverse;
    const Floats8 inside = (at >= 0.0f) & (at < cells) ? at : Floats8{};  // others count as if on a side
    const Floats8 part = inside - __builtin_convertvector(__builtin_convertvector(inside, Ints8), Floats8),
                  nearest = part < 1.0f - part ? part : 1.0f - part, size = d < 0.0f ? -d : d;
    leaves |= nearest <= reach * inverse * size + doubt_of(from, min);
  };
  along(x, origin.x, grid.min()[0]);
  along(y, origin.y, grid.min()[1]);
  along(z, origin.z, grid.min()[2]);
}

// Bounds how far noise moves hits of a facet, without their normals.
[[gnu::always_inline]] inline float reach_of(const RangeNoise& noise, const Facet& facet, const Hits& hits,
                                             std::uint32_t first, std::uint32_t end) {
  const Float3 n = narrow(facet.plane);
  Floats8 least = 1.0f - Floats8{}, farthest{};
  for (std::uint32_t k = first; k < end; k += kLanes) {
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

// Lists the hits whose noise matters: all, or with a grid those that may leave their voxels. Returns their number.
template <class FacetOf>
[[gnu::always_inline]] inline std::uint32_t list_moved(const RangeNoise& noise, const Float3& origin, const Hits& hits,
                                                       const VoxelGrid* grid, const FacetOf& facet_of,
                                                       std::uint32_t* moved) {
  std::uint32_t many = 0;
  for (std::uint32_t first = 0, end; first < hits.size; first = end) {
    end = first + 1;
    while (end < hits.size && hits.primitive[end] == hits.primitive[first]) ++end;
    if (!grid || end - first < kFew) {
      for (std::uint32_t k = first; k < end; ++k) moved[many++] = k;
      continue;
    }
    const float reach = reach_of(noise, facet_of(hits.primitive[first]), hits, first, end);
    for (std::uint32_t k = first; k < end; k += kLanes) {
      Ints8 leaves;
      leave_voxels(reach - Floats8{}, origin, *grid, hits.x + k, hits.y + k, hits.z + k, hits.t + k, leaves);
      if (!any(leaves)) continue;
      const std::uint32_t of_run = std::min(end - k, kLanes);
      for (std::uint32_t i = 0; i < of_run; ++i) {
        moved[many] = k + i;
        many += leaves[i] != 0;
      }
    }
  }
  return many;
}

VANTAGE_TARGET_CLONES
void add_noise(const Surface& surface, const RangeNoise& noise, const Float3& origin, std::uint32_t place, Hits& hits,
               const VoxelGrid* grid) {
  Facet facet;
  std::uint32_t known = RayBundle::kNoHit;  // the facet's triangle
  const auto facet_of = [&](std::uint32_t triangle) -> const Facet& {
    if (triangle != known) facet = surface.facet(triangle), known = triangle;
    return facet;
  };
  std::uint32_t moved[Hits::kCapacity];
  const std::uint32_t many = list_moved(noise, origin, hits, grid, facet_of, moved);
  std::copy_n(hits.t, hits.size, hits.range);
  for (std::uint32_t first = 0; first < many; first += kLanes) {
    alignas(32) float x[2 * kLanes]{}, y[2 * kLanes]{}, z[2 * kLanes]{}, t[2 * kLanes]{}, reflectivity[2 * kLanes],
        range[kLanes];
    alignas(32) std::uint32_t low[kLanes], high[kLanes], triangle[kLanes], bits[kLanes];
    const std::uint32_t here = std::min(many - first, kLanes);
    for (std::uint32_t i = 0; i < kLanes; ++i) {
      const std::uint32_t k = moved[first + std::min(i, here - 1)];
      x[i] = hits.x[k], y[i] = hits.y[k], z[i] = hits.z[k], t[i] = hits.t[k];
      low[i] = hits.ray_low[k], high[i] = hits.ray_high[k], triangle[i] = hits.primitive[k];
    }
    for (std::uint32_t i = 0; i < here;) {
      // Overwrites values past the triangle's hits, which the next triangle replaces or nobody reads.
      shade(facet_of(triangle[i]), origin, x + i, y + i, z + i, t + i, reflectivity + i);
      for (const std::uint32_t one = triangle[i]; i < here && triangle[i] == one;) ++i;
    }
    Floats8 sigmas;
    noise.find_sigmas(t, reflectivity, sigmas);
    if (grid) {
      Ints8 leaves;
      leave_voxels(kFarthest * sigmas, origin, *grid, x, y, z, t, leaves);
      if (!any(leaves)) continue;
    }
    noise.draw<kLanes>(low, high, place, bits);
    noise.displace_eight(t, sigmas, bits, range);
    for (std::uint32_t i = 0; i < here; ++i) hits.range[moved[first + i]] = range[i];
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
  for (float* values : {hits.x, hits.y, hits.z, hits.t}) std::fill_n(values + hits.size, std::size_t{kLanes}, 1.0f);
  for (std::uint32_t* values : {hits.ray_low, hits.ray_high}) std::fill_n(values + hits.size, std::size_t{kLanes}, 0u);
  add_noise(surface, noise, origin, place, hits, grid);
}

}  // namespace vantage
