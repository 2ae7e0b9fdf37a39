// SPDX-License-Identifier: Apache-2.0
#include <system_error>

#include "report/pictures.hpp"
#include "report/tables.hpp"
#include "report/text.hpp"
#include "vantage/error.hpp"
#include "vantage/export.hpp"

namespace vantage {

std::size_t write_plan(const std::filesystem::path& folder, const PlanResult& result, const PlanConfig& config,
                       Simulator& simulator, const SearchArea& area) {
  if (result.front.empty())
    throw Error(Errc::invalid_argument,
                "there is nothing to write: the search ended before its first networks were evaluated");
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) throw Error(Errc::io, "cannot make the folder " + folder.string() + ": " + failed.message());
  const std::size_t chosen = compromise(result, config);
  const PlanEntry& entry = result.front[chosen];

  write_front_csv(folder / "front.csv", result, config);
  write_text(folder / "front.json", front_json(result, config, simulator));
  write_history_csv(folder / "history.csv", result);
  write_fronts_csv(folder / "fronts.csv", result, config);
  write_stations_csv(folder / "stations.csv", entry.stations);

  VoxelField field;
  const NetworkCounts counts = simulator.evaluate(to_network(entry.stations), {.overlap = true, .field = &field});
  const OverlapMatrix overlap = overlap_matrix(counts);
  write_overlap_csv(folder / "overlap.csv", overlap);
  write_coverage_ply(folder / "coverage.ply", simulator, field);

  const double exact = coverage(counts, simulator.goal_density());
  const std::string title = std::to_string(entry.stations.size()) +
                            (entry.stations.size() == 1 ? " station" : " stations") + ": coverage " + fixed(exact, 3) +
                            ", overlap " + fixed(clustering_coefficient(overlap), 3);
  const auto save = [&](const std::string& name, const std::unique_ptr<Canvas>& picture) {
    for (const char* extension : {".png", ".svg"}) picture->save(folder / (name + extension));
  };
  save("front", front_picture(result, config));
  save("hypervolume", hypervolume_picture(result, config));
  if (!has_one_objective(config)) save("history", history_picture(result, config));
  save("plan", plan_view_picture(simulator.scene(), area, entry.stations, overlap, title));
  return chosen;
}

}  // namespace vantage
