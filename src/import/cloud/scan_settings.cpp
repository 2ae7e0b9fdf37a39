// SPDX-License-Identifier: Apache-2.0
#include "import/cloud/scan_settings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vantage::importer {
namespace {

using nlohmann::json;

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr double kAtScanner_m = 0.05;  // nearer points are no hits: writers put misses at 0
constexpr std::size_t kSamples = 1 << 14;
// Compares points this many rows or columns apart: far enough for rounded coordinates, near enough for one sweep.
constexpr std::uint32_t kLeastApart = 8, kMostApart = 200;
constexpr std::size_t kLeastPairs = 50;
// An azimuth says little within this angle of a pole.
constexpr double kFromPole_deg = 30;
// A cell of one degree counts as filled by every ray if it has as many points as this quantile of all cells.
constexpr double kFullShare = 0.9;
constexpr std::uint32_t kLeastInCell = 4;
// A gap without points of at least this width lies outside the field of view.
constexpr int kGap_deg = 10;
// A degree of azimuth or zenith lies in the field of view if it has at least this share of the mean number of points,
// so that a few wrong points do not count.
constexpr double kLeastShare = 0.01;
constexpr double kNotAlone = 2;  // points
// Ranges are counted in classes that grow by this factor; a class counts if it has this share of the points.
constexpr double kRangeGrows = 1.05, kLeastOfRange = 1e-4;

double median(std::vector<double> values) {
  const auto half = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), half, values.end());
  return *half;
}

// Rounds to three digits, so that scans with the same setting agree.
double rounded(double value) {
  const double digit = std::pow(10, std::floor(std::log10(value)) - 2);
  return std::round(value / digit) * digit;
}

}  // namespace

void ScanSettings::add(const Eigen::Vector3d& p, std::optional<std::array<std::uint32_t, 2>> cell) {
  const double range = p.norm();
  if (!(range >= kAtScanner_m)) return;
  ++points_;
  const auto class_of_range = static_cast<std::size_t>(std::log(range / kAtScanner_m) / std::log(kRangeGrows));
  ++ranges_[std::min(class_of_range, kRanges - 1)];
  const double azimuth = std::atan2(p.y(), p.x()) * kDegrees, zenith = std::acos(p.z() / range) * kDegrees;
  const int a = std::clamp(static_cast<int>(std::floor(azimuth + 180)), 0, kAzimuths - 1);
  const int z = std::clamp(static_cast<int>(std::floor(zenith)), 0, kZeniths - 1);
  std::uint32_t& count = directions_[static_cast<std::size_t>(z * kAzimuths + a)];
  if (count < UINT32_MAX) ++count;
  if (!cell) return;
  const Sample sample{azimuth, zenith, (*cell)[0], (*cell)[1]};
  if (samples_.size() < kSamples) {
    samples_.push_back(sample);
  } else {
    // Any generator will do; this is Knuth's linear congruential one.
    random_ = random_ * 6364136223846793005 + 1442695040888963407;
    if (const std::uint64_t place = (random_ >> 16) % points_; place < kSamples) samples_[place] = sample;
  }
}

std::optional<std::array<double, 2>> ScanSettings::steps_by_grid() const {
  // Returns the median angle of a step over pairs of points that are near each other in the grid.
  const auto step = [&](auto&& index, auto&& angle, double turn, bool from_poles) -> std::optional<double> {
    std::vector<Sample> sorted;
    for (const Sample& s : samples_)
      if (!from_poles || (s.zenith > kFromPole_deg && s.zenith < 180 - kFromPole_deg)) sorted.push_back(s);
    std::ranges::sort(sorted, {}, index);
    std::vector<double> steps;
    for (std::size_t k = 0; k < sorted.size(); ++k)
      for (std::size_t other = k + 1; other < sorted.size(); ++other) {
        const std::uint32_t apart = index(sorted[other]) - index(sorted[k]);
        if (apart > kMostApart) break;
        if (apart < kLeastApart) continue;
        steps.push_back(std::abs(std::remainder(angle(sorted[other]) - angle(sorted[k]), turn)) / apart);
        break;
      }
    if (steps.size() < kLeastPairs) return {};
    const double found = median(std::move(steps));
    return found > 0 ? std::optional(found) : std::nullopt;
  };
  // A mirror that turns over the top fills both sides of a column, so that azimuths are taken modulo 180 degrees.
  const auto column =
      step([](const Sample& s) { return s.column; }, [](const Sample& s) { return s.azimuth; }, 180, true);
  const auto row = step([](const Sample& s) { return s.row; }, [](const Sample& s) { return s.zenith; }, 360, false);
  if (!column || !row) return {};
  return std::array{*column, *row};
}

