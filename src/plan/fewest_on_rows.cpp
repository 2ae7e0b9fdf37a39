// SPDX-License-Identifier: Apache-2.0
#include "plan/fewest_on_rows.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <bitset>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "plan/choose_on_rows.hpp"

namespace vantage {
namespace {

// What a missing link counts beside a coverage that is short: as much as this share of it. Large enough that a network
// in two parts is never taken for the sake of coverage, small enough that a search may pass through one.
constexpr double kMissingLink = 0.2;
// Swaps without a better network before a search gives up, and for how many of them a change may not be undone.
constexpr std::size_t kPatience = 40, kTabu = 7;
// How many networks of one station fewer a search begins at: those that lose least.
constexpr std::size_t kBeginnings = 3;
// By how much a weakest link is asked to become better at a time.
constexpr double kLinkStep = 0.02;
// Ways along links that are looked at further than one station.
constexpr std::size_t kFarthest = 4, kWaysTried = 24;

// Parts of a network under a least overlap, for asking what one more station joins.
struct Parts {
  std::vector<std::size_t> part;  // of each
  std::size_t count = 0;
};

Parts parts_of(const PairTable& pairs, std::span<const std::size_t> rows, double link) {
  Parts parts{.part = std::vector<std::size_t>(rows.size(), rows.size())};
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (parts.part[i] < rows.size()) continue;
    parts.part[i] = parts.count;
    open.assign(1, i);
    while (!open.empty()) {
      const std::size_t at = open.back();
      open.pop_back();
      for (std::size_t j = 0; j < rows.size(); ++j) {
        if (parts.part[j] < rows.size() || static_cast<double>(pairs.overlap(rows[at], rows[j])) < link) continue;
        parts.part[j] = parts.count;
        open.push_back(j);
      }
    }
    ++parts.count;
  }
  return parts;
}

// Parts left once `row` is there too.
std::size_t parts_with(const PairTable& pairs, std::span<const std::size_t> rows, const Parts& parts, std::size_t row,
                       double link) {
  std::bitset<max_stations> joined;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (static_cast<double>(pairs.overlap(rows[i], row)) >= link) joined.set(parts.part[i]);
  return parts.count + 1 - joined.count();
}

double weakest_of(const PairTable& pairs, std::span<const std::size_t> rows) {
  if (rows.size() < 2) return 1;
  std::vector<double> best(rows.size(), 0);
  std::vector<bool> done(rows.size(), false);
  double weakest = 1;
  std::size_t at = 0;
  for (std::size_t step = 1; step < rows.size(); ++step) {
    done[at] = true;
    for (std::size_t j = 0; j < rows.size(); ++j)
      if (!done[j]) best[j] = std::max(best[j], static_cast<double>(pairs.overlap(rows[at], rows[j])));
    std::size_t next = rows.size();
    for (std::size_t j = 0; j < rows.size(); ++j)
      if (!done[j] && (next == rows.size() || best[j] > best[next])) next = j;
    weakest = std::min(weakest, best[next]);
    at = next;
  }
  return weakest;
}

// A station that leaves for another one, and the network after it.
struct Swap {
  double missed = std::numeric_limits<double>::infinity(), coverage = -1;
  std::size_t out = 0, in = 0;
  bool better_than(const Swap& other) const {
    return missed < other.missed || (missed == other.missed && coverage > other.coverage);
  }
};

class Chooser {
 public:
  Chooser(const RowQuestion& question, std::stop_token stop)
      : q_(question), rows_(question.rows), pairs_(question.pairs), stop_(std::move(stop)) {}

  double missed(double coverage, std::size_t parts, double wanted_link) const {
    const double short_of = std::max(0.0, q_.coverage - coverage);
    return (q_.coverage > 0 ? short_of / q_.coverage : 0) +
           (wanted_link > 0 && parts > 1 ? kMissingLink * static_cast<double>(parts - 1) : 0);
  }
  double missed_by(std::span<const std::size_t> chosen, double coverage, double wanted_link) const {
    return missed(coverage, wanted_link > 0 ? parts_of(pairs_, chosen, wanted_link).count : 1, wanted_link);
  }

