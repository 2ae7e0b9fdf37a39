// SPDX-License-Identifier: Apache-2.0
#include "survey_problem.hpp"

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "vantage/objective.hpp"
#include "vantage/planner.hpp"

namespace vantage::bench {
namespace {

constexpr std::size_t kPatches = 600;
constexpr std::size_t kFewest = 4, kMost = 12;        // stations of FITNESS
constexpr double kHead = 1.5, kKeepOff = 0.5;         // m
constexpr double kVoxel = 0.0783, kSpacing = 0.01;    // m
constexpr double kStep = 0.1 * 0.017453292519943295;  // of the scanner
constexpr double kGoal = kVoxel * kVoxel / (kSpacing * kSpacing);

// An upright box, axis-parallel.
struct Prism {
  double x0, y0, x1, y1, height;
};

struct Patch {
  double x, y, z, nx, ny;
  std::size_t prism;
};

struct Survey {
  double side = 0;  // of the square ground, around the origin
  std::vector<Prism> prisms;
  std::vector<Patch> patches;

  double to_metres(double u) const { return side * (u - 0.5); }
  bool stands(double x, double y) const {
    return std::none_of(prisms.begin(), prisms.end(), [&](const Prism& p) {
      return x > p.x0 - kKeepOff && x < p.x1 + kKeepOff && y > p.y0 - kKeepOff && y < p.y1 + kKeepOff;
    });
  }
  bool hidden(double x, double y, const Patch& target) const;
  double points(double x, double y, const Patch& target) const;  // in the voxel of the patch
};

// True if the line from a head to the patch runs through another box, below its top.
bool Survey::hidden(double x, double y, const Patch& t) const {
  for (std::size_t i = 0; i < prisms.size(); ++i) {
    if (i == t.prism) continue;  // convex: the side of the normal decides
    const Prism& p = prisms[i];
    double in = 0, out = 1;
    const auto clip = [&](double from, double to, double low, double high) {
      if (from == to) {
        if (from < low || from > high) out = -1;
        return;
      }
      const double a = (low - from) / (to - from), b = (high - from) / (to - from);
      in = std::max(in, std::min(a, b));
      out = std::min(out, std::max(a, b));
    };
    clip(x, t.x, p.x0, p.x1);
    clip(y, t.y, p.y0, p.y1);
    if (in < out && std::min(kHead + in * (t.z - kHead), kHead + out * (t.z - kHead)) < p.height) return true;
  }
  return false;
}

double Survey::points(double x, double y, const Patch& t) const {
  const double dx = x - t.x, dy = y - t.y, facing = dx * t.nx + dy * t.ny;
  if (facing <= 0 || hidden(x, y, t)) return 0;
  // One ray takes step² sin(zenith) of the sphere; sin(zenith) is level distance over distance.
  const double level = dx * dx + dy * dy, dz = kHead - t.z;
  return kVoxel * kVoxel * facing / ((level + dz * dz) * kStep * kStep * std::sqrt(level));
}

std::shared_ptr<const Survey> make_survey(const std::string& name) {
  auto survey = std::make_shared<Survey>();
  if (name == "WALLS") {
    survey->side = 30;
    survey->prisms = {{-5, -5, 5, 5, 5}};
  } else if (name == "YARD") {
    survey->side = 24;
    survey->prisms = {{-8, -7, -5, -4, 3}, {-2, -8, 1, -6.5, 1},   {4, -7, 6, -3, 5},
                      {-8.5, 0, -7, 4, 2}, {-3.5, -1, -1, 2.5, 4}, {2, 0, 6, 1, 1.2},
                      {4, 4, 8, 5.5, 3},   {-4, 6, -2.5, 9, 2.5},  {0.5, 6.5, 1.5, 7.5, 6}};
  } else {
    throw std::invalid_argument("unknown survey " + name);
  }
  double area = 0;
  for (const Prism& p : survey->prisms) area += 2 * (p.x1 - p.x0 + p.y1 - p.y0) * p.height;
  // Patches at equal steps of area along the walls, their heights by the golden ratio.
  double skipped = 0;
  std::size_t next = 0;
  for (std::size_t i = 0; i < survey->prisms.size(); ++i) {
    const Prism& p = survey->prisms[i];
    const double w = p.x1 - p.x0, d = p.y1 - p.y0;
    for (const auto& [x, y, ax, ay, nx, ny] :
         {std::array{p.x0, p.y0, w, 0.0, 0.0, -1.0}, std::array{p.x1, p.y0, 0.0, d, 1.0, 0.0},
          std::array{p.x0, p.y1, w, 0.0, 0.0, 1.0}, std::array{p.x0, p.y0, 0.0, d, -1.0, 0.0}}) {
      const double length = ax + ay, wall = length * p.height;
      for (; next < kPatches; ++next) {
        const double at = ((static_cast<double>(next) + 0.5) * area / kPatches - skipped) / wall;
        if (at >= 1) break;
        const double up = std::fmod(static_cast<double>(next) * 0.6180339887498949, 1.0);
        survey->patches.push_back({x + at * ax, y + at * ay, up * p.height, nx, ny, i});
      }
      skipped += wall;
    }
  }
  return survey;
}

// Connected components of the heads that see each other past the boxes, all of which are higher than the heads.
std::size_t connected_parts(const Survey& survey, const std::vector<std::array<double, 2>>& heads) {
  const auto sees = [&](const std::array<double, 2>& a, const std::array<double, 2>& b) {
    const Patch target{b[0], b[1], kHead, 0, 0, survey.prisms.size()};
    return !survey.hidden(a[0], a[1], target);
  };
  OverlapMatrix seen(heads.size());
  for (std::size_t i = 0; i < heads.size(); ++i)
    for (std::size_t j = i + 1; j < heads.size(); ++j)
      if (sees(heads[i], heads[j])) seen.set(i, j, 1);
  return connectivity(seen, 1).parts;
}

void evaluate(const Survey& survey, std::span<const double> x, std::span<double> f) {
  const std::size_t n = x.size() / 2;
  std::vector<std::array<double, 2>> heads(n);
  std::vector<char> works(n);
  for (std::size_t i = 0; i < n; ++i) {
    heads[i] = {survey.to_metres(x[2 * i]), survey.to_metres(x[2 * i + 1])};
    works[i] = survey.stands(heads[i][0], heads[i][1]);
  }
  double filled = 0;
  using Seen = std::bitset<kPatches>;
  std::vector<Seen> seen(n);
  for (std::size_t k = 0; k < survey.patches.size(); ++k) {
    const Patch& patch = survey.patches[k];
    double points = 0;
    for (std::size_t i = 0; i < n; ++i) {
      if (!works[i]) continue;
      const double here = survey.points(heads[i][0], heads[i][1], patch);
      points += here;
      seen[i][k] = here >= 1;
    }
    filled += std::min(1.0, points / kGoal);
  }
  OverlapMatrix overlap(n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      const double shared = static_cast<double>((seen[i] & seen[j]).count());
      if (shared > 0) overlap.set(i, j, shared / static_cast<double>((seen[i] | seen[j]).count()));
    }
  }
  f[0] = 1 - filled / static_cast<double>(survey.patches.size());
  if (f.size() > 1) f[1] = 1 - clustering_coefficient(overlap);
}

// Section 5.1.2 of the paper: 0.4 coverage, 0.4 number of stations, 0.2 visibility.
double unfitness(const Survey& survey, std::span<const double> x) {
  const std::size_t n = station_count_from_alpha(x.back(), kFewest, kMost);
  double missed = 0;
  evaluate(survey, x.first(2 * n), {&missed, 1});
  std::vector<std::array<double, 2>> heads;
  for (std::size_t i = 0; i < n; ++i) heads.push_back({survey.to_metres(x[2 * i]), survey.to_metres(x[2 * i + 1])});
  const double spared = static_cast<double>(kMost - n) / (kMost - kFewest);
  return 1 - (0.4 * (1 - missed) + 0.4 * (std::exp2(spared) - 1) +
              0.2 / static_cast<double>(connected_parts(survey, heads)));
}

std::vector<std::size_t> misplaced(const Survey& survey, std::span<const double> x) {
  std::vector<std::size_t> coordinates;
  for (std::size_t i = 0; i + 1 < x.size(); i += 2)
    if (!survey.stands(survey.to_metres(x[i]), survey.to_metres(x[i + 1])))
      coordinates.insert(coordinates.end(), {i, i + 1});
  return coordinates;
}

}  // namespace

