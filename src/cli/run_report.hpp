// SPDX-License-Identifier: Apache-2.0
// Commands with results share these: duration, engine and folder.
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

// Logs the engine, always, so that every result shows what made it.
void tell_engine(const Simulator& simulator);
void tell_grid(const Simulator& simulator);

// Makes the folder and tests it. Throws Error io if it is not writable.
void make_folder(const std::filesystem::path& folder);

}  // namespace vantage::cli
