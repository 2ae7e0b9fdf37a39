// SPDX-License-Identifier: Apache-2.0
#include "plan/capture_master.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <coin/CbcModel.hpp>
#include <coin/CglFlowCover.hpp>
#include <coin/CglGomory.hpp>
#include <coin/CglMixedIntegerRounding2.hpp>
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

// More groups make each cut tell more, and the linear program larger; so many of this size do well.
constexpr std::size_t most_groups = 24;
constexpr std::size_t voxels_per_group = 50;
// Cuts that no solution has leaned on for so many rounds are dropped.
constexpr std::size_t idle_rounds = 6;
// What branch and bound may be wrong by: its tolerances.
constexpr double bound_slack = 1e-6;
// Solutions as good as the known one must not be lost to rounding.
constexpr double known_slack = 1e-7;
// A cut must be broken by this share of all weight.
constexpr double broken = 1e-9;

}  // namespace

struct CaptureMaster::Impl {
  struct Cut {
    std::size_t group;
    double constant;
    std::vector<double> of;  // a coefficient each candidate
    std::size_t idle = 0;
  };

  const CaptureRows& rows;
  std::vector<std::size_t> fixed;
  std::size_t candidates, groups;
  std::vector<double> base;          // b_v
  std::vector<double> weight;        // w_v / Σ w
  std::vector<double> group_weight;  // Σ w of each group
  std::vector<Cut> cuts;

  Impl(const CaptureRows& r, std::size_t n, std::span<const std::size_t> f)
      : rows(r),
        fixed(f.begin(), f.end()),
        candidates(n),
        groups(std::clamp<std::size_t>(r.voxels().size() / voxels_per_group, 1, most_groups)),
        base(r.voxels().size()),
        weight(r.voxels().size()),
        group_weight(groups) {
    const double all = rows.total_weight() > 0 ? rows.total_weight() : 1;
    for (std::size_t v = 0; v < weight.size(); ++v) {
      weight[v] = rows.weights()[v] / all;
      group_weight[group_of(v)] += weight[v];
    }
    for (const std::size_t k : fixed)
      for (const CapturedVoxel& seen : rows.row(k)) base[seen.voxel] += share(seen);
    for (double& b : base) b = std::min(b, 1.0);
  }

  // Neighbours along the Morton order are seen alike.
  std::size_t group_of(std::size_t voxel) const { return voxel * groups / weight.size(); }
  double share(const CapturedVoxel& seen) const { return std::min(seen.points / rows.goal_density(), 1.0); }

  std::vector<double> fills(std::span<const double> y) const {
    std::vector<double> fill(base);
    for (std::size_t k = 0; k < candidates; ++k) {
      if (y[k] <= 0) continue;
      for (const CapturedVoxel& seen : rows.row(k)) fill[seen.voxel] += y[k] * share(seen);
    }
    return fill;
  }

  double value(std::span<const double> y) const {
    const std::vector<double> fill = fills(y);
    double sum = 0;
    for (std::size_t v = 0; v < fill.size(); ++v) sum += weight[v] * std::min(fill[v], 1.0);
    return sum;
  }

  std::vector<Cut> cuts_at(std::span<const double> y) const {
    const std::vector<double> fill = fills(y);
    std::vector<Cut> made(groups);
    for (std::size_t g = 0; g < groups; ++g) made[g] = {g, 0, std::vector<double>(candidates), 0};
    for (std::size_t v = 0; v < fill.size(); ++v)
      made[group_of(v)].constant += weight[v] * (fill[v] >= 1 ? 1 : base[v]);
    for (std::size_t k = 0; k < candidates; ++k)
      for (const CapturedVoxel& seen : rows.row(k))
        if (fill[seen.voxel] < 1) made[group_of(seen.voxel)].of[k] += weight[seen.voxel] * share(seen);
    return made;
  }

  double at(const Cut& cut, std::span<const double> y) const {
    double sum = cut.constant;
    for (std::size_t k = 0; k < candidates; ++k) sum += cut.of[k] * y[k];
    return sum;
  }

  // What the duals of the cuts prove, in our own arithmetic: with u_c >= 0 on the cuts of each group adding up to at
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

  // The fewest stations of which `proven` allows that much.
  double stations_proven(std::span<const double> dual, double wanted) const {
    double least = 0, most = static_cast<double>(candidates);
    if (proven(dual, most) < wanted) return most;
    // It grows with the number and is linear between whole ones: halving to well below what a ceiling would notice.
    for (int step = 0; step < 50; ++step) {
      const double middle = 0.5 * (least + most);
      (proven(dual, middle) < wanted ? least : most) = middle;
    }
    return least;
  }

