// SPDX-License-Identifier: Apache-2.0
// Four objectives and more: While, Bradstreet, Barone: A Fast Way of Calculating Exact Hypervolumes (WFG), 2012, in
// slices along the last objective until three are left.
#include "optimise/hypervolume.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>

#include "core/first_numbers.hpp"
#include "optimise/infinity.hpp"
#include "optimise/sweep.hpp"

namespace vantage::optimise {
namespace {

// Everything below works on a plain array of points, all inside the reference.
struct Points {
  std::vector<double> values;
  std::size_t objectives;

  std::size_t size() const { return values.size() / objectives; }
  const double* operator[](std::size_t i) const { return values.data() + i * objectives; }
};

bool weakly_dominates(const double* a, const double* b, std::size_t m) {
  for (std::size_t j = 0; j < m; ++j)
    if (a[j] > b[j]) return false;
  return true;
}

Points without_dominated(const Points& points) {
  const std::size_t m = points.objectives;
  Points kept{{}, m};
  for (std::size_t i = 0; i < points.size(); ++i) {
    bool dominated = false;
    for (std::size_t j = 0; j < points.size() && !dominated; ++j) {
      // The first of equal points stays.
      dominated =
          j != i && weakly_dominates(points[j], points[i], m) && (j < i || !weakly_dominates(points[i], points[j], m));
    }
    if (!dominated) kept.values.insert(kept.values.end(), points[i], points[i] + m);
  }
  return kept;
}

template <std::size_t M>
std::vector<std::array<double, M>> as_arrays(const Points& points) {
  std::vector<std::array<double, M>> result(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) std::copy_n(points[i], M, result[i].begin());
  return result;
}

double box_volume(const double* point, std::span<const double> reference) {
  double product = 1;
  for (std::size_t j = 0; j < reference.size(); ++j) product *= reference[j] - point[j];
  return product;
}

double volume_inside(const Points& points, std::span<const double> reference) {
  const std::size_t m = points.objectives, k = points.size();
  if (k == 0) return 0;
  if (k == 1) return box_volume(points[0], reference);
  if (m == 1) {
    return reference[0] - *std::min_element(points.values.begin(), points.values.end());
  }
  if (m == 2) return area(as_arrays<2>(points), {reference[0], reference[1]});
  if (m == 3) return volume3(as_arrays<3>(points), {reference[0], reference[1], reference[2]});

  // Worst in the last objective first: each point then adds a slab of constant cross-section above the later ones.
  std::vector<std::size_t> order = first_numbers(k);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return points[a][m - 1] != points[b][m - 1] ? points[a][m - 1] > points[b][m - 1] : a < b;
  });
  const auto lower_reference = reference.first(m - 1);
  double sum = 0;
  for (std::size_t i = 0; i < k; ++i) {
    const double* p = points[order[i]];
    Points limited{{}, m - 1};
    limited.values.reserve((k - i) * (m - 1));
    for (std::size_t j = i + 1; j < k; ++j)
      for (std::size_t d = 0; d + 1 < m; ++d) limited.values.push_back(std::max(p[d], points[order[j]][d]));
    if (m - 1 > 3) limited = without_dominated(limited);
    sum += (reference[m - 1] - p[m - 1]) * (box_volume(p, lower_reference) - volume_inside(limited, lower_reference));
  }
  return sum;
}

std::vector<double> contributions_inside(const Points& points, std::span<const double> reference) {
  const std::size_t m = points.objectives, k = points.size();
  if (m == 2) return contributions2(as_arrays<2>(points), {reference[0], reference[1]});
  if (m == 3) return contributions3(as_arrays<3>(points), {reference[0], reference[1], reference[2]});
  std::vector<double> result(k);
  for (std::size_t i = 0; i < k; ++i) {
    Points limited{{}, m};
    limited.values.reserve(k * m);
    for (std::size_t j = 0; j < k; ++j) {
      if (j == i) continue;
      for (std::size_t d = 0; d < m; ++d) limited.values.push_back(std::max(points[i][d], points[j][d]));
    }
    if (m > 3) limited = without_dominated(limited);
    result[i] = std::max(0.0, box_volume(points[i], reference) - volume_inside(limited, reference));
  }
  return result;
}

// Indices of the points inside, and their values.
struct Inside {
  std::vector<std::size_t> index;
  Points points;
};
Inside select_inside(const PointSet& set, std::span<const double> reference) {
  Inside result{{}, {{}, set.objectives}};
  result.points.values.reserve(set.values.size());
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (!inside(set[i], reference)) continue;
    result.index.push_back(i);
    result.points.values.insert(result.points.values.end(), set[i].begin(), set[i].end());
  }
  return result;
}

// When p leaves a set, another point gains what only the two of them dominated. That volume lies in a box above p which
// ends, along each objective, at the second point that dominates p's projection; few points reach into it.
class Removal {
 public:
  Removal(const Points& points, std::span<const double> reference)
      : points_(points), reference_(reference.begin(), reference.end()), alive_(points.size()) {
    std::iota(alive_.begin(), alive_.end(), std::size_t{0});
    contributions_ = contributions_inside(points, reference);
  }

