// SPDX-License-Identifier: Apache-2.0
/// Configurations as lists of named values: each field is listed once, in `settings()` of its struct, and what is made
/// of all of them (results, checkpoints, configuration files) goes by that list.
#pragma once

#include <string>
#include <vector>

namespace vantage {

/// One field of a configuration.
struct Setting {
  std::string name;  ///< "azimuth_step_deg": its key in results.
  std::string json;  ///< Its value as JSON text, to the last bit.
  /// The option of the program that sets it, without dashes; empty: none, or nothing is set. Neighbours that share one
  /// are its values in order.
  std::string option = {};
  /// Whether another value can change what a search finds. Limits, places and devices cannot, so a run may be resumed
  /// under others.
  bool decides = true;
};
using Settings = std::vector<Setting>;

}  // namespace vantage
