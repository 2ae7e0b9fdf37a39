// SPDX-License-Identifier: Apache-2.0
// Dynamic programmes over the ends of pieces. The numbers of pieces and of missing links add up. Among the cuts with
// the fewest, the longest piece, and then the walking, are least along pieces that such cuts consist of.
#include "evaluate/cut_round.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace vantage {
namespace {

using Cost = std::array<std::size_t, 3>;  // pieces, parts after the first of each, pieces that are not linked

Cost sum(const Cost& before, const RoundPiece& piece) {
  return {before[0] + 1, before[1] + piece.parts - 1, before[2] + (piece.linked ? 0 : 1)};
}

// All pieces that are short enough, by their ends.
std::vector<std::vector<RoundPiece>> pieces_of(const RoundTimes& times, double most_min) {
  const std::size_t n = times.stay_min.size();
  // The first and the last stop that each is linked to; itself if there is none.
  std::vector<std::pair<std::size_t, std::size_t>> reach(n);
  for (std::size_t a = 0; a < n; ++a) {
    reach[a] = {a, a};
    for (std::size_t b = 0; b < n && times.linked; ++b)
      if (b != a && times.linked(a, b)) reach[a] = {std::min(reach[a].first, b), std::max(reach[a].second, b)};
  }
  std::vector<std::vector<RoundPiece>> pieces(n + 1);
  for (std::size_t first = 0; first < n; ++first) {
    std::vector<std::size_t> part(n - first);  // the part that each stop of the piece is in
    double standing = 0, stepping = 0;
    std::size_t low = n, high = 0, parts = 0;
    for (std::size_t last = first; last < n; ++last) {
      standing += times.stay_min[last];
      if (standing > most_min) break;  // walking may get shorter with a further stop, standing does not
      if (last > first) stepping += times.step_min[last - 1];
      low = std::min(low, reach[last].first), high = std::max(high, reach[last].second);
      const std::size_t size = last - first;
      part[size] = size, ++parts;
      for (std::size_t k = 0; k < size; ++k) {
        if (part[k] == part[size] || (times.linked && !times.linked(first + k, last))) continue;
        std::replace(part.begin(), part.begin() + static_cast<std::ptrdiff_t>(size), std::size_t{part[k]}, part[size]);
        --parts;
      }
      const double walk = times.out_min[first] + stepping + times.out_min[last];
      if (standing + walk > most_min) continue;
      const bool whole = first == 0 && last + 1 == n;
      pieces[last + 1].push_back({.first = first,
                                  .end = last + 1,
                                  .minutes = standing + walk,
                                  .walk_min = walk,
                                  .parts = parts,
                                  .linked = whole || !times.linked || low < first || high > last});
    }
  }
  return pieces;
}

}  // namespace

std::vector<RoundPiece> cut_round(const RoundTimes& times, double most_min) {
  const std::size_t n = times.stay_min.size();
  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  constexpr double kLong = std::numeric_limits<double>::infinity();
  std::vector<std::vector<RoundPiece>> pieces = pieces_of(times, most_min);
  std::vector<Cost> least(n + 1, {kNone, kNone, kNone});
  least[0] = {0, 0, 0};
  for (std::size_t end = 1; end <= n; ++end) {
    std::erase_if(pieces[end], [&](const RoundPiece& piece) { return least[piece.first][0] == kNone; });
    for (const RoundPiece& piece : pieces[end]) least[end] = std::min(least[end], sum(least[piece.first], piece));
    std::erase_if(pieces[end], [&](const RoundPiece& piece) { return sum(least[piece.first], piece) != least[end]; });
  }
  if (least[n][0] == kNone) return {};
  std::vector<double> longest(n + 1, kLong), walk(n + 1, kLong);
  longest[0] = walk[0] = 0;
  for (std::size_t end = 1; end <= n; ++end)
    for (const RoundPiece& piece : pieces[end])
      longest[end] = std::min(longest[end], std::max(longest[piece.first], piece.minutes));
  std::vector<const RoundPiece*> chosen(n + 1, nullptr);
  for (std::size_t end = 1; end <= n; ++end)
    for (const RoundPiece& piece : pieces[end])
      if (piece.minutes <= longest[n] && walk[piece.first] + piece.walk_min < walk[end])
        walk[end] = walk[piece.first] + piece.walk_min, chosen[end] = &piece;
  std::vector<RoundPiece> cut;
  for (std::size_t end = n; end > 0; end = cut.back().first) cut.push_back(*chosen[end]);
  std::ranges::reverse(cut);
  return cut;
}

}  // namespace vantage
