// SPDX-License-Identifier: Apache-2.0
// Depth that a scan saw in each direction.
#pragma once

#include <cstddef>
#include <vector>

#include "core/glm.hpp"
#include "vantage/taken_scans.hpp"

namespace vantage {

// Cells of about 1° in each direction, with the farthest point of each. Cells without points among others take their
// neighbours' depth, since thinned points lie apart where surfaces are near.
class DepthPicture {
 public:
  explicit DepthPicture(const TakenScan& scan);

  // Returns how far, in metres, the scan saw beyond a place, along the ray to it; below 0 if something stands before
  // it, or if there is no point.
  double beyond(const glm::dvec3& place) const;

 private:
  std::size_t cell_of(const glm::dvec3& way) const;
  std::size_t cell_of(std::size_t row, double turn) const;
  void fill();

  glm::dvec3 head_;
  std::vector<std::size_t> first_;  // cell of each row, and behind the last
  std::vector<float> depth_;        // 0: no point
};

}  // namespace vantage