std::optional<double> ScanSettings::step_by_density() const {
  std::vector<std::uint32_t> counts;
  for (int z = static_cast<int>(kFromPole_deg); z < kZeniths - static_cast<int>(kFromPole_deg); ++z)
    for (int a = 0; a < kAzimuths; ++a)
      if (const std::uint32_t n = directions_[static_cast<std::size_t>(z * kAzimuths + a)]; n > 0) counts.push_back(n);
  if (counts.empty()) return {};
  const auto full = counts.begin() + static_cast<std::ptrdiff_t>(kFullShare * static_cast<double>(counts.size() - 1));
  std::nth_element(counts.begin(), full, counts.end());
  if (*full < kLeastInCell) return {};
  return 1 / std::sqrt(static_cast<double>(*full));
}

json ScanSettings::as_json() const {
  if (points_ == 0) return nullptr;
  std::vector<std::uint64_t> of_azimuth(kAzimuths), of_zenith(kZeniths);
  for (int z = 0; z < kZeniths; ++z)
    for (int a = 0; a < kAzimuths; ++a) {
      const std::uint32_t n = directions_[static_cast<std::size_t>(z * kAzimuths + a)];
      of_azimuth[static_cast<std::size_t>(a)] += n, of_zenith[static_cast<std::size_t>(z)] += n;
    }
  const auto seen = [&](const std::vector<std::uint64_t>& counts, int k) {
    const auto all = static_cast<double>(points_) / static_cast<double>(counts.size());
    return static_cast<double>(counts[static_cast<std::size_t>(k)]) >= std::max(kNotAlone, kLeastShare * all);
  };
  int first = 0, last = kZeniths - 1;
  while (first < last && !seen(of_zenith, first)) ++first;
  while (last > first && !seen(of_zenith, last)) --last;
  // The widest gap around the horizon lies outside the field of view.
  int gap = 0, gap_end = 0;
  for (int k = 0, length = 0; k < 2 * kAzimuths; ++k) {
    length = seen(of_azimuth, k % kAzimuths) ? 0 : length + 1;
    if (length > gap) gap = length, gap_end = k + 1;
  }
  json azimuth{0, 360};
  if (gap >= kGap_deg && gap < kAzimuths) {
    const int width = kAzimuths - gap;
    azimuth = {std::remainder(gap_end + 0.5 * width - 180, 360), width};
  }
  const auto often = [&](std::uint64_t n) {
    return static_cast<double>(n) >= std::max(kNotAlone, kLeastOfRange * static_cast<double>(points_));
  };
  std::size_t nearest = 0, farthest = kRanges - 1;
  while (nearest < farthest && !often(ranges_[nearest])) ++nearest;
  while (farthest > nearest && !often(ranges_[farthest])) --farthest;
  json step = nullptr;
  const auto by_grid = steps_by_grid();
  if (by_grid)
    step = {rounded((*by_grid)[0]), rounded((*by_grid)[1])};
  else if (const auto by_density = step_by_density())
    step = {rounded(*by_density), rounded(*by_density)};
  return {{"azimuth", azimuth},
          {"zenith", {first, last + 1}},
          {"range",
           {kAtScanner_m * std::pow(kRangeGrows, static_cast<double>(nearest + 1)),
            kAtScanner_m * std::pow(kRangeGrows, static_cast<double>(farthest))}},
          {"step", step},
          {"by_grid", by_grid.has_value()}};
}

}  // namespace vantage::importer
