// SPDX-License-Identifier: Apache-2.0
#include "objective/built_in/built_in.hpp"

namespace vantage::built_in {

// Minutes from entering the site to leaving it.
Objective time(const ObjectiveSettings& settings) {
  return {.name = "time",
          .label = "Time on site",
          .unit = "min",
          .noun = "time on site",
          // An hour per station, if the number is known: no survey exceeds this scale.
          .scale = minimise(0, 60 * static_cast<double>(settings.stations_max)),
          .needs = {.counts = false, .time = true},
          .value = [](const MeasuredNetwork& m) { return m.minutes_on_site; },
          .kind = Objective::Kind::time,
          .advice = "use a faster setting of the scanner, or ask for less to be captured"};
}

}  // namespace vantage::built_in
