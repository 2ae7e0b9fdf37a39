// SPDX-License-Identifier: Apache-2.0
// What a survey comes to, for people: one page that opens from disk in any browser, and a few sheets of paper.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vantage/missed.hpp"
#include "vantage/planner.hpp"
#include "vantage/summary.hpp"

namespace vantage {

// A network as the report shows it.
struct ReportNetwork {
  PlanEntry entry = {};
  std::vector<std::string> names = {};  // of its stations
  SurveySummary summary = {};
  // By what two of its stations are linked, as the summary says: equation 11, or the scan overlap. Empty: not measured.
  OverlapMatrix links = {};
  // What its stations see: a JPEG each, empty where there is none; or none at all.
  std::vector<std::vector<std::uint8_t>> pictures = {};
};

struct Report {
  std::string title = {};     // what was surveyed
  std::string question = {};  // what was asked of it
  std::string command = {};   // as it was typed
  std::vector<ReportNetwork> networks = {};
  std::size_t answer = 0;                  // of the networks
  std::vector<Objective> measures = {};    // all that is told of a network
  std::vector<Objective> front_axes = {};  // to the right, up, and by colour where there is a third; empty: no front
  std::vector<MissedShare> missed = {};    // of the answer; empty: not looked at
  std::string parameters = "{}";           // JSON text of an object
};

// Of a plan: a network for each entry of the front, numbered as in front.json.
Report report_of(const PlanResult& result, const Simulator& simulator);

// Of stations that were measured without a plan: by every ray, or on a sample. `names`: one a station.
// `scan_overlaps`: of all surfaces, from `link` on two stations count as linked; empty: not looked at.
ReportNetwork measured_network(std::span<const PlacedStation> stations, std::vector<std::string> names,
                               const NetworkCounts& counts, const Simulator& simulator, OverlapMatrix scan_overlaps,
                               double link);
// With that network alone.
Report report_of(ReportNetwork network, const Simulator& simulator);

// Why voxels of the answer are missed: a reason for each of `ranks`, as `why_missed()` has them.
struct ReportMissed {
  std::vector<std::uint32_t> ranks = {};
  std::vector<WhyMissed> why = {};
};

// "Overlap", or "Scan overlap": what its links are measured by, as the words above a table.
std::string link_words(const ReportNetwork& network);

// What the view in three dimensions shows besides the networks.
struct ReportSite {
  Simulator& simulator;
  const SearchArea& area;
  const VoxelField* field = nullptr;     // of the answer by every ray; null: from a sample, as for all other networks
  const ReportMissed* missed = nullptr;  // null: nothing is told apart
};

// The page. Nothing in it is loaded from anywhere. Throws Error: io, and what the simulator throws.
void write_report_html(const std::filesystem::path& file, const Report& report, const ReportSite& site,
                       const Progress& progress = {});
// Four sheets A4 at most: the summary with the plan from above, the stations, their links, what is missed.
void write_report_pdf(const std::filesystem::path& file, const Report& report, const ReportSite& site);

}  // namespace vantage
