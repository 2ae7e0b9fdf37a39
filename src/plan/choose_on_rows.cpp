// SPDX-License-Identifier: Apache-2.0
#include "plan/choose_on_rows.hpp"

#include <algorithm>
#include <numeric>
#include <queue>

namespace vantage {

RowCover::RowCover(const CaptureRows& rows, std::span<const std::size_t> taken)
    : rows_(rows), points_(rows.voxels().size()) {
  for (const std::size_t row : taken) add(row);
}

double RowCover::filled(std::uint64_t points) const {
  const double share = static_cast<double>(points) / rows_.goal_density();
  return share < 1 ? share : 1;
}

void RowCover::add(std::size_t row) {
  for (const CapturedVoxel& seen : rows_.row(row)) points_[seen.voxel] += seen.points;
}

void RowCover::remove(std::size_t row) {
  for (const CapturedVoxel& seen : rows_.row(row)) points_[seen.voxel] -= seen.points;
}

double RowCover::gain(std::size_t row) const {
  double sum = 0;
  for (const CapturedVoxel& seen : rows_.row(row)) {
    const std::uint64_t has = points_[seen.voxel];
    if (static_cast<double>(has) >= rows_.goal_density()) continue;
    sum += rows_.weights()[seen.voxel] * (filled(has + seen.points) - filled(has));
  }
  return rows_.total_weight() > 0 ? sum / rows_.total_weight() : 0;
}

double RowCover::loss(std::size_t row) const {
  double sum = 0;
  for (const CapturedVoxel& seen : rows_.row(row)) {
    const std::uint64_t has = points_[seen.voxel];
    sum += rows_.weights()[seen.voxel] * (filled(has) - filled(has - seen.points));
  }
  return rows_.total_weight() > 0 ? sum / rows_.total_weight() : 0;
}

double RowCover::fill(std::size_t voxel) const { return filled(points_[voxel]); }

double RowCover::value() const {
  double sum = 0;
  for (std::size_t v = 0; v < points_.size(); ++v) sum += rows_.weights()[v] * filled(points_[v]);
  return rows_.total_weight() > 0 ? sum / rows_.total_weight() : 0;
}

RowColumns::RowColumns(const CaptureRows& rows) : rows_(rows), offsets_(rows.voxels().size() + 1, 0) {
  for (std::size_t row = 0; row < rows.size(); ++row)
    for (const CapturedVoxel& seen : rows.row(row)) ++offsets_[seen.voxel + 1];
  std::partial_sum(offsets_.begin(), offsets_.end(), offsets_.begin());
  entries_.resize(offsets_.back());
  std::vector<std::size_t> next(offsets_.begin(), offsets_.end() - 1);
  for (std::size_t row = 0; row < rows.size(); ++row)
    for (const CapturedVoxel& seen : rows.row(row))
      entries_[next[seen.voxel]++] = {static_cast<std::uint32_t>(row), seen.points};
}

void RowColumns::add_gains_without(std::size_t leaving, const RowCover& cover, std::span<double> gains) const {
  if (rows_.total_weight() <= 0) return;
  for (const CapturedVoxel& seen : rows_.row(leaving)) {
    const std::uint64_t has = cover.points(seen.voxel), left = has - seen.points;
    if (static_cast<double>(left) >= rows_.goal_density()) continue;  // full without it, too
    const double share = rows_.weights()[seen.voxel] / rows_.total_weight();
    const double lost = cover.filled(has) - cover.filled(left);
    for (std::size_t k = offsets_[seen.voxel]; k < offsets_[seen.voxel + 1]; ++k) {
      const Seen& other = entries_[k];
      gains[other.row] += share * (lost - (cover.filled(has + other.points) - cover.filled(left + other.points)));
    }
  }
}

std::vector<std::size_t> choose_greedily(const CaptureRows& rows, std::size_t count, std::span<const std::size_t> fixed,
                                         double enough, const MayTake& may_take) {
  std::vector<std::size_t> taken(fixed.begin(), fixed.end());
  RowCover cover(rows, taken);

  struct Bound {
    double gain;
    std::size_t row, seen_at;
    bool operator<(const Bound& other) const { return gain != other.gain ? gain < other.gain : row > other.row; }
  };
  std::priority_queue<Bound> queue;
  for (std::size_t row = 0; row < rows.size(); ++row)
    if (std::find(taken.begin(), taken.end(), row) == taken.end()) queue.push({cover.gain(row), row, taken.size()});

  std::vector<Bound> refused;  // for now: what may be taken depends on what is
  while (taken.size() < fixed.size() + count && !queue.empty() && (enough >= 1 || cover.value() < enough)) {
    const Bound best = queue.top();
    queue.pop();
    if (best.gain <= 0) break;
    if (may_take && !may_take(best.row, taken)) {
      refused.push_back(best);
      continue;
    }
    if (best.seen_at < taken.size()) {
      queue.push({cover.gain(best.row), best.row, taken.size()});
      continue;
    }
    cover.add(best.row);
    taken.push_back(best.row);
    for (const Bound& again : refused) queue.push(again);
    refused.clear();
  }
  return taken;
}

std::vector<std::size_t> improve_by_swaps(const CaptureRows& rows, std::vector<std::size_t> chosen, std::size_t fixed,
                                          double least, const MayTake& may_take, const Progress& progress) {
  RowCover cover(rows, chosen);
  std::vector<char> in(rows.size(), 0);
  for (const std::size_t row : chosen) in[row] = 1;
  // Upper bounds of what each row adds to the set of now, for skipping: F(S − o + r) − F(S − o) is at most
  // F(S + r) − F(S − o), the gain of r and the loss of o; and what a row adds shrinks when another is added.
  std::vector<double> bound(rows.size()), known(rows.size());
  for (std::size_t row = 0; row < rows.size(); ++row) bound[row] = cover.gain(row);
  std::vector<std::size_t> others, order;

  std::size_t unchanged = 0;  // rows in a row that could not be changed
  for (std::size_t at = fixed; chosen.size() > fixed && unchanged < chosen.size() - fixed && !progress.stopped();) {
    const std::size_t out = chosen[at];
    const double lost = cover.loss(out);
    cover.remove(out);
    others = chosen;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(at));
    order.clear();
    for (std::size_t row = 0; row < rows.size(); ++row)
      if (!in[row]) order.push_back(row);
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return bound[a] != bound[b] ? bound[a] > bound[b] : a < b; });
    std::size_t best = out;
    double most = lost + least;
    std::size_t looked_at = 0;
    for (; looked_at < order.size(); ++looked_at) {
      const std::size_t row = order[looked_at];
      if (bound[row] + lost <= most) break;
      const double gain = cover.gain(row);
      known[row] = gain;
      if (gain > most && (!may_take || may_take(row, others))) {
        most = gain;
        best = row;
      }
    }
    cover.add(best);
    if (best == out) {
      ++unchanged;
    } else {
      in[out] = 0;
      in[best] = 1;
      chosen[at] = best;
      unchanged = 0;
      for (double& one : bound) one += lost;
      bound[out] = lost;
    }
    for (std::size_t k = 0; k < looked_at; ++k) bound[order[k]] = std::min(bound[order[k]], known[order[k]]);
    at = at + 1 < chosen.size() ? at + 1 : fixed;
  }
  return chosen;
}

std::vector<std::size_t> drop_and_swap(const CaptureRows& rows, std::vector<std::size_t> chosen, std::size_t fixed,
                                       double enough, const Progress& progress) {
  while (chosen.size() > fixed && !progress.stopped()) {
    const RowCover cover(rows, chosen);
    std::size_t least = fixed;
    double lost = cover.loss(chosen[fixed]);
    for (std::size_t at = fixed + 1; at < chosen.size(); ++at)
      if (const double loss = cover.loss(chosen[at]); loss < lost) lost = loss, least = at;
    std::vector<std::size_t> fewer = chosen;
    fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(least));
    if (RowCover(rows, fewer).value() < enough) {
      fewer = improve_by_swaps(rows, std::move(fewer), fixed, 1e-9, {}, progress);
      if (RowCover(rows, fewer).value() < enough) break;
    }
    chosen = std::move(fewer);
  }
  return chosen;
}

}  // namespace vantage
