// SPDX-License-Identifier: Apache-2.0
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <vector>

#include "cli/command.hpp"
#include "cli/options.hpp"
#include "vantage/vantage.hpp"

namespace vantage::cli {
namespace {

struct InfoOptions {
  std::optional<std::string> scene;
  bool allow_outside = false, json = false;

  void add(CLI::App& command) {
    add_text(command, "--measure", "SCENE", "Trace a few rays of this scene with every usable engine and rank them",
             scene);
    command.add_flag("--allow-outside", allow_outside, "Let it name buffers and images outside its own folder");
    command.add_flag("--json", json, "Print one JSON object");
  }
};

struct EngineRow {
  EngineInfo info;
  std::optional<double> rays_per_second = std::nullopt;
  std::string failure = {};
};

// The median of three passes over one station in the middle of the scene, after one to warm up: compile, upload, fault
// pages in.
double measure(const Scene& scene, const EngineInfo& info) {
  const Vec3 size = scene.bounds().size();
  const double extent = std::max({size.x, size.y, size.z});
  Scanner scanner;
  scanner.azimuth_step = scanner.zenith_step = Angle::degrees(0.3);
  scanner.min_range_m = 0;
  scanner.max_range_m = 4 * extent;
  Simulator simulator(scene, scanner,
                      {.engine = info.engine,
                       .device_index = info.device_index,
                       .user_size_m = extent / 100,
                       .point_spacing_m = extent / 2000});
  const Network network{{.position = scene.bounds().centre()}};
  std::vector<double> rates;
  for (int pass = 0; pass < 4; ++pass) {
    const auto start = std::chrono::steady_clock::now();
    const auto counts = simulator.evaluate(network, {.overlap = false, .skip = false});
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (pass > 0) rates.push_back(static_cast<double>(counts.rays) / seconds);
  }
  std::sort(rates.begin(), rates.end());
  return rates[rates.size() / 2];
}

nlohmann::json to_json(const EngineRow& row) {
  nlohmann::json json{{"engine", to_string(row.info.engine)},
                      {"device", row.info.device},
                      {"driver", row.info.driver},
                      {"device_index", row.info.device_index},
                      {"usable", row.info.usable},
                      {"software", row.info.software},
                      {"chosen_by_default", row.info.chosen_by_default},
                      {"reason", row.info.reason}};
  if (row.rays_per_second) json["rays_per_second"] = *row.rays_per_second;
  if (!row.failure.empty()) json["failure"] = row.failure;
  return json;
}

std::string to_text(const EngineRow& row) {
  const EngineInfo& info = row.info;
  std::string text =
      fmt::format("{} {:<12} {:>2}  {}{}{}\n",
                  info.chosen_by_default ? "*"
                  : info.usable          ? " "
                                         : "-",
                  to_string(info.engine), info.device_index, info.device, info.driver.empty() ? "" : ", ", info.driver);
  if (row.rays_per_second) text += fmt::format("    {:.2f} million rays a second\n", *row.rays_per_second * 1e-6);
  if (!row.failure.empty()) text += "    failed: " + row.failure + "\n";
  if (!info.reason.empty()) text += "    " + info.reason + "\n";
  return text;
}

int info(CLI::App&, InfoOptions& options, Program& program) {
  std::optional<Scene> scene;
  if (options.scene) scene = Scene::load(*options.scene, {.allow_outside = options.allow_outside});
  std::vector<EngineRow> rows;
  for (auto& found : list_engines()) rows.push_back({.info = std::move(found)});
  if (scene) {
    for (auto& row : rows) {
      if (!row.info.usable || program.stop.stop_requested()) continue;
      spdlog::info("measuring {} on {}", to_string(row.info.engine), row.info.device);
      try {
        row.rays_per_second = measure(*scene, row.info);
      } catch (const Error& error) {
        row.failure = error.what();
      }
    }
    std::stable_sort(rows.begin(), rows.end(), [](const EngineRow& a, const EngineRow& b) {
      return a.rays_per_second.value_or(-1) > b.rays_per_second.value_or(-1);
    });
  }
  const auto presets = own_presets_file();
  const auto scanners = list_scanners(presets);

  if (options.json) {
    nlohmann::json json{{"version", version()},
                        {"engines", nlohmann::json::array()},
                        {"scanners", nlohmann::json::array()},
                        {"scanners_file", presets.string()}};
    for (const auto& row : rows) json["engines"].push_back(to_json(row));
    for (const auto& scanner : scanners)
      json["scanners"].push_back({{"key", scanner.key}, {"summary", scanner.summary}});
    program.console.print(json);
  } else {
    std::string text = fmt::format("vantage {}\n\nengines (* taken by default, - refused):\n", version());
    for (const auto& row : rows) text += to_text(row);
    text += presets.empty() ? "\nscanners:\n" : fmt::format("\nscanners, built in and from {}:\n", presets.string());
    for (const auto& scanner : scanners) text += fmt::format("  {:<14} {}\n", scanner.key, scanner.summary);
    program.console.print(text);
  }
  return program.stop.stop_requested() ? exit_failed : exit_ok;
}

}  // namespace

void add_info(CLI::App& app, Program& program) {
  add_command<InfoOptions>(app, program, "info", "List engines, devices and scanners, and why one was chosen", info,
                           {"vantage info --measure site.glb"});
}

}  // namespace vantage::cli
