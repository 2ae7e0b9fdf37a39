// SPDX-License-Identifier: Apache-2.0
/// What a person wants to know of a network of stations, in plain words: how much is captured, whether the scans hang
/// together, how long it takes, and what to do about what fails. As data first, so that any report can show it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "vantage/evaluation.hpp"
#include "vantage/placement.hpp"
#include "vantage/planner.hpp"

namespace vantage {

/// A header and a line a station: its name, ground and head (survey frame, metres, to the millimetre), what became of
/// it, and its points on surveyed meshes, where `points` has them. Where any is turned or has another scanner than the
/// first also heading and tilt in degrees, its scanner and that one's step; `scanners` is what setups count.
std::string station_table(std::span<const PlacedStation> stations, std::span<const std::string> names,
                          std::span<const std::uint64_t> points = {}, std::span<const Scanner> scanners = {});

/// A line of a summary: "captured", "linked", "registered", "on site" or "to do", and what there is to say.
struct SummaryLine {
  std::string heading = {}, text = {};
};
/// What is known of a network, in words; then what to do about stations that are left out, links that are missing, and
/// requirements that it violates.
std::vector<SummaryLine> summary_lines(const Evaluation& evaluation, std::span<const Requirement> requirements = {});
/// The same for a terminal, with line ends.
std::string summary_text(const Evaluation& evaluation, std::span<const Requirement> requirements = {});

/// A sentence for each requirement that no network of a front keeps, with how near one comes; empty where all are kept
/// by some. Lines for a terminal.
std::string unmet_text(const PlanResult& result);

}  // namespace vantage
