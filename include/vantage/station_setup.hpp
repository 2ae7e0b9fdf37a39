// SPDX-License-Identifier: Apache-2.0
/// How an instrument is set up at a station: which scanner, and how it is turned.
#pragma once

#include <array>
#include <cstdint>

#include "vantage/types.hpp"

namespace vantage {

/// Scanners stand upright unless tilted. The axis then leans by `tilt` from straight up towards `heading`: at 90° the
/// head lies, at 180° it hangs. The heading turns the scanner about up, from +X towards +Y. It adds to
/// `Scanner::heading`, which turns the scanner about its own axis.
struct StationSetup {
  Angle heading = Angle::degrees(0);  ///< Turn about up.
  Angle tilt = Angle::degrees(0);     ///< Lean of the axis.
  std::uint32_t scanner = 0;          ///< Index into `Simulator::scanners()`.

  bool turned() const { return heading != Angle() || tilt != Angle(); }  ///< True unless heading and tilt are 0.
  /// Rows of Rz(heading) · Ry(tilt), which takes directions from the scanner's frame to the survey's. Quarter turns are
  /// exact.
  std::array<Vec3, 3> survey_from_scanner() const;
  friend bool operator==(const StationSetup&, const StationSetup&) = default;
};

}  // namespace vantage
