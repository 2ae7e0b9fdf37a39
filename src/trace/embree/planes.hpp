// SPDX-License-Identifier: Apache-2.0
// Intersection of a ray with the plane of a triangle: the distance of every hit of the CPU engine.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "scene/scene_data.hpp"
#include "scene/scene_difference.hpp"
#include "trace/embree/vectors.hpp"
#include "vantage/types.hpp"

namespace vantage {

// Planes of a scene's triangles: a table, or computed on demand if triangles are shared, as a table for all their
// places may not fit. Safe to use from any thread.
class Planes {
 public:
  explicit Planes(std::shared_ptr<const SceneData> scene);
  // Takes a changed scene; no other thread may use the planes meanwhile. An error changes nothing.
  void take(std::shared_ptr<const SceneData> scene, const SceneDifference& difference);

  // A plane relative to a head.
  struct Seen {
    double x, y, z, height;  // unit normal, and the plane's offset from the head along it
  };
  Seen seen(std::uint32_t triangle, const Float3& o) const {
    const Plane p = plane(triangle);
    return {p.x, p.y, p.z, p.offset - (p.x * o.x + p.y * o.y + p.z * o.z)};
  }

  // Computes distances along n directions, in double and rounded once. Uses only additions, multiplications and a
  // division, so that every processor gets the same bits. The plane does not determine the distance of a ray that
  // nearly lies in it; it is then clamped to the triangle's extent along the ray, or infinite if the ray passes beside.
  // REQUIRES: plane == seen(triangle, o). Inlined, to be compiled for the caller's target.
  template <unsigned n>
  [[gnu::always_inline]] void distances(const Seen& plane, std::uint32_t triangle, const Float3& o, const float* x,
                                        const float* y, const float* z, float* t) const {
    static_assert(n == 1 || n == 8);
    if constexpr (n == 8) {
      Floats8 fx, fy, fz, ft;
      load(fx, x);
      load(fy, y);
      load(fz, z);
      if (distances(plane, fx, fy, fz, ft)) [[likely]] {
        store(t, ft);
        return;
      }
    }
    for (unsigned i = 0; i < n; ++i) {
      const double slope = plane.x * x[i] + plane.y * y[i] + plane.z * z[i], along = plane.height / slope;
      const bool clear = std::abs(slope) >= kGrazing;
      t[i] = static_cast<float>(clear ? along : within(triangle, o, {x[i], y[i], z[i]}, along));
    }
  }
  // Computes eight; returns false if one nearly lies in the plane.
  [[gnu::always_inline]] static bool distances(const Seen& plane, const Floats8& x, const Floats8& y, const Floats8& z,
                                               Floats8& t) {
    Doubles4 lx, ly, lz, hx, hy, hz;
    widen(x, lx, hx);
    widen(y, ly, hy);
    widen(z, lz, hz);
    const Doubles4 low = plane.x * lx + plane.y * ly + plane.z * lz, high = plane.x * hx + plane.y * hy + plane.z * hz;
    narrow(plane.height / low, plane.height / high, t);
    const auto flat = ~((low >= kGrazing) | (low <= -kGrazing)) | ~((high >= kGrazing) | (high <= -kGrazing));
    return (flat[0] | flat[1] | flat[2] | flat[3]) == 0;
  }

  // Marks points at distances t of n directions that lie beside the triangle: outside a ball 1.5 times as large as the
  // one around its middle. No true hit does, but for a triangle seen edge-on, a test of edges may let any ray in its
  // plane pass.
  template <unsigned n>
  [[gnu::always_inline]] void beside(std::uint32_t triangle, const Float3& o, const float* x, const float* y,
                                     const float* z, const float* t, std::int32_t* is_beside) const {
    const Ball ball = shared_ ? ball_of(scene_->corners(triangle)) : balls_[triangle];
    const float cx = ball.x - o.x, cy = ball.y - o.y, cz = ball.z - o.z;
    for (unsigned i = 0; i < n; ++i) {
      const float dx = t[i] * x[i] - cx, dy = t[i] * y[i] - cy, dz = t[i] * z[i] - cz;
      is_beside[i] = !(dx * dx + dy * dy + dz * dz <= ball.square + kBallDoubt * (t[i] * t[i]));
    }
  }
  // Returns the largest distance of a hit from the middle of a triangle whose corners lie within `radius` of it and
  // `farthest` of a head at o.
  static double reach(double radius, double farthest, const Float3& o) {
    return 1.5 * radius * (1 + 0x1p-10) + 0x1p-15 * farthest + 0x1p-19 * std::sqrt(dot(widen(o), widen(o)));
  }

  Vec3 normal(std::uint32_t triangle) const {  // unit
    const Plane p = plane(triangle);
    return {p.x, p.y, p.z};
  }

 private:
  static constexpr double kGrazing = 0x1p-10;  // cosine

  double within(std::uint32_t triangle, const Float3& o, const Float3& d, double t) const;

  struct Plane {
    double x, y, z, offset;  // unit normal n, and n·p for its points p
  };
  struct Ball {
    float x, y, z, square;  // middle of the corners; 1.5 times their largest distance from it, and a rounding, squared
  };
  static constexpr float kBallDoubt = 0x1p-34f;  // of a squared distance, for all roundings

  void fill(std::uint32_t first, std::uint32_t count);  // those triangles' planes

  static Plane plane_of(const std::array<Float3, 3>& corners);
  static Ball ball_of(const std::array<Float3, 3>& corners);
  Plane plane(std::uint32_t triangle) const {
    return shared_ ? plane_of(scene_->corners(triangle)) : planes_[triangle];
  }

  std::shared_ptr<const SceneData> scene_;
  bool shared_;
  std::vector<Plane> planes_;  // per triangle, unless shared_
  std::vector<Ball> balls_;
};

}  // namespace vantage