  // Further columns and rows under which the taken rows hang together: at one of them a unit for each enters, each
  // keeps one and hands the others on along links to taken rows. Returns the columns that have to be whole.
  std::vector<int> add_flow(ClpSimplex& lp, std::size_t stations, const RowGraph& graph) const;
  void add_exclusions(ClpSimplex& lp, std::size_t stations, const ExcludedRows& excluded) const;

  Relaxed solve(bool fewest, double limit, double tolerance, double seconds, const Progress& progress);

  void drop_idle(ClpSimplex& lp, std::span<const double> dual) {
    std::vector<int> drop;
    std::vector<Cut> kept;
    for (std::size_t c = 0; c < cuts.size(); ++c) {
      cuts[c].idle = dual[c] > 0 ? 0 : cuts[c].idle + 1;
      if (cuts[c].idle > idle_rounds)
        drop.push_back(first_cut + static_cast<int>(c));
      else
        kept.push_back(std::move(cuts[c]));
    }
    cuts = std::move(kept);
    if (!drop.empty()) lp.deleteRows(static_cast<int>(drop.size()), drop.data());
  }

  // Columns: y of each candidate, then θ of each group. Rows: Σ y, Σ θ, then the cuts.
  enum Row { number, capture, first_cut };

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

CaptureMaster::CaptureMaster(const CaptureRows& rows, std::size_t candidates, std::span<const std::size_t> fixed)
    : impl_(std::make_unique<Impl>(rows, candidates, fixed)) {
  cut_at(std::vector<double>(candidates, 0.0));
}
CaptureMaster::CaptureMaster(CaptureMaster&&) noexcept = default;
CaptureMaster::~CaptureMaster() = default;

double CaptureMaster::value(std::span<const double> y) const { return impl_->value(y); }

void CaptureMaster::cut_at(std::span<const double> y) {
  for (Impl::Cut& cut : impl_->cuts_at(y)) impl_->cuts.push_back(std::move(cut));
}

Relaxed CaptureMaster::most(double stations, double tolerance, double seconds, const Progress& progress) {
  return impl_->solve(false, stations, tolerance, seconds, progress);
}

Relaxed CaptureMaster::fewest(double capture, double tolerance, double seconds, const Progress& progress) {
  return impl_->solve(true, capture, tolerance, seconds, progress);
}

// Both questions have the same cuts. Of `most`, `limit` is the number of stations and the master's solution is always
// one of the relaxation, F(y) below its bound; of `fewest`, `limit` is the capture and the master's solution falls
// short of it until enough cuts are there.
Relaxed CaptureMaster::Impl::solve(bool fewest, double limit, double tolerance, double seconds,
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
    lp.setRowLower(capture, limit);
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
    const double of_capture = fewest ? std::abs(lp.dualRowSolution()[capture]) : 1;
    std::vector<double> dual(cuts.size());
    for (std::size_t c = 0; c < dual.size() && of_capture > 0; ++c)
      dual[c] = std::abs(lp.dualRowSolution()[first_cut + static_cast<int>(c)]) / of_capture;
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

    // Between the master's solution, which jumps about, and the best so far, cuts are deeper (Ben-Ameur and Neto:
    // Acceleration of cutting-plane and column generation algorithms, Networks 49, 2007).
    for (std::size_t k = 0; k < candidates; ++k) between[k] = 0.5 * (y[k] + best.y[k]);
    std::vector<Cut> made = cuts_at(y);
    if (best.y != y)
      for (Cut& cut : cuts_at(between)) made.push_back(std::move(cut));
    drop_idle(lp, dual);
    for (Cut& cut : made) {
      if (theta[cut.group] - at(cut, y) <= broken) continue;
      add(lp, cut);
      cuts.push_back(std::move(cut));
    }
  }
}

