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
#include <string>
#include <vector>

#include "vantage/placement.hpp"
#include "vantage/scanner.hpp"
#include "vantage/settings.hpp"

namespace vantage {

/// Hours of every day outside of which nobody may scan in some rooms.
struct AccessWindow {
  std::string rooms;  ///< Pattern of their names, as for meshes in `captured()`: "hall*", "!hall*", "hall*|archive".
  /// Minutes after midnight. An end at or before the begin is of the next day; 0 to 1440 is all day.
  double from_min = 0, to_min = 0;
};
/// Reads "hall*=06:00-08:00". Throws Error invalid_argument; the message begins with `what`.
AccessWindow parse_access_window(const std::string& text, const std::string& what = "window");
std::string to_string(const AccessWindow& window);  ///< As it is read.

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
  std::size_t crews = 1;          ///< Crews that work side by side, a session each, every day.
  double day_start_min = 8 * 60;  ///< Minutes after midnight at which the crews' day begins, at the entrance.
  /// Hours of rooms, with a day. A station in a room that several name is scanned within one of these.
  std::vector<AccessWindow> windows = {};
};

/// Its members as named values, for results and configuration files.
Settings settings(const OnSiteOptions& options);
/// One row for each setting that users give, and its bounds.
const SettingTable<OnSiteOptions>& on_site_settings();

/// Charged batteries that an instrument takes. It is on from the begin of its first stay to the end of its last, on the
/// ways between them too, and off while a crew waits; a battery is changed between stations.
struct BatteryUse {
  std::string instrument;     ///< `Scanner::name` without a setting: settings of one scanner share batteries.
  double battery_min = 0;     ///< `Scanner::battery_min`.
  double battery_scans = 0;   ///< `Scanner::battery_scans`.
  double on_min = 0;          ///< Minutes with the scanner on.
  std::size_t scans = 0;      ///< Scans of the instrument.
  std::size_t batteries = 0;  ///< Charged batteries for these minutes and scans.
  std::size_t in_a_day = 0;   ///< The most in one day, of all crews; those of a round that is not split.
};

/// One round: in at the entrance, to every station, and back out.
struct Round {
  std::vector<std::size_t> order;  ///< Indices of the stations; unusable ones are left out.
  std::vector<double> arrive_min;  ///< Minutes from the start until the stay at each begins, in that order.
  std::vector<double> stay_min;    ///< Minutes at each: scan, set-up and photos.
  std::vector<double> legs_m;      ///< Path to each in that order, then back out: one more than stations.
  /// Ground points of each of these paths, survey frame; a straight line if the search area does not connect its ends.
  std::vector<std::vector<Vec3>> paths;
  double walk_m = 0;                                                  ///< All of `legs_m` together, metres.
  double scan_min = 0, set_up_min = 0, photos_min = 0, walk_min = 0;  ///< Minutes of each, over the whole round.
  double minutes = 0;           ///< Scan, set-up, photos, walking and waiting together.
  std::size_t unconnected = 0;  ///< Legs that the search area does not connect: `detour` times the straight line.
  std::size_t unlinked = 0;     ///< Stations without a link to the one before; 0 if links were not given.
  /// One of each instrument that states how long a battery lasts, in the order of scanners.
  std::vector<BatteryUse> batteries = {};
};

/// Stations of a longer round, as a round of their own that one crew does within a day: consecutive ones, unless access
/// windows say otherwise.
struct Session : Round {
  std::size_t day = 1, crew = 1;  ///< Both from 1.
  std::size_t parts = 1;          ///< Groups of its stations that no link connects; 1 if links were not given.
  bool linked = true;             ///< Some station is linked to one of another session, if there is one.
  double start_min = 0;           ///< Minutes after midnight at which it leaves the entrance.
  std::vector<double> wait_min;   ///< Minutes waited for an access window before the stay at each.
  double waiting_min = 0;         ///< All of these.
};

/// A station of a visit that no session can scan within the access windows of its room.
struct ClosedStation {
  std::size_t station = 0;  ///< As in `Round::order`.
  std::string why;          ///< Reason, and the change that would help, for people.
};

/// The round over all stations.
struct Visit : Round {
  double day_min = 0;                 ///< `OnSiteOptions::day_min` of the sessions; 0: none were asked for.
  std::vector<Session> sessions;      ///< In the order of the round, by day and crew; empty: none, or not asked for.
  std::string not_split;              ///< Reason why the round cannot be split into sessions; empty: there is none.
  std::vector<ClosedStation> closed;  ///< Stations in no session, since none can keep their access windows.
  std::size_t bound = 0;              ///< Stations that access windows are for.
};

/// Batteries that a visit takes: of its sessions, each of which begins with charged ones, together; else of its round.
std::vector<BatteryUse> batteries_of(const Visit& visit);

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
  /// Two of some points, by their indices, and a length of the way between them in metres.
  struct Way {
    std::size_t a = 0, b = 0;  ///< Indices of the points.
    double metres = 0;         ///< Length that is compared with.
  };
  /// Tells whether the way between two points is longer than a length, for each of many: much faster than way_m() of
  /// each. 0 if the search area does not connect them. Throws as way_m().
  std::vector<std::uint8_t> longer(std::span<const Vec3> points, std::span<const Way> than) const;
  /// Orders the stations by nearest neighbour, then improves the order by reversing parts of it (2-opt) and moving up
  /// to three stations elsewhere (Or-opt), until neither helps. With `link`, consecutive stations are linked as far as
  /// the links allow by a walk that is at most 1.3 times as long, and takes `most_min` or less. The round is begun at
  /// the end that is nearer to the entrance. Throws Error invalid_argument for a station that is not within 1000 km of
  /// the scene, and std::out_of_range for a scanner that does not exist.
  Visit visit(std::span<const PlacedStation> stations, const LinkStrength& link = {},
              double most_min = std::numeric_limits<double>::infinity()) const;
  /// Cuts a visit of these stations into sessions of at most `OnSiteOptions::day_min`: as few as its order allows.
  /// Among these cuts it takes the one whose sessions have the fewest components in all, then the fewest unlinked
  /// sessions, then the shortest longest session, then the least walking. A visit without stations, or options without
  /// a day, give none. With access windows, stations that have one come first: a session takes as many of them as fit
  /// in a day, by cheapest insertion. It then takes others, each time the one that adds the fewest minutes, and leaves
  /// the entrance as late as that allows. The remaining stations are cut as above. Stations whose windows no session
  /// can keep are in none (`add_windows`). Throws Error invalid_argument if a day is too short for one station and the
  /// walk there and back.
  std::vector<Session> sessions(std::span<const PlacedStation> stations, const Visit& visit,
                                const LinkStrength& link = {}) const;
  /// Sets `Visit::closed` and `bound` of a visit of these stations, if the options have a day and access windows.
  void add_windows(std::span<const PlacedStation> stations, Visit& visit) const;
  /// `Scanner::rays()` / `Scanner::points_per_second`, in minutes. Throws std::out_of_range.
  double minutes_per_scan(std::uint32_t scanner = 0) const;
  const OnSiteOptions& options() const noexcept;  ///< Options in force.

 private:
  friend class Site;
  /// Access windows of a place on the ground, by their indices.
  using WindowsAt = std::function<std::vector<std::size_t>(const Vec3&)>;
  OnSite(const SearchArea& area, const ClashChecker& clash, std::span<const Scanner> scanners,
         const OnSiteOptions& options, const Vec3& origin, WindowsAt windows_at);

  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

}  // namespace vantage
