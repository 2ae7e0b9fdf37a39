// SPDX-License-Identifier: Apache-2.0
#include "import/cloud/rectangles.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace vantage::importer {
namespace {

// Sorts squares by rows, the second number, and removes duplicates.
void sort_rows(std::vector<Square>& squares) {
  std::ranges::sort(squares,
                    [](const Square& a, const Square& b) { return std::pair(a[1], a[0]) < std::pair(b[1], b[0]); });
  squares.erase(std::unique(squares.begin(), squares.end()), squares.end());
}

void fill_rows(std::vector<Square>& squares, std::int32_t most) {
  sort_rows(squares);
  const std::size_t count = squares.size();
  for (std::size_t k = 1; k < count; ++k) {
    const Square before = squares[k - 1], after = squares[k];
    if (before[1] != after[1] || after[0] - before[0] > most + 1) continue;
    for (std::int32_t u = before[0] + 1; u < after[0]; ++u) squares.push_back({u, after[1]});
  }
}

void transpose(std::vector<Square>& squares) {
  for (Square& square : squares) std::swap(square[0], square[1]);
}

}  // namespace

std::vector<Square> close_gaps(std::vector<Square> squares, std::int32_t most) {
  fill_rows(squares, most);
  transpose(squares);
  fill_rows(squares, most);
  transpose(squares);
  sort_rows(squares);
  return squares;
}

std::vector<Rectangle> rectangles(const std::vector<Square>& squares) {
  std::vector<Rectangle> all;
  std::map<std::pair<std::int32_t, std::int32_t>, std::size_t> open, next;  // by first column and end
  for (std::size_t k = 0; k < squares.size();) {
    const std::int32_t row = squares[k][1];
    next.clear();
    while (k < squares.size() && squares[k][1] == row) {
      const std::int32_t first = squares[k][0];
      std::int32_t end = first;
      for (; k < squares.size() && squares[k] == Square{end, row}; ++k) ++end;
      const auto above = open.find({first, end});
      const bool goes_on = above != open.end() && all[above->second].high[1] == row;
      if (!goes_on) all.push_back({{first, row}, {end, row}});
      const std::size_t number = goes_on ? above->second : all.size() - 1;
      all[number].high[1] = row + 1;
      next[{first, end}] = number;
    }
    std::swap(open, next);
  }
  return all;
}

Outlines::Outlines(const std::vector<Rectangle>& all) {
  std::vector<Square>& rows = corners_[0];
  for (const Rectangle& r : all)
    for (const Square& corner : {r.low, Square{r.high[0], r.low[1]}, r.high, Square{r.low[0], r.high[1]}})
      rows.push_back(corner);
  corners_[1] = rows;
  sort_rows(rows);
  transpose(corners_[1]);
  sort_rows(corners_[1]);
}

std::vector<Square> Outlines::of(const Rectangle& rectangle) const {
  std::vector<Square> outline;
  // Adds corners from one corner to the next, without the latter. `across`: 0 along a row, 1 along a column.
  const auto side = [&](std::size_t across, std::int32_t line, std::int32_t from, std::int32_t to) {
    const std::vector<Square>& corners = corners_[across];
    const auto less = [](const Square& a, const Square& b) { return std::pair(a[1], a[0]) < std::pair(b[1], b[0]); };
    auto first = std::ranges::lower_bound(corners, Square{std::min(from, to), line}, less);
    const auto last = std::ranges::upper_bound(corners, Square{std::max(from, to), line}, less);
    std::vector<Square> along(first, last);
    if (from > to) std::ranges::reverse(along);
    along.pop_back();
    if (across) transpose(along);
    outline.insert(outline.end(), along.begin(), along.end());
  };
  side(0, rectangle.low[1], rectangle.low[0], rectangle.high[0]);
  side(1, rectangle.high[0], rectangle.low[1], rectangle.high[1]);
  side(0, rectangle.high[1], rectangle.high[0], rectangle.low[0]);
  side(1, rectangle.low[0], rectangle.high[1], rectangle.low[1]);
  return outline;
}

}  // namespace vantage::importer
