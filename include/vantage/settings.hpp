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
  /// Option of the program that sets it, without dashes; empty: none, or not set. Neighbours that share one are its
  /// values in order.
  std::string option = {};
  /// Whether another value can change what a search finds. Limits, places and devices cannot, so a run may be resumed
  /// under others.
  bool decides = true;
};
using Settings = std::vector<Setting>;

/// One setting of a struct of options, described once. The command line, configuration files, the defaults that a scene
/// carries and the keyword arguments of Python are made from these rows.
template <class Options>
struct SettingRow {
  std::string name;   ///< Its keyword, words parted by dashes: "user-size".
  std::string unit;   ///< How a value looks: "M", "DEG[,DEG]". Empty: a switch, "true" or "false".
  std::string help;   ///< One sentence, with what holds where nothing is given.
  std::string group;  ///< The heading that it stands under.
  /// Reads a value, or adds one where the setting is repeated. Throws Error invalid_argument, with `what` in front.
  std::function<void(Options&, const std::string& text, const std::string& what)> set;
  std::function<bool(const Options&)> given;  ///< Whether somebody gave it a value. Empty: it always has one.
  bool repeated = false;                      ///< Takes any number of values, each given on its own.
  bool by_scene = false;                      ///< A scene may carry a default for it.
  bool by_preset = false;                     ///< A scanner's preset says it, so that a scene's default does not hold.
  std::vector<std::string> excludes = {};     ///< Settings that it cannot be given together with.
};
template <class Options>
using SettingTable = std::vector<SettingRow<Options>>;

/// A sample of voxels: a number of them or a share.
struct SampleSize {
  std::optional<std::uint64_t> voxels = {};
  std::optional<double> share = {};  ///< Above 0, at most 1.
  /// The number, of so many: at most all, of a share at least one.
  std::uint64_t of(std::uint64_t population) const;
};

/// Devices as users list them: all, some by their number, the processor.
struct DeviceList {
  bool all = false, cpu = false;
  std::vector<std::uint32_t> numbers = {};
};

}  // namespace vantage
