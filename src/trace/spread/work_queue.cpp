// SPDX-License-Identifier: Apache-2.0
#include "trace/spread/work_queue.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vantage {

void follow_rates(std::vector<double>& shares, std::span<const double> rates) {
  constexpr double kNearly = 0.02;
  shares.resize(rates.size());
  const double all = std::accumulate(rates.begin(), rates.end(), 0.0);
  const auto fair = [&](std::size_t k) { return rates[k] / all; };
  bool right = true;
  for (std::size_t k = 0; k < rates.size(); ++k) right &= std::abs(shares[k] - fair(k)) <= kNearly * fair(k);
  if (right) return;
  for (std::size_t k = 0; k < rates.size(); ++k) shares[k] = fair(k);
}

Chunk WorkQueue::take(double share, bool known) {
  if (!returned_.empty()) {
    const Chunk chunk = returned_.back();
    returned_.pop_back();
    return chunk;
  }
  constexpr double kLeastPart = 1.0 / 16;  // lower bound, so that handing out stays cheap
  const auto share_of = [&](std::size_t items, double part) {
    return static_cast<std::size_t>(std::ceil(part * share * static_cast<double>(items)));
  };
  std::size_t wanted = std::max<std::size_t>(share_of(items_, kLeastPart), 1);
  if (known) {
    if (next_ >= round_end_) {
      round_ = items_ - next_;
      round_end_ = next_ + static_cast<std::size_t>(std::ceil(of_rest_ * static_cast<double>(round_)));
    }
    wanted = std::max(wanted, std::min(share_of(round_, of_rest_), round_end_ - next_));
  }
  const Chunk chunk{next_, std::min(items_, next_ + wanted)};
  next_ = chunk.end;
  return chunk;
}

}  // namespace vantage
