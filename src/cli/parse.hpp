// SPDX-License-Identifier: Apache-2.0
// What users type, turned into values. Every function throws Error invalid_argument that quotes the text it could not
// read.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/station_setup.hpp"
#include "vantage/types.hpp"

namespace vantage::cli {

// The numbers that an option takes. Never NaN; infinite only where an end is.
struct Interval {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_included = true, high_included = true;
};
inline constexpr Interval any_number{};
inline constexpr Interval positive{.low = 0, .low_included = false};
inline constexpr Interval not_negative{.low = 0};

// `what` opens the message: the option's name.
double parse_number(std::string_view text, const std::string& what, const Interval& interval = any_number);
std::uint64_t parse_count(std::string_view text, const std::string& what, std::uint64_t low = 0,
                          std::uint64_t high = std::numeric_limits<std::uint64_t>::max());
std::vector<std::string_view> split(std::string_view text, char separator);
// Comma-separated numbers, from `fewest` to `most` of them.
std::vector<double> parse_numbers(std::string_view text, const std::string& what, std::size_t fewest, std::size_t most,
                                  const Interval& interval = any_number);

// A station as it is typed: X,Y,Z of the scanner's head, u,v on the search area, or with its quantities named:
// x=5,y=3.6 (the ground there is looked for), x=5,y=3.6,z=1.85, x=5,y=3.6,ground=0, u=0.25,v=0.5; and with those how it
// is set up: heading=30,tilt=90,step=0.1,scanner=rtc360@6mm.
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
};
StationText parse_station(std::string_view text, const std::string& what);

struct CountRange {
  std::size_t low = 0, high = 0;
};
CountRange parse_count_range(std::string_view text, const std::string& what, std::size_t low, std::size_t high);

// A sample of voxels: a number of them ("20000") or a share ("5%", "0.05").
struct SampleSize {
  std::optional<std::uint64_t> voxels;
  std::optional<double> share;
  std::uint64_t of(std::uint64_t population) const;
};
SampleSize parse_sample(std::string_view text, const std::string& what);

// Seconds: a number, or one with s, min or h behind it.
double parse_duration(std::string_view text, const std::string& what);

}  // namespace vantage::cli
