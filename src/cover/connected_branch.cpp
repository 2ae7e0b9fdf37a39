// SPDX-License-Identifier: Apache-2.0
#include "cover/connected_branch.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <coin/ClpSimplex.hpp>
#include <cstdint>
#include <deque>
#include <limits>
#include <numeric>
#include <optional>
#include <queue>
#include <span>
#include <utility>

#include "core/seconds_since.hpp"
#include "cover/connected_growth.hpp"
#include "cover/network.hpp"

namespace vantage {
namespace {

// Violations below are left to branching.
constexpr double kSeparated = 1e-3, kCovered = 1e-6;
// Error of a bound, due to the tolerances of the linear program.
constexpr double kProgramSlack = 1e-6;
// A value this near to 0 or 1 is whole.
constexpr double kIntegral = 1e-6;
// A problem is branched once its bound falls by less than this share in `kTailRounds` rounds.
constexpr double kTail = 2e-4;
constexpr std::size_t kTailRounds = 4;
// Nested cuts for each candidate: before each, the capacities of the last cut's set are filled up (Koch, Martin:
// Solving Steiner tree problems in graphs to optimality, 1998).
constexpr int kNested = 3;
// Rows are dropped after so many slack rounds.
constexpr std::size_t kSlackRounds = 12;
constexpr std::size_t kMostPockets = 200;
// Capacity below which nothing flows.
constexpr double kNone = 1e-9;

using Set = std::vector<std::uint32_t>;

// Minimum cuts between the root and others, through candidates of given capacity.
class NodeCuts {
 public:
  explicit NodeCuts(const std::vector<Set>& links) : links_(links) {}

  // Returns a set of candidates of least capacity that separates `to` from `root`, and its capacity; among equals the
  // set nearest to the root. They are the doors of a pocket: all that `to` reaches without them. REQUIRES: not linked.
  std::pair<BendersMaster::Pocket, double> between(std::size_t root, std::size_t to, std::span<const double> capacity);

 private:
  bool augment(std::size_t root, std::size_t to, std::span<const double> capacity);

