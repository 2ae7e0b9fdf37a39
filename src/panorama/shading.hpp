// SPDX-License-Identifier: Apache-2.0
// Shading of rendered panoramas: a lamp at the station, a bright sky, and darkened creases (screen-space obscurance,
// after Mittring: Finding Next Gen, 2007), so that pipes stand out in front of pipes.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include "image/srgb.hpp"
#include "vantage/station_setup.hpp"

namespace vantage {

// One row of rays of a panorama, all around. Arrays that no view needs are empty.
struct PanoramaRow {
  std::vector<float> range;  // infinity without a hit
  std::vector<std::array<float, 3>> normal;
  std::vector<float> reflectivity;
  std::vector<std::int32_t> mesh;
  std::vector<std::uint32_t> colour;
};

// Rows around those being shaded. Rows are pushed from the top; old ones are dropped.
class RowWindow {
 public:
  void push(PanoramaRow row) { rows_.push_back(std::move(row)); }
  void drop_before(std::uint32_t row) {
    for (; first_ < row; ++first_) rows_.pop_front();
  }
  std::uint32_t end() const { return first_ + static_cast<std::uint32_t>(rows_.size()); }
  bool holds(std::int64_t row) const { return row >= first_ && row < end(); }
  const PanoramaRow& operator[](std::uint32_t row) const { return rows_[row - first_]; }

 private:
  std::deque<PanoramaRow> rows_;
  std::uint32_t first_ = 0;
};

class PanoramaShading {
 public:
  // A pattern of `rows` × `columns` rays over the full sphere, `supersample` of them per pixel and direction; the first
  // column looks along `first_azimuth`. `extent_m` of the scene scales the haze.
  PanoramaShading(std::uint32_t rows, std::uint32_t columns, std::uint32_t supersample, double first_azimuth,
                  double extent_m);
  // Sets the rotation of the pattern.
  void turn(const StationSetup& setup);
  // Rows needed below and above the shaded one.
  std::uint32_t reach() const { return reach_; }
  // Light on a hit, a factor of its colour. REQUIRES: a hit, with range and normal.
  float light(const RowWindow& window, std::uint32_t row, std::uint32_t column) const;
  // Share of its own colour that a surface keeps at a distance; the rest is sky at the horizon.
  float clearness(float range) const;
  LinearColour sky(std::uint32_t row, std::uint32_t column) const;
  LinearColour haze() const;

 private:
  struct Tap {
    int down;
    float across;  // columns at the equator
    float radius;  // in rays
  };
  // Survey frame.
  glm::vec3 direction(std::uint32_t row, std::uint32_t column) const {
    const glm::vec3 own{sin_zenith_[row] * cos_azimuth_[column], sin_zenith_[row] * sin_azimuth_[column],
                        cos_zenith_[row]};
    return turned_ ? survey_from_scanner_ * own : own;
  }
  std::uint32_t rows_, columns_, reach_ = 0;
  float step_;
  float extent_;
  bool turned_ = false;
  glm::mat3 survey_from_scanner_{1};
  std::vector<Tap> taps_;
  std::vector<std::uint32_t> across_;  // by row and tap: columns to its right, all around
  std::vector<float> sin_zenith_, cos_zenith_, sin_azimuth_, cos_azimuth_;
};

}  // namespace vantage
