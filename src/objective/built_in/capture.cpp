// SPDX-License-Identifier: Apache-2.0
#include "core/text.hpp"
#include "objective/built_in/built_in.hpp"
#include "vantage/error.hpp"

namespace vantage::built_in {

// The share of attainable coverage that a network captures (attainable.cpp). Whoever measures counts it, on voxels
// whose attainable counts are known.
Objective capture(const ObjectiveSettings& settings) {
  if (!(settings.attainable > 0 && settings.attainable <= 1))
    throw Error(Errc::invalid_argument,
                "capture is a share of what is attainable, a coverage above 0 and at most 1, not " +
                    number(settings.attainable));
  return {.name = "capture",
          .label = "Captured (share of what is attainable)",
          .noun = "share captured of what is attainable",
          .percent = true,
          .scale = maximise(1, 0),
          .needs = {.counts = false, .attainable = true},
          .value = [](const MeasuredNetwork& m) { return m.captured.value; },
          .standard_error = [](const MeasuredNetwork& m) { return m.captured.standard_error; },
          .kind = Objective::Kind::coverage,
          .coverage_of_one = settings.attainable,
          .advice = "allow more stations, or give more places to stand",
          .parameters = "of an attainable coverage of " + number(settings.attainable)};
}

}  // namespace vantage::built_in
