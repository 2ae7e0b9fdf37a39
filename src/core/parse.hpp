// SPDX-License-Identifier: Apache-2.0
// Reads the text of a setting. Every function throws Error invalid_argument that quotes the text it could not read.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/settings.hpp"

namespace vantage {

// Numbers that a setting accepts. Never NaN; infinite only if an end is.
struct Interval {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_included = true, high_included = true;
};
inline constexpr Interval kAnyNumber{};
inline constexpr Interval kPositive{.low = 0, .low_included = false};
inline constexpr Interval kNotNegative{.low = 0};
inline constexpr Interval kAnyShare{.low = 0, .high = 1};
inline constexpr Interval kShareBelow1{.low = 0, .high = 1, .high_included = false};
// Lengths, steps and rates that must not be 0, in any of their units. Smaller and larger ones would overflow values
// computed from them.
inline constexpr Interval kMeasurable{.low = 1e-6, .high = 1e9};
// Limits of time in seconds, 0 for none: at most thirty years, since clocks count in 64 bits of nanoseconds.
inline constexpr Interval kAnySeconds{.low = 0, .high = 1e9};

// Throws unless the number is finite and in the interval.
void check_number(double value, const std::string& what, const Interval& interval = kAnyNumber);

// Messages begin with `what`, the name of the setting.
double parse_number(std::string_view text, const std::string& what, const Interval& interval = kAnyNumber);
std::uint64_t parse_count(std::string_view text, const std::string& what, std::uint64_t low = 0,
                          std::uint64_t high = std::numeric_limits<std::uint64_t>::max());
// Parses "true" or "false".
bool parse_flag(std::string_view text, const std::string& what);
// Returns the text without surrounding blanks.
std::string_view trimmed_text(std::string_view text);
std::vector<std::string_view> split(std::string_view text, char separator);
// Parses comma-separated numbers, from `fewest` to `most` of them.
std::vector<double> parse_numbers(std::string_view text, const std::string& what, std::size_t fewest, std::size_t most,
                                  const Interval& interval = kAnyNumber);

struct CountRange {
  std::size_t low = 0, high = 0;
};
CountRange parse_count_range(std::string_view text, const std::string& what, std::size_t low, std::size_t high);

// Parses a number of voxels ("20000") or a share of them ("5%", "0.05").
SampleSize parse_sample(std::string_view text, const std::string& what);

// Parses comma-separated devices: all, numbers, cpu.
DeviceList parse_devices(std::string_view text, const std::string& what);

// Parses seconds: a number, optionally followed by s, min or h.
double parse_duration(std::string_view text, const std::string& what);
// Parses "06:30" to minutes after midnight, up to 24:00.
double parse_clock(std::string_view text, const std::string& what);
// Parses "4G", "500 MiB" or "2e9" to bytes; K, M, G, T are powers of 1024.
std::uint64_t parse_bytes(std::string_view text, const std::string& what);

}  // namespace vantage