MoProblem fitness_problem() {
  const auto survey = make_survey("WALLS");
  const std::size_t n = 2 * kMost + 1;
  MoProblem p{"FITNESS", n, 1, Bounds::uniform(n, 0, 1), {}};
  const auto in_use = [](std::span<const double> x) { return station_count_from_alpha(x.back(), kFewest, kMost); };
  p.evaluate = [survey](auto x, auto f) { f[0] = unfitness(*survey, x); };
  p.misplaced = [survey, in_use](std::span<const double> x) { return misplaced(*survey, x.first(2 * in_use(x))); };
  for (std::size_t i = 0; i < kMost; ++i) p.blocks.push_back({2 * i, 2 * i + 1});
  p.blocks_in_use = in_use;
  return p;
}

MoProblem coverage_problem(const std::string& name, std::size_t n) {
  MoProblem p = survey_problem(name, n);
  p.objectives = 1;
  return p;
}

MoProblem survey_problem(const std::string& name, std::size_t n) {
  const auto survey = make_survey(name);
  MoProblem p{name, n, 2, Bounds::uniform(n, 0, 1), {}};
  p.evaluate = [survey](auto x, auto f) { evaluate(*survey, x, f); };
  p.misplaced = [survey](std::span<const double> x) { return misplaced(*survey, x); };
  for (std::size_t i = 0; i + 1 < n; i += 2) p.blocks.push_back({i, i + 1});
  return p;
}

}  // namespace vantage::bench
