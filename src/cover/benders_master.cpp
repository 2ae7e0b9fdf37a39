// SPDX-License-Identifier: Apache-2.0
#include "cover/benders_master.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <coin/CbcModel.hpp>
#include <coin/ClpSimplex.hpp>
#include <coin/OsiClpSolverInterface.hpp>
#include <functional>
#include <limits>
#include <numeric>
#include <utility>

#include "core/seconds_since.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

using Clock = std::chrono::steady_clock;

// More groups make cuts tighter and the linear program larger.
constexpr std::size_t kMostGroups = 24;
constexpr std::size_t kElementsPerGroup = 50;
// A cut is dropped after this many slack rounds.
constexpr std::size_t kIdleRounds = 6;
// Error of a bound from branch and bound, due to its tolerances.
constexpr double kBoundSlack = 1e-6;
// Rounding must not lose solutions as good as the known one.
constexpr double kKnownSlack = 1e-7;
// A cut is added if it is violated by this share of all weight.
constexpr double kViolated = 1e-9;
// A pocket limits an element if its doors lower the element's coverage by more than this.
constexpr double kLimited = 1e-6;

}  // namespace

struct BendersMaster::Impl {
  const CoverProblem& problem;
  const CoverageMatrix& matrix;
  const std::vector<std::size_t>& existing;
  std::size_t candidates, groups;
  std::vector<double> base;          // b_e
  std::vector<double> weight;        // w_e / Σ w
  std::vector<double> group_weight;  // Σ w of each group
  std::vector<Cut> cuts;

  Impl(const CoverProblem& p, std::size_t n)
      : problem(p),
        matrix(p.matrix),
        existing(p.existing),
        candidates(n),
        groups(std::clamp<std::size_t>(matrix.elements() / kElementsPerGroup, 1, kMostGroups)),
        base(matrix.elements()),
        weight(matrix.elements()),
        group_weight(groups) {
    const double all = matrix.total_weight() > 0 ? matrix.total_weight() : 1;
    for (std::size_t e = 0; e < weight.size(); ++e) {
      weight[e] = matrix.weight(e) / all;
      group_weight[group_of(e)] += weight[e];
    }
    for (const std::size_t k : existing)
      for (const CoverageMatrix::Entry& one : matrix.column(k)) base[one.element] += share(one);
    for (double& b : base) b = std::min(b, 1.0);
  }

  // Neighbouring elements share a group, since elements along a space-filling curve are covered alike.
  std::size_t group_of(std::size_t element) const { return element * groups / weight.size(); }
  double share(const CoverageMatrix::Entry& one) const { return std::min(one.amount / matrix.goal(one.element), 1.0); }

  std::vector<double> covered_at(std::span<const double> y) const {
    std::vector<double> covered(base);
    for (std::size_t k = 0; k < candidates; ++k) {
      if (y[k] <= 0) continue;
      for (const CoverageMatrix::Entry& one : matrix.column(k)) covered[one.element] += y[k] * share(one);
    }
    return covered;
  }

  double value(std::span<const double> y) const {
    const std::vector<double> covered = covered_at(y);
    double sum = 0;
    for (std::size_t e = 0; e < covered.size(); ++e) sum += weight[e] * std::min(covered[e], 1.0);
    return sum;
  }

  std::vector<Cut> cuts_at(std::span<const double> y, std::span<const Pocket> pockets = {}) const {
    std::vector<double> covered = covered_at(y);
    const PocketUse use = pockets_used(y, pockets, covered);
    std::vector<Cut> made(groups);
    for (std::size_t g = 0; g < groups; ++g) made[g] = {g, 0, std::vector<double>(candidates), 0};
    for (std::size_t e = 0; e < covered.size(); ++e)
      made[group_of(e)].constant += weight[e] * (covered[e] >= 1 ? 1 : base[e]);
    for (std::size_t k = 0; k < candidates; ++k)
      for (const CoverageMatrix::Entry& one : matrix.column(k))
        if (covered[one.element] < 1 && !use.holds(one.element, k))
          made[group_of(one.element)].of[k] += weight[one.element] * share(one);
    for (std::size_t e = 0; e < use.of.size(); ++e)
      if (covered[e] < 1)
        for (const std::uint32_t p : use.of[e])
          for (const std::uint32_t door : pockets[p].doors) made[group_of(e)].of[door] += weight[e];
    return made;
  }

