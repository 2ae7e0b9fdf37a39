// SPDX-License-Identifier: Apache-2.0
#include "panorama/shading.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vantage {
namespace {

constexpr std::array<float, 2> kRingPixels{1.0f, 3.6f};
constexpr int kTapsARing = 8;
constexpr float kFlatCosine = 0.06f;  // least rise of a neighbour over the tangent plane, to hide facets of round pipes
constexpr float kObscuranceStrength = 1.5f;
constexpr LinearColour kZenithSky{0.24f, 0.41f, 0.72f, 1}, kHorizonSky{0.76f, 0.84f, 0.92f, 1},
    kBelowHorizon{0.42f, 0.44f, 0.46f, 1};

}  // namespace

PanoramaShading::PanoramaShading(std::uint32_t rows, std::uint32_t columns, std::uint32_t supersample,
                                 double first_azimuth, double extent_m)
    : rows_(rows),
      columns_(columns),
      step_(static_cast<float>(std::numbers::pi / rows)),
      extent_(static_cast<float>(extent_m)) {
  for (std::uint32_t i = 0; i < rows; ++i) {
    const double zenith = (i + 0.5) * std::numbers::pi / rows;
    sin_zenith_.push_back(static_cast<float>(std::sin(zenith)));
    cos_zenith_.push_back(static_cast<float>(std::cos(zenith)));
  }
  for (std::uint32_t j = 0; j < columns; ++j) {
    const double azimuth = first_azimuth + j * 2 * std::numbers::pi / columns;
    sin_azimuth_.push_back(static_cast<float>(std::sin(azimuth)));
    cos_azimuth_.push_back(static_cast<float>(std::cos(azimuth)));
  }
  for (std::size_t ring = 0; ring < kRingPixels.size(); ++ring) {
    const float radius = kRingPixels[ring] * static_cast<float>(supersample);
    for (int k = 0; k < kTapsARing; ++k) {
      const double angle = (k + 0.5 * static_cast<double>(ring)) * 2 * std::numbers::pi / kTapsARing;
      const int down = static_cast<int>(std::lround(static_cast<double>(radius) * std::sin(angle)));
      taps_.push_back({down, radius * static_cast<float>(std::cos(angle)), radius});
      reach_ = std::max(reach_, static_cast<std::uint32_t>(std::abs(down)));
    }
  }
  for (const float sine : sin_zenith_) {
    // Near the poles a ray step across is narrower than one down.
    const float stretch = std::min(1 / sine, static_cast<float>(columns) / 64);
    const std::int64_t all = columns;
    for (const Tap& tap : taps_)
      across_.push_back(static_cast<std::uint32_t>((std::lround(tap.across * stretch) % all + all) % all));
  }
}

void PanoramaShading::turn(const StationSetup& setup) {
  turned_ = setup.turned();
  const auto rows = setup.survey_from_scanner();
  for (int r = 0; r < 3; ++r) {
    const Vec3& row = rows[static_cast<std::size_t>(r)];
    const double values[] = {row.x, row.y, row.z};
    for (int c = 0; c < 3; ++c) survey_from_scanner_[c][r] = static_cast<float>(values[c]);
  }
}

float PanoramaShading::light(const RowWindow& window, std::uint32_t row, std::uint32_t column) const {
  const PanoramaRow& here = window[row];
  const float range = here.range[column];
  const glm::vec3 normal = glm::make_vec3(here.normal[column].data());
  const glm::vec3 view = direction(row, column);
  float covered = 0;
  for (std::size_t k = 0; k < taps_.size(); ++k) {
    const Tap& tap = taps_[k];
    const std::int64_t other_row = static_cast<std::int64_t>(row) + tap.down;
    if (other_row < 0 || other_row >= rows_ || !window.holds(other_row)) continue;
    std::uint32_t other_column = column + across_[row * taps_.size() + k];
    if (other_column >= columns_) other_column -= columns_;
    const auto there = static_cast<std::uint32_t>(other_row);
    const float other_range = window[there].range[other_column];
    if (!std::isfinite(other_range)) continue;
    const glm::vec3 between = direction(there, other_column) * other_range - view * range;
    const float length = glm::length(between);
    if (!(length > 0)) continue;
    const float rise = dot(between, normal) / length - kFlatCosine;
    if (rise <= 0) continue;
    const float near =
        length / (8 * tap.radius * step_ * range);  // an object far in front casts no crease, only a faint outline
    covered += rise / (1 + near * near);
  }
  const float open = 1 / (1 + kObscuranceStrength * 4 * covered / static_cast<float>(taps_.size()));
  const float facing = std::clamp(-dot(view, normal), 0.0f, 1.0f);
  const float up = 0.5f + 0.5f * normal.z;
  return open * (0.22f + 0.24f * up + 0.62f * facing);
}

float PanoramaShading::clearness(float range) const { return 1 - 0.45f * (1 - std::exp(-0.4f * range / extent_)); }

LinearColour PanoramaShading::haze() const { return kHorizonSky; }

LinearColour PanoramaShading::sky(std::uint32_t row, std::uint32_t column) const {
  const float height = direction(row, column).z;
  const LinearColour& end = height >= 0 ? kZenithSky : kBelowHorizon;
  const float share = height >= 0 ? std::pow(height, 0.6f) : std::min(1.0f, -6 * height);
  return kHorizonSky + (end - kHorizonSky) * share;
}

}  // namespace vantage