std::vector<int> CaptureMaster::Impl::add_flow(ClpSimplex& lp, std::size_t stations, const RowGraph& graph) const {
  const auto all = static_cast<double>(stations + fixed.size());
  const auto is_fixed = [&](std::size_t k) { return std::ranges::find(fixed, k) != fixed.end(); };
  const auto add_column = [&](double most) {
    lp.addColumn(0, nullptr, nullptr, 0, most, 0);
    return lp.numberColumns() - 1;
  };
  std::vector<int> whole;
  // What each row takes in, and what it takes in less what it hands on.
  struct Terms {
    std::vector<int> index;
    std::vector<double> value;
    void add(int column, double factor) { index.push_back(column), value.push_back(factor); }
  };
  std::vector<Terms> in(candidates), net(candidates);
  Terms sources;
  for (std::size_t k = 0; k < candidates; ++k) {
    if (!fixed.empty() && k != fixed.front()) continue;
    const int flow = add_column(all), here = add_column(1);
    whole.push_back(here);
    sources.add(here, 1);
    const int index[] = {flow, here};
    const double value[] = {1, -all};
    lp.addRow(2, index, value, -COIN_DBL_MAX, 0);
    in[k].add(flow, 1), net[k].add(flow, 1);
  }
  lp.addRow(static_cast<int>(sources.index.size()), sources.index.data(), sources.value.data(), -COIN_DBL_MAX, 1);
  for (std::size_t a = 0; a < candidates; ++a)
    for (std::size_t b = 0; b < candidates; ++b) {
      if (!graph.linked(a, b)) continue;
      const int flow = add_column(all - 1);
      in[b].add(flow, 1), net[b].add(flow, 1), net[a].add(flow, -1);
    }
  for (std::size_t k = 0; k < candidates; ++k) {
    const int y = static_cast<int>(k);
    const double there = is_fixed(k) ? 1 : 0;
    if (there == 0) in[k].add(y, -all), net[k].add(y, -1);
    lp.addRow(static_cast<int>(in[k].index.size()), in[k].index.data(), in[k].value.data(), -COIN_DBL_MAX, there * all);
    lp.addRow(static_cast<int>(net[k].index.size()), net[k].index.data(), net[k].value.data(), there, there);
    // A fraction of a flow reaches far; so each taken row needs a taken neighbour, too.
    Terms neighbours;
    bool fixed_neighbour = there > 0;
    for (std::size_t l = 0; l < candidates; ++l) {
      if (!graph.linked(k, l)) continue;
      fixed_neighbour = fixed_neighbour || is_fixed(l);
      neighbours.add(static_cast<int>(l), -1);
    }
    if (fixed_neighbour || all < 2) continue;
    neighbours.add(y, 1);
    lp.addRow(static_cast<int>(neighbours.index.size()), neighbours.index.data(), neighbours.value.data(),
              -COIN_DBL_MAX, 0);
  }
  return whole;
}

// At most one of two that exclude each other: none of those beside a row that is taken, one line of the program for
// all.
void CaptureMaster::Impl::add_exclusions(ClpSimplex& lp, std::size_t stations, const ExcludedRows& excluded) const {
  for (const std::size_t k : fixed)
    for (const std::size_t other : excluded.beside(k))
      if (other < candidates) lp.setColumnUpper(static_cast<int>(other), 0);
  for (std::size_t k = 0; k < candidates; ++k) {
    std::vector<int> index;
    for (const std::size_t other : excluded.beside(k))
      if (other < candidates) index.push_back(static_cast<int>(other));
    if (index.empty()) continue;
    const auto most = static_cast<double>(std::min(index.size(), stations));
    std::vector<double> value(index.size(), 1);
    index.push_back(static_cast<int>(k)), value.push_back(most);
    lp.addRow(static_cast<int>(index.size()), index.data(), value.data(), -COIN_DBL_MAX, most);
  }
}

CaptureMaster::Choice CaptureMaster::choose(std::size_t stations, double seconds, double known, const RowGraph* graph,
                                            const ExcludedRows& excluded) const {
  const Impl& m = *impl_;
  ClpSimplex lp;
  m.load(lp);
  lp.setOptimizationDirection(-1);
  for (std::size_t g = 0; g < m.groups; ++g) lp.setObjectiveCoefficient(static_cast<int>(m.candidates + g), 1);
  lp.setRowUpper(Impl::number, static_cast<double>(stations));
  lp.setRowLower(Impl::capture, known - known_slack);
  std::vector<int> whole;
  for (const std::size_t k : m.fixed)
    if (k < m.candidates) lp.setColumnUpper(static_cast<int>(k), 0);  // it cannot be taken again
  if (graph) whole = m.add_flow(lp, stations, *graph);
  m.add_exclusions(lp, stations, excluded);
  OsiClpSolverInterface solver(&lp);
  solver.messageHandler()->setLogLevel(0);
  for (const int column : whole) solver.setInteger(column);
  for (std::size_t k = 0; k < m.candidates; ++k) solver.setInteger(static_cast<int>(k));
  CbcModel model(solver);
  model.setLogLevel(0);
  model.messageHandler()->setLogLevel(0);
  model.setMaximumSeconds(seconds);
  // What costs to be used at all, as flows between stations do.
  CglFlowCover flow_cover;
  CglMixedIntegerRounding2 rounding;
  CglGomory gomory;
  if (graph) {
    model.addCutGenerator(&flow_cover, -1, "flow cover");
    model.addCutGenerator(&rounding, -1, "rounding");
    model.addCutGenerator(&gomory, -1, "gomory");
  }
  model.branchAndBound();
  Choice choice;
  // Maximised, so Cbc's values are those of the negated objective.
  choice.bound = std::min(1.0, std::abs(model.getBestPossibleObjValue()) + bound_slack);
  if (const double* best = model.bestSolution()) {
    for (std::size_t k = 0; k < m.candidates; ++k)
      if (best[k] > 0.5) choice.rows.push_back(k);
  }
  return choice;
}

}  // namespace vantage
