// SPDX-License-Identifier: Apache-2.0
// Common start of all benchmarks of tracing: a scene, its stations, a scanner, and the engines to compare.
#pragma once

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "trace/tracer.hpp"
#include "vantage/measure.hpp"
#include "vantage/scene.hpp"
#include "vantage/simulator.hpp"

namespace vantage::bench {

// Inputs of an engine, for benchmarks of engines alone.
struct TracedSite {
  TraceScene scene;
  std::vector<TraceStation> stations;
  double goal_density = 0;
};

struct SiteOptions {
  std::string scene;
  std::string station_file;        // x,y,z a line under a header
  std::vector<std::string> typed;  // "x,y,z"
  double step_deg = 0.0286;        // Table 4 of the method, as are the rest
  double spacing_m = 0.005;
  double user_size_m = 0.01;
  bool noise = false;
  std::vector<std::string> engines;  // empty: all usable ones
  std::uint32_t repeats = 5;

  void add(CLI::App& command);
  Network stations() const;
  Scanner scanner() const;
  SimulatorConfig config() const;
  TracedSite traced(const Scene& site, const Network& network) const;
  // Those of the named engines that can run here.
  std::vector<EngineInfo> engines_here() const;
  // Makes the first engine on the given devices that have it, or else on the best one.
  Simulator simulator(const Scene& site, std::span<const std::size_t> devices = {}) const;
};

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace vantage::bench
