// SPDX-License-Identifier: Apache-2.0
#include "core/parse.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "vantage/error.hpp"

namespace vantage {
namespace {

[[noreturn]] void refuse(const std::string& what, std::string_view text, const std::string& why) {
  throw Error(Errc::invalid_argument, what + ": '" + std::string(text) + "' " + why);
}

std::string number_text(double value) {
  std::array<char, 32> buffer{};
  return {buffer.data(), std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr};
}

}  // namespace

std::string_view trimmed_text(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

namespace {

// from_chars accepts no leading plus, which users type.
std::string_view without_plus(std::string_view text) {
  return text.size() > 1 && text[0] == '+' && text[1] != '-' ? text.substr(1) : text;
}

std::string describe(const Interval& interval) {
  std::string words;
  if (std::isfinite(interval.low)) words = (interval.low_included ? "at least " : "above ") + number_text(interval.low);
  if (std::isfinite(interval.high)) {
    if (!words.empty()) words += " and ";
    words += (interval.high_included ? "at most " : "below ") + number_text(interval.high);
  }
  return words;
}

}  // namespace

namespace {

double checked(double value, std::string_view text, const std::string& what, const Interval& interval) {
  if (!std::isfinite(value)) refuse(what, text, "is not a finite number");
  const bool above = interval.low_included ? value >= interval.low : value > interval.low;
  const bool below = interval.high_included ? value <= interval.high : value < interval.high;
  if (!above || !below) refuse(what, text, "must be " + describe(interval));
  return value;
}

}  // namespace

void check_number(double value, const std::string& what, const Interval& interval) {
  checked(value, number_text(value), what, interval);
}

double parse_number(std::string_view text, const std::string& what, const Interval& interval) {
  const std::string_view digits = without_plus(trimmed_text(text));
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range) refuse(what, text, "is too large or too small for a number");
  if (error != std::errc{} || end != digits.data() + digits.size() || digits.empty())
    refuse(what, text, "is not a number");
  return checked(value, text, what, interval);
}

std::uint64_t parse_count(std::string_view text, const std::string& what, std::uint64_t low, std::uint64_t high) {
  const std::string_view digits = without_plus(trimmed_text(text));
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool whole = error != std::errc::invalid_argument && end == digits.data() + digits.size();
  if (!whole) refuse(what, text, "is not a whole number");
  if (error == std::errc::result_out_of_range || value < low || value > high)
    refuse(what, text,
           high == std::numeric_limits<std::uint64_t>::max()
               ? "must be at least " + std::to_string(low) + " and fit in 64 bits"
               : "must lie between " + std::to_string(low) + " and " + std::to_string(high));
  return value;
}

bool parse_flag(std::string_view text, const std::string& what) {
  if (text != "true" && text != "false") refuse(what, text, "is neither true nor false");
  return text == "true";
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0;;) {
    const std::size_t end = text.find(separator, begin);
    parts.push_back(text.substr(begin, end == std::string_view::npos ? end : end - begin));
    if (end == std::string_view::npos) return parts;
    begin = end + 1;
  }
}

std::vector<double> parse_numbers(std::string_view text, const std::string& what, std::size_t fewest, std::size_t most,
                                  const Interval& interval) {
  const auto parts = split(text, ',');
  if (parts.size() < fewest || parts.size() > most)
    refuse(what, text,
           "must be " + std::to_string(fewest) + (most == fewest ? "" : " to " + std::to_string(most)) +
               (most == 1 ? " number" : " numbers with commas between them"));
  std::vector<double> values;
  for (const auto part : parts) values.push_back(parse_number(part, what, interval));
  return values;
}

CountRange parse_count_range(std::string_view text, const std::string& what, std::size_t low, std::size_t high) {
  const auto dots = text.find("..");
  if (dots == std::string_view::npos) {
    const std::size_t count = parse_count(text, what, low, high);
    return {count, count};
  }
  const CountRange range{parse_count(text.substr(0, dots), what, low, high),
                         parse_count(text.substr(dots + 2), what, low, high)};
  if (range.low > range.high) refuse(what, text, "must not fall: the smaller number comes first");
  return range;
}

std::uint64_t SampleSize::of(std::uint64_t population) const {
  if (voxels) return std::min(*voxels, population);
  return std::clamp<std::uint64_t>(static_cast<std::uint64_t>(std::llround(*share * static_cast<double>(population))),
                                   1, std::max<std::uint64_t>(population, 1));
}

