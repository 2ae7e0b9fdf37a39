// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/pane_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/target_clones.hpp"
#include "trace/embree/drawn_triangle.hpp"
#include "trace/embree/ray_caster.hpp"
#include "trace/embree/vectors.hpp"

namespace vantage {
namespace {

constexpr std::uint32_t kPaneLanes = 8;
constexpr std::uint32_t kRaysTogether = 64;  // rays for which faces are chosen at once
constexpr float kCosineRounding = 1e-5f;     // of cosines here

}  // namespace

PaneView::PaneView(std::shared_ptr<const SceneData> scene, std::shared_ptr<const Planes> planes, const Float3& head)
    : scene_(std::move(scene)), planes_(std::move(planes)), head_(head) {
  for (std::uint32_t triangle = scene_->opaque_count(); triangle < scene_->triangle_count(); ++triangle) {
    const auto p = scene_->corners(triangle);
    const std::array<Vec3, 3> corners{widen(p[0]) - widen(head_), widen(p[1]) - widen(head_),
                                      widen(p[2]) - widen(head_)};
    const DrawnTriangle drawn(corners, false);
    Face face{.x = {},
              .y = {},
              .z = {},
              .doubt = {},
              .plane = planes_->seen(triangle, head_),
              .triangle = triangle,
              .flat = drawn.flat,
              .certain = drawn.certain};
    const auto put = [&](std::size_t k, const Vec3& normal, double doubt) {
      face.x[k] = static_cast<float>(normal.x), face.y[k] = static_cast<float>(normal.y);
      face.z[k] = static_cast<float>(normal.z);
      face.doubt[k] = static_cast<float>(doubt) * (1 + 0x1p-20f);
    };
    if (drawn.flat) {
      const DrawnTriangle::Band band = drawn.band();
      put(0, band.normal, band.doubt);
    } else {
      for (std::size_t k = 0; k < 3; ++k) put(k, drawn.edge[k], drawn.doubt[k]);
    }
    // All hits lie in a ball around the triangle's middle.
    const double away = std::sqrt(dot(drawn.middle, drawn.middle));
    const double radius =
        (drawn.flat ? Planes::reach(drawn.radius, drawn.farthest, head_) : drawn.radius * (1 + drawn.stretch)) *
        (1 + 0x1p-10);
    const bool around = radius >= away;  // the ball holds the head
    const Vec3 to = away > 0 ? drawn.middle * (1 / away) : Vec3{0, 0, 1};
    x_.push_back(static_cast<float>(to.x)), y_.push_back(static_cast<float>(to.y));
    z_.push_back(static_cast<float>(to.z));
    sine_.push_back(around ? 0 : static_cast<float>(radius / away));
    cosine_.push_back(around ? -std::numeric_limits<float>::infinity()
                             : static_cast<float>(std::sqrt(1 - radius * radius / (away * away))));
    nearest_.push_back(around ? 0 : static_cast<float>((away - radius) * (1 - 0x1p-10)));
    faces_.push_back(face);
  }
  while (nearest_.size() % kPaneLanes != 0) {
    for (std::vector<float>* each : {&x_, &y_, &z_, &sine_, &cosine_}) each->push_back(0);
    nearest_.push_back(std::numeric_limits<float>::infinity());
  }
}

namespace {

// A cone of directions.
struct Cone {
  Float3 axis;
  float cosine, sine;  // of its half angle; 0 and infinite: all directions
};
Cone cone_of(const float* x, const float* y, const float* z, std::uint32_t n) {
  float sx = 0, sy = 0, sz = 0;
  for (std::uint32_t k = 0; k < n; ++k) sx += x[k], sy += y[k], sz += z[k];
  const float length = std::sqrt(sx * sx + sy * sy + sz * sz), scale = length > 0 ? 1 / length : 0;
  const Float3 axis{sx * scale, sy * scale, sz * scale};
  float cosine = 1;
  for (std::uint32_t k = 0; k < n; ++k) cosine = std::min(cosine, axis.x * x[k] + axis.y * y[k] + axis.z * z[k]);
  cosine -= kCosineRounding;
  if (!(cosine > 0)) return {axis, 0, std::numeric_limits<float>::infinity()};
  return {axis, cosine, std::sqrt(std::max(0.0f, 1 - cosine * cosine))};
}

// Returns true if no direction of the cone lies on the inner side of the plane through head and edge.
bool beside_edge(const Cone& cone, float x, float y, float z, float doubt) {
  return (x * cone.axis.x + y * cone.axis.y + z * cone.axis.z) * cone.cosine + cone.sine + kCosineRounding < -doubt;
}

}  // namespace

VANTAGE_TARGET_CLONES
bool PaneView::find(const Hits& hits, const float* end, Crossings& found) const {
  bool any_found = false;
  std::fill_n(found.count, hits.size, 0u);
  for (std::uint32_t first = 0; first < hits.size; first += kRaysTogether) {
    const std::uint32_t n = std::min(kRaysTogether, hits.size - first);
    alignas(64) float x[kRaysTogether], y[kRaysTogether], z[kRaysTogether];
    alignas(64) float farthest[kRaysTogether];
    for (std::uint32_t k = 0; k < kRaysTogether; ++k) {
      const std::uint32_t from = first + std::min(k, n - 1);
      x[k] = RayCaster::safe(hits.x[from]), y[k] = RayCaster::safe(hits.y[from]), z[k] = RayCaster::safe(hits.z[from]);
      farthest[k] = k < n ? end[from] : -1;  // no crossing lies before it
    }
    const Floats8 reach = Floats8{} + *std::max_element(farthest, farthest + n);
    const Cone cone = cone_of(x, y, z, n);
    for (std::size_t group = 0; group < nearest_.size(); group += kPaneLanes) {
      Floats8 fx, fy, fz, cosine, sine, nearest;
      load(fx, x_.data() + group), load(fy, y_.data() + group), load(fz, z_.data() + group);
      load(cosine, cosine_.data() + group), load(sine, sine_.data() + group), load(nearest, nearest_.data() + group);
      const Ints8 apart = (cone.axis.x * fx + cone.axis.y * fy + cone.axis.z * fz <
                           cone.cosine * cosine - cone.sine * sine - kCosineRounding) |
                          (nearest > reach);
      if (!any(~apart)) continue;
      for (std::uint32_t lane = 0; lane < kPaneLanes && group + lane < faces_.size(); ++lane) {
        if (apart[lane] != 0) continue;
        const Face& face = faces_[group + lane];
        bool beside = false;
        for (std::uint32_t e = 0; e < 3 && !face.flat; ++e)
          beside = beside || beside_edge(cone, face.x[e], face.y[e], face.z[e], face.doubt[e]);
        if (beside) continue;
        for (std::uint32_t k = 0; k < n; k += kPaneLanes) {
          Floats8 dx, dy, dz, ends, t;
          load(dx, x + k), load(dy, y + k), load(dz, z + k), load(ends, farthest + k);
          Ints8 possible = ends > 0, sure = possible;
          if (face.flat) {
            const Floats8 off = face.x[0] * dx + face.y[0] * dy + face.z[0] * dz;
            possible &= (off <= face.doubt[0]) & (off >= -face.doubt[0]);
            if (!any(possible)) continue;
            sure = Ints8{};
          } else {
            for (std::uint32_t e = 0; e < 3; ++e) {
              const Floats8 edge = face.x[e] * dx + face.y[e] * dy + face.z[e] * dz;
              possible &= edge >= -face.doubt[e];
              sure &= edge >= face.doubt[e];
            }
            if (!any(possible)) continue;
            alignas(32) float at[kPaneLanes];
            planes_->distances<kPaneLanes>(face.plane, face.triangle, head_, x + k, y + k, z + k, at);
            load(t, at);
            possible &= (t > 0) & (t <= ends);
            if (!any(possible)) continue;
            if (!face.certain) sure = Ints8{};
          }
          for (std::uint32_t i = 0; i < kPaneLanes; ++i) {
            if (possible[i] == 0) continue;
            any_found = true;
            const std::uint32_t ray = first + k + i;
            std::uint32_t& count = found.count[ray];
            if (sure[i] == 0 || count >= Crossings::kMost) {
              count = Crossings::kUnsure;
              continue;
            }
            std::uint32_t place = count++;
            for (; place > 0 && (found.t[ray][place - 1] > t[i] ||
                                 (found.t[ray][place - 1] == t[i] && found.triangle[ray][place - 1] > face.triangle));
                 --place) {
              found.t[ray][place] = found.t[ray][place - 1];
              found.triangle[ray][place] = found.triangle[ray][place - 1];
            }
            found.t[ray][place] = t[i];
            found.triangle[ray][place] = face.triangle;
          }
        }
      }
    }
  }
  return any_found;
}

}  // namespace vantage
