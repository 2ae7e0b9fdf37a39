// SPDX-License-Identifier: Apache-2.0
/// Time of a survey on site: scanning, setting up, and walking from station to station in a good order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "vantage/placement.hpp"
#include "vantage/scanner.hpp"
#include "vantage/settings.hpp"

namespace vantage {

/// Times of a person with a tripod. These are our assumptions, each with a setting; crews differ by more than scanners.
struct OnSiteOptions {
  /// Minutes at each station besides the scan: tripod, levelling, settings, stepping out of view, packing up.
  double set_up_min = 3;
  double photos_min = 0;         ///< At each station for pictures, where the scanner takes some.
  double walking_m_per_s = 0.8;  ///< With scanner and tripod in hand.
  /// Length of a path that the search area does not connect, in straight lines between its ends.
  double detour = 1.5;
  /// Ground where people enter and leave; empty: at the station nearest to where a search area found on foot is
  /// entered, else at the first.
  std::optional<Vec3> entrance = std::nullopt;
  /// Minutes of the longest session, from the entrance and back: a longer round is split. Empty: it is not.
  std::optional<double> day_min = std::nullopt;
  std::size_t crews = 1;  ///< Crews that work side by side, a session each, every day.
};

Settings settings(const OnSiteOptions& options);
/// One row for each setting that users give, and its bounds.
const SettingTable<OnSiteOptions>& on_site_settings();

/// One round: in at the entrance, to every station, and back out.
struct Round {
  std::vector<std::size_t> order;  ///< Indices of the stations; unusable ones are left out.
  std::vector<double> arrive_min;  ///< Minutes from the start to the arrival at each, in that order.
  std::vector<double> stay_min;    ///< Minutes at each: scan, set-up and photos.
  std::vector<double> legs_m;      ///< Path to each in that order, then back out: one more than stations.
  /// Ground points of each of these paths, survey frame; a straight line if the search area does not connect its ends.
  std::vector<std::vector<Vec3>> paths;
  double walk_m = 0;
  double scan_min = 0, set_up_min = 0, photos_min = 0, walk_min = 0;
  double minutes = 0;           ///< Scan, set-up, photos and walking together.
  std::size_t unconnected = 0;  ///< Legs that the search area does not connect: `detour` times the straight line.
  std::size_t unlinked = 0;     ///< Stations without a link to the one before; 0 if links were not given.
};

/// Consecutive stations of a longer round, as a round of their own that one crew does within a day.
struct Session : Round {
  std::size_t day = 1, crew = 1;  ///< Both from 1.
  std::size_t parts = 1;          ///< Groups of its stations that no link connects; 1 if links were not given.
  bool linked = true;             ///< Some station is linked to one of another session, if there is one.
};

/// The round over all stations.
struct Visit : Round {
  double day_min = 0;             ///< `OnSiteOptions::day_min` of the sessions; 0: none were asked for.
  std::vector<Session> sessions;  ///< In the order of the round, by day and crew; empty: none, or not asked for.
  std::string not_split;          ///< What keeps the round from being split into sessions; empty: nothing.
};

/// Strength of the link between two stations, by their indices: 0 if they are not linked, else at most 1.
using LinkStrength = std::function<double(std::size_t, std::size_t)>;

/// Paths over a site, and the time of a round; made by `Site::on_site()`. A graph of at most some 20 000 places lies
/// over the search area, 0.25 m apart or more. Links connect neighbours that are free at knee and hip height. Safe to
/// read from any thread; copies share storage.
class OnSite {
 public:
  /// Metres from one ground point to another along the search area; empty if it does not connect them. Throws Error
  /// invalid_argument for a point that is not within 1000 km of the scene.
  std::optional<double> way_m(const Vec3& from, const Vec3& to) const;
  /// The ground points of such a way, from one end to the other; none if the search area does not connect them. Throws
  /// as way_m().
  std::vector<Vec3> way(const Vec3& from, const Vec3& to) const;
  /// Two of some points, and a length of the way between them.
  struct Way {
    std::size_t a = 0, b = 0;
    double metres = 0;
  };
  /// Tells whether the way between two points is longer than a length, for each of many: much faster than way_m() of
  /// each. 0 if the search area does not connect them. Throws as way_m().
  std::vector<std::uint8_t> longer(std::span<const Vec3> points, std::span<const Way> than) const;
  /// Orders the stations by nearest neighbour, then improves the order by reversing parts of it (2-opt) and moving up
  /// to three stations elsewhere (Or-opt), until neither helps. With `link`, consecutive stations are linked as far as
  /// the links allow by a walk that is at most 1.25 times as long, and takes `most_min` or less. The round is begun at
  /// the end that is nearer to the entrance. Throws Error invalid_argument for a station that is not within 1000 km of
  /// the scene, and std::out_of_range for a scanner that does not exist.
  Visit visit(std::span<const PlacedStation> stations, const LinkStrength& link = {},
              double most_min = std::numeric_limits<double>::infinity()) const;
  /// Cuts a visit of these stations into sessions of at most `OnSiteOptions::day_min`: as few as its order allows.
  /// Among these cuts that one is taken whose sessions fall into the fewest parts, then the one with the fewest
  /// sessions that are not linked, then with the shortest longest session, then with the least walking. A visit without
  /// stations, or options without a day, give none. Throws Error invalid_argument if a day is too short for one station
  /// and the walk there and back.
  std::vector<Session> sessions(std::span<const PlacedStation> stations, const Visit& visit,
                                const LinkStrength& link = {}) const;
  /// `Scanner::rays()` / `Scanner::points_per_second`, in minutes. Throws std::out_of_range.
  double minutes_per_scan(std::uint32_t scanner = 0) const;
  const OnSiteOptions& options() const noexcept;

 private:
  friend class Site;
  OnSite(const SearchArea& area, const ClashChecker& clash, std::span<const Scanner> scanners,
         const OnSiteOptions& options, const Vec3& origin);

  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

}  // namespace vantage
