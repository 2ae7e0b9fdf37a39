// SPDX-License-Identifier: Apache-2.0
#include "taken/depth_picture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace vantage {
namespace {

constexpr std::size_t kDepthRows = 180;
constexpr int kFills = 2;  // cells that are filled beside others, on each side

}  // namespace

DepthPicture::DepthPicture(const TakenScan& scan) : head_(to_glm(scan.head)), first_{0} {
  for (std::size_t row = 0; row < kDepthRows; ++row) {
    const double zenith = (static_cast<double>(row) + 0.5) / kDepthRows * std::numbers::pi;
    first_.push_back(first_.back() + std::max<std::size_t>(8, std::lround(2 * kDepthRows * std::sin(zenith))));
  }
  depth_.resize(first_.back());
  for (const TakenPoint& point : scan.thinned) {
    const glm::dvec3 offset(point.offset[0], point.offset[1], point.offset[2]);
    const double range = length(offset);
    if (!(range > 0)) continue;
    float& depth = depth_[cell_of(offset / range)];
    depth = std::max(depth, static_cast<float>(range));
  }
  for (int k = 0; k < kFills; ++k) fill();
}

double DepthPicture::beyond(const glm::dvec3& place) const {
  const double range = length(place - head_);
  if (!(range > 0)) return std::numeric_limits<double>::infinity();
  const float depth = depth_[cell_of((place - head_) / range)];
  return depth > 0 ? depth - range : -std::numeric_limits<double>::infinity();
}

std::size_t DepthPicture::cell_of(const glm::dvec3& way) const {
  const double zenith = std::acos(std::clamp(way.z, -1.0, 1.0));
  const auto row = static_cast<std::size_t>(zenith / std::numbers::pi * kDepthRows);
  return cell_of(std::min(row, kDepthRows - 1), std::atan2(way.y, way.x) / (2 * std::numbers::pi) + 0.5);
}

// `turn`: the azimuth, 0 to 1.
std::size_t DepthPicture::cell_of(std::size_t row, double turn) const {
  const std::size_t columns = first_[row + 1] - first_[row];
  return first_[row] + std::min(static_cast<std::size_t>(turn * static_cast<double>(columns)), columns - 1);
}

void DepthPicture::fill() {
  const std::vector<float> before = depth_;
  for (std::size_t row = 0; row < kDepthRows; ++row) {
    const std::size_t columns = first_[row + 1] - first_[row];
    for (std::size_t column = 0; column < columns; ++column) {
      float& depth = depth_[first_[row] + column];
      if (depth > 0) continue;
      const double turn = (static_cast<double>(column) + 0.5) / static_cast<double>(columns);
      depth = std::max(before[first_[row] + (column + 1) % columns],
                       before[first_[row] + (column + columns - 1) % columns]);
      if (row > 0) depth = std::max(depth, before[cell_of(row - 1, turn)]);
      if (row + 1 < kDepthRows) depth = std::max(depth, before[cell_of(row + 1, turn)]);
    }
  }
}

}  // namespace vantage
