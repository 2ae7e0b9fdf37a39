// SPDX-License-Identifier: Apache-2.0
// Counts long runs of rays on one triangle by steps. The hits of a column's rays on a plane lie on a line, in the order
// of the rays. If two of them lie in one voxel, too deep for noise to move them out, so do all between, as a voxel is
// convex. If rays are many times denser than voxels, few hits are computed.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "trace/embree/picture.hpp"
#include "trace/embree/planes.hpp"
#include "trace/embree/station_rays.hpp"
#include "trace/embree/vectors.hpp"

namespace vantage {

class RunSteps {
 public:
  static constexpr std::uint32_t kStep = 8;  // rows

  // Borrows all.
  RunSteps(const StationRays& rays, const TraceStation& station, const Picture& picture)
      : rays_(rays), station_(station) {
    // Two hits without glass before them do not exclude glass between.
    if (rays.glass()) return;
    const std::uint32_t rows = rays.pattern().rows();
    sines_.resize((rows + kStep - 1) / kStep + kLanes);
    cosines_.resize(sines_.size());
    for (std::uint32_t row = 0, k = 0; row < rows; row += kStep, ++k) {
      sines_[k] = picture.sines()[row];
      cosines_[k] = picture.cosines()[row];
    }
  }

  // Returns true if a run of so many rays may be counted by steps.
  bool pay(std::uint32_t rays) const { return rays >= 3 * kStep && !sines_.empty(); }

  // Goes along rows `row` to `end` of a column, whose rays all hit this facet's triangle. Calls settled(point, rays)
  // for rays in a row whose points all lie in the voxel of `point`, and rest(from, to) for rows to be computed one by
  // one. Each row is in one call. Inlined, to be compiled for the caller's target.
  template <class Settled, class Rest>
  [[gnu::always_inline]] void along(std::uint32_t row, std::uint32_t end, std::uint32_t column, std::uint32_t triangle,
                                    const Planes::Seen& plane, const Facet& facet, const Settled& settled,
                                    const Rest& rest) const {
    const float cosine = rays_.pattern().cos_azimuth[column], sine = rays_.pattern().sin_azimuth[column];
    std::uint32_t from = row;  // all rows before it are done
    std::uint32_t first = (row + kStep - 1) / kStep;
    const std::uint32_t last = (end - 1) / kStep;
    for (; first + 2 <= last; first = std::min(last, first + (kMost - 1))) {
      const std::uint32_t samples = std::min(last - first + 1, kMost);
      Bounds bounds;
      if (!find_bounds(first, first + samples - 1, cosine, sine, triangle, plane, facet, bounds)) continue;
      Samples found;
      find(first, samples, cosine, sine, plane, bounds, found);
      for (std::uint32_t k = 0; k + 1 < samples;) {
        std::uint32_t same = k + 1;
        while (same < samples && found.x[same] == found.x[k] && found.y[same] == found.y[k] &&
               found.z[same] == found.z[k])
          ++same;
        if (--same > k) {
          const std::uint32_t begin = (first + k) * kStep;
          if (from < begin) rest(from, begin);
          from = (first + same) * kStep;
          settled(Float3{found.px[k], found.py[k], found.pz[k]}, from - begin);
          k = same;
        } else {
          ++k;
        }
      }
    }
    if (from < end) rest(from, end);
  }

 private:
  static constexpr std::uint32_t kLanes = 8, kMost = 32;
  // Largest distance of a hit from a voxel's side at which it may leave the voxel: along any axis, in voxels.
  struct Bounds {
    float reach;   // by noise along the ray; its share counts on each axis
    float beside;  // by roundings of directions
  };
  // Voxels of hits, by axis, and the hits. A hit that may leave its voxel gets a unique voxel.
  struct Samples {
    alignas(32) std::array<std::int32_t, kMost + kLanes> x, y, z;
    alignas(32) std::array<float, kMost + kLanes> px, py, pz;
  };