  // The disjoint pockets that limit each element.
  struct PocketUse {
    std::vector<std::vector<std::uint32_t>> of;  // by element; empty: no pockets
    std::vector<std::vector<char>> members;      // by pocket and candidate
    bool holds(std::size_t element, std::size_t k) const {
      return !of.empty() && std::ranges::any_of(of[element], [&](std::uint32_t p) { return members[p][k] != 0; });
    }
  };
  // Finds the pockets that apply at y, and lowers the coverage of the elements that they limit.
  PocketUse pockets_used(std::span<const double> y, std::span<const Pocket> pockets,
                         std::vector<double>& covered) const {
    PocketUse use;
    if (pockets.empty()) return use;
    struct Limit {
      double less;
      std::uint32_t pocket;
    };
    std::vector<std::vector<Limit>> limits(covered.size());
    std::vector<double> inside(covered.size());
    std::vector<std::uint32_t> touched;
    for (std::uint32_t p = 0; p < pockets.size(); ++p) {
      use.members.emplace_back(candidates, 0);
      for (const std::uint32_t k : pockets[p].members) use.members[p][k] = 1;
      double most = 0;
      for (const std::uint32_t door : pockets[p].doors) most += y[door];
      touched.clear();
      for (const std::uint32_t k : pockets[p].members) {
        if (y[k] <= 0) continue;
        for (const CoverageMatrix::Entry& one : matrix.column(k)) {
          if (inside[one.element] == 0) touched.push_back(one.element);
          inside[one.element] += y[k] * share(one);
        }
      }
      for (const std::uint32_t e : touched) {
        if (const double less = inside[e] - most; less > kLimited) limits[e].push_back({less, p});
        inside[e] = 0;
      }
    }
    use.of.resize(covered.size());
    std::vector<std::vector<char>> apart(pockets.size(), std::vector<char>(pockets.size()));
    for (std::size_t a = 0; a < pockets.size(); ++a)
      for (std::size_t b = 0; b < pockets.size(); ++b)
        apart[a][b] =
            std::ranges::none_of(pockets[a].members, [&](std::uint32_t k) { return use.members[b][k] != 0; }) ? 1 : 0;
    for (std::size_t e = 0; e < covered.size(); ++e) {
      std::ranges::stable_sort(limits[e], std::greater<>(), &Limit::less);
      for (const Limit& limit : limits[e]) {
        if (!std::ranges::all_of(use.of[e], [&](std::uint32_t p) { return apart[p][limit.pocket] != 0; })) continue;
        use.of[e].push_back(limit.pocket), covered[e] -= limit.less;
      }
    }
    return use;
  }

  double at(const Cut& cut, std::span<const double> y) const {
    double sum = cut.constant;
    for (std::size_t k = 0; k < candidates; ++k) sum += cut.of[k] * y[k];
    return sum;
  }

  // Upper bound on F(y), proven by the duals of the cuts. With u_c >= 0 on the cuts of each group, with a sum of at
  // most 1, F(y) <= Σ_c u_c constant_c + Σ_g (1 − Σ_{c of g} u_c) W_g + Σ_k y_k Σ_c u_c of_ck for every y.
  double proven(std::span<const double> dual, double stations) const {
    std::vector<double> used(groups), gain(candidates);
    std::vector<double> u(dual.begin(), dual.end());
    for (std::size_t c = 0; c < cuts.size(); ++c) used[cuts[c].group] += u[c] = std::max(u[c], 0.0);
    for (std::size_t c = 0; c < cuts.size(); ++c) u[c] /= std::max(used[cuts[c].group], 1.0);
    double sum = 0;
    for (std::size_t g = 0; g < groups; ++g) sum += (1 - std::min(used[g], 1.0)) * group_weight[g];
    for (std::size_t c = 0; c < cuts.size(); ++c) {
      if (u[c] == 0) continue;
      sum += u[c] * cuts[c].constant;
      for (std::size_t k = 0; k < candidates; ++k) gain[k] += u[c] * cuts[c].of[k];
    }
    std::sort(gain.begin(), gain.end(), std::greater<>());
    for (std::size_t k = 0; k < gain.size() && stations > 0; ++k, stations -= 1)
      sum += std::min(stations, 1.0) * gain[k];
    return std::min(sum, 1.0);
  }

  // The least number of stations for which `proven` allows this coverage.
  double stations_proven(std::span<const double> dual, double wanted) const {
    double least = 0, most = static_cast<double>(candidates);
    if (proven(dual, most) < wanted) return most;
    // The bound grows with the number, linearly between integers: bisect to well below the effect on a ceiling.
    for (int step = 0; step < 50; ++step) {
      const double middle = 0.5 * (least + most);
      (proven(dual, middle) < wanted ? least : most) = middle;
    }
    return least;
  }

  void add_exclusions(ClpSimplex& lp, std::size_t stations) const;

  Relaxed solve(bool fewest, double limit, double tolerance, double seconds, const Progress& progress);

