// SPDX-License-Identifier: Apache-2.0
// Colours of reasons, in pictures and clouds alike.
#pragma once

#include <array>

#include "map/colour.hpp"
#include "vantage/missed.hpp"

namespace vantage {

struct MissedStyle {
  WhyMissed why;
  Colour colour;
  const char* words;
};

// In the order of legends and columns; reasons beyond help come first. Any two differ for people with any kind of
// colour blindness.
inline constexpr std::array<MissedStyle, why_missed_count> kMissedStyles{
    {{WhyMissed::captured, {0.56, 0.75, 0.87}, "captured"},
     {WhyMissed::hidden, {0.29, 0.27, 0.33}, "hidden from everywhere"},
     {WhyMissed::far, {0.04, 0.48, 0.36}, "out of range"},
     {WhyMissed::flat, {0.79, 0.41, 0.63}, "seen only too flatly"},
     {WhyMissed::dark, {0.35, 0.10, 0.00}, "too dark at that distance"},
     {WhyMissed::sparse, {0.94, 0.83, 0.23}, "too sparse"},
     {WhyMissed::not_chosen, {0.85, 0.34, 0.04}, "other stations would capture it"}}};

constexpr const MissedStyle& missed_style(WhyMissed why) {
  for (const MissedStyle& style : kMissedStyles)
    if (style.why == why) return style;
  return kMissedStyles.front();
}

}  // namespace vantage
