// SPDX-License-Identifier: Apache-2.0
#include "core/text.hpp"
#include "objective/built_in/built_in.hpp"

namespace vantage::built_in {

// Number of connected components, which cannot be registered with each other.
Objective parts(const ObjectiveSettings& settings) {
  return {.name = "parts",
          .label = "Parts that no link connects",
          .noun = "number of parts",
          .scale = minimise(1, 2),
          .needs = {.pairs = true},
          .value = [least = settings.link_overlap](
                       const MeasuredNetwork& m) { return static_cast<double>(connectivity(m.overlap, least).parts); },
          .advice = "allow more stations, or tie scans together with targets",
          .parameters = "links from " + number(settings.link_overlap) + " on"};
}

}  // namespace vantage::built_in
