// SPDX-License-Identifier: Apache-2.0
#include "plan/decision_space.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "vantage/error.hpp"

namespace vantage {
namespace {

[[noreturn]] void refuse(const std::string& what) { throw Error(Errc::invalid_argument, "plan: " + what); }

void check(const PlanConfig& config) {
  const bool fix = config.problem == Problem::coverage_fix || config.problem == Problem::coverage_overlap_fix;
  const auto count = [](std::size_t n) { return std::to_string(n); };
  if (config.stations_min < 1) refuse("at least one station is needed");
  if (config.stations_min > config.stations_max)
    refuse("stations_min " + count(config.stations_min) + " is above stations_max " + count(config.stations_max));
  if (fix && config.stations_min != config.stations_max)
    refuse(to_string(config.problem) + " needs one number of stations, not " + count(config.stations_min) + " to " +
           count(config.stations_max) + "; use a -min problem to search for the number");
  if (config.stations_max + config.fixed.size() > max_stations)
    refuse("at most " + count(max_stations) + " stations in all, " + count(config.stations_max + config.fixed.size()) +
           " were asked for");
  if (config.iterations < 1) refuse("at least one iteration is needed");
  if (config.problem != Problem::coverage_fix && config.population == 1)
    refuse("a population of 1 has no front; give 2 or more");
  if (!(config.sigma0 > 0) || !std::isfinite(config.sigma0))
    refuse("sigma0 must be above 0, not " + std::to_string(config.sigma0));
  if (!(config.max_seconds >= 0)) refuse("max_seconds must not be negative, not " + std::to_string(config.max_seconds));
  if (!(config.min_link_overlap >= 0 && config.min_link_overlap < 1))
    refuse("min_link_overlap must lie in [0, 1), not " + std::to_string(config.min_link_overlap));
  if (config.fitness) {
    if (config.problem != Problem::coverage_min)
      refuse("a fitness needs coverage-min, not " + to_string(config.problem));
    if (config.min_link_overlap > 0)
      refuse("a fitness has its own measure of connectedness; leave min_link_overlap at 0");
    for (const double weight : {config.fitness->coverage, config.fitness->station_count, config.fitness->visibility})
      if (!(weight >= 0 && weight <= 1))
        refuse("the weights of a fitness lie in [0, 1], not " + std::to_string(weight));
  }
  if (config.heights_m) {
    const auto [low, high] = *config.heights_m;
    if (!(low > 0 && low <= high && std::isfinite(high)))
      refuse("heights_m must be two rising heights above 0, not " + std::to_string(low) + " and " +
             std::to_string(high));
  }
}

}  // namespace

DecisionSpace::DecisionSpace(const Site& site, const PlanConfig& config)
    : site_(site),
      min_(config.stations_min),
      max_(config.stations_max),
      objectives_(objective_names(config).size()),
      minimises_(config.problem == Problem::coverage_min || config.problem == Problem::coverage_overlap_min),
      overlap_(config.problem == Problem::coverage_overlap_fix || config.problem == Problem::coverage_overlap_min),
      heights_(config.heights_m.has_value()),
      fitness_(config.fitness) {
  check(config);
  if (heights_) height_bounds_ = *config.heights_m;
  for (const Vec3& head : config.fixed) {
    // A kept station was scanned from where it stands, whatever the search area says; its (u, v) is for the reader.
    const auto uv = site.project(head - Vec3{0, 0, site.height_m});
    kept_.push_back({.uv = uv.value_or(Uv{}), .position = head, .status = StationStatus::ok});
  }
}

std::size_t DecisionSpace::dimension() const { return max_ * (heights_ ? 3 : 2) + (minimises_ ? 1 : 0); }

Bounds DecisionSpace::bounds() const {
  Bounds bounds;
  for (std::size_t i = 0; i < max_; ++i) {
    bounds.lower.insert(bounds.lower.end(), {site_.uv_min.u, site_.uv_min.v});
    bounds.upper.insert(bounds.upper.end(), {site_.uv_max.u, site_.uv_max.v});
  }
  if (heights_) {
    bounds.lower.insert(bounds.lower.end(), max_, height_bounds_[0]);
    bounds.upper.insert(bounds.upper.end(), max_, height_bounds_[1]);
  }
  if (minimises_) bounds.lower.push_back(0), bounds.upper.push_back(1);
  return bounds;
}

std::size_t DecisionSpace::placed_count(std::span<const double> x) const {
  return minimises_ ? station_count_from_alpha(x.back(), min_, max_) : max_;
}

double DecisionSpace::height(std::span<const double> x, std::size_t i) const {
  return heights_ ? x[2 * max_ + i] : site_.height_m;
}

std::vector<PlacedStation> DecisionSpace::decode(std::span<const double> x) const {
  std::vector<PlacedStation> stations = kept_;
  const std::size_t n = placed_count(x);
  for (std::size_t i = 0; i < n; ++i) stations.push_back(place_station(site_, {x[2 * i], x[2 * i + 1]}, height(x, i)));
  return stations;
}

std::vector<std::size_t> DecisionSpace::coordinates(std::size_t i) const {
  const std::size_t k = i - kept_.size();
  return {2 * k, 2 * k + 1};  // the height cannot leave a hole or a clash
}

std::vector<std::vector<std::size_t>> DecisionSpace::blocks() const {
  std::vector<std::vector<std::size_t>> blocks;
  for (std::size_t k = 0; k < max_; ++k) {
    auto& block = blocks.emplace_back(std::vector{2 * k, 2 * k + 1});
    if (heights_) block.push_back(2 * max_ + k);
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
    const auto uv = site_.project(head - Vec3{0, 0, site_.height_m});
    if (!uv)
      refuse("the initial position " + std::to_string(head.x) + ", " + std::to_string(head.y) + ", " +
             std::to_string(head.z) + " is not above the search area");
    x[2 * i] = uv->u, x[2 * i + 1] = uv->v;
    if (heights_) {
      const auto ground = site_.locate(*uv);
      x[2 * max_ + i] = std::clamp(ground ? head.z - ground->z : site_.height_m, height_bounds_[0], height_bounds_[1]);
    }
  }
  if (minimises_)
    x.back() =
        max_ == min_ ? 0 : static_cast<double>(std::max(heads.size(), min_) - min_) / static_cast<double>(max_ - min_);
  return x;
}

std::vector<std::vector<double>> DecisionSpace::encode_each(std::span<const Vec3> heads) const {
  std::vector<std::vector<double>> xs{encode(heads)};
  if (minimises_)
    for (std::size_t n = std::min(heads.size(), max_) - 1; n >= min_ && n < heads.size(); --n)
      xs.push_back(encode(heads.first(n)));
  return xs;
}

void DecisionSpace::objectives_of(std::span<const double> x, double coverage, double overlap, std::size_t parts,
                                  std::span<double> f) const {
  if (fitness_) {
    const double spared =
        max_ == min_ ? 1 : static_cast<double>(max_ - placed_count(x)) / static_cast<double>(max_ - min_);
    f[0] = 1 - (fitness_->coverage * coverage + fitness_->station_count * (std::exp2(spared) - 1) +
                fitness_->visibility / static_cast<double>(parts));
    return;
  }
  std::size_t k = 0;
  f[k++] = 1 - coverage;
  if (overlap_) f[k++] = 1 - overlap;
  if (minimises_) f[k++] = x.back();
  // Behind every connected network, whose objectives lie in [0, 1]; outside the reference point, so without
  // hypervolume.
  if (parts > 1)
    for (double& value : f) value += static_cast<double>(parts - 1);
}

}  // namespace vantage
