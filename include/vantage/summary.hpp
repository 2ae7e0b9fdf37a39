// SPDX-License-Identifier: Apache-2.0
/// What a person wants to know of a network of stations, in plain words: how much is captured, whether the scans hang
/// together, how long it takes, and what to do about what fails. As data first, so that any report can show it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "vantage/measure.hpp"
#include "vantage/placement.hpp"
#include "vantage/planner.hpp"

namespace vantage {

/// What stations are called in every table and picture: "S1", "S2", … in their order, and "K1", "K2", … those that were
/// there before, each counted from 1. `given`: names of their owner's, an entry a station or none at all; an empty one
/// leaves the station its number's name. Where two would have one name, the later is told apart by its number among
/// all: "P1 (3)".
std::vector<std::string> station_names(std::span<const PlacedStation> stations,
                                       std::span<const std::string> given = {});

/// A header and a line a station: its name, ground and head (survey frame, metres, to the millimetre), what became of
/// it, and its points on surveyed meshes, where `points` has them. Where any is turned or has another scanner than the
/// first also heading and tilt in degrees, its scanner and that one's step; `scanners` is what setups count.
std::string station_table(std::span<const PlacedStation> stations, std::span<const std::string> names,
                          std::span<const std::uint64_t> points = {}, std::span<const Scanner> scanners = {});

/// How the stations that count hang together. Stations by their place in the network, from 0.
struct SummaryLinks {
  std::string measure = "overlap";                   ///< What a link is measured by, as said in a sentence.
  double least = 0;                                  ///< From which value on two stations count as linked.
  std::vector<std::vector<std::size_t>> parts = {};  ///< That hang together, the largest first.
  /// The weakest link of the strongest spanning tree, where there is one part of several stations.
  std::optional<std::pair<std::size_t, std::size_t>> weakest = std::nullopt;
  double weakest_value = 0;
  /// Of a part but the first: its best pair with a station outside of it, and what that measures.
  struct Gap {
    std::size_t inside = 0, outside = 0;
    double value = 0;
  };
  std::vector<Gap> gaps = {};
};
/// `used`: whether a station counts, one each; what is not said is used.
SummaryLinks summary_links(const OverlapMatrix& overlap, double least, const std::vector<bool>& used = {});
/// Of the stations that are active, by scan overlap (`scan_overlap_matrix`).
SummaryLinks scan_links(const OverlapMatrix& scan_overlaps, double least, std::span<const PlacedStation> stations);
inline constexpr const char* scan_overlap_measure = "scan overlap";  ///< `SummaryLinks::measure` of these.

/// Something that is not as it was asked, or as it should be, and what to do about it.
struct SummaryFault {
  std::string what = {}, advice = {};
};
/// One for each station that is left out, or stands where none should.
std::vector<SummaryFault> station_faults(std::span<const PlacedStation> stations, std::span<const std::string> names);

struct SurveySummary {
  std::vector<std::string> names = {};                   ///< Of the stations.
  double captured = 0;                                   ///< Coverage (equation 8).
  double captured_error = 0;                             ///< Its standard error; 0 where every ray was cast.
  std::optional<double> of_visible = std::nullopt;       ///< The same as a share of what can be seen at all.
  std::optional<SummaryLinks> links = std::nullopt;      ///< Empty: not measured.
  std::optional<double> registration_mm = std::nullopt;  ///< Predicted error of the registered scans; empty: not known.
  std::optional<double> seconds_on_site = std::nullopt;  ///< Empty: not known.
  std::vector<SummaryFault> faults = {};                 ///< Besides those that the links show.
};
/// Of a network of a plan: what the search and the confirmation know of it.
SurveySummary summary_of(const PlanEntry& entry, const PlanResult& result);

/// A line of a summary: "captured", "linked", "registered", "on site" or "to do", and what there is to say.
struct SummaryLine {
  std::string heading = {}, text = {};
};
std::vector<SummaryLine> summary_lines(const SurveySummary& summary);
/// The same for a terminal, with line ends.
std::string summary_text(const SurveySummary& summary);

/// A sentence for each requirement that no network of a front keeps, with how near one comes; empty where all are kept
/// by some. Lines for a terminal.
std::string unmet_text(const PlanResult& result);

}  // namespace vantage
