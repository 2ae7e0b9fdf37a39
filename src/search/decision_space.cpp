// SPDX-License-Identifier: Apache-2.0
#include "search/decision_space.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "search/refuse.hpp"

namespace vantage {
namespace {

void check(const SurveyProblem& problem) {
  const auto count = [](std::size_t n) { return std::to_string(n); };
  if (problem.stations_min < 1) refuse("at least one station is needed");
  if (problem.stations_min > problem.stations_max)
    refuse("stations_min " + count(problem.stations_min) + " is above stations_max " + count(problem.stations_max));
  if (problem.stations_max + problem.existing.size() > max_stations)
    refuse("at most " + count(max_stations) + " stations in all, " +
           count(problem.stations_max + problem.existing.size()) + " were asked for");
  if (problem.heights_m) {
    const auto [low, high] = *problem.heights_m;
    if (!(low > 0 && low <= high && std::isfinite(high)))
      refuse("heights_m must be two rising heights above 0, not " + std::to_string(low) + " and " +
             std::to_string(high));
  }
}

}  // namespace

DecisionSpace::DecisionSpace(const PlacementOracle& oracle, const SurveyProblem& problem)
    : oracle_(oracle),
      min_(problem.stations_min),
      max_(problem.stations_max),
      heights_(problem.heights_m.has_value()),
      scanners_(oracle.scanners) {
  check(problem);
  if (heights_) height_bounds_ = *problem.heights_m;
  // An existing station was scanned from its position, whatever the search area; its (u, v) is only for the reader.
  existing_ = existing_stations(oracle, problem.existing, problem.existing_setups);
}

std::size_t DecisionSpace::dimension() const {
  return first_scanner() + (searches_scanner() ? max_ : 0) + (searches_number() ? 1 : 0);
}

Bounds DecisionSpace::bounds() const {
  Bounds bounds;
  for (std::size_t i = 0; i < max_; ++i) {
    bounds.lower.insert(bounds.lower.end(), {oracle_.uv_min.u, oracle_.uv_min.v});
    bounds.upper.insert(bounds.upper.end(), {oracle_.uv_max.u, oracle_.uv_max.v});
  }
  if (heights_) {
    bounds.lower.insert(bounds.lower.end(), max_, height_bounds_[0]);
    bounds.upper.insert(bounds.upper.end(), max_, height_bounds_[1]);
  }
  if (searches_scanner()) {
    bounds.lower.insert(bounds.lower.end(), max_, 0.0);
    bounds.upper.insert(bounds.upper.end(), max_, 1.0);
  }
  if (searches_number()) bounds.lower.push_back(0), bounds.upper.push_back(1);
  return bounds;
}

std::size_t DecisionSpace::placed_count(std::span<const double> x) const {
  return searches_number() ? station_count_from_alpha(x.back(), min_, max_) : max_;
}

double DecisionSpace::height(std::span<const double> x, std::size_t i) const {
  return heights_ ? x[2 * max_ + i] : oracle_.height_m;
}

std::uint32_t DecisionSpace::scanner(std::span<const double> x, std::size_t i) const {
  if (!searches_scanner()) return scanners_.empty() ? 0 : scanners_.front();
  const auto n = static_cast<double>(scanners_.size());
  return scanners_[static_cast<std::size_t>(std::clamp(std::floor(x[first_scanner() + i] * n), 0.0, n - 1))];
}

double DecisionSpace::encoded(std::uint32_t scanner) const {
  const auto found = std::ranges::find(scanners_, scanner);
  const auto place = static_cast<double>(found == scanners_.end() ? 0 : found - scanners_.begin());
  return (place + 0.5) / static_cast<double>(scanners_.size());
}

std::vector<PlacedStation> DecisionSpace::decode(std::span<const double> x) const {
  std::vector<PlacedStation> stations = existing_;
  const std::size_t n = placed_count(x);
  for (std::size_t i = 0; i < n; ++i) {
    stations.push_back(place_station(oracle_, {x[2 * i], x[2 * i + 1]}, height(x, i)));
    stations.back().setup.scanner = scanner(x, i);
  }
  return stations;
}

std::vector<std::size_t> DecisionSpace::coordinates(std::size_t i) const {
  const std::size_t k = i - existing_.size();
  std::vector<std::size_t> own{2 * k, 2 * k + 1};
  if (heights_) own.push_back(2 * max_ + k);
  return own;
}

std::vector<std::vector<std::size_t>> DecisionSpace::blocks() const {
  std::vector<std::vector<std::size_t>> blocks;
  for (std::size_t k = 0; k < max_; ++k) {
    auto& block = blocks.emplace_back(std::vector{2 * k, 2 * k + 1});
    if (heights_) block.push_back(2 * max_ + k);
    if (searches_scanner()) block.push_back(first_scanner() + k);
  }
  return blocks;
}

std::vector<double> DecisionSpace::encode(std::span<const Vec3> heads) const {
  if (heads.empty() || heads.size() > max_)
    refuse("an initial network needs 1 to " + std::to_string(max_) + " positions, " + std::to_string(heads.size()) +
           " were given");
  std::vector<double> x(dimension());
  for (std::size_t i = 0; i < max_; ++i) {
    const Vec3 head = heads[i % heads.size()];
    const auto uv = oracle_.project(head - Vec3{0, 0, oracle_.height_m});
    if (!uv)
      refuse("the initial position " + std::to_string(head.x) + ", " + std::to_string(head.y) + ", " +
             std::to_string(head.z) + " is not above the search area");
    x[2 * i] = uv->u, x[2 * i + 1] = uv->v;
    if (heights_) {
      const auto ground = oracle_.locate(*uv);
      x[2 * max_ + i] =
          std::clamp(ground ? head.z - ground->z : oracle_.height_m, height_bounds_[0], height_bounds_[1]);
    }
    if (searches_scanner()) x[first_scanner() + i] = encoded(scanners_.front());
  }
  if (searches_number())
    x.back() =
        max_ == min_ ? 0 : static_cast<double>(std::max(heads.size(), min_) - min_) / static_cast<double>(max_ - min_);
  return x;
}

std::vector<double> DecisionSpace::encode(std::span<const PlacedStation> stations) const {
  std::vector<double> x(dimension());
  for (std::size_t i = 0; i < max_; ++i) {
    const PlacedStation& station = stations[i % stations.size()];
    x[2 * i] = station.uv.u, x[2 * i + 1] = station.uv.v;
    if (heights_)
      x[2 * max_ + i] = std::clamp(station.position.z - station.ground.z, height_bounds_[0], height_bounds_[1]);
    if (searches_scanner()) x[first_scanner() + i] = encoded(station.setup.scanner);
  }
  if (searches_number())
    x.back() = static_cast<double>(std::max(stations.size(), min_) - min_) / static_cast<double>(max_ - min_);
  return x;
}

std::vector<std::vector<double>> DecisionSpace::encode_each(std::span<const Vec3> heads) const {
  std::vector<std::vector<double>> xs{encode(heads)};
  if (searches_number())
    for (std::size_t n = std::min(heads.size(), max_) - 1; n >= min_ && n < heads.size(); --n)
      xs.push_back(encode(heads.first(n)));
  return xs;
}

}  // namespace vantage
