// SPDX-License-Identifier: Apache-2.0
// Set-ups of stations by control points.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vantage/evaluation.hpp"

namespace vantage {

// Control points that a station may be set up by; indices into `Evaluation::targets`.
struct KnownPoints {
  std::vector<std::size_t> seen;                    // in its scan, within range
  std::optional<std::size_t> under = std::nullopt;  // its tripod
};

// Two known points fix a levelled station, or one if it stands over another; a third one checks them.
inline constexpr std::size_t kFixing = 2, kChecking = 3;
bool may_be_set_up(const KnownPoints& known);

// Returns the known points of each station; empty if there is no control point.
std::vector<KnownPoints> known_points(const Evaluation& evaluation);

// "resection from 3", "resection from 2, unchecked", "over P1, sights 2", "1 seen, too few", "none seen".
std::string set_up_text(const KnownPoints& known, const Evaluation& evaluation);

}  // namespace vantage