  // Removes the least contributor and returns it.
  std::size_t next() {
    std::size_t least = 0;
    for (std::size_t a = 1; a < alive_.size(); ++a)
      if (contributions_[alive_[a]] <= contributions_[alive_[least]]) least = a;
    const std::size_t p = alive_[least];
    alive_.erase(alive_.begin() + static_cast<std::ptrdiff_t>(least));
    hand_over(points_[p]);
    return p;
  }

 private:
  void hand_over(const double* p) {
    const std::size_t m = points_.objectives;
    first_ = second_ = reference_;
    for (const std::size_t a : alive_) {
      const double* q = points_[a];
      std::size_t above = 0, axis = 0;
      for (std::size_t d = 0; d < m; ++d) {
        if (q[d] > p[d]) {
          ++above;
          axis = d;
        }
      }
      if (above != 1) continue;
      if (q[axis] < first_[axis]) {
        second_[axis] = first_[axis];
        first_[axis] = q[axis];
      } else if (q[axis] < second_[axis]) {
        second_[axis] = q[axis];
      }
    }
    local_.values.clear();
    local_.objectives = m;
    near_.clear();
    for (const std::size_t a : alive_) {
      const double* q = points_[a];
      bool reaches = true;
      for (std::size_t d = 0; d < m && reaches; ++d) reaches = q[d] < second_[d];
      if (!reaches) continue;
      near_.push_back(a);
      for (std::size_t d = 0; d < m; ++d) local_.values.push_back(std::max(p[d], q[d]));
    }
    if (near_.empty()) return;
    const auto gains = contributions_inside(local_, second_);
    for (std::size_t i = 0; i < near_.size(); ++i) contributions_[near_[i]] += gains[i];
  }

  const Points& points_;
  std::vector<double> reference_, contributions_, first_, second_;
  std::vector<std::size_t> alive_, near_;
  Points local_;
};

// Two objectives: neighbours in a list, the least contributor in a heap whose outdated entries are skipped. Needs
// non-dominated points.
std::vector<std::size_t> remove_from_staircase(const Points& points, std::span<const double> reference,
                                               std::size_t count) {
  const std::size_t k = points.size();
  std::vector<std::size_t> order = first_numbers(k);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return points[a][0] < points[b][0]; });
  std::vector<std::size_t> previous(k), next(k);
  for (std::size_t i = 0; i < k; ++i) {
    previous[order[i]] = i == 0 ? k : order[i - 1];
    next[order[i]] = i + 1 == k ? k : order[i + 1];
  }
  std::vector<double> value(k);
  std::vector<char> removed(k, 0);
  std::priority_queue<std::pair<double, std::size_t>>
      heap;  // negated contributions: the least on top, the later of equals
  const auto measure = [&](std::size_t i) {
    const double right = next[i] == k ? reference[0] : points[next[i]][0];
    const double top = previous[i] == k ? reference[1] : points[previous[i]][1];
    value[i] = (right - points[i][0]) * (top - points[i][1]);
    heap.emplace(-value[i], i);
  };
  for (std::size_t i = 0; i < k; ++i) measure(i);
  std::vector<std::size_t> result;
  result.reserve(count);
  while (result.size() < count) {
    const auto [negated, i] = heap.top();
    heap.pop();
    if (removed[i] || -negated != value[i]) continue;
    removed[i] = 1;
    result.push_back(i);
    if (previous[i] != k) next[previous[i]] = next[i];
    if (next[i] != k) previous[next[i]] = previous[i];
    if (previous[i] != k) measure(previous[i]);
    if (next[i] != k) measure(next[i]);
  }
  return result;
}

// Finds the front of each point by binary search: if a front does not dominate a point, no later front does. Points
// come in lexicographic order, so no later point dominates an earlier one. `Front` answers covers() and accepts
// insert().
template <typename Front>
std::vector<std::size_t> ranks_by_fronts(const PointSet& points) {
  const std::size_t k = points.size();
  std::vector<std::size_t> order(k), result(k);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto less = [&](std::size_t a, std::size_t b) {
    const auto p = points[a], q = points[b];
    return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
  };
  std::sort(order.begin(), order.end(), less);
  std::vector<Front> fronts;
  for (std::size_t i = 0; i < k; ++i) {
    const auto p = points[order[i]];
    if (i > 0 && !less(order[i - 1], order[i])) {  // equal to the previous one
      result[order[i]] = result[order[i - 1]];
      continue;
    }
    const auto front = std::partition_point(fronts.begin(), fronts.end(), [&](const Front& f) { return f.covers(p); });
    result[order[i]] = static_cast<std::size_t>(front - fronts.begin());
    (front == fronts.end() ? fronts.emplace_back() : *front).insert(p);
  }
  return result;
}

// One or two objectives: the lowest last value.
struct LowestFront {
  double lowest = kInfinity;
  bool covers(std::span<const double> p) const { return p.size() == 1 || lowest <= p[1]; }
  void insert(std::span<const double> p) {
    if (p.size() > 1) lowest = p[1];
  }
};

