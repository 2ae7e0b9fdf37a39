// SPDX-License-Identifier: Apache-2.0
#include "plan/what_pays.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "cover/partial_cover.hpp"
#include "scene/scene_data.hpp"

namespace vantage {
namespace {

// After this many stations the gain of one more is looked at alone, after twice as many that of two.
constexpr std::size_t kLookedAtTogether = 5;
constexpr std::size_t kFirstChoice = 64;  // stations; then twice as many

}  // namespace

StationsThatPay stations_that_pay(const CoverProblem& problem, const CoverageMatrix& weighted, double element_m2,
                                  double least_m2) {
  const std::size_t kept = problem.existing.size();
  const double whole_m2 = problem.matrix.total_weight() * element_m2;
  StationsThatPay found{.least_m2 = least_m2};
  // Longer and longer, since few sites take as many stations as are allowed.
  for (std::size_t most = std::min(kFirstChoice, problem.most);; most = std::min(2 * most, problem.most)) {
    CoverProblem shorter = problem;
    shorter.most = most;
    const std::vector<std::size_t> order = greedy(shorter);
    std::vector<double> captured_m2;  // by the existing stations, and after each further one
    PartialCover cover(problem.matrix, std::span(order).first(kept));
    captured_m2.push_back(cover.value() * whole_m2);
    for (std::size_t k = kept; k < order.size(); ++k) {
      cover.add(order[k]);
      captured_m2.push_back(cover.value() * whole_m2);
    }
    const std::size_t all = captured_m2.size() - 1;
    const bool ended = all < most || most == problem.most;
    for (std::size_t n = problem.existing.empty() ? 1 : 0; n <= all; ++n) {
      const std::size_t next = std::max<std::size_t>(1, n / kLookedAtTogether), last = std::min(n + next, all);
      if (n + next > all && !ended) break;
      found.next_m2 = last > n ? (captured_m2[last] - captured_m2[n]) / static_cast<double>(last - n) : 0;
      if (found.next_m2 >= least_m2) continue;
      found.stations = n;
      found.capture = weighted.coverage(std::span(order).first(kept + n));
      return found;
    }
  }
}

double surveyed_area_m2(const Scene& scene) {
  const SceneData& data = scene.data();
  double area = 0;
  for (std::size_t m = 0; m < data.meshes.size(); ++m) {
    if (data.meshes[m].role != Role::surveyed) continue;
    const MeshRange& range = data.ranges[m];
    for (std::uint32_t t = range.first_triangle; t < range.first_triangle + range.triangle_count; ++t) {
      const auto p = data.corners(t);
      const Vec3 a = widen(p[0]), normal = cross(widen(p[1]) - a, widen(p[2]) - a);
      area += std::sqrt(dot(normal, normal)) / 2;
    }
  }
  return area;
}

}  // namespace vantage
