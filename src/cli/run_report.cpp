// SPDX-License-Identifier: Apache-2.0
#include "cli/run_report.hpp"

#include <spdlog/spdlog.h>

#include <string>

#include "vantage/error.hpp"
#include "vantage/export.hpp"

namespace vantage::cli {

void tell_engine(const Simulator& simulator) {
  const EngineInfo& info = simulator.engine();
  // For Embree always, also if requested: its reason tells whether this processor agrees with others.
  std::string reason = info.engine == Engine::embree ? ": " + info.reason : "";
  const SimulatorConfig& config = simulator.config();
  if (config.engine == Engine::automatic && !config.device_index && config.devices.empty())
    for (const auto& engine : list_engines())
      if (engine.chosen_by_default) reason = ": " + engine.reason;
  spdlog::info("{} on {}{}", to_string(info.engine), info.device, reason);
}

void tell_grid(const Simulator& simulator) {
  const char* const goal =
      simulator.config().spacing_by_detail ? "goals up to {:.1f} points" : "goal {:.1f} points each";
  spdlog::info("{} surveyed voxels of {:.4g} m, {}; {} rays per station", simulator.voxel_count(),
               simulator.voxel_size_m(), fmt::format(fmt::runtime(goal), simulator.goal_density()),
               simulator.scanner().rays());
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  const auto probe = folder / ".writable";
  if (!error) {
    try {
      write_text(probe, "");
      std::filesystem::remove(probe, error);
    } catch (const Error& failure) {
      throw Error(Errc::io, folder.string() + ": is not writable", {failure.what()});
    }
  }
  if (error) throw Error(Errc::io, folder.string() + ": cannot be made: " + error.message());
}

}  // namespace vantage::cli
