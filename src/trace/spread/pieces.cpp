// SPDX-License-Identifier: Apache-2.0
#include "trace/spread/pieces.hpp"

#include <algorithm>
#include <cmath>

namespace vantage {

Piece Pieces::take(double share, bool known) {
  if (!returned_.empty()) {
    const Piece piece = returned_.back();
    returned_.pop_back();
    return piece;
  }
  // Of what is left, so much that a surprise can be made good by the others; never so little that handing out costs.
  constexpr double of_rest = 0.75, least = 1.0 / 16;
  const double smallest = least * share * static_cast<double>(items_),
               fair = known ? of_rest * share * static_cast<double>(items_ - next_) : 0;
  const auto wanted = static_cast<std::size_t>(std::ceil(std::max({smallest, fair, 1.0})));
  const Piece piece{next_, std::min(items_, next_ + wanted)};
  next_ = piece.end;
  return piece;
}

}  // namespace vantage
