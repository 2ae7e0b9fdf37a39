// SPDX-License-Identifier: Apache-2.0
// Makes a table of settings, one call per row.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/parse.hpp"
#include "vantage/error.hpp"
#include "vantage/settings.hpp"
#include "vantage/types.hpp"

namespace vantage {

// Returns degrees without the rounding of radians, so that 360 is not above 360.
inline double whole_degrees(Angle angle) {
  const double degrees = angle.in_degrees();
  return std::abs(degrees) < 1e3 ? std::round(degrees * 1e12) / 1e12 : degrees;
}

// Returns the help of a setting with its default.
inline std::string otherwise(const std::string& help, double usual) {
  std::array<char, 32> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.6g", usual);
  return help + "; " + buffer.data() + " otherwise";
}

template <class Options>
class SettingRows {
 public:
  using Row = SettingRow<Options>;
  template <class Value>
  using Member = std::optional<Value> Options::*;

  // Starts a group: the next rows have this heading.
  SettingRows& group(std::string name) {
    group_ = std::move(name);
    return *this;
  }
  // These functions change the last row.
  SettingRows& by_scene() { return last().by_scene = true, *this; }
  SettingRows& advanced() { return last().advanced = true, *this; }
  SettingRows& by_preset() { return last().by_preset = true, *this; }
  SettingRows& checked(std::function<void(const Options&, const std::string& what)> check) {
    return last().check = std::move(check), *this;
  }
  SettingRows& excludes(std::vector<std::string> names) { return last().excludes = std::move(names), *this; }

