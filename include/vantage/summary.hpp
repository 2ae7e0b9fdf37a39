// SPDX-License-Identifier: Apache-2.0
/// Summary of a network of stations in plain words: captured surface, connection of the scans, time on site, and how to
/// mend faults. Given as data first, for any report.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "vantage/evaluation.hpp"
#include "vantage/placement.hpp"
#include "vantage/planner.hpp"
#include "vantage/scene.hpp"

namespace vantage {

/// Shares of the mixed points among all points, in words: "1.2 % of the points lie between surfaces, …".
std::string mixed_text(const MixedPoints& mixed, std::uint64_t points);

/// A header, and a line for each station: its name, ground and head (survey frame, metres, to the millimetre), its
/// status, and its points on surveyed meshes if `points` has them. If any is turned, or has another scanner than the
/// first, also heading and tilt in degrees, its scanner and that scanner's step. `scanners` are indexed by
/// `StationSetup::scanner`. `set_ups`: how each may be set up by known points, or none.
std::string station_table(std::span<const PlacedStation> stations, std::span<const std::string> names,
                          std::span<const std::uint64_t> points = {}, std::span<const Scanner> scanners = {},
                          std::span<const std::string> set_ups = {});
/// Returns for each station how it may be set up by the control points that its scan measures: "resection from 3".
/// Empty if there is no control point.
std::vector<std::string> set_ups_of(const Evaluation& evaluation);

/// A line of a summary: its heading ("planned", "captured", "mixed", "linked", "registered", "to check", "control",
/// "on site", "hours" or "to do") and its text.
struct SummaryLine {
  std::string heading = {}, text = {};  ///< Subject of the line, and its text.
};
/// Figures of a network in words, then advice on stations that are left out, missing links and violated requirements.
std::vector<SummaryLine> summary_lines(const Evaluation& evaluation, std::span<const Requirement> requirements = {});
/// The same of a plan's answer. The first lines tell of a plane laid under the model and what ended the plan, the last
/// ones of floor without stations and floor that nothing leads to.
std::vector<SummaryLine> summary_lines(const PlanResult& result);
/// A sentence on a plan's number of stations: what they capture, what ended it, and what a further one would add. "16
/// stations capture 86.2 % of what is attainable; a further one would add some 22 m² in 4 min, and has to add 25 m²".
/// Empty unless the fewest stations are asked for by what they capture.
std::string planned_text(const PlanResult& result);
/// `summary_lines` of a plan for a terminal.
std::string summary_text(const PlanResult& result);
/// A part of the floor where stations may stand, and the stations on it.
struct FloorPart {
  /// Kinds of parts.
  enum class Kind {
    storey,    ///< Ground above or below other ground. A site of one level has none.
    building,  ///< Ground under a roof and within walls, apart from other such ground. A site of one has none.
    room,      ///< A room that the file names.
  };
  Kind kind = Kind::storey;  ///< Kind of the part.
  std::string name = {};     ///< "storey 2", counted from below; "building 1", the largest; the room's own.
  double area_m2 = 0;        ///< Ground of the search area in plan; 0: none of it is reached.
  Vec3 place = {};           ///< A point of it, survey frame; of a room without ground its middle.
  std::size_t stations = 0;  ///< Usable stations that stand on it.
};
std::string to_string(FloorPart::Kind kind);  ///< "storey", "building", "room"
/// Storeys from below, then buildings, the largest first, then rooms as the scene has them.
std::vector<FloorPart> floor_parts(const Scene& scene, const SearchArea& area, std::span<const PlacedStation> stations);

/// Lines on the ground alone: a plane laid under the model, more stations than one for 5 m² of floor, storeys,
/// buildings and rooms that hold no station, closed floor that is planned as if entered, and closed floor that is not.
std::vector<SummaryLine> ground_lines(const Scene& scene, const SearchArea& area,
                                      std::span<const PlacedStation> stations);
/// A line on the rooms that more than one session enters, which have to be open again; none if there is no such room.
std::vector<SummaryLine> again_lines(const Scene& scene, const Evaluation& evaluation);
/// One sentence on all closed floor that is planned as if entered, for a headline; empty if there is none.
std::string entered_text(const SearchArea& area);
/// Lines as they stand in a terminal: each heading once, texts below each other.
std::string lines_text(std::span<const SummaryLine> lines);
/// `summary_lines` for a terminal.
std::string summary_text(const Evaluation& evaluation, std::span<const Requirement> requirements = {});

/// Lines for a terminal: the trade-off of a plan as a table of about five lines, with captured share, registration
/// error and time on site of each number of stations, and `registration_jump_text()`. Empty if the plan has none.
std::string trade_off_text(const PlanResult& result);
/// A sentence on the number of stations of a trade-off whose scans register much worse than those of fewer stations,
/// and why; empty if there is none.
std::string registration_jump_text(std::span<const TradeOffPoint> points);

/// Lines for a terminal: a sentence for each requirement that no network of a front meets, with the nearest value.
/// Empty if each is met by some network.
std::string unmet_text(const PlanResult& result);

}  // namespace vantage
