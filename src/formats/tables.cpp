// SPDX-License-Identifier: Apache-2.0
#include "formats/tables.hpp"

#include <algorithm>

#include "core/atomic_file.hpp"
#include "core/text.hpp"
#include "vantage/export.hpp"
#include "vantage/summary.hpp"
#include "words/csv_cell.hpp"
#include "words/station_cells.hpp"

namespace vantage {

void write_text(const std::filesystem::path& file, const std::string& text) { write_atomically(file, text); }

void write_overlap_csv(const std::filesystem::path& file, const OverlapMatrix& overlap) {
  std::string text = "station";
  for (std::size_t i = 0; i < overlap.size(); ++i) text += "," + number(i + 1);
  text += "\n";
  for (std::size_t i = 0; i < overlap.size(); ++i) {
    text += number(i + 1);
    for (const double value : overlap.row(i)) text += "," + number(value);
    text += "\n";
  }
  write_atomically(file, text);
}

void write_front_csv(const std::filesystem::path& file, const PlanResult& result) {
  const bool alpha = result.problem.stations_min < result.problem.stations_max;
  std::size_t most = 0;
  bool setups = !result.problem.scanners.empty();
  for (const PlanEntry& entry : result.front) {
    most = std::max(most, entry.stations.size());
    setups |= tells_setups(entry.stations);
  }
  std::string text = "entry,station_count";
  for (const Objective& measure : result.measures)
    text += "," + csv_cell(measure.name) + "," + csv_cell(measure.name + "_se");
  for (const Objective& measure : result.measures) text += "," + csv_cell("exact_" + measure.name);
  text += ",dominated,missed";
  if (alpha) text += ",alpha";
  for (std::size_t i = 0; i < most; ++i) {
    for (const char* name : kStationColumns) text += "," + std::string(name) + number(i + 1);
    if (!setups) continue;
    for (const char* name : kSetupColumns) text += "," + std::string(name) + number(i + 1);
  }
  text += "\n";
  for (std::size_t k = 0; k < result.front.size(); ++k) {
    const PlanEntry& e = result.front[k];
    text += number(k + 1) + "," + number(e.stations.size());
    for (const Objective& measure : result.measures) {
      const Estimate& value = e.searched.at(measure.name);
      text += "," + number(value.value) + "," + number(value.standard_error);
    }
    for (const Objective& measure : result.measures)
      text += "," + (e.exact ? number(e.value(measure.name)) : std::string());
    text += std::string(",") + (!e.exact ? "" : e.dominated ? "1" : "0") + "," + number(e.violation);
    if (alpha) text += "," + number(e.x.back());
    const auto names = station_names(e.stations, e.names);
    for (std::size_t i = 0; i < most; ++i) {
      if (i < e.stations.size())
        text += "," + station_cells(e.stations[i], names[i]) +
                (setups ? "," + setup_cells(e.stations[i].setup, result.scanners) : "");
      else
        text.append(std::size(kStationColumns) + (setups ? std::size(kSetupColumns) : 0), ',');
    }
    text += "\n";
  }
  write_atomically(file, text);
}

void write_history_csv(const std::filesystem::path& file, const PlanResult& result) {
  std::string text = "iteration,evaluations,hypervolume,front_size,seconds\n";
  for (const PlanIteration& line : result.history)
    text += number(line.iteration) + "," + number(line.evaluations) + "," + number(line.hypervolume) + "," +
            number(line.front.size()) + "," + number(line.seconds) + "\n";
  write_atomically(file, text);
}

void write_fronts_csv(const std::filesystem::path& file, const PlanResult& result) {
  const std::vector<Objective>& objectives = result.problem.objectives;
  std::string text = "iteration";
  for (const Objective& objective : objectives) text += "," + csv_cell(objective.name);
  text += "\n";
  for (const PlanIteration& line : result.history) {
    for (const auto& f : line.front) {
      // Above 1 the network violates a requirement, and its values were not kept.
      if (std::any_of(f.begin(), f.end(), [](double value) { return !(value <= 1); })) continue;
      text += number(line.iteration);
      for (std::size_t k = 0; k < objectives.size(); ++k) text += "," + number(objectives[k].unscaled(f[k]));
      text += "\n";
    }
  }
  write_atomically(file, text);
}

}  // namespace vantage