  // What is chosen, and further rows until it is enough.
  std::vector<std::size_t> grown(std::vector<std::size_t> chosen);
  std::vector<std::size_t> swapped(std::vector<std::size_t> chosen, double wanted_link);
  // Without the station that is missed least; with `nth`, the one after so many.
  std::vector<std::size_t> without_one(const std::vector<std::size_t>& chosen, std::size_t nth);
  double coverage_of(std::span<const std::size_t> chosen) {
    reset(chosen);
    return cover_->value();
  }
  bool stopped() const { return stop_.stop_requested(); }

 private:
  void reset(std::span<const std::size_t> chosen) {
    cover_.emplace(rows_);
    for (const std::size_t row : chosen) cover_->add(row);
  }
  bool allowed(std::size_t row, std::span<const std::size_t> chosen) const {
    return std::ranges::none_of(chosen, [&](std::size_t other) { return other == row || pairs_.too_near(other, row); });
  }
  bool linked(std::size_t a, std::size_t b) const {
    return a != b && (q_.link <= 0 || static_cast<double>(pairs_.overlap(a, b)) >= q_.link);
  }
  // Whether `row` may stand with all on the way back from `at`; `from` is `size()` where a way begins.
  bool along_way(std::size_t row, std::size_t at, std::span<const std::size_t> from) const {
    for (; from[at] < rows_.size(); at = from[at])
      if (at == row || pairs_.too_near(at, row)) return false;
    return true;
  }
  std::vector<std::size_t> next_way(const std::vector<std::size_t>& chosen) const;
  std::vector<std::size_t> way_between_parts(const std::vector<std::size_t>& chosen) const;
  std::optional<std::size_t> first_row() const;

  const RowQuestion& q_;
  const CaptureRows& rows_;
  const PairTable& pairs_;
  std::stop_token stop_;
  std::optional<RowCover> cover_;
  std::optional<RowColumns> columns_;
};

// Of the part of all candidates that hangs together and captures most, the row that captures most.
std::optional<std::size_t> Chooser::first_row() const {
  std::vector<std::size_t> part(rows_.size(), rows_.size()), open;
  std::optional<std::size_t> best;
  double most = 0;
  for (std::size_t start = q_.fixed; start < rows_.size(); ++start) {
    if (part[start] < rows_.size()) continue;
    part[start] = start;
    open.assign(1, start);
    RowCover all(rows_);
    std::size_t richest = start;
    const RowCover none(rows_);
    double gain = -1;
    while (!open.empty()) {
      const std::size_t at = open.back();
      open.pop_back();
      all.add(at);
      if (const double alone = none.gain(at); alone > gain || (alone == gain && at < richest))
        gain = alone, richest = at;
      for (std::size_t j = q_.fixed; j < rows_.size(); ++j)
        if (part[j] == rows_.size() && linked(at, j)) part[j] = start, open.push_back(j);
    }
    if (const double together = all.value(); !best || together > most) most = together, best = richest;
  }
  return best;
}

// The way along links, from what is chosen to a station that is worth going to, that gains most for each station.
std::vector<std::size_t> Chooser::next_way(const std::vector<std::size_t>& chosen) const {
  const std::size_t none = rows_.size();
  std::vector<std::size_t> hops(rows_.size(), none), from(rows_.size(), none), now = chosen, next;
  std::vector<double> gain(rows_.size(), 0);
  for (std::size_t row = q_.fixed; row < rows_.size(); ++row)
    if (allowed(row, chosen)) gain[row] = cover_->gain(row);
  for (const std::size_t row : chosen) hops[row] = 0;
  struct Way {
    double score;
    std::size_t to;
  };
  std::vector<Way> ways;
  for (std::size_t hop = 1; hop <= kFarthest && !now.empty(); ++hop) {
    next.clear();
    for (std::size_t row = q_.fixed; row < rows_.size(); ++row) {
      if (hops[row] < none || !allowed(row, chosen)) continue;
      for (const std::size_t before : now)
        if (linked(before, row) && (from[row] == none || gain[before] > gain[from[row]]) &&
            along_way(row, before, from))
          from[row] = before;
      if (from[row] < none) next.push_back(row);
    }
    for (const std::size_t row : next) {
      hops[row] = hop;
      double sum = 0;  // no less than what the way gains together
      for (std::size_t at = row; hops[at] > 0; at = from[at]) sum += gain[at];
      if (gain[row] > 0) ways.push_back({sum / static_cast<double>(hop), row});
    }
    now = next;
  }
  std::ranges::sort(ways,
                    [](const Way& a, const Way& b) { return a.score != b.score ? a.score > b.score : a.to < b.to; });
  std::vector<std::size_t> best;
  double most = 0;
  for (std::size_t k = 0; k < ways.size() && k < kWaysTried && ways[k].score > most; ++k) {
    std::vector<std::size_t> way;
    for (std::size_t at = ways[k].to; hops[at] > 0; at = from[at]) way.push_back(at);
    std::ranges::reverse(way);
    double sum = gain[way.front()];
    if (way.size() > 1) {
      RowCover along = *cover_;
      sum = 0;
      for (const std::size_t row : way) sum += along.gain(row), along.add(row);
    }
    if (const double each = sum / static_cast<double>(way.size()); each > most) most = each, best = std::move(way);
  }
  return best;
}

// The stations between the first part and the one that takes fewest; empty where links lead to none.
std::vector<std::size_t> Chooser::way_between_parts(const std::vector<std::size_t>& chosen) const {
  const Parts parts = parts_of(pairs_, chosen, q_.link);
  const std::size_t none = rows_.size();
  std::vector<std::size_t> from(rows_.size(), none), open;
  std::vector<char> seen(rows_.size(), 0), other(rows_.size(), 0);
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (parts.part[i] == 0)
      seen[chosen[i]] = 1, open.push_back(chosen[i]);
    else
      other[chosen[i]] = 1;
  }
  for (std::size_t k = 0; k < open.size(); ++k) {
    const std::size_t at = open[k];
    for (std::size_t row = 0; row < rows_.size(); ++row) {
      if (seen[row] || !linked(at, row) || (!other[row] && (row < q_.fixed || !allowed(row, chosen)))) continue;
      if (!along_way(row, at, from)) continue;
      from[row] = at, seen[row] = 1;
      if (!other[row]) {
        open.push_back(row);
        continue;
      }
      std::vector<std::size_t> way;
      for (std::size_t back = at; from[back] < none; back = from[back]) way.push_back(back);
      return way;
    }
  }
  return {};
}

