// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "search/measures.hpp"
#include "vantage/export.hpp"

namespace vantage::test {

inline std::string content(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline std::size_t entries(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

// The value at a byte; advances it.
template <class T>
T take(const std::string& bytes, std::size_t& at) {
  T value{};
  if (at + sizeof value <= bytes.size()) std::memcpy(&value, bytes.data() + at, sizeof value);
  at += sizeof value;
  return value;
}

// A made-up result of a problem by name with a front of `entries` networks, coverage falling from 0.95.
inline PlanResult sample_result(const std::string& name, std::size_t stations_min, std::size_t stations_max,
                                std::size_t entries, std::uint64_t sample_voxels = 0) {
  PlanResult result;
  result.problem = survey_problem(name, name.ends_with("-fix") ? stations_max : stations_min, stations_max);
  result.config.sample_voxels = sample_voxels;
  const SurveyProblem& problem = result.problem;
  result.measures = measures_of(problem).all;
  const bool counts = problem.stations_min < problem.stations_max;
  for (std::size_t k = 0; k < entries; ++k) {
    const double t = entries > 1 ? static_cast<double>(k) / static_cast<double>(entries - 1) : 0;
    PlanEntry e;
    const std::size_t n = station_count_from_alpha(1 - t, problem.stations_min, problem.stations_max);
    for (std::size_t i = 0; i < n; ++i) {
      const double u = 0.1 + 0.8 * static_cast<double>(i) / 64;
      e.stations.push_back({.uv = {u, t}, .position = {1 / 3.0 + 10 * u, 10 * t, 1.85}, .status = StationStatus::ok});
      e.x.insert(e.x.end(), {u, t});
    }
    e.x.resize(2 * problem.stations_max);
    if (counts) e.x.push_back(1 - t);
    const double coverage = 0.95 - 0.5 * t * t, overlap = 0.1 + 0.8 * t;
    for (const Objective& measure : result.measures)
      e.searched[measure.name] = e.values[measure.name] = {static_cast<double>(n), 0};
    e.searched["coverage"] = {coverage, 0.001}, e.values["coverage"] = {coverage - 0.002, 0};
    e.searched["overlap"] = {overlap, 0.01}, e.values["overlap"] = {overlap + 0.004, 0};
    e.exact = true;
    e.overlap_matrix = OverlapMatrix(n);
    e.counts.points_on_surveyed.assign(n, 1000 + k);
    result.front.push_back(e);
  }
  for (std::size_t it = 1; it <= 20; ++it) {
    PlanIteration line{.iteration = it,
                       .evaluations = 10 * it,
                       .hypervolume = 0.5 + 0.02 * static_cast<double>(it),
                       .front = {},
                       .seconds = 0.5 * static_cast<double>(it)};
    for (const PlanEntry& e : result.front) {
      std::vector<double> values;
      for (const Objective& objective : problem.objectives) values.push_back(e.searched.at(objective.name).value);
      line.front.push_back(scaled_objectives(problem, e.x, values));
      for (std::size_t k = 0; k < line.front.back().size(); ++k)
        if (!problem.objectives[k].by_alpha) line.front.back()[k] += 0.01 * static_cast<double>(20 - it) * 0.4;
    }
    result.history.push_back(line);
  }
  result.hypervolume = 0.9, result.evaluations = 200, result.drawn = 800, result.redrawn = 40;
  result.stop_reason = StopReason::max_iterations;
  result.seconds = 12.5, result.trace_seconds = 10;
  return result;
}

}  // namespace vantage::test
