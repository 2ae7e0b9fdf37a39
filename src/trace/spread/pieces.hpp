// SPDX-License-Identifier: Apache-2.0
// Cuts a row of items into chunks for several workers.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace vantage {

struct Piece {
  std::size_t first = 0, end = 0;
  std::size_t size() const { return end - first; }
};

// Sets `shares` of the work in proportion to `rates`; a member that takes no part has rate 0. Shares that are nearly
// right stay, so that the next work of this kind is cut into the same pieces although rates vary slightly.
void follow_rates(std::vector<double>& shares, std::span<const double> rates);

// Hands out all items in pieces, large ones first, so that all workers finish together, however fast each is. Not
// thread-safe.
//
// It works in rounds, each of `of_rest` of the remaining items; the others can thus make up for a slow piece
// (factoring: Hummel, Schonberg, Flynn, 1992).
class Pieces {
 public:
  static constexpr double factored = 0.9;
  explicit Pieces(std::size_t items, double of_rest = factored) : items_(items), of_rest_(of_rest) {}

  bool empty() const { return next_ == items_ && returned_.empty(); }
  // Returns a piece for a member that does the part `share` of all work. `known`: whether its rate was measured;
  // otherwise it gets a small piece to measure it. REQUIRES: not empty.
  Piece take(double share, bool known);
  // Returns a piece that was taken but not done.
  void give_back(const Piece& piece) { returned_.push_back(piece); }

 private:
  std::size_t items_;
  double of_rest_;
  std::size_t next_ = 0;
  std::size_t round_ = 0, round_end_ = 0;  // items left when the round began, and where it ends
  std::vector<Piece> returned_;
};

}  // namespace vantage