// Three objectives: the staircase of the last two.
struct StaircaseFront {
  std::vector<std::array<double, 2>> stairs;  // by ascending first and descending second value
  bool covers(std::span<const double> p) const {
    const auto after = std::partition_point(stairs.begin(), stairs.end(), [&](const auto& s) { return s[0] <= p[1]; });
    return after != stairs.begin() && std::prev(after)->at(1) <= p[2];
  }
  void insert(std::span<const double> p) {
    const auto begin = std::partition_point(stairs.begin(), stairs.end(), [&](const auto& s) { return s[0] < p[1]; });
    const auto end = std::partition_point(begin, stairs.end(), [&](const auto& s) { return s[1] >= p[2]; });
    if (begin == end) {
      stairs.insert(begin, {p[1], p[2]});
    } else {
      *begin = {p[1], p[2]};
      stairs.erase(begin + 1, end);
    }
  }
};

struct ListFront {
  std::vector<std::span<const double>> members;
  bool covers(std::span<const double> p) const {
    return std::any_of(members.rbegin(), members.rend(),
                       [&](std::span<const double> q) { return weakly_dominates(q.data(), p.data(), p.size()); });
  }
  void insert(std::span<const double> p) { members.push_back(p); }
};

// Marks points that are dominated, or equal to an earlier one. They contribute no volume.
std::vector<char> is_redundant(const PointSet& points) {
  const auto rank = ranks(points);
  std::vector<char> result(points.size());
  std::vector<std::size_t> best;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (rank[i] == 0) best.push_back(i);
    result[i] = rank[i] != 0;
  }
  std::sort(best.begin(), best.end(), [&](std::size_t a, std::size_t b) {
    const auto p = points[a], q = points[b];
    const auto order = std::lexicographical_compare_three_way(p.begin(), p.end(), q.begin(), q.end());
    return order != 0 ? order < 0 : a < b;
  });
  for (std::size_t i = 1; i < best.size(); ++i)
    result[best[i]] = std::ranges::equal(points[best[i]], points[best[i - 1]]);
  return result;
}

}  // namespace

bool dominates(std::span<const double> a, std::span<const double> b) {
  bool better = false;
  for (std::size_t j = 0; j < a.size(); ++j) {
    if (a[j] > b[j]) return false;
    better |= a[j] < b[j];
  }
  return better;
}

bool inside(std::span<const double> point, std::span<const double> reference) {
  for (std::size_t j = 0; j < point.size(); ++j)
    if (!(point[j] < reference[j])) return false;
  return true;
}

double volume(const PointSet& points, std::span<const double> reference) {
  Points selected = select_inside(points, reference).points;
  if (points.objectives > 3) selected = without_dominated(selected);
  return volume_inside(selected, reference);
}

std::vector<double> contributions(const PointSet& points, std::span<const double> reference) {
  std::vector<double> result(points.size(), 0.0);
  const Inside selected = select_inside(points, reference);
  if (selected.index.empty()) return result;
  if (points.objectives == 1) {  // only a single best point contributes, up to the second best
    const auto& v = selected.points.values;
    const auto best = static_cast<std::size_t>(std::min_element(v.begin(), v.end()) - v.begin());
    double second = reference[0];
    for (std::size_t i = 0; i < v.size(); ++i)
      if (i != best) second = std::min(second, v[i]);
    result[selected.index[best]] = second - v[best];
    return result;
  }
  const auto values = contributions_inside(selected.points, reference);
  for (std::size_t i = 0; i < values.size(); ++i) result[selected.index[i]] = values[i];
  return result;
}

std::vector<std::size_t> least_contributors(const PointSet& points, std::span<const double> reference,
                                            std::size_t count) {
  const std::size_t k = points.size(), m = points.objectives;
  count = std::min(count, k);
  std::vector<std::size_t> result;
  result.reserve(count);
  const auto redundant = is_redundant(points);
  std::vector<std::size_t> index;
  Points kept{{}, m};
  for (std::size_t i = k; i-- > 0;)
    if ((redundant[i] || !inside(points[i], reference)) && result.size() < count) result.push_back(i);
  if (result.size() == count) return result;
  for (std::size_t i = 0; i < k; ++i) {
    if (redundant[i] || !inside(points[i], reference)) continue;
    index.push_back(i);
    kept.values.insert(kept.values.end(), points[i].begin(), points[i].end());
  }
  if (m == 2) {
    for (const std::size_t i : remove_from_staircase(kept, reference, count - result.size()))
      result.push_back(index[i]);
    return result;
  }
  if (m == 1) {  // a single point is left
    result.push_back(index.front());
    return result;
  }
  Removal removal(kept, reference);
  while (result.size() < count) result.push_back(index[removal.next()]);
  return result;
}

std::vector<std::size_t> ranks(const PointSet& points) {
  if (points.objectives <= 2) return ranks_by_fronts<LowestFront>(points);
  if (points.objectives == 3) return ranks_by_fronts<StaircaseFront>(points);
  return ranks_by_fronts<ListFront>(points);
}

}  // namespace vantage::optimise