  const std::vector<Set>& links_;
  std::vector<Set> near_;  // links of the root and of candidates with capacity, to such and the end
  // Flow through each candidate, and along links between two with capacity.
  std::vector<double> through_;
  std::vector<std::vector<std::pair<std::uint32_t, double>>> along_;
  std::vector<char> entered_, left_;  // reached by the last search: before and behind a candidate's capacity
};

// One shortest path of free capacity (Edmonds, Karp, 1972). Each candidate is two nodes, its capacity between them.
bool NodeCuts::augment(std::size_t root, std::size_t to, std::span<const double> capacity) {
  const std::size_t n = links_.size();
  std::ranges::fill(entered_, 0), std::ranges::fill(left_, 0);
  struct From {
    std::uint32_t node;  // 2 k: before candidate k; 2 k + 1: behind it
    double free;
  };
  std::vector<From> from(2 * n);
  std::vector<std::uint32_t> open{static_cast<std::uint32_t>(2 * root + 1)};
  left_[root] = 1;
  const auto flow_of = [&](std::uint32_t a, std::uint32_t b) -> double {
    for (const auto& [other, flow] : along_[a])
      if (other == b) return flow;
    return 0;
  };
  for (std::size_t at = 0; at < open.size(); ++at) {
    const std::uint32_t node = open[at], k = node / 2;
    const auto reach = [&](std::uint32_t next, double free) {
      std::vector<char>& seen = next % 2 == 0 ? entered_ : left_;
      if (seen[next / 2] || free <= kNone) return;
      seen[next / 2] = 1, from[next] = {node, free}, open.push_back(next);
    };
    if (node % 2 == 1) {
      for (const std::uint32_t other : near_[k]) {
        if (other == to) {
          // Found: the free capacity of the path, then its flow.
          double free = std::numeric_limits<double>::infinity();
          for (std::uint32_t back = node; back != 2 * root + 1; back = from[back].node)
            free = std::min(free, from[back].free);
          const auto add = [&](std::uint32_t a, std::uint32_t b, double flow) {
            for (auto& [known, value] : along_[a])
              if (known == b) {
                value += flow;
                return;
              }
            along_[a].emplace_back(b, flow);
          };
          add(k, other, free);
          for (std::uint32_t back = node; back != 2 * root + 1; back = from[back].node) {
            const std::uint32_t before = from[back].node;
            if (back / 2 == before / 2)
              through_[back / 2] += back % 2 == 1 ? free : -free;
            else if (back % 2 == 0)
              add(before / 2, back / 2, free);
            else
              add(back / 2, before / 2, -free);
          }
          return true;
        }
        reach(2 * other, std::numeric_limits<double>::infinity());
      }
      if (k != root) reach(2 * k, through_[k]);  // back through it
    } else {
      reach(2 * k + 1, capacity[k] - through_[k]);
      for (const std::uint32_t other : near_[k])
        if (other != to) reach(2 * other + 1, flow_of(other, k));
    }
  }
  return false;
}

std::pair<BendersMaster::Pocket, double> NodeCuts::between(std::size_t root, std::size_t to,
                                                           std::span<const double> capacity) {
  const std::size_t n = links_.size();
  near_.assign(n, {});
  for (std::size_t k = 0; k < n; ++k)
    if (k == root || capacity[k] > kNone)
      for (const std::uint32_t other : links_[k])
        if (other != root && (other == to || capacity[other] > kNone)) near_[k].push_back(other);
  through_.assign(n, 0), along_.assign(n, {});
  entered_.assign(n, 0), left_.assign(n, 0);
  while (augment(root, to, capacity)) {
  }
  // The separator consists of the candidates that border on reached ones and are not passed.
  std::vector<char> in_set(n, 0);
  for (std::size_t k = 0; k < n; ++k)
    if (left_[k])
      for (const std::uint32_t other : links_[k])
        if (!left_[other]) in_set[other] = 1;
  // Leaves out those that `to` does not reach around the others.
  std::vector<char> seen(n, 0);
  std::vector<std::uint32_t> open{static_cast<std::uint32_t>(to)};
  seen[to] = 1;
  BendersMaster::Pocket pocket;
  double sum = 0;
  for (std::size_t at = 0; at < open.size(); ++at)
    for (const std::uint32_t other : links_[open[at]]) {
      if (seen[other]) continue;
      seen[other] = 1;
      if (in_set[other])
        pocket.doors.push_back(other), sum += capacity[other];
      else
        open.push_back(other);
    }
  pocket.members = open;
  pocket.members.insert(pocket.members.end(), pocket.doors.begin(), pocket.doors.end());
  return {std::move(pocket), sum};
}

class Branching {
 public:
  Branching(const CoverProblem& problem, const BendersMaster& master, double known, double bound, double seconds,
            const std::stop_token& stop)
      : problem_(problem),
        master_(master),
        candidates_(problem.matrix.candidates()),
        links_(candidates_),
        cuts_(links_),
        exists_(candidates_, 0),
        begun_(std::chrono::steady_clock::now()),
        seconds_(seconds),
        stop_(stop),
        best_(known),
        first_bound_(bound) {
    for (const std::size_t k : problem.existing) exists_[k] = 1;
    for (std::size_t k = 0; k < candidates_; ++k)
      for (const StationGraph::Overlap& one : problem.graph->overlaps(k))
        if (static_cast<double>(one.share) >= problem.link) links_[k].push_back(one.candidate);
    load();
  }

  ConnectedBranch run();

 private:
  // A part of the problem: its root, and candidates that are taken or left.
  struct Part {
    double bound;
    std::size_t root;
    std::vector<std::pair<std::uint32_t, bool>> fixed;
    bool operator<(const Part& other) const { return bound < other.bound; }
  };
  struct Row {
    std::vector<char> without;  // roots for which it does not hold; empty: none
    std::size_t idle = 0;
  };

