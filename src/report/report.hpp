// SPDX-License-Identifier: Apache-2.0
// Content of a report, gathered before it becomes a page or sheets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "map/pictures.hpp"
#include "report/accuracy.hpp"
#include "vantage/report.hpp"
#include "vantage/summary.hpp"

namespace vantage {

// A room, and what the answer does in it.
struct RoomFacts {
  std::string storey, name;
  double floor_m2 = 0;
  std::optional<double> captured = {};  // share of its surveyed surface; empty: it has none
  std::string stations = {};            // names of those in it; empty: there is none, and `why`
  std::string why = {};
};

// Borrows its content.
struct Report {
  struct Network {
    const Evaluation& evaluation;
    bool dominated = false;
  };
  ReportOptions options = {};  // with a title
  std::string crs = {};        // coordinate system of the survey frame, whose north is shown; empty: not known
  std::string question = {};   // question that the plan answers
  std::vector<Network> networks = {};
  std::size_t answer = 0;                      // index of the network
  std::vector<Requirement> requirements = {};  // on the networks
  std::vector<Objective> measures = {};        // of every network
  std::vector<Objective> front_axes = {};      // to the right, up, and by colour if there is a third; empty: no front
  std::vector<TradeOffPoint> trade_off = {};   // stations against what they capture; empty: not known
  std::vector<SummaryLine> ground = {};        // a plane laid under the model, and floor that is not entered
  std::vector<SummaryLine> again = {};         // rooms that sessions of the answer enter again
  std::string parameters = "{}";               // JSON text of an object
  std::vector<std::pair<std::string, std::string>> facts = {};  // scanner, time, …: heading and sentence
  std::optional<Accuracy> accuracy = {};                        // of the answer, by room or mesh
  std::vector<RoomFacts> rooms = {};                            // under the answer; empty: none, or not looked at
  std::span<const PlanPage> plan = {};                          // views of the plan; empty: not drawn yet
  // Views of the answer's stations: a JPEG each, empty if there is none; or none at all.
  std::vector<std::vector<std::uint8_t>> pictures = {};

  const Evaluation& shown() const { return networks[answer].evaluation; }
};

// Report of a plan: a network for each entry of the front, numbered as in front.json.
Report report_of(const PlanResult& result, Site& site, const ReportOptions& options);
// Report of given stations.
Report report_of(const Evaluation& evaluation, Site& site, const ReportOptions& options);

// Returns pairs of heading and sentence that a reader asks first besides coverage: scanner, stations, time, what
// "captured" stands for.
std::vector<std::pair<std::string, std::string>> report_facts(const Report& report, const Simulator& simulator);

// False, and no file, if stopped before the page or the sheets were made.
bool write_report_html(const std::filesystem::path& file, const Report& report, Site& site, const Progress& progress);
bool write_report_pdf(const std::filesystem::path& file, const Report& report, Site& site, const std::stop_token& stop);
// report.html and report.pdf of a plan, side by side. `plan`: its pages, which a stop may have kept from being drawn.
// Returns the names of those that a stop left out.
// Throws Error invalid_argument if there is no report in this build.
std::vector<std::string> write_reports(const std::filesystem::path& folder, const PlanResult& result, Site& site,
                                       const ReportOptions& options, std::span<const PlanPage> plan,
                                       const Progress& progress);

}  // namespace vantage
