// SPDX-License-Identifier: Apache-2.0
// Facts about each station and target that a crew needs.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "report/report.hpp"
#include "report/wall_corners.hpp"

namespace vantage {

struct StationFacts {
  std::string name;
  std::size_t visit = 0;                 // its place in the round, from 1; 0: it is not visited
  std::size_t stop = 0;                  // the same in its session; in the round if there are no sessions
  double walk_m = 0, done_min = 0;       // the way to it, and the time since the start once it is scanned
  std::string done_at = {};              // time of day then, in a session; else ""
  std::vector<WallCorner> corners = {};  // two that locate its spot, by `WallCorners::nearest`
  double alone = 0;                      // share of the surveyed surface that it alone sees; 0: none, or not known
  std::string alone_where = {};          // the rooms, or meshes, with most of that
  // Scan that its own is to be registered to, if it has no link to the one before: "register to S3". It has the
  // strongest link to that.
  std::string register_to = {};
  std::string targets = {};  // that it measures: "T1, T3"
  std::string set_up = {};   // by known points, "resection from 3", if they allow it
  std::string note = {};     // "there before", what is wrong with its place, or nothing
};

struct TargetFacts {
  std::vector<WallCorner> corners = {};  // that locate its spot
  std::string kind = {};                 // "proposed", "there before", "check of …"; of a control point "± 2 mm"
  std::string stations = {};             // that measure it, and how far they are in plan: "S1 6.61, S4 7.02"
};
// Returns the facts of all targets of the answer, in their order.
std::vector<TargetFacts> target_facts(const Report& report, const Simulator& simulator);

// Returns the facts of all stations of the answer, in their order.
std::vector<StationFacts> station_facts(const Report& report, const Simulator& simulator);

// A round that a crew takes on its own sheets: all of it, or a session.
struct SheetRound {
  const Round* round = nullptr;            // borrowed from the network; null: none is known
  std::string name = {};                   // "Day 1, crew 2" of a session
  std::vector<std::size_t> stations = {};  // in its order, by their places in the network
  std::optional<double> start_min = {};    // of a session, minutes after midnight
};
// The sessions of a network, else its round, else one without any.
std::vector<SheetRound> sheet_rounds(const Evaluation& network);

// The text on a session's links: "within, and to others", "in 2 parts; to no other session".
std::string session_links(const Session& session, const Evaluation& network);

// "2"; for several instruments "2 of Leica RTC360, 1 of Trimble X7"; empty if battery life is not known.
std::string batteries_text(const Round& round);

// Stations by their place in the round, the others behind them.
std::vector<std::size_t> visiting_order(const std::vector<StationFacts>& facts);

// "4.84 + wall 0.51": the distances to a station's corners.
std::string tape_text(const std::vector<WallCorner>& corners);
// "1 h 5 min", "20 s".
std::string minutes_text(double minutes);

}  // namespace vantage
