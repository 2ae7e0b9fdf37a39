// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <utility>

#include "trace/embree/seen_triangle.hpp"

namespace vantage {

// The triangles that last stood in a station's way. Most of what is hidden from a station is hidden by one of them, and
// asking them costs far less than a ray. They only answer where Embree's answer is certain, so that no count depends on
// them.
class Occluders {
 public:
  explicit Occluders(double min_range) : nearest_(min_range * (1 + SeenTriangle::distance_doubt)) {}

  // Whether nothing in the box can be seen, with all that Surface::distance allows a distance to be off.
  bool hide_box(const Vec3& low, const Vec3& high) {
    for (std::size_t k = 0; k < size_; ++k) {
      if (kept_[k].triangle.height() > nearest_ && kept_[k].triangle.covers(low, high, 1 + 0x1p-6)) return first(k);
    }
    return false;
  }
  // Whether a ray along d is stopped before Embree's distance t.
  bool stop_ray(const Vec3& d, double t) {
    for (std::size_t k = 0; k < size_; ++k) {
      const SeenTriangle& triangle = kept_[k].triangle;
      if (!triangle.is_steep(d)) continue;
      const double own = triangle.distance(d);
      if (own > nearest_ && own * (1 + SeenTriangle::distance_doubt) < t && triangle.must_hit(d)) return first(k);
    }
    return false;
  }
  bool knows(std::uint32_t id) const {
    for (std::size_t k = 0; k < size_; ++k) {
      if (kept_[k].id == id) return true;
    }
    return false;
  }
  void add(std::uint32_t id, const SeenTriangle& triangle) {
    if (size_ < kept_.size()) ++size_;
    kept_[size_ - 1] = {id, triangle};
    first(size_ - 1);
  }

 private:
  struct Kept {
    std::uint32_t id = 0;
    SeenTriangle triangle;
  };
  // Moves one to the front, where the next question starts.
  bool first(std::size_t k) {
    for (; k > 0; --k) std::swap(kept_[k], kept_[k - 1]);
    return true;
  }

  double nearest_;  // nearer triangles may lie before the ray's start
  std::array<Kept, 4> kept_;
  std::size_t size_ = 0;
};

}  // namespace vantage
