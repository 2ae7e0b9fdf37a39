// SPDX-License-Identifier: Apache-2.0
// How reasons are shown, in pictures and clouds alike.
#pragma once

#include <array>

#include "report/colour.hpp"
#include "vantage/missed.hpp"

namespace vantage {

struct MissedStyle {
  WhyMissed why;
  Colour colour;
  const char* words;
};

// What shows last, and so before all others, last: first what nothing helps.
inline constexpr std::array<MissedStyle, why_missed_count> kMissedStyles{
    {{WhyMissed::captured, {0.10, 0.59, 0.25}, "captured"},
     {WhyMissed::hidden, {0.62, 0.63, 0.66}, "hidden from everywhere"},
     {WhyMissed::far, {0.16, 0.34, 0.66}, "out of range"},
     {WhyMissed::flat, {0.49, 0.27, 0.62}, "seen only too flatly"},
     {WhyMissed::sparse, {0.95, 0.62, 0.15}, "too sparse"},
     {WhyMissed::not_chosen, {0.84, 0.10, 0.11}, "not with these stations"}}};

constexpr const MissedStyle& missed_style(WhyMissed why) {
  for (const MissedStyle& style : kMissedStyles)
    if (style.why == why) return style;
  return kMissedStyles.front();
}

}  // namespace vantage