  void drop_idle(ClpSimplex& lp, std::span<const double> dual) {
    std::vector<int> drop;
    std::vector<Cut> kept;
    for (std::size_t c = 0; c < cuts.size(); ++c) {
      cuts[c].idle = dual[c] > 0 ? 0 : cuts[c].idle + 1;
      if (cuts[c].idle > kIdleRounds)
        drop.push_back(first_cut + static_cast<int>(c));
      else
        kept.push_back(std::move(cuts[c]));
    }
    cuts = std::move(kept);
    if (!drop.empty()) lp.deleteRows(static_cast<int>(drop.size()), drop.data());
  }

  // Columns: y of each candidate, then θ of each group. Rows: Σ y, Σ θ, then the cuts.
  enum Row { number, coverage, first_cut };

  void load(ClpSimplex& lp) const {
    const int columns = static_cast<int>(candidates + groups);
    lp.setLogLevel(0);
    lp.resize(0, columns);
    for (int c = 0; c < columns; ++c) {
      const auto k = static_cast<std::size_t>(c);
      lp.setColumnBounds(c, 0, k < candidates ? 1 : group_weight[k - candidates]);
    }
    std::vector<int> index(candidates);
    std::vector<double> ones(std::max(candidates, groups), 1.0);
    for (std::size_t k = 0; k < candidates; ++k) index[k] = static_cast<int>(k);
    lp.addRow(static_cast<int>(candidates), index.data(), ones.data(), -COIN_DBL_MAX, COIN_DBL_MAX);
    index.resize(groups);
    for (std::size_t g = 0; g < groups; ++g) index[g] = static_cast<int>(candidates + g);
    lp.addRow(static_cast<int>(groups), index.data(), ones.data(), -COIN_DBL_MAX, COIN_DBL_MAX);
    for (const Cut& cut : cuts) add(lp, cut);
  }

  void add(ClpSimplex& lp, const Cut& cut) const {
    std::vector<int> index{static_cast<int>(candidates + cut.group)};
    std::vector<double> value{1};
    for (std::size_t k = 0; k < candidates; ++k) {
      if (cut.of[k] == 0) continue;
      index.push_back(static_cast<int>(k));
      value.push_back(-cut.of[k]);
    }
    lp.addRow(static_cast<int>(index.size()), index.data(), value.data(), -COIN_DBL_MAX, cut.constant);
  }
};

BendersMaster::BendersMaster(const CoverProblem& problem, std::size_t candidates)
    : impl_(std::make_unique<Impl>(problem, candidates)) {
  cut_at(std::vector<double>(candidates, 0.0));
}
BendersMaster::BendersMaster(BendersMaster&&) noexcept = default;
BendersMaster::~BendersMaster() = default;

double BendersMaster::value(std::span<const double> y) const { return impl_->value(y); }

void BendersMaster::cut_at(std::span<const double> y) {
  for (Cut& cut : impl_->cuts_at(y)) impl_->cuts.push_back(std::move(cut));
}

std::vector<BendersMaster::Cut> BendersMaster::supergradients(std::span<const double> y,
                                                              std::span<const Pocket> pockets) const {
  return impl_->cuts_at(y, pockets);
}
const std::vector<BendersMaster::Cut>& BendersMaster::cuts() const { return impl_->cuts; }
std::size_t BendersMaster::groups() const { return impl_->groups; }
double BendersMaster::group_weight(std::size_t group) const { return impl_->group_weight[group]; }

Relaxed BendersMaster::max_coverage(double stations, double tolerance, double seconds, const Progress& progress) {
  return impl_->solve(false, stations, tolerance, seconds, progress);
}

Relaxed BendersMaster::min_stations(double coverage, double tolerance, double seconds, const Progress& progress) {
  return impl_->solve(true, coverage, tolerance, seconds, progress);
}

