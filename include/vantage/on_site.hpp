// SPDX-License-Identifier: Apache-2.0
/// What a survey takes on site: scanning, setting up, and walking from station to station in a good order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "vantage/placement.hpp"
#include "vantage/scanner.hpp"
#include "vantage/settings.hpp"

namespace vantage {

/// What a person with a tripod takes. Assumptions of ours, each with an option: what a crew really takes differs by
/// more than by scanner.
struct OnSiteOptions {
  /// At each station besides the scan itself: tripod, levelling, settings, stepping out of view, packing up.
  double set_up_min = 3;
  double walking_m_per_s = 0.8;  ///< With scanner and tripod in hand.
  /// Of ways that the search area does not connect, what the way is longer than the straight line.
  double detour = 1.5;
  std::optional<Vec3> entrance = std::nullopt;  ///< Ground where one enters and leaves; empty: at the first station.
};

Settings settings(const OnSiteOptions& options);

/// One round: in at the entrance, to every station, and back out.
struct Visit {
  std::vector<std::size_t> order;  ///< Of the stations, by index; those that cannot be used are left out.
  std::vector<double> legs_m;      ///< The way to each in that order, then back out: one more than stations.
  double walk_m = 0;
  double scan_min = 0, set_up_min = 0, walk_min = 0;
  double minutes = 0;           ///< All three together.
  std::size_t unconnected = 0;  ///< Legs that the search area does not connect: `detour` times the straight line.
};

/// Ways over a site, and the time of a round. Safe to read from any thread; copies share storage.
class OnSite {
 public:
  /// Lays a graph of some 20 000 places at most over the search area, 0.25 m apart or more, its links between
  /// neighbours that see each other at hip height. Throws Error invalid_argument (an option out of its range).
  OnSite(const SearchArea& area, const ClashChecker& clash, const Scanner& scanner, const OnSiteOptions& options = {});
  /// With several scanners, which stations choose from by `StationSetup::scanner`. Throws as above, and Error
  /// invalid_argument for none.
  OnSite(const SearchArea& area, const ClashChecker& clash, std::span<const Scanner> scanners,
         const OnSiteOptions& options = {});

  /// Metres from one ground point to another along the search area; empty where it does not connect them.
  std::optional<double> way_m(const Vec3& from, const Vec3& to) const;
  /// The order by nearest neighbour, made better by turning parts of it round (2-opt) and moving up to three stations
  /// elsewhere (Or-opt) until neither helps. Throws std::out_of_range for a scanner that is not there.
  Visit visit(std::span<const PlacedStation> stations) const;
  /// `Scanner::rays()` at `Scanner::points_per_second`. Throws std::out_of_range.
  double minutes_per_scan(std::uint32_t scanner = 0) const;
  const OnSiteOptions& options() const noexcept;

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

}  // namespace vantage
