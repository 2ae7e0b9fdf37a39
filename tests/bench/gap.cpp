// SPDX-License-Identifier: Apache-2.0
#include "gap.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>

#include "core/text.hpp"
#include "map/chart.hpp"
#include "support/site_of.hpp"
#include "vantage/candidates.hpp"
#include "vantage/placement.hpp"

namespace vantage::bench {
namespace {

struct GapDot {
  std::size_t stations, candidates;
  double bound, found;
};

constexpr std::array<Colour, 4> kGapColours{{style::kBlue, style::kOrange, {0.10, 0.50, 0.32}, {0.48, 0.25, 0.60}}};

void draw(const std::string& file, const GapOptions& options, const std::vector<GapDot>& dots) {
  constexpr double kWidth = 820, kHeight = 520;
  Canvas canvas(kWidth, kHeight);
  double low = 1, high = 0;
  for (const GapDot& dot : dots) low = std::min(low, dot.found), high = std::max(high, dot.bound);
  const auto [fewest, most] = std::ranges::minmax(options.candidates);
  const Axis x{.label = "Candidates",
               .low = static_cast<double>(fewest) / 1.15,
               .high = static_cast<double>(most) * 1.15,
               .logarithmic = true};
  const Axis y = axis_over("Coverage", low, high, 0, 1);
  const Chart chart(canvas, {86, 72, kWidth - 86 - 200, kHeight - 72 - 70}, x, y, "What can be captured at best",
                    std::filesystem::path(options.site.scene).stem().string() + ", a sample of " +
                        std::to_string(options.sample) + " voxels");
  Point at{kWidth - 180, 90};
  for (std::size_t s = 0; s < options.counts.size(); ++s) {
    const Colour colour = kGapColours[s % kGapColours.size()];
    std::vector<Point> bound, found, between;
    double gap = 0;
    for (const GapDot& dot : dots) {
      if (dot.stations != options.counts[s]) continue;
      bound.push_back(chart.at(static_cast<double>(dot.candidates), dot.bound));
      found.push_back(chart.at(static_cast<double>(dot.candidates), dot.found));
      gap = dot.bound / dot.found - 1;
    }
    between = bound;
    between.insert(between.end(), found.rbegin(), found.rend());
    canvas.polygon(between, colour, 0.12);
    canvas.path(bound, {.colour = colour, .width = 1.4, .dashes = {5, 4}});
    canvas.path(found, {.colour = colour, .width = 2.2});
    for (const Point& p : found) canvas.disc(p, 4, colour);
    for (const Point& p : bound) canvas.circle(p, 4, {.colour = colour, .width = 1.4});
    canvas.text(at, std::to_string(options.counts[s]) + " stations", {.size = 13.5, .bold = true, .colour = colour});
    canvas.text({at.x, at.y + 18}, "gap " + fixed(100 * gap, 1) + " % at the last", {.size = 12.5});
    at.y += 48;
  }
  canvas.circle({at.x + 6, at.y}, 4, {.colour = style::kInk, .width = 1.4});
  canvas.text({at.x + 18, at.y}, "no choice has more", {.size = 12.5});
  canvas.disc({at.x + 6, at.y + 22}, 4, style::kInk);
  canvas.text({at.x + 18, at.y + 22}, "the best choice found", {.size = 12.5});
  canvas.save(file);
}

}  // namespace

void GapOptions::add(CLI::App& command) {
  site.add(command);
  command.add_option("--counts", counts, "Numbers of stations")->delimiter(',')->capture_default_str();
  command.add_option("--candidates", candidates, "Numbers of candidates, rising")
      ->delimiter(',')
      ->capture_default_str();
  command.add_option("--sample", sample, "Voxels looked at")->capture_default_str();
  command.add_option("-o", picture, "Draw it: .png or .svg");
}

void run_gap(const GapOptions& options) {
  Site site = test::site_of(options.site.simulator(Scene::load(options.site.scene)));
  const std::size_t most = *std::ranges::max_element(options.candidates);
  // The first n of them are spread as evenly as all.
  const Candidates all =
      find_candidates(site, {.first = most, .most = most, .sample_voxels = options.sample, .max_seconds = 0});
  std::printf("stations,candidates,bound,found,gap\n");
  std::vector<GapDot> dots;
  for (const std::size_t stations : options.counts)
    for (const std::size_t candidates : options.candidates) {
      if (candidates > all.stations().size()) continue;
      const CoverageMatrix& whole = all.coverage().matrix();
      CoverageMatrix matrix(whole.weights(), whole.goal());
      matrix.append(whole, candidates);
      const CoverSolution best = max_cover({.matrix = matrix, .most = stations});
      dots.push_back({stations, candidates, best.bound, best.coverage});
      std::printf("%zu,%zu,%.4f,%.4f,%.4f\n", stations, candidates, best.bound, best.coverage, best.gap());
      std::fflush(stdout);
    }
  if (!options.picture.empty()) draw(options.picture, options, dots);
}

}  // namespace vantage::bench