  void load();
  void add_coverage(const BendersMaster::Cut& cut, const std::vector<char>& without = {});
  void add_separator(std::size_t root, std::size_t to, const Set& set);
  void drop_idle();
  void bound_columns(const Part& part);
  // Lowers the bound of a part by cuts. Returns the candidate to branch on; empty if the part is finished.
  std::optional<std::size_t> solve(Part& part);
  bool separate(std::size_t root, const std::vector<double>& y);
  void keep(BendersMaster::Pocket pocket);
  void offer(std::vector<std::size_t> chosen);
  bool over() const { return stop_.stop_requested() || seconds_since(begun_) > seconds_; }

  const CoverProblem& problem_;
  const BendersMaster& master_;
  std::size_t candidates_;
  std::vector<Set> links_;
  NodeCuts cuts_;
  std::vector<char> exists_;
  std::chrono::steady_clock::time_point begun_;
  double seconds_;
  std::stop_token stop_;
  ClpSimplex lp_;
  std::vector<Row> rows_;  // of the linear program, behind the first
  std::deque<BendersMaster::Pocket> pockets_;
  std::vector<std::size_t> chosen_;
  double best_, first_bound_;
};

// Columns: y of each candidate, then θ of each group. The first row is Σ y.
void Branching::load() {
  lp_.setLogLevel(0);
  lp_.resize(0, static_cast<int>(candidates_ + master_.groups()));
  lp_.setOptimizationDirection(-1);
  for (std::size_t g = 0; g < master_.groups(); ++g) {
    lp_.setColumnBounds(static_cast<int>(candidates_ + g), 0, master_.group_weight(g));
    lp_.setObjectiveCoefficient(static_cast<int>(candidates_ + g), 1);
  }
  std::vector<int> index(candidates_);
  std::iota(index.begin(), index.end(), 0);
  const std::vector<double> ones(candidates_, 1);
  lp_.addRow(static_cast<int>(candidates_), index.data(), ones.data(), -COIN_DBL_MAX,
             static_cast<double>(problem_.most));
  for (const BendersMaster::Cut& cut : master_.cuts()) add_coverage(cut);
}

void Branching::add_coverage(const BendersMaster::Cut& cut, const std::vector<char>& without) {
  std::vector<int> index{static_cast<int>(candidates_ + cut.group)};
  std::vector<double> value{1};
  for (std::size_t k = 0; k < candidates_; ++k)
    if (cut.of[k] != 0) index.push_back(static_cast<int>(k)), value.push_back(-cut.of[k]);
  lp_.addRow(static_cast<int>(index.size()), index.data(), value.data(), -COIN_DBL_MAX, cut.constant);
  rows_.push_back({without});
}

void Branching::add_separator(std::size_t root, std::size_t to, const Set& set) {
  std::vector<int> index;
  std::vector<double> value;
  double most = 1;
  for (const std::size_t end : {root, to})
    if (exists_[end])
      most -= 1;
    else
      index.push_back(static_cast<int>(end)), value.push_back(1);
  for (const std::uint32_t k : set) {
    if (exists_[k]) return;  // never violated
    index.push_back(static_cast<int>(k)), value.push_back(-1);
  }
  lp_.addRow(static_cast<int>(index.size()), index.data(), value.data(), -COIN_DBL_MAX, most);
  rows_.push_back({});
}

void Branching::drop_idle() {
  std::vector<int> drop;
  std::vector<Row> kept;
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    rows_[r].idle = std::abs(lp_.dualRowSolution()[r + 1]) > 1e-9 ? 0 : rows_[r].idle + 1;
    if (rows_[r].idle > kSlackRounds)
      drop.push_back(static_cast<int>(r + 1));
    else
      kept.push_back(rows_[r]);
  }
  if (drop.size() < rows_.size() / 4) return;
  rows_ = std::move(kept);
  lp_.deleteRows(static_cast<int>(drop.size()), drop.data());
}

// Each candidate is at most N / 2 links from the root if there are no existing candidates.
void Branching::bound_columns(const Part& part) {
  std::vector<int> drop;
  std::vector<Row> kept;
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    if (!rows_[r].without.empty() && rows_[r].without[part.root])
      drop.push_back(static_cast<int>(r + 1));
    else
      kept.push_back(std::move(rows_[r]));
  }
  rows_ = std::move(kept);
  if (!drop.empty()) lp_.deleteRows(static_cast<int>(drop.size()), drop.data());
  std::vector<std::size_t> hops(candidates_, candidates_);
  std::vector<std::size_t> open{part.root};
  hops[part.root] = 0;
  for (std::size_t at = 0; at < open.size(); ++at)
    for (const std::uint32_t other : links_[open[at]])
      if (hops[other] == candidates_) hops[other] = hops[open[at]] + 1, open.push_back(other);
  const std::size_t reach = problem_.existing.empty() ? problem_.most / 2 : candidates_ - 1;
  for (std::size_t k = 0; k < candidates_; ++k) {
    const bool out = exists_[k] || hops[k] > reach || problem_.graph->excluded(part.root, k);
    lp_.setColumnBounds(static_cast<int>(k), 0, out ? 0 : 1);
  }
  if (!exists_[part.root]) lp_.setColumnBounds(static_cast<int>(part.root), 1, 1);
  for (const auto& [k, taken] : part.fixed) {
    if (!taken) lp_.setColumnBounds(static_cast<int>(k), 0, 0);
    if (!taken || lp_.columnUpper()[k] == 0) continue;
    lp_.setColumnBounds(static_cast<int>(k), 1, 1);
    for (const std::uint32_t other : problem_.graph->excluded(k)) lp_.setColumnBounds(static_cast<int>(other), 0, 0);
  }
}

