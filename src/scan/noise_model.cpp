// SPDX-License-Identifier: Apache-2.0
#include "scan/noise_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/normal_table.hpp"
#include "shared/noise_types.h"

namespace vantage {
namespace {

// The cell of ascending `nodes` whose line applies at x, and the position of x in it: below 0 or above 1 outside the
// nodes.
struct Cell {
  std::size_t low = 0, high = 0;
  double share = 0;
};

Cell cell_at(const std::vector<double>& nodes, double x) {
  if (nodes.size() < 2) return {};
  const auto above = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, x);
  const auto high = static_cast<std::size_t>(above - nodes.begin());
  return {high - 1, high, (x - nodes[high - 1]) / (nodes[high] - nodes[high - 1])};
}

double mix(double a, double b, double share) { return a + (b - a) * share; }

// Darker surfaces count as this dark: the first step above 0 of the regular table; at 0, σ would not be finite.
constexpr double kDarkest = 1.0 / (NoiseModel::kSide - 1);

// Returns the reflectivity of the darkest surface that the scanner detects at a distance, at most 1.
double darkest_detected(const Scanner& scanner, double distance_m) {
  if (scanner.detection_range_m == 0) return 0;
  const double part = distance_m / scanner.detection_range_m;
  return std::min(scanner.detection_reflectivity * part * part, 1.0);
}

}  // namespace

double table_sigma(const NoiseTable& table, double distance_m, double reflectivity) {
  if (table.empty()) return 0;
  const Cell column = cell_at(table.distances_m, distance_m);
  const auto in_row = [&](std::size_t r) {
    const double* sigma = table.sigma_m.data() + r * table.distances_m.size();
    return mix(sigma[column.low], sigma[column.high], column.share);
  };
  const double lowest = table.reflectivities.front();
  if (table.reflectivities.size() > 1 && reflectivity < lowest)
    return std::max(0.0, in_row(0)) * std::sqrt(lowest / std::max(reflectivity, std::min(kDarkest, lowest)));
  const Cell row = cell_at(table.reflectivities, reflectivity);
  return std::max(0.0, mix(in_row(row.low), in_row(row.high), row.share));
}

NoiseModel make_noise_model(const Scanner& scanner, std::uint64_t seed) {
  static_assert(NoiseModel::kSide == noise_table_side);
  NoiseModel model;
  model.seed = seed;
  model.min_range = static_cast<float>(scanner.min_range_m);
  model.inverse_span = static_cast<float>(1.0 / (scanner.max_range_m - scanner.min_range_m));
  if (scanner.noise.empty()) return model;

  constexpr double kIntervals = NoiseModel::kSide - 1;
  model.sigma.reserve(std::size_t{NoiseModel::kSide} * NoiseModel::kSide);
  for (std::uint32_t r = 0; r < NoiseModel::kSide; ++r) {
    for (std::uint32_t d = 0; d < NoiseModel::kSide; ++d) {
      const auto distance_at = [&](double step) {
        return mix(scanner.min_range_m, scanner.max_range_m, step / kIntervals);
      };
      // Surfaces that are not detected have no noise, and would make the reach large. The darkest cell with a detected
      // point, at the nearer end of its distances, therefore stands for all darker ones.
      const double darkest = darkest_detected(scanner, distance_at(d > 0 ? d - 1.0 : 0.0)) - 1 / kIntervals;
      model.sigma.push_back(
          static_cast<float>(table_sigma(scanner.noise, distance_at(d), std::max(r / kIntervals, darkest))));
    }
  }
  // Rounds up: |z| stays 1.5e-5 below its limit, which is more than the look-up's own rounding.
  const double largest = *std::max_element(model.sigma.begin(), model.sigma.end());
  model.reach = std::nextafter(static_cast<float>(kNormalLimit * largest), HUGE_VALF);
  if (largest == 0) {  // a table of zeros is no noise
    model.sigma.clear();
    model.reach = 0;
  }
  return model;
}

double model_sigma(const NoiseModel& model, double range_m, double reflectivity) {
  if (!model.enabled()) return 0;
  constexpr int kLast = static_cast<int>(NoiseModel::kSide) - 1;
  const auto cell = [](double normalised) {
    const double x = std::clamp(normalised, 0.0, 1.0) * kLast;
    const int low = std::min(static_cast<int>(x), kLast - 1);
    return std::pair{low, x - low};
  };
  const auto [d, d_share] =
      cell((range_m - static_cast<double>(model.min_range)) * static_cast<double>(model.inverse_span));
  const auto [r, r_share] = cell(reflectivity);
  const auto at = [&](int row, int column) {
    return static_cast<double>(model.sigma[static_cast<std::size_t>(row * (kLast + 1) + column)]);
  };
  return mix(mix(at(r, d), at(r, d + 1), d_share), mix(at(r + 1, d), at(r + 1, d + 1), d_share), r_share);
}

}  // namespace vantage
