// SPDX-License-Identifier: Apache-2.0
// Makes a table of settings, one call per row.
#pragma once

#include <array>
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

// The help of a setting with its default.
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
  // These change the last row.
  SettingRows& by_scene() { return last().by_scene = true, *this; }
  SettingRows& by_preset() { return last().by_preset = true, *this; }
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
    return optional(
        std::move(name), std::move(unit), std::move(help), member,
        [interval](const std::string& text, const std::string& what) { return parse_number(text, what, interval); });
  }
  // A number that is never empty; the help tells its default.
  SettingRows& number(std::string name, std::string unit, const std::string& help, double Options::*member,
                      Interval interval) {
    return custom(std::move(name), std::move(unit), otherwise(help, Options().*member),
                  [member, interval](Options& options, const std::string& text, const std::string& what) {
                    options.*member = parse_number(text, what, interval);
                  });
  }
  SettingRows& degrees(std::string name, std::string help, Member<Angle> member, Interval interval) {
    return optional(std::move(name), "DEG", std::move(help), member,
                    [interval](const std::string& text, const std::string& what) {
                      return Angle::degrees(parse_number(text, what, interval));
                    });
  }
  // At least `fewest` numbers; the last one is repeated for those missing.
  template <std::size_t N>
  SettingRows& numbers(std::string name, std::string unit, std::string help, Member<std::array<double, N>> member,
                       std::size_t fewest, Interval interval) {
    return optional(std::move(name), std::move(unit), std::move(help), member,
                    [fewest, interval](const std::string& text, const std::string& what) {
                      const auto values = parse_numbers(text, what, fewest, N, interval);
                      std::array<double, N> all{};
                      for (std::size_t k = 0; k < N; ++k) all[k] = values[std::min(k, values.size() - 1)];
                      return all;
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
    return custom(std::move(name), std::move(unit), std::move(help),
                  [member, low, high](Options& options, const std::string& text, const std::string& what) {
                    options.*member = static_cast<Integer>(parse_count(text, what, low, high));
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
      last().group = row.group, last().repeated = row.repeated, last().excludes = row.excludes;
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