SampleSize parse_sample(std::string_view text, const std::string& what) {
  constexpr Interval kSomeShare{.low = 0, .high = 1, .low_included = false};
  if (text.ends_with('%'))
    return {
        .voxels = std::nullopt,
        .share =
            parse_number(text.substr(0, text.size() - 1), what, {.low = 0, .high = 100, .low_included = false}) / 100};
  if (text.find('.') != std::string_view::npos)
    return {.voxels = std::nullopt, .share = parse_number(text, what, kSomeShare)};
  return {.voxels = parse_count(text, what, 1), .share = std::nullopt};
}

DeviceList parse_devices(std::string_view text, const std::string& what) {
  DeviceList list;
  for (const std::string_view part : split(text, ',')) {
    if (part == "all" || part == "cpu") {
      bool& given = part == "all" ? list.all : list.cpu;
      if (given) refuse(what, text, "names " + std::string(part) + " twice");
      given = true;
      continue;
    }
    if (part.empty() || part.find_first_not_of("+-0123456789 ") != std::string_view::npos)
      refuse(what, text, "is no list of devices: 0, or 0,1, or all, or any of them with cpu");
    const auto number = static_cast<std::uint32_t>(parse_count(part, what, 0, 0xFFFF));
    if (std::find(list.numbers.begin(), list.numbers.end(), number) != list.numbers.end())
      refuse(what, text, "names device " + std::to_string(number) + " twice");
    list.numbers.push_back(number);
  }
  if (list.all && !list.numbers.empty()) refuse(what, text, "names devices besides all of them");
  return list;
}

double parse_duration(std::string_view text, const std::string& what) {
  double unit = 1;
  std::string_view number = text;
  for (const auto& [suffix, seconds] :
       {std::pair<std::string_view, double>{"min", 60}, {"h", 3600}, {"m", 60}, {"s", 1}}) {
    if (!text.ends_with(suffix)) continue;
    unit = seconds;
    number.remove_suffix(suffix.size());
    break;
  }
  const std::string_view digits = without_plus(trimmed_text(number));
  double parsed = 0;
  if (digits.empty() || std::from_chars(digits.begin(), digits.end(), parsed).ptr != digits.end())
    refuse(what, text, "is no time; write a number and s, min or h: 90s, 15min or 2h");
  const double seconds = unit * parse_number(number, what, {.low = 1e-6});
  if (seconds > kAnySeconds.high) refuse(what, text, "must be at most " + number_text(kAnySeconds.high) + " seconds");
  return seconds;
}

double parse_clock(std::string_view text, const std::string& what) {
  constexpr unsigned kHours = 24, kMinutes = 60;
  const std::string_view clock = trimmed_text(text);
  const auto colon = clock.find(':');
  const auto digits = [](std::string_view part) -> std::optional<unsigned> {
    unsigned value = 0;
    if (part.empty() || part.size() > 2) return std::nullopt;
    const auto [end, error] = std::from_chars(part.begin(), part.end(), value);
    return error == std::errc() && end == part.end() ? std::optional(value) : std::nullopt;
  };
  if (colon != std::string_view::npos) {
    const auto hours = digits(clock.substr(0, colon)), minutes = digits(clock.substr(colon + 1));
    if (hours && minutes && clock.size() == colon + 3 && *minutes < kMinutes &&
        *hours * kMinutes + *minutes <= kHours * kMinutes)
      return *hours * kMinutes + *minutes;
  }
  refuse(what, text, "is no time of the day; write hours and minutes from 00:00 to 24:00, such as 06:30");
}

std::uint64_t parse_bytes(std::string_view text, const std::string& what) {
  std::string_view number = text;
  for (const std::string_view end : {"iB", "B"})
    if (number.ends_with(end)) {
      number.remove_suffix(end.size());
      break;
    }
  double unit = 1;
  constexpr std::string_view kPrefixes = "KMGT";
  if (const auto power = number.empty() ? std::string_view::npos : kPrefixes.find(number.back());
      power != std::string_view::npos) {
    unit = std::exp2(10.0 * static_cast<double>(power + 1));
    number.remove_suffix(1);
  }
  while (number.ends_with(' ')) number.remove_suffix(1);
  const double bytes = unit * parse_number(number, what, kPositive);
  if (!(bytes >= 1 && bytes < 0x1p63)) refuse(what, text, "is no number of bytes");
  return static_cast<std::uint64_t>(bytes);
}

}  // namespace vantage
