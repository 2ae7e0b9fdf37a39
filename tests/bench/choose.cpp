// SPDX-License-Identifier: Apache-2.0
#include "choose.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <vector>

#include "core/philox.hpp"
#include "cover/swaps.hpp"

namespace vantage::bench {
namespace {

// A square floor of one voxel a cell, with candidates all over it. Each sees cells within reach at random unless
// something hides them, the nearer the denser: a station at the goal out to a third of its reach.
CoverageMatrix floor_matrix(const ChooseOptions& options) {
  RandomStream random(options.seed);
  const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(options.voxels))));
  // Radius at which the stations' discs cover the floor once.
  const double reach = std::sqrt(static_cast<double>(side * side) / 3.14159 / static_cast<double>(options.stations));
  constexpr double goal = 100;
  CoverageMatrix matrix(std::vector<std::uint32_t>(side * side, 1), goal);
  std::vector<std::uint32_t> points(side * side);
  for (std::size_t k = 0; k < options.candidates; ++k) {
    std::fill(points.begin(), points.end(), 0u);
    const double x = random.uniform() * static_cast<double>(side), y = random.uniform() * static_cast<double>(side);
    const auto low = [&](double at) { return static_cast<std::size_t>(std::max(at - 2 * reach, 0.0)); };
    const auto high = [&](double at) {
      return static_cast<std::size_t>(std::min(at + 2 * reach, static_cast<double>(side)));
    };
    for (std::size_t j = low(y); j < high(y); ++j)
      for (std::size_t i = low(x); i < high(x); ++i) {
        const double dx = static_cast<double>(i) + 0.5 - x, dy = static_cast<double>(j) + 0.5 - y;
        const double away = std::hypot(dx, dy) / (2 * reach);
        if (away < 1 && random.uniform() < 0.7)
          points[j * side + i] = static_cast<std::uint32_t>(goal / std::max(9 * away * away, 0.1));
      }
    matrix.add(points);
  }
  return matrix;
}

}  // namespace

void ChooseOptions::add(CLI::App& command) {
  command.add_option("--stations", stations, "How many to choose")->check(CLI::PositiveNumber)->capture_default_str();
  command.add_option("--candidates", candidates, "To choose among")->check(CLI::PositiveNumber)->capture_default_str();
  command.add_option("--voxels", voxels, "Of the site")->check(CLI::PositiveNumber)->capture_default_str();
  command.add_option("--capture", capture, "Coverage that the fewest stations are chosen for")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command.add_option("--seed", seed, "Of the site")->capture_default_str();
}

void run_choose(const ChooseOptions& options) {
  const CoverageMatrix matrix = floor_matrix(options);
  using Clock = std::chrono::steady_clock;
  std::printf("what,stations,coverage,seconds\n");
  const auto timed = [&](const char* what, auto&& choose) {
    const auto begun = Clock::now();
    const std::vector<std::size_t> found = choose();
    const double seconds = std::chrono::duration<double>(Clock::now() - begun).count();
    std::printf("%s,%zu,%.4f,%.2f\n", what, found.size(), matrix.coverage(found), seconds);
    std::fflush(stdout);
    return found;
  };
  const CoverProblem most{.matrix = matrix, .most = options.stations};
  const auto chosen = timed("greedy", [&] { return greedy(most); });
  timed("swaps", [&] { return improve_by_swaps(most, chosen); });
  const CoverProblem fewest{.matrix = matrix, .coverage = options.capture};
  const auto enough = timed("greedy for the coverage", [&] { return greedy(fewest); });
  timed("drops and swaps", [&] { return drop_and_swap(fewest, enough); });
}

}  // namespace vantage::bench
