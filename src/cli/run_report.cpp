// SPDX-License-Identifier: Apache-2.0
#include "cli/run_report.hpp"

#include <spdlog/spdlog.h>

namespace vantage::cli {

void tell_engine(const Simulator& simulator) {
  const EngineInfo& info = simulator.engine();
  spdlog::info("{} on {}{}{}", to_string(info.engine), info.device, info.reason.empty() ? "" : ": ", info.reason);
}

void tell_grid(const Simulator& simulator) {
  spdlog::info("{} surveyed voxels of {:.4g} m, goal {:.1f} points each; {} rays a station", simulator.voxel_count(),
               simulator.voxel_size_m(), simulator.goal_density(), simulator.scanner().rays());
}

}  // namespace vantage::cli