bool Branching::separate(std::size_t root, const std::vector<double>& y) {
  std::vector<double> there(y.begin(), y.begin() + static_cast<std::ptrdiff_t>(candidates_));
  for (std::size_t k = 0; k < candidates_; ++k)
    if (exists_[k]) there[k] = 1;
  bool any = false;
  for (std::size_t k = 0; k < candidates_; ++k) {
    if (k == root || there[k] < 10 * kSeparated) continue;
    std::vector<double> capacity = there;
    if (std::ranges::binary_search(links_[root], static_cast<std::uint32_t>(k))) continue;
    for (int nested = 0; nested < kNested; ++nested) {
      auto [pocket, sum] = cuts_.between(root, k, capacity);
      const bool violated = sum < there[k] - kSeparated;
      if (violated) add_separator(root, k, pocket.doors), any = true;
      for (const std::uint32_t one : pocket.doors) capacity[one] = 1;
      if (sum < 1 - kSeparated) keep(std::move(pocket));
      if (!violated) break;
    }
  }
  for (std::size_t k = 0; k < candidates_; ++k)
    for (const std::uint32_t other : problem_.graph->excluded(k)) {
      if (other <= k || y[k] + y[other] <= 1 + kSeparated) continue;
      const int index[] = {static_cast<int>(k), static_cast<int>(other)};
      const double ones[] = {1, 1};
      lp_.addRow(2, index, ones, -COIN_DBL_MAX, 1);
      rows_.push_back({});
      any = true;
    }
  return any;
}

void Branching::keep(BendersMaster::Pocket pocket) {
  if (std::ranges::any_of(pocket.doors, [&](std::uint32_t k) { return exists_[k] != 0; })) return;  // always open
  std::ranges::sort(pocket.members), std::ranges::sort(pocket.doors);
  if (std::ranges::any_of(pockets_, [&](const auto& known) { return known.members == pocket.members; })) return;
  pockets_.push_back(std::move(pocket));
  if (pockets_.size() > kMostPockets) pockets_.pop_front();
}

void Branching::offer(std::vector<std::size_t> further) {
  std::vector<std::size_t> chosen = problem_.existing;
  chosen.insert(chosen.end(), further.begin(), further.end());
  if (chosen.size() > problem_.existing.size() + problem_.most) return;
  if (components_of(problem_, chosen, problem_.link).count > 1) return;
  for (const std::size_t a : further)
    for (const std::size_t b : chosen)
      if (a != b && problem_.graph->excluded(a, b)) return;
  if (const double coverage = problem_.matrix.coverage(chosen); coverage > best_)
    best_ = coverage, chosen_ = std::move(further);
}

