// SPDX-License-Identifier: Apache-2.0
#include "report/tables.hpp"

#include <algorithm>

#include "core/atomic_file.hpp"
#include "report/text.hpp"
#include "vantage/export.hpp"

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

void write_front_csv(const std::filesystem::path& file, const PlanResult& result, const PlanConfig& config) {
  std::size_t most = 0;
  for (const PlanEntry& entry : result.front) most = std::max(most, entry.stations.size());
  std::string text =
      "entry,station_count,coverage,coverage_se,overlap,overlap_se,exact_coverage,exact_overlap,dominated";
  if (objective_names(config.problem).back() == "alpha") text += ",alpha";
  for (std::size_t i = 0; i < most; ++i)
    for (const char* name : {"x", "y", "z", "u", "v", "status"}) text += "," + std::string(name) + number(i + 1);
  text += "\n";
  for (std::size_t k = 0; k < result.front.size(); ++k) {
    const PlanEntry& e = result.front[k];
    text += number(k + 1) + "," + number(e.stations.size()) + "," + number(e.coverage) + "," + number(e.coverage_se) +
            "," + number(e.overlap) + "," + number(e.overlap_se) + ",";
    text += e.confirmed ? number(e.exact_coverage) + "," + number(e.exact_overlap) + "," + (e.dominated ? "1" : "0")
                        : std::string(",,");
    if (objective_names(config.problem).back() == "alpha") text += "," + number(e.x.back());
    for (std::size_t i = 0; i < most; ++i) {
      if (i >= e.stations.size()) {
        text += ",,,,,,";
        continue;
      }
      const PlacedStation& s = e.stations[i];
      if (s.status == StationStatus::hole)
        text += ",,,";
      else
        text += "," + number(s.position.x) + "," + number(s.position.y) + "," + number(s.position.z);
      text += "," + number(s.uv.u) + "," + number(s.uv.v) + "," + to_string(s.status);
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

void write_fronts_csv(const std::filesystem::path& file, const PlanResult& result, const PlanConfig& config) {
  std::string text = "iteration";
  for (const std::string& name : objective_names(config)) text += "," + name;
  text += "\n";
  for (const PlanIteration& line : result.history) {
    for (const auto& f : line.front) {
      text += number(line.iteration);
      for (const double value : f) text += "," + number(value);
      text += "\n";
    }
  }
  write_atomically(file, text);
}

}  // namespace vantage
