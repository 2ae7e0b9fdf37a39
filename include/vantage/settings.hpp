// SPDX-License-Identifier: Apache-2.0
/// Configurations as lists of named values. `settings()` of a struct lists each field once; results, checkpoints and
/// configuration files use that list.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace vantage {

/// One field of a configuration.
struct Setting {
  std::string name;  ///< "azimuth_step_deg": key in results.
  std::string json;  ///< Value as JSON text, to the last bit.
  /// Option of the program that sets it, without dashes; empty: none, or not set. Neighbours with the same option are
  /// its values in order.
  std::string option = {};
  /// True if another value can change the result of a search. Limits, places and devices cannot, so a run may be
  /// resumed with others.
  bool decides = true;
};
/// A configuration, field by field.
using Settings = std::vector<Setting>;

/// One setting of a struct of options, described once. The command line, configuration files, a scene's defaults and
/// Python's keyword arguments are made from these rows.
template <class Options>
struct SettingRow {
  std::string name;   ///< Its keyword, words separated by dashes: "user-size".
  std::string unit;   ///< Form of a value: "M", "DEG[,DEG]". Empty: a switch, "true" or "false".
  std::string help;   ///< One sentence, with the default.
  std::string group;  ///< Heading above it.
  /// Reads a value, or adds one if the setting is repeated. Throws Error invalid_argument; the message begins with
  /// `what`.
  std::function<void(Options&, const std::string& text, const std::string& what)> set;
  /// Throws Error invalid_argument, as `set` does, if the options hold a value that `set` does not read. Empty: it
  /// reads every value of the type.
  std::function<void(const Options&, const std::string& what)> check = {};
  std::function<bool(const Options&)> given;  ///< True if the user gave it a value. Empty: it always has one.
  bool repeated = false;                      ///< Takes any number of values, each given on its own.
  bool by_scene = false;                      ///< A scene may carry a default for it.
  bool by_preset = false;                     ///< A scanner's preset gives it, which overrides a scene's default.
  bool advanced = false;                      ///< For special cases: lists of settings may leave it out.
  std::vector<std::string> excludes = {};     ///< Settings that exclude it.
};
/// The rows of all settings of a struct, in the order in which they are listed.
template <class Options>
using SettingTable = std::vector<SettingRow<Options>>;

/// Throws Error invalid_argument with the first setting that is out of its range, and its value.
template <class Options>
void check_settings(const SettingTable<Options>& table, const Options& options) {
  for (const SettingRow<Options>& row : table)
    if (row.check) row.check(options, row.name);
}

/// A sample of voxels: a number of them or a share.
struct SampleSize {
  std::optional<std::uint64_t> voxels = {};  ///< A number of them.
  std::optional<double> share = {};          ///< Above 0, at most 1.
  /// Number of voxels out of `population`: at most all, and for a share at least one.
  std::uint64_t of(std::uint64_t population) const;
};

/// Devices as users list them: all, some by their number, the processor.
struct DeviceList {
  bool all = false, cpu = false;            ///< All graphics cards; the processor.
  std::vector<std::uint32_t> numbers = {};  ///< Numbers of graphics cards (`EngineInfo::device_index`).
};

}  // namespace vantage
