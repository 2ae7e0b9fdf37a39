// SPDX-License-Identifier: Apache-2.0
#include "import/cloud/density.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "import/program.hpp"

namespace vantage::importer {
namespace {

constexpr std::size_t kReservoir = 1023, kMostSampled = 1 << 14;
// A plane has three unknowns; twice as many points show whether they lie in one. Neighbours add more points.
constexpr double kEnough = 6;
constexpr double kFarthest = 1e13;  // its cells of the smallest size can be numbered

std::uint64_t mixed(
    std::uint64_t value) {  // Steele, Lea and Flood: Fast Splittable Pseudorandom Number Generators, 2014
  value = (value ^ (value >> 30)) * 0xBF58476D1CE4E5B9;
  value = (value ^ (value >> 27)) * 0x94D049BB133111EB;
  return value ^ (value >> 31);
}

}  // namespace

void Density::add(const Eigen::Vector3d& p) {
  if (!(p.cwiseAbs().maxCoeff() <= kFarthest)) return;
  ++points_;
  if (reservoir_.size() < kReservoir) {
    reservoir_.push_back(p);
  } else {
    random_ += 0x9E3779B97F4A7C15;
    if (const std::uint64_t place = mixed(random_) % points_; place < kReservoir) reservoir_[place] = p;
  }
  for (std::size_t s = 0; s < kSizes_m.size(); ++s) {
    std::uint64_t hash = s;
    for (int axis = 0; axis < 3; ++axis)
      hash = mixed(hash +
                   static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(p[axis] / (kSizes_m[s] * scale_)))));
    Sample& sample = samples_[s];
    if (hash & sample.mask) continue;
    ++sample.counts[hash];
    while (sample.counts.size() > kMostSampled) {
      sample.mask = 2 * sample.mask + 1;
      std::erase_if(sample.counts, [&](const auto& cell) { return (cell.first & sample.mask) != 0; });
    }
  }
}

Eigen::Vector3d Density::middle() const {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  std::vector<double> values;
  for (int axis = 0; axis < 3 && !reservoir_.empty(); ++axis) {
    values.clear();
    for (const Eigen::Vector3d& p : reservoir_) values.push_back(p[axis]);
    const auto half = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), half, values.end());
    middle[axis] = *half;
  }
  return middle;
}

Eigen::Vector3d Density::extent() const {
  constexpr double kLeftOut = 0.02;  // at each end
  Eigen::Vector3d extent = Eigen::Vector3d::Zero();
  std::vector<double> values;
  for (int axis = 0; axis < 3 && !reservoir_.empty(); ++axis) {
    values.clear();
    for (const Eigen::Vector3d& p : reservoir_) values.push_back(p[axis]);
    std::ranges::sort(values);
    const auto left_out = static_cast<std::size_t>(kLeftOut * static_cast<double>(values.size()));
    extent[axis] = values[values.size() - 1 - left_out] - values[left_out];
  }
  return extent;
}

double Density::median(std::size_t size) const {
  std::vector<std::uint32_t> counts;
  for (const auto& cell : samples_[size].counts) counts.push_back(cell.second);
  if (counts.empty()) return 0;
  const auto half = counts.begin() + static_cast<std::ptrdiff_t>(counts.size() / 2);
  std::nth_element(counts.begin(), half, counts.end());
  return *half;
}

bool Density::too_thin() const { return median(kSizes_m.size() - 1) < kEnough; }

double Density::cells(std::size_t size) const {
  return static_cast<double>(samples_[size].counts.size()) * static_cast<double>(samples_[size].mask + 1);
}

std::size_t choose_cell(const Density& density, double memory, double bytes_each) {
  for (std::size_t s = 0; s < Density::kSizes_m.size(); ++s)
    if (density.median(s) >= kEnough && density.cells(s) * bytes_each <= memory) return s;
  if (!density.too_thin())
    throw Refused("its surfaces take more memory than there is, even in cells of 50 cm; export parts of it");
  throw Refused("its points, " + std::to_string(density.points()) +
                " in all, are too thin for surfaces: cells of 50 cm mostly hold fewer than 6; export more of them, or "
                "give the setting unit if its coordinates are no metres");
}

}  // namespace vantage::importer