  // Bounds the hits from one row to another. On an arc of less than half a turn, the cosine of incidence is least, and
  // the distance largest, at an end. Returns false if no bound is known or steps do not pay.
  [[gnu::always_inline]] bool find_bounds(std::uint32_t first, std::uint32_t last, float cosine, float sine,
                                          std::uint32_t triangle, const Planes::Seen& plane, const Facet& facet,
                                          Bounds& bounds) const {
    // A lower slope is near that of rays that nearly lie in the plane (Planes::distances()).
    constexpr double kFlat = 0x1p-8;
    double least = 1, farthest = 0, apart[3] = {};
    bool up[2] = {};
    for (int k = 0; k < 2; ++k) {
      const std::uint32_t at = k == 0 ? first : last;
      Float3 d{sines_[at] * cosine, sines_[at] * sine, cosines_[at]};
      if (station_.turn) d = (*station_.turn)(d);
      const double slope = plane.x * d.x + plane.y * d.y + plane.z * d.z, t = plane.height / slope;
      if (!(std::abs(slope) >= kFlat) || !(t > 0)) return false;
      up[k] = slope > 0;
      least = std::min(least, std::abs(slope));
      farthest = std::max(farthest, t);
      const double sign = k == 0 ? -1 : 1;
      apart[0] += sign * t * d.x, apart[1] += sign * t * d.y, apart[2] += sign * t * d.z;
    }
    if (up[0] != up[1]) return false;
    const double inverse = rays_.grid().inverse_size();
    const double voxels = (std::abs(apart[0]) + std::abs(apart[1]) + std::abs(apart[2])) * inverse;
    if (voxels * 2 > last - first) return false;
    // Directions and distances between are rounded as well.
    least *= 1 - 0x1p-16;
    farthest *= 1 + 0x1p-16;
    if (!rays_.all_count(triangle, least, farthest)) return false;
    const double darkest = facet.diffuse * std::max(least - facet.tilt, 0.0);
    bounds.reach = static_cast<float>(
        rays_.noise().reach_within(static_cast<float>(farthest), static_cast<float>(darkest)) * inverse);
    bounds.beside = static_cast<float>(0x1p-20 * farthest / least * inverse);
    return true;
  }

  [[gnu::always_inline]] void find(std::uint32_t first, std::uint32_t samples, float cosine, float sine,
                                   const Planes::Seen& plane, const Bounds& bounds, Samples& found) const {
    const VoxelGrid& grid = rays_.grid();
    const float inverse = grid.inverse_size(), cells = static_cast<float>(1u << grid.depth());
    const Float3 origin = station_.origin;
    for (std::uint32_t k = 0; k < samples; k += kLanes) {
      Floats8 sines, x, y, z, t;
      load(sines, sines_.data() + first + k);
      load(z, cosines_.data() + first + k);
      x = sines * cosine, y = sines * sine;
      if (station_.turn) {
        const Turn& turn = *station_.turn;
        const Floats8 tx = turn.x.x * x + turn.x.y * y + turn.x.z * z, ty = turn.y.x * x + turn.y.y * y + turn.y.z * z,
                      tz = turn.z.x * x + turn.z.y * y + turn.z.z * z;
        x = tx, y = ty, z = tz;
      }
      Planes::distances(plane, x, y, z, t);
      Ints8 leaves{};
      const auto along = [&](const Floats8& d, float from, float min, std::int32_t* cell, float* point)
          __attribute__((always_inline)) {
        const Floats8 p = from + t * d, at = (p - min) * inverse;
        const Floats8 inside = (at >= 0.0f) & (at < cells) ? at : Floats8{};
        const Ints8 whole = __builtin_convertvector(inside, Ints8);
        const Floats8 part = inside - __builtin_convertvector(whole, Floats8),
                      nearest = part < 1.0f - part ? part : 1.0f - part, size = d < 0.0f ? -d : d;
        const float doubt = 0x1p-20f * ((std::abs(from) + std::abs(min)) * inverse + cells) + bounds.beside;
        leaves |= nearest <= bounds.reach * size + doubt;
        store(cell + k, whole);
        store(point + k, p);
      };
      along(x, origin.x, grid.min()[0], found.x.data(), found.px.data());
      along(y, origin.y, grid.min()[1], found.y.data(), found.py.data());
      along(z, origin.z, grid.min()[2], found.z.data(), found.pz.data());
      const Ints8 own = -1 - static_cast<std::int32_t>(k) - Ints8{0, 1, 2, 3, 4, 5, 6, 7};
      Ints8 whole;
      load(whole, found.x.data() + k);
      store(found.x.data() + k, leaves ? own : whole);
    }
  }

  const StationRays& rays_;
  const TraceStation& station_;
  std::vector<float> sines_, cosines_;  // of every kStep-th row; empty: all rows one by one
};

}  // namespace vantage
