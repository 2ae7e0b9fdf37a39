// SPDX-License-Identifier: Apache-2.0
// What every result names: how long it took and what it was traced with.
#pragma once

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "vantage/simulator.hpp"

namespace vantage::cli {

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

inline nlohmann::json seconds_json(const Stopwatch& watch, double trace_seconds) {
  return {{"total", watch.seconds()}, {"trace", trace_seconds}};
}

// The engine's line: always said, so that no result hides what made it.
void tell_engine(const Simulator& simulator);
void tell_grid(const Simulator& simulator);

// Makes the folder and tries it out. Throws Error io where nothing can be written to it.
void make_folder(const std::filesystem::path& folder);

}  // namespace vantage::cli