std::vector<std::size_t> Chooser::grown(std::vector<std::size_t> chosen) {
  const std::size_t most = std::min(q_.fixed + q_.most, rows_.size());
  const auto add = [&](std::span<const std::size_t> way) {
    for (const std::size_t row : way)
      if (chosen.size() < most) chosen.push_back(row), cover_->add(row);
  };
  reset(chosen);
  if (chosen.empty())
    if (const auto first = first_row()) add(std::span(&*first, 1));
  bool along_links = q_.link > 0;
  while (chosen.size() < most) {
    const bool enough = cover_->value() >= q_.coverage;
    if (enough && chosen.size() >= q_.fixed + q_.fewest) {
      if (q_.link <= 0 || parts_of(pairs_, chosen, q_.link).count == 1) break;
      const auto way = way_between_parts(chosen);
      if (way.empty() || chosen.size() + way.size() > most) break;
      add(way);
      continue;
    }
    std::vector<std::size_t> way;
    if (along_links) way = next_way(chosen);
    if (way.empty()) {
      // Nothing that hangs together adds anything: what is left is coverage, and the links are told as missing.
      if (along_links && enough) break;
      along_links = false;
      std::optional<std::size_t> best;
      double gain = 0;
      for (std::size_t row = q_.fixed; row < rows_.size(); ++row) {
        if (!allowed(row, chosen)) continue;
        if (const double own = cover_->gain(row); own > gain) gain = own, best = row;
      }
      if (!best) break;
      way.assign(1, *best);
    }
    add(way);
  }
  // A number that is asked for is kept, even by stations that add nothing.
  for (std::size_t row = q_.fixed; row < rows_.size() && chosen.size() < std::min(most, q_.fixed + q_.fewest); ++row)
    if (allowed(row, chosen)) add(std::span(&row, 1));
  return chosen;
}

