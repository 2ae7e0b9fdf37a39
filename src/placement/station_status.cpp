// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "vantage/placement.hpp"

namespace vantage {

std::string to_string(StationStatus status) {
  switch (status) {
    case StationStatus::ok: return "ok";
    case StationStatus::hole: return "hole";
    case StationStatus::clash: return "clash";
    case StationStatus::inside: return "inside";
    case StationStatus::off_ground: return "off_ground";
    case StationStatus::outside: return "outside";
  }
  return "unknown";
}

std::string explain(StationStatus status) {
  switch (status) {
    case StationStatus::ok: return "";
    case StationStatus::hole: return "has no ground under its (u, v)";
    case StationStatus::clash:
      return "clashes: something stands within its security volume, or touches its mast or head";
    case StationStatus::inside: return "is inside something solid";
    case StationStatus::off_ground:
      return "is off the ground: nothing to stand on at the scanner's height below its head";
    case StationStatus::outside: return "is outside of the search area";
  }
  return "";
}

std::string to_string(LeftOutReason reason) {
  switch (reason) {
    case LeftOutReason::unreachable: return "not reachable (roofs, furniture, tops of walls)";
    case LeftOutReason::sealed: return "sealed, no opening leads there";
    case LeftOutReason::narrow: return "too narrow";
    case LeftOutReason::headroom: return "no headroom";
    case LeftOutReason::limits: return "outside of the levels and regions asked for";
    case LeftOutReason::small: return "too small";
  }
  return "unknown";
}

std::string to_string(Bar bar) {
  switch (bar) {
    case Bar::door: return "door";
    case Bar::headroom: return "headroom";
    case Bar::climb: return "climb";
    case Bar::step: return "step";
    case Bar::no_way: return "no_way";
  }
  return "unknown";
}

std::string to_string(ClosedKind kind) {
  switch (kind) {
    case ClosedKind::room: return "room";
    case ClosedKind::ground: return "ground";
    case ClosedKind::attic: return "attic";
    case ClosedKind::top: return "top";
    case ClosedKind::hollow: return "hollow";
    case ClosedKind::low: return "low";
  }
  return "unknown";
}

std::size_t existing_count(std::span<const PlacedStation> stations) {
  return static_cast<std::size_t>(std::ranges::count(stations, true, &PlacedStation::existing));
}

bool active(const PlacedStation& station) {
  switch (station.status) {
    case StationStatus::ok:
    case StationStatus::off_ground:
    case StationStatus::outside: return true;
    case StationStatus::clash: return station.existing;
    case StationStatus::hole:
    case StationStatus::inside: return false;
  }
  return false;
}

}  // namespace vantage