std::optional<std::size_t> Branching::solve(Part& part) {
  bound_columns(part);
  double before = 2;  // value of the last round
  std::size_t slow = 0;
  while (true) {
    lp_.dual();
    if (lp_.status() == 1) {
      part.bound = 0;
      return std::nullopt;
    }
    if (lp_.status() != 0) break;
    const std::vector<double> y(lp_.primalColumnSolution(), lp_.primalColumnSolution() + candidates_);
    const std::vector<double> theta(lp_.primalColumnSolution() + candidates_,
                                    lp_.primalColumnSolution() + candidates_ + master_.groups());
    const double value = std::accumulate(theta.begin(), theta.end(), kProgramSlack);
    part.bound = std::min(part.bound, value);
    if (part.bound <= best_ + 2 * kProgramSlack) return std::nullopt;
    if (over()) break;
    slow = before - value < kTail * value ? slow + 1 : 0;
    before = value;
    drop_idle();
    bool any = separate(part.root, y);
    std::vector<BendersMaster::Pocket> pockets;
    std::vector<char> without(candidates_, 0);
    for (const BendersMaster::Pocket& pocket : pockets_) {
      if (std::ranges::find(pocket.members, static_cast<std::uint32_t>(part.root)) != pocket.members.end()) continue;
      pockets.push_back(pocket);
      for (const std::uint32_t k : pocket.members) without[k] = 1;
    }
    for (const BendersMaster::Cut& cut : master_.supergradients(y, pockets)) {
      double at = cut.constant;
      for (std::size_t k = 0; k < candidates_; ++k) at += cut.of[k] * y[k];
      if (theta[cut.group] - at <= kCovered / static_cast<double>(master_.groups())) continue;
      add_coverage(cut, without), any = true;
    }
    std::optional<std::size_t> split;
    double least = 0.5 - kIntegral;
    for (std::size_t k = 0; k < candidates_; ++k)
      if (const double off = std::abs(y[k] - 0.5); off < least) least = off, split = k;
    if (!split) {
      std::vector<std::size_t> chosen;
      for (std::size_t k = 0; k < candidates_; ++k)
        if (y[k] > 0.5) chosen.push_back(k);
      offer(std::move(chosen));
      if (!any) return std::nullopt;  // the best of this part
      continue;
    }
    if (!any || slow >= kTailRounds) return split;
  }
  return candidates_;  // not known: the part stays open
}

ConnectedBranch Branching::run() {
  std::priority_queue<Part> open;
  for (std::size_t k = 0; k < candidates_; ++k)
    if (problem_.existing.empty() || k == problem_.existing.front()) open.push({first_bound_, k, {}});
  CoverProblem grown = problem_;
  const ColumnIndex columns(problem_.matrix);
  grown.fewest = grown.most, grown.coverage = 1;
  double left = best_;  // largest bound of parts that were given up
  while (!open.empty() && open.top().bound > best_ + 2 * kProgramSlack && !over()) {
    Part part = open.top();
    open.pop();
    if (part.fixed.empty() && problem_.existing.empty()) {
      std::vector<std::size_t> around = grow_connected(grown, columns, {part.root});
      offer(std::move(around));
    }
    const std::optional<std::size_t> split = solve(part);
    if (!split) continue;
    if (*split == candidates_) {
      left = std::max(left, part.bound);
      continue;
    }
    for (const bool taken : {true, false}) {
      Part half = part;
      half.fixed.emplace_back(static_cast<std::uint32_t>(*split), taken);
      open.push(std::move(half));
    }
  }
  ConnectedBranch result{.chosen = chosen_, .bound = std::max(best_, left)};
  if (!open.empty()) result.bound = std::max(result.bound, open.top().bound);
  result.bound = std::min(result.bound, first_bound_);
  return result;
}

}  // namespace

ConnectedBranch branch_connected(const CoverProblem& problem, const BendersMaster& master, double known, double bound,
                                 double seconds, const std::stop_token& stop) {
  return Branching(problem, master, known, bound, seconds, stop).run();
}

}  // namespace vantage
