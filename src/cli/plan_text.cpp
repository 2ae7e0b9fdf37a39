// SPDX-License-Identifier: Apache-2.0
#include "cli/plan_text.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace vantage::cli {
namespace {

// More stations than this are not read on a screen.
constexpr std::size_t kStationsShown = 50;

// A value of a network, or a dash where it was not computed.
std::string cell(double value) { return std::isfinite(value) ? fmt::format("{:.4f}", value) : "-"; }

// Its violations, and missing links.
std::string remarks(const PlanEntry& entry, const PlanResult& result) {
  std::string text;
  const auto pairs = [](const Objective& objective) { return objective.needs.pairs; };
  if (entry.exact && std::ranges::any_of(result.problem.objectives, pairs)) {
    const std::size_t parts = connectivity(entry.overlap_matrix, result.problem.link_overlap).parts;
    if (parts > 1) text += fmt::format("  in {} parts", parts);
  }
  for (const Requirement& requirement : result.problem.requirements) {
    const Estimate& value = entry.estimate(requirement.objective.name);
    if (requirement.missed_by(value) > 0)
      text += fmt::format("  not met: {} ({})", in_words(requirement), value_text(requirement, value.value));
  }
  return text;
}

// Networks of the front, a line each, and how the search ended.
std::string front_text(const PlanResult& result, std::size_t chosen) {
  std::string text;
  std::vector<const Objective*> told;
  for (const Objective& measure : result.measures)
    if (!measure.by_alpha) told.push_back(&measure);
  for (const Objective* measure : told)
    text += fmt::format("{:>9}", measure->unit.empty() ? measure->name : measure->name + " " + measure->unit) + " ";
  text += "stations\n";
  for (std::size_t k = 0; k < result.front.size(); ++k) {
    const PlanEntry& entry = result.front[k];
    for (const Objective* measure : told) text += fmt::format("{:>9} ", cell(entry.value(measure->name)));
    text += fmt::format("{:>8}{}{}\n", entry.stations.size(),
                        k == chosen       ? "  <- answer"
                        : entry.dominated ? "  dominated"
                                          : "",
                        remarks(entry, result));
  }
  text += fmt::format("{} evaluations, hypervolume {:.4f}", result.evaluations, result.hypervolume);
  if (result.config.sample_voxels > 0 && !std::isnan(result.exact_hypervolume))
    text += fmt::format(" ({:.4f} by every ray)", result.exact_hypervolume);
  if (result.spared > 0) text += fmt::format(", {} networks not worth every ray", result.spared);
  text += fmt::format(", stopped: {}\n", to_string(result.stop_reason));
  return text;
}

}  // namespace

std::string plan_text(const PlanResult& result, const std::string& folder) {
  std::string text;
  const std::size_t chosen = answer(result);
  const PlanEntry& entry = result.front[chosen];
  if (result.scene && result.area && result.area->on_plane())
    text = ground_lines(*result.scene, *result.area, entry.stations).front().text + "\n";
  if (result.area)
    if (const std::string entered = entered_text(*result.area); !entered.empty()) text += entered + "\n";
  text += unmet_text(result);
  // The summary and the trade-off tell all of a surveyor's plan.
  const bool whole_front = result.trade_off.empty() || result.front.size() > 1;
  if (whole_front) text += front_text(result, chosen) + "\n";
  const std::size_t shown = std::min(entry.stations.size(), kStationsShown);
  const std::span<const std::uint64_t> points(entry.counts.points_on_surveyed);
  const std::vector<std::string> set_ups = set_ups_of(entry);
  text += station_table(std::span(entry.stations).first(shown), station_names(entry.stations, entry.names),
                        points.first(std::min(shown, points.size())), result.scanners,
                        std::span<const std::string>(set_ups).first(std::min(shown, set_ups.size())));
  if (shown < entry.stations.size())
    text += fmt::format("and {} more in stations.csv\n", entry.stations.size() - shown);
  text += "\n";
  text += summary_text(result);
  if (const std::string trade_off = trade_off_text(result); !trade_off.empty()) text += "\n" + trade_off + "\n";
  return text + "results in " + folder + "\n";
}

}  // namespace vantage::cli