  template <class Set>
  SettingRows& custom(std::string name, std::string unit, std::string help, Set set,
                      std::function<bool(const Options&)> given = {}) {
    Row row;
    row.name = std::move(name), row.unit = std::move(unit), row.help = std::move(help), row.group = group_;
    row.set = std::move(set), row.given = std::move(given);
    rows_.push_back(std::move(row));
    return *this;
  }
  SettingRows& number(std::string name, std::string unit, std::string help, Member<double> member, Interval interval) {
    optional(
        std::move(name), std::move(unit), std::move(help), member,
        [interval](const std::string& text, const std::string& what) { return parse_number(text, what, interval); });
    return checked([member, interval](const Options& options, const std::string& what) {
      if (options.*member) check_number(*(options.*member), what, interval);
    });
  }
  // A number that is never empty; the help tells its default.
  SettingRows& number(std::string name, std::string unit, const std::string& help, double Options::*member,
                      Interval interval) {
    const auto value = [member](Options& options) -> double& { return options.*member; };
    return number_in(std::move(name), std::move(unit), otherwise(help, Options().*member), value, interval);
  }
  // `value` returns the options' number by reference.
  template <class Value>
  SettingRows& number_in(std::string name, std::string unit, std::string help, Value value, Interval interval) {
    custom(std::move(name), std::move(unit), std::move(help),
           [value, interval](Options& options, const std::string& text, const std::string& what) {
             value(options) = parse_number(text, what, interval);
           });
    return checked([value, interval](const Options& options, const std::string& what) {
      check_number(value(const_cast<Options&>(options)), what, interval);
    });
  }
  SettingRows& degrees(std::string name, std::string help, Angle Options::*member, Interval interval) {
    custom(std::move(name), "DEG", std::move(help),
           [member, interval](Options& options, const std::string& text, const std::string& what) {
             options.*member = Angle::degrees(parse_number(text, what, interval));
           });
    return checked([member, interval](const Options& options, const std::string& what) {
      check_number(whole_degrees(options.*member), what, interval);
    });
  }
  SettingRows& degrees(std::string name, std::string help, Member<Angle> member, Interval interval) {
    optional(std::move(name), "DEG", std::move(help), member,
             [interval](const std::string& text, const std::string& what) {
               return Angle::degrees(parse_number(text, what, interval));
             });
    return checked([member, interval](const Options& options, const std::string& what) {
      if (options.*member) check_number(whole_degrees(*(options.*member)), what, interval);
    });
  }
  // At least `fewest` numbers; the last one is repeated for those missing.
  template <std::size_t N>
  SettingRows& numbers(std::string name, std::string unit, std::string help, Member<std::array<double, N>> member,
                       std::size_t fewest, Interval interval) {
    optional(std::move(name), std::move(unit), std::move(help), member,
             [fewest, interval](const std::string& text, const std::string& what) {
               const auto values = parse_numbers(text, what, fewest, N, interval);
               std::array<double, N> all{};
               for (std::size_t k = 0; k < N; ++k) all[k] = values[std::min(k, values.size() - 1)];
               return all;
             });
    return checked([member, interval](const Options& options, const std::string& what) {
      if (options.*member)
        for (const double value : *(options.*member)) check_number(value, what, interval);
    });
  }
  SettingRows& text(std::string name, std::string unit, std::string help, Member<std::string> member) {
    return optional(std::move(name), std::move(unit), std::move(help), member,
                    [](const std::string& text, const std::string&) { return text; });
  }
  template <class Value, class Parse>
  SettingRows& optional(std::string name, std::string unit, std::string help, Member<Value> member, Parse parse) {
    return custom(
        std::move(name), std::move(unit), std::move(help),
        [member, parse](Options& options, const std::string& text, const std::string& what) {
          options.*member = parse(text, what);
        },
        [member](const Options& options) { return (options.*member).has_value(); });
  }
  template <class Integer>
  SettingRows& count(std::string name, std::string unit, std::string help, Integer Options::*member, std::uint64_t low,
                     std::uint64_t high) {
    custom(std::move(name), std::move(unit), std::move(help),
           [member, low, high](Options& options, const std::string& text, const std::string& what) {
             options.*member = static_cast<Integer>(parse_count(text, what, low, high));
           });
    // A default may lie outside: 0 for a number that is chosen.
    return checked([member, low, high](const Options& options, const std::string& what) {
      if (options.*member != Options().*member) parse_count(std::to_string(options.*member), what, low, high);
    });
  }
  SettingRows& flag(std::string name, std::string help, bool Options::*member) {
    return custom(std::move(name), "", std::move(help),
                  [member](Options& options, const std::string& text, const std::string& what) {
                    options.*member = parse_flag(text, what);
                  });
  }
  // `parse` returns an element of the options' list `values`.
  template <class Values, class Parse>
  SettingRows& repeated(std::string name, std::string unit, std::string help, Values values, Parse parse) {
    custom(
        std::move(name), std::move(unit), std::move(help),
        [values, parse](Options& options, const std::string& text, const std::string& what) {
          values(options).push_back(parse(text, what));
        },
        [values](const Options& options) { return !values(const_cast<Options&>(options)).empty(); });
    last().repeated = true;
    return *this;
  }
  template <class Values>
  SettingRows& texts(std::string name, std::string unit, std::string help, Values values) {
    return repeated(std::move(name), std::move(unit), std::move(help), values,
                    [](const std::string& text, const std::string&) { return text; });
  }

  // Adds the rows of another table, whose options are the member `part`.
  template <class Part>
  SettingRows& include(const SettingTable<Part>& rows, Part Options::*part) {
    for (const SettingRow<Part>& row : rows) {
      std::function<bool(const Options&)> given;
      if (row.given) given = [part, inner = row.given](const Options& options) { return inner(options.*part); };
      custom(
          row.name, row.unit, row.help,
          [part, inner = row.set](Options& options, const std::string& text, const std::string& what) {
            inner(options.*part, text, what);
          },
          std::move(given));
      if (row.check)
        last().check = [part, inner = row.check](const Options& options, const std::string& what) {
          inner(options.*part, what);
        };
      last().group = row.group, last().repeated = row.repeated, last().excludes = row.excludes;
      last().advanced = row.advanced;
    }
    return *this;
  }

  SettingTable<Options> take() { return std::move(rows_); }

 private:
  Row& last() { return rows_.back(); }

  std::string group_;
  SettingTable<Options> rows_;
};

// Calls `read`, and prefixes its messages with `what`.
template <class Read>
auto named(const std::string& what, Read&& read) {
  try {
    return read();
  } catch (const Error& error) {
    throw Error(error.code(), what + ": " + error.what());
  }
}

}  // namespace vantage
