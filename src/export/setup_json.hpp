// SPDX-License-Identifier: Apache-2.0
// A station's setup in JSON: its turn, and its scanner so far that the station can be read again.
#pragma once

#include <span>

#include "vantage/scanner.hpp"
#include "vantage/station_setup.hpp"

namespace vantage {

// Adds {heading, tilt, scanner, step}, as the columns of stations.csv; and, if the scanner is another than the first,
// with another view, {zenith_step, horizontal, vertical, zenith_start, nearest, farthest}. Degrees and metres. `step`
// is that of azimuth, and, without `zenith_step`, of zenith; it is left out if the first scanner's own two differ.
template <class Json>
void add_setup(Json& station, const StationSetup& setup, std::span<const Scanner> scanners) {
  const Scanner &scanner = scanners[setup.scanner], &first = scanners.front();
  const bool one_step = scanner.azimuth_step == scanner.zenith_step;
  const bool own_view = setup.scanner > 0 &&
                        (!one_step || scanner.horizontal_angle != first.horizontal_angle ||
                         scanner.vertical_angle != first.vertical_angle || scanner.zenith_start != first.zenith_start ||
                         scanner.min_range_m != first.min_range_m || scanner.max_range_m != first.max_range_m);
  station["heading"] = setup.heading.in_degrees();
  station["tilt"] = setup.tilt.in_degrees();
  station["scanner"] = scanner.name;
  if (one_step || own_view) station["step"] = scanner.azimuth_step.in_degrees();
  if (!own_view) return;
  if (!one_step) station["zenith_step"] = scanner.zenith_step.in_degrees();
  station["horizontal"] = scanner.horizontal_angle.in_degrees();
  station["vertical"] = scanner.vertical_angle.in_degrees();
  station["zenith_start"] = scanner.zenith_start.in_degrees();
  station["nearest"] = scanner.min_range_m;
  station["farthest"] = scanner.max_range_m;
}

}  // namespace vantage
