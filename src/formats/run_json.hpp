// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <span>

#include "vantage/planner.hpp"
#include "vantage/simulator.hpp"
#include "vantage/summary.hpp"

namespace vantage {

// See run_parameters_json(). Equal runs give equal objects: nothing here depends on time or on file names.
nlohmann::ordered_json run_parameters(const Simulator& simulator, const PlanResult* result);

// NaN has no JSON; what is not known is null.
inline nlohmann::ordered_json known(double value) {
  return value == value ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
}
// An object {heading, text} of each line.
nlohmann::ordered_json lines_json(std::span<const SummaryLine> lines);
nlohmann::ordered_json mixed_json(const MixedPoints& mixed);

// Storeys, buildings and rooms with their ground and stations, and floor that nothing leads to.
nlohmann::ordered_json floor_json(const Scene& scene, const SearchArea& area, std::span<const PlacedStation> stations);

}  // namespace vantage