std::vector<std::size_t> Chooser::without_one(const std::vector<std::size_t>& chosen, std::size_t nth) {
  struct Loss {
    double missed, coverage;
    std::size_t at;
  };
  reset(chosen);
  const double whole = cover_->value();
  std::vector<Loss> losses;
  for (std::size_t at = q_.fixed; at < chosen.size(); ++at) {
    std::vector<std::size_t> rest = chosen;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(at));
    const double coverage = whole - cover_->loss(chosen[at]);
    losses.push_back({missed_by(rest, coverage, q_.link), coverage, at});
  }
  std::ranges::stable_sort(losses, [](const Loss& a, const Loss& b) {
    return a.missed != b.missed ? a.missed < b.missed : a.coverage > b.coverage;
  });
  std::vector<std::size_t> rest = chosen;
  rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(losses[std::min(nth, losses.size() - 1)].at));
  return rest;
}

// Swaps one station for another, the best swap each time though it be for the worse, and keeps the best network met.
std::vector<std::size_t> Chooser::swapped(std::vector<std::size_t> chosen, double wanted_link) {
  reset(chosen);
  if (!columns_) columns_.emplace(rows_);
  std::vector<std::size_t> best = chosen;
  double best_coverage = cover_->value(), best_missed = missed_by(chosen, best_coverage, wanted_link);
  std::vector<std::size_t> barred_until(rows_.size(), 0);  // neither out nor in again before that swap
  std::vector<double> gain(rows_.size(), 0);
  std::vector<Swap> swaps(chosen.size());
  std::size_t idle = 0;
  for (std::size_t swap = 1; best_missed > 0 && idle < kPatience && !stopped(); ++swap, ++idle) {
    const double whole = cover_->value();
    tbb::parallel_for(q_.fixed, rows_.size(), [&](std::size_t row) { gain[row] = cover_->gain(row); });
    const auto best_swap_of = [&](std::size_t at) {
      const std::size_t leaving = chosen[at];
      const bool may_leave = barred_until[leaving] <= swap;
      std::vector<std::size_t> others = chosen;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(at));
      const Parts parts = wanted_link > 0 ? parts_of(pairs_, others, wanted_link) : Parts{};
      const double left = whole - cover_->loss(leaving);
      std::vector<double> without = gain;
      columns_->add_gains_without(leaving, *cover_, without);
      Swap least;
      for (std::size_t row = q_.fixed; row < rows_.size(); ++row) {
        if (row == leaving || !allowed(row, others)) continue;
        const std::size_t count = wanted_link > 0 ? parts_with(pairs_, others, parts, row, wanted_link) : 1;
        const Swap now{missed(left + without[row], count, wanted_link), left + without[row], at, row};
        if ((!may_leave || barred_until[row] > swap) && now.missed >= best_missed) continue;
        if (now.better_than(least)) least = now;
      }
      return least;
    };
    tbb::parallel_for(q_.fixed, chosen.size(), [&](std::size_t at) { swaps[at] = best_swap_of(at); });
    Swap least;
    for (std::size_t at = q_.fixed; at < chosen.size(); ++at)
      if (swaps[at].better_than(least)) least = swaps[at];
    if (least.missed == std::numeric_limits<double>::infinity()) break;
    const std::size_t leaving = chosen[least.out];
    cover_->remove(leaving), cover_->add(least.in);
    chosen[least.out] = least.in;
    barred_until[leaving] = swap + kTabu + 1, barred_until[least.in] = swap + kTabu / 2 + 1;
    if (least.missed < best_missed || (least.missed == best_missed && least.coverage > best_coverage)) {
      if (least.missed < best_missed) idle = 0;
      best = chosen, best_missed = least.missed, best_coverage = least.coverage;
    }
  }
  return best;
}

}  // namespace

