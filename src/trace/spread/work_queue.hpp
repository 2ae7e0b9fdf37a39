// SPDX-License-Identifier: Apache-2.0
// Cuts a row of items into chunks for several workers.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace vantage {

struct Chunk {
  std::size_t first = 0, end = 0;
  std::size_t size() const { return end - first; }
};

// Sets `shares` of the work in proportion to `rates`; a worker that does not take part has rate 0. Nearly right shares
// stay, so that later work of this kind is cut into the same chunks although rates vary slightly.
void follow_rates(std::vector<double>& shares, std::span<const double> rates);

// Hands out all items in chunks, large ones first, so that all workers finish together, however fast each is. Not
// thread-safe.
//
// It works in rounds, each of `of_rest` of the remaining items; the others can thus make up for a slow chunk
// (factoring: Hummel, Schonberg, Flynn, 1992).
class WorkQueue {
 public:
  static constexpr double kFactored = 0.9;
  explicit WorkQueue(std::size_t items, double of_rest = kFactored) : items_(items), of_rest_(of_rest) {}

  bool empty() const { return next_ == items_ && returned_.empty(); }
  // Returns a chunk for a worker that does the part `share` of all work. `known`: true if its rate was measured;
  // otherwise it gets a small chunk to measure it. REQUIRES: not empty.
  Chunk take(double share, bool known);
  // Takes back a chunk that was taken but not done.
  void give_back(const Chunk& chunk) { returned_.push_back(chunk); }

 private:
  std::size_t items_;
  double of_rest_;
  std::size_t next_ = 0;
  std::size_t round_ = 0, round_end_ = 0;  // items left when the round began, and where it ends
  std::vector<Chunk> returned_;
};

}  // namespace vantage
