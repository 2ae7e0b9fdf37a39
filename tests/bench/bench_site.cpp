// SPDX-License-Identifier: Apache-2.0
#include "bench_site.hpp"

#include <algorithm>
#include <fstream>
#include <memory>
#include <sstream>

#include "scan/noise_model.hpp"
#include "scan/pattern.hpp"
#include "vantage/error.hpp"

namespace vantage::bench {
namespace {

Station station_of(const std::string& line) {
  std::istringstream text(line);
  Vec3 p;
  char first = 0, second = 0;
  if (!(text >> p.x >> first >> p.y >> second >> p.z) || first != ',' || second != ',')
    throw Error(Errc::malformed_file, "a station is x,y,z; \"" + line + "\" is not");
  return {p};
}

}  // namespace

void SiteOptions::add(CLI::App& command) {
  command.add_option("scene", scene, "glTF scene")->required();
  command.add_option("--stations", station_file, "CSV of station heads: a header, then x,y,z");
  command.add_option("--station", typed, "A station's head x,y,z; may be repeated");
  command.add_option("--step", step_deg, "Step angle, degrees")->capture_default_str();
  command.add_option("--spacing", spacing_m, "Wanted spacing of points, metres")->capture_default_str();
  command.add_option("--user-size", user_size_m, "Upper bound of the voxel size, metres")->capture_default_str();
  command.add_flag("--noise", noise, "With the range noise of Table 1");
  command.add_option("--engine", engines, "Engines to compare; all usable ones if absent");
  command.add_option("--repeats", repeats, "Runs of each kind; the best counts")->capture_default_str();
}

Network SiteOptions::stations() const {
  Network network;
  for (const auto& text : typed) network.push_back(station_of(text));
  if (!station_file.empty()) {
    std::ifstream file(station_file);
    std::string line;
    if (!std::getline(file, line)) throw Error(Errc::io, "cannot read the stations from " + station_file);
    while (std::getline(file, line)) network.push_back(station_of(line));
  }
  if (network.empty()) throw Error(Errc::invalid_argument, "no station: give --stations or --station");
  return network;
}

Scanner SiteOptions::scanner() const {
  Scanner scanner;
  scanner.azimuth_step = scanner.zenith_step = Angle::degrees(step_deg);
  if (noise) scanner.noise = rtc360_noise();
  return scanner;
}

SimulatorConfig SiteOptions::config() const {
  SimulatorConfig config;
  config.user_size_m = user_size_m;
  config.point_spacing_m = spacing_m;
  config.noise = noise;
  return config;
}

TracedSite SiteOptions::traced(const Scene& site, const Network& network) const {
  const auto grid = std::make_shared<const VoxelGrid>(VoxelGrid::build(site.data(), user_size_m));
  TracedSite traced{.scene = {.scene = {std::make_shared<const Scene>(site), &site.data()},
                              .grid = grid,
                              .scanners = {{std::make_shared<const RayPattern>(make_pattern(scanner())),
                                            std::make_shared<const NoiseModel>(noise ? make_noise_model(scanner(), 1)
                                                                                     : NoiseModel{})}}},
                    .stations = {},
                    .goal_density = grid->voxel_size() * grid->voxel_size() / (spacing_m * spacing_m)};
  for (const Station& station : network) {
    const Vec3 p = station.position - site.data().origin;
    traced.stations.push_back({{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)},
                               static_cast<std::uint32_t>(traced.stations.size())});
  }
  return traced;
}

std::vector<EngineInfo> SiteOptions::engines_here() const {
  std::vector<EngineInfo> found;
  for (const EngineInfo& info : list_engines()) {
    const bool wanted =
        engines.empty() || std::find(engines.begin(), engines.end(), to_string(info.engine)) != engines.end();
    if (wanted && info.usable) found.push_back(info);
  }
  if (found.empty()) throw Error(Errc::no_suitable_device, "none of the wanted engines runs on this machine");
  return found;
}

Simulator SiteOptions::simulator(const Scene& site, std::span<const std::size_t> devices) const {
  SimulatorConfig own = config();
  const EngineInfo engine = engines_here().front();
  own.engine = engine.engine;
  const std::vector<DeviceChoice> all = all_devices(engine.engine);
  for (const std::size_t device : devices) {
    if (device >= all.size())
      throw Error(Errc::invalid_argument, "there is no device " + std::to_string(device) + " among " +
                                              std::to_string(all.size()) + ", counted from 0");
    own.devices.push_back(all[device]);
  }
  if (devices.empty() && engine.engine != Engine::embree) own.device_index = engine.device_index;
  return Simulator(site, scanner(), own);
}

}  // namespace vantage::bench
