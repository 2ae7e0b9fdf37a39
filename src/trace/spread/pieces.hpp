// SPDX-License-Identifier: Apache-2.0
// Work in a row of items, cut into pieces for several who work on it.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace vantage {

struct Piece {
  std::size_t first = 0, end = 0;
  std::size_t size() const { return end - first; }
};

// Makes `shares` of all work those of members who are as fast as `rates` say; one who takes no part has the rate 0.
// Shares that are nearly right stay as they are, so that the next work of this kind is cut into the same pieces: a rate
// is not quite the same from one time to the next.
void follow_rates(std::vector<double>& shares, std::span<const double> rates);

// All items, handed out in pieces: large ones first, then smaller, so that all who work on it end together
// however fast each is. Not thread-safe.
//
// In rounds, each of `of_rest` of what is left, so that a surprise can be made good by the others (factoring: Hummel,
// Schonberg, Flynn, 1992).
class Pieces {
 public:
  static constexpr double factored = 0.9;
  explicit Pieces(std::size_t items, double of_rest = factored) : items_(items), of_rest_(of_rest) {}

  bool empty() const { return next_ == items_ && returned_.empty(); }
  // For one that does the part `share` of all that is done. `known`: whether by experience; where not, a small piece
  // is to give some. REQUIRES: not empty.
  Piece take(double share, bool known);
  // What was taken and not done.
  void give_back(const Piece& piece) { returned_.push_back(piece); }

 private:
  std::size_t items_;
  double of_rest_;
  std::size_t next_ = 0;
  std::size_t round_ = 0, round_end_ = 0;  // how much was left when it began, and where it ends
  std::vector<Piece> returned_;
};

}  // namespace vantage
