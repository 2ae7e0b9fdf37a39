// SPDX-License-Identifier: Apache-2.0
#include "vantage/placement.hpp"

namespace vantage {

std::string to_string(StationStatus status) {
  switch (status) {
    case StationStatus::ok: return "ok";
    case StationStatus::hole: return "hole";
    case StationStatus::clash: return "clash";
  }
  return "unknown";
}

}  // namespace vantage
