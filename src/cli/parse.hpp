// SPDX-License-Identifier: Apache-2.0
// Parses stations from users. Numbers and the like: core/parse.hpp.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "core/parse.hpp"
#include "vantage/station_setup.hpp"
#include "vantage/types.hpp"

namespace vantage::cli {

// Properties that a station's scanner has of its own, besides its steps of azimuth.
struct ScannerView {
  std::optional<Angle> zenith_step = {}, horizontal = {}, vertical = {}, zenith_start = {};
  std::optional<double> nearest_m = {}, farthest_m = {};
};

// A station from a user: X,Y,Z of the scanner's head, or u,v on the search area. Or named quantities: x=5,y=3.6 (the
// ground there is found), x=5,y=3.6,z=1.85, x=5,y=3.6,ground=0, u=0.25,v=0.5. With names also its setup:
// heading=30,tilt=90,step=0.1,scanner=rtc360@6mm, zenith-step= where it is another, horizontal=, vertical= and
// zenith-start= of the field of view, nearest= and farthest= of the range, and its name=.
struct StationText {
  std::optional<Vec3> position = {};  // the head
  std::optional<Uv> uv = {};
  std::optional<Vec3> ground = {};  // below the head
  std::optional<std::array<double, 2>> xy = {};
  std::optional<std::array<double, 2>> pair = {};  // two numbers without names: u,v, unless they cannot be
  std::string name = {};
  StationSetup setup = {};  // heading and tilt
  std::string scanner = {};
  std::optional<Angle> step = {};
  ScannerView view = {};
};
StationText parse_station(std::string_view text, const std::string& what);

}  // namespace vantage::cli