// Both problems have the same cuts. For max_coverage() `limit` is the number of stations; each solution of the master
// is one of the relaxation, with F(y) below its bound. For min_stations() it is the coverage, which the master's
// solution misses until there are enough cuts.
Relaxed BendersMaster::Impl::solve(bool fewest, double limit, double tolerance, double seconds,
                                   const Progress& progress) {
  const auto begun = Clock::now();
  Relaxed best{.bound = fewest ? 0.0 : 1.0, .reached = 0, .y = std::vector<double>(candidates, 0.0)};
  if (fewest) {
    const std::vector<double> all(candidates, 1.0);
    if (value(all) < limit) {
      best.bound = std::numeric_limits<double>::infinity();
      best.complete = true;
      return best;
    }
  }
  ClpSimplex lp;
  load(lp);
  lp.setOptimizationDirection(fewest ? 1 : -1);
  for (std::size_t c = 0; c < candidates + groups; ++c)
    lp.setObjectiveCoefficient(static_cast<int>(c), (c < candidates) == fewest ? 1 : 0);
  if (fewest)
    lp.setRowLower(coverage, limit);
  else
    lp.setRowUpper(number, limit);

  double best_value = -1;
  std::vector<double> between(candidates);
  while (true) {
    lp.dual();
    ++best.rounds;
    if (lp.status() != 0) throw Error(Errc::device_failure, "the linear program of a bound could not be solved");
    const std::vector<double> y(lp.primalColumnSolution(), lp.primalColumnSolution() + candidates);
    const std::vector<double> theta(lp.primalColumnSolution() + candidates,
                                    lp.primalColumnSolution() + candidates + groups);
    const double of_coverage = fewest ? std::abs(lp.dualRowSolution()[coverage]) : 1;
    std::vector<double> dual(cuts.size());
    for (std::size_t c = 0; c < dual.size() && of_coverage > 0; ++c)
      dual[c] = std::abs(lp.dualRowSolution()[first_cut + static_cast<int>(c)]) / of_coverage;
    best.bound =
        fewest ? std::max(best.bound, stations_proven(dual, limit)) : std::min(best.bound, proven(dual, limit));
    const double now = value(y);
    if (now > best_value) {
      best_value = now;
      best.y = y;
      best.reached = fewest ? std::accumulate(y.begin(), y.end(), 0.0) : now;
    }
    const double apart = fewest ? limit - now : best.bound - best_value;
    progress(std::clamp(tolerance / std::max(apart, tolerance), 0.0, 1.0));
    best.complete = apart <= tolerance;
    if (best.complete || progress.stopped() || (seconds > 0 && seconds_since(begun) > seconds)) return best;

    // Cuts are deeper between the master's solution, which jumps, and the best so far (Ben-Ameur and Neto: Acceleration
    // of cutting-plane and column generation algorithms, Networks 49, 2007).
    for (std::size_t k = 0; k < candidates; ++k) between[k] = 0.5 * (y[k] + best.y[k]);
    std::vector<Cut> made = cuts_at(y);
    if (best.y != y)
      for (Cut& cut : cuts_at(between)) made.push_back(std::move(cut));
    drop_idle(lp, dual);
    for (Cut& cut : made) {
      if (theta[cut.group] - at(cut, y) <= kViolated) continue;
      add(lp, cut);
      cuts.push_back(std::move(cut));
    }
  }
}

// Allows at most one of two candidates that exclude each other. Each candidate has a row: if it is taken, none of the
// others is. Existing candidates are exempt.
void BendersMaster::Impl::add_exclusions(ClpSimplex& lp, std::size_t stations) const {
  if (!problem.graph) return;
  const auto exists = [&](std::size_t k) { return std::ranges::find(existing, k) != existing.end(); };
  const auto excluded_by = [&](std::size_t k) {
    std::vector<int> others;
    for (std::size_t other = 0; other < candidates; ++other)
      if (problem.graph->excluded(k, other) && !(exists(k) && exists(other))) others.push_back(static_cast<int>(other));
    return others;
  };
  for (const std::size_t k : existing)
    for (const int other : excluded_by(k)) lp.setColumnUpper(other, 0);
  for (std::size_t k = 0; k < candidates; ++k) {
    std::vector<int> index = excluded_by(k);
    if (index.empty()) continue;
    const auto most = static_cast<double>(std::min(index.size(), stations));
    std::vector<double> value(index.size(), 1);
    index.push_back(static_cast<int>(k)), value.push_back(most);
    lp.addRow(static_cast<int>(index.size()), index.data(), value.data(), -COIN_DBL_MAX, most);
  }
}

BendersMaster::Choice BendersMaster::choose(std::size_t stations, double seconds, double known) const {
  const Impl& m = *impl_;
  ClpSimplex lp;
  m.load(lp);
  lp.setOptimizationDirection(-1);
  for (std::size_t g = 0; g < m.groups; ++g) lp.setObjectiveCoefficient(static_cast<int>(m.candidates + g), 1);
  lp.setRowUpper(Impl::number, static_cast<double>(stations));
  lp.setRowLower(Impl::coverage, known - kKnownSlack);
  for (const std::size_t k : m.existing)
    if (k < m.candidates) lp.setColumnUpper(static_cast<int>(k), 0);  // it cannot be taken again
  m.add_exclusions(lp, stations);
  OsiClpSolverInterface solver(&lp);
  solver.messageHandler()->setLogLevel(0);
  for (std::size_t k = 0; k < m.candidates; ++k) solver.setInteger(static_cast<int>(k));
  CbcModel model(solver);
  model.setLogLevel(0);
  model.messageHandler()->setLogLevel(0);
  model.setMaximumSeconds(seconds);
  model.branchAndBound();
  Choice choice;
  // Cbc minimises the negated objective.
  choice.bound = std::min(1.0, std::abs(model.getBestPossibleObjValue()) + kBoundSlack);
  if (const double* best = model.bestSolution()) {
    for (std::size_t k = 0; k < m.candidates; ++k)
      if (best[k] > 0.5) choice.candidates.push_back(k);
  }
  return choice;
}

}  // namespace vantage