PairTable::PairTable(const CaptureRows& surroundings, std::span<const PlacedStation> stations, double nearest_m)
    : size_(stations.size()), overlap_(size_ * size_, 0), near_(size_ * size_, 0) {
  const bool linked = surroundings.size() == size_;
  const std::size_t words = (surroundings.voxels().size() + 63) / 64;
  std::vector<std::uint64_t> bits(size_ * words, 0);
  std::vector<std::uint32_t> seen(size_, 0);
  for (std::size_t k = 0; linked && k < size_; ++k) {
    for (const CapturedVoxel& one : surroundings.row(k))
      bits[k * words + one.voxel / 64] |= std::uint64_t{1} << (one.voxel % 64);
    seen[k] = static_cast<std::uint32_t>(surroundings.row(k).size());
  }
  tbb::parallel_for(std::size_t{0}, size_, [&](std::size_t i) {
    for (std::size_t j = 0; j < size_; ++j) {
      if (i == j) continue;
      std::uint32_t both = 0;
      for (std::size_t w = 0; w < words; ++w)
        both += static_cast<std::uint32_t>(std::popcount(bits[i * words + w] & bits[j * words + w]));
      if (both > 0) overlap_[i * size_ + j] = static_cast<float>(both) / static_cast<float>(std::min(seen[i], seen[j]));
      const Vec3 apart = stations[i].position - stations[j].position;
      near_[i * size_ + j] = dot(apart, apart) < nearest_m * nearest_m ? 1 : 0;
    }
  });
}

PairTable::PairTable(std::size_t size, std::vector<float> overlaps, std::vector<char> near)
    : size_(size), overlap_(std::move(overlaps)), near_(std::move(near)) {}

RowAnswer judge_rows(const RowQuestion& question, std::vector<std::size_t> rows) {
  RowAnswer answer{.rows = std::move(rows)};
  Chooser chooser(question, {});
  answer.coverage = chooser.coverage_of(answer.rows);
  answer.link = weakest_of(question.pairs, answer.rows);
  answer.missed = chooser.missed_by(answer.rows, answer.coverage, question.link);
  return answer;
}

RowAnswer fewest_on_rows(const RowQuestion& question, std::stop_token stop, std::optional<RowAnswer> from,
                         std::optional<RowAnswer>* nearly) {
  Chooser chooser(question, stop);
  std::vector<std::size_t> fixed(question.fixed);
  std::iota(fixed.begin(), fixed.end(), std::size_t{0});
  RowAnswer best = from ? std::move(*from) : judge_rows(question, chooser.grown(std::move(fixed)));
  const auto placed = [&](const RowAnswer& answer) { return answer.rows.size() - question.fixed; };
  const auto swap = [&] {
    if (best.missed > 0 && !chooser.stopped()) best = judge_rows(question, chooser.swapped(best.rows, question.link));
  };
  swap();
  if (from && best.missed > 0 && placed(best) < question.most && !chooser.stopped()) {
    best = judge_rows(question, chooser.grown(std::move(best.rows)));
    swap();
  }
  // With as many as are allowed and yet not enough, or with enough: one fewer, for as long as that is no worse.
  while (placed(best) > std::max<std::size_t>(question.fewest, 1) && !chooser.stopped()) {
    std::optional<RowAnswer> fewer;
    for (std::size_t nth = 0; nth < std::min(kBeginnings, placed(best)) && !chooser.stopped(); ++nth) {
      RowAnswer found = judge_rows(question, chooser.swapped(chooser.without_one(best.rows, nth), question.link));
      if (found.missed <= best.missed) {
        fewer = std::move(found);
        break;
      }
      if (nearly && (!*nearly || (*nearly)->rows.size() > found.rows.size() || (*nearly)->missed > found.missed))
        *nearly = std::move(found);
    }
    if (!fewer) break;
    best = std::move(*fewer);
  }
  return best;
}

RowAnswer better_on_rows(const RowQuestion& question, RowAnswer from, std::stop_token stop) {
  Chooser chooser(question, stop);
  RowAnswer best = std::move(from);
  if (best.missed > 0) {
    RowAnswer found = judge_rows(question, chooser.swapped(best.rows, question.link));
    if (found.missed < best.missed) best = std::move(found);
  }
  while (best.missed == 0 && best.rows.size() > 1 && !chooser.stopped()) {
    RowAnswer found = judge_rows(question, chooser.swapped(best.rows, best.link + kLinkStep));
    if (found.missed > 0 || found.link <= best.link) break;
    best = std::move(found);
  }
  return best;
}

}  // namespace vantage
