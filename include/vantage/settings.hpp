// SPDX-License-Identifier: Apache-2.0
/// Configurations as lists of named values. `settings()` of a struct lists each field once; results, checkpoints and
/// configuration files use that list.
#pragma once

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

}  // namespace vantage
