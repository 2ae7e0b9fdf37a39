// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include "core/hash.hpp"
#include "core/setting_list.hpp"
#include "core/setting_table.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

Settings settings(const Scanner& scanner) {
  SettingList list;
  list.add("name", scanner.name, {.decides = false})
      .add("heading_deg", scanner.heading, {"heading"})
      .add("horizontal_angle_deg", scanner.horizontal_angle, {"horizontal"})
      .add("vertical_angle_deg", scanner.vertical_angle, {"vertical"})
      .add("zenith_start_deg", scanner.zenith_start, {"zenith-start"})
      .add("azimuth_step_deg", scanner.azimuth_step, {"step"})
      .add("zenith_step_deg", scanner.zenith_step, {"step"})
      .add("height_m", scanner.height_m, {"height"})
      .add("min_range_m", scanner.min_range_m, {"range"})
      .add("max_range_m", scanner.max_range_m, {"range"})
      .add("points_per_second", scanner.points_per_second, {"rate"})
      .add("noise", nlohmann::ordered_json{{"distances_m", scanner.noise.distances_m},
                                           {"reflectivities", scanner.noise.reflectivities},
                                           {"sigma_m", scanner.noise.sigma_m}})
      .add("beam_divergence_mrad", scanner.beam_divergence.in_radians() * 1e3, {"beam"})
      .add("exit_diameter_mm", scanner.exit_diameter_m * 1e3, {"beam"});
  if (!scanner.row_zeniths.empty()) list.add("row_zeniths_deg", scanner.row_zeniths);
  if (!scanner.directions.empty()) {  // too many to list
    Hash hash;
    hash.add_all(scanner.directions), hash.add_all(scanner.times_s);
    list.add("directions", nlohmann::ordered_json{{"rays", scanner.directions.size()}, {"hash", hash.value()}});
  }
  if (scanner.angle_accuracy.in_radians() > 0 || scanner.range_accuracy_m > 0 || scanner.range_accuracy_ppm > 0)
    list.add("angle_accuracy_arcsec", scanner.angle_accuracy.in_degrees() * 3600, {"calibration"})
        .add("range_accuracy_mm", scanner.range_accuracy_m * 1e3, {"calibration"})
        .add("range_accuracy_ppm", scanner.range_accuracy_ppm, {"calibration"});
  // It enters a plan through registration's own setting.
  if (scanner.tilt_accuracy.in_radians() > 0)
    list.add("tilt_accuracy_arcsec", scanner.tilt_accuracy.in_degrees() * 3600, {.decides = false});
  if (scanner.battery_min > 0 || scanner.battery_scans > 0)
    list.add("battery_min", scanner.battery_min, {"battery", false})
        .add("battery_scans", scanner.battery_scans, {"battery", false});
  if (scanner.detection_range_m > 0)
    list.add("detection_range_m", scanner.detection_range_m, {"detection"})
        .add("detection_reflectivity", scanner.detection_reflectivity, {"detection"});
  if (scanner.dropout > 0) list.add("dropout", scanner.dropout, {"dropout"});
  return list.take();
}

Settings settings(const SimulatorConfig& config) {
  std::vector<std::string> devices;
  for (const DeviceChoice& device : config.devices)
    devices.push_back(to_string(device.engine) + (device.index ? " " + std::to_string(*device.index) : ""));
  return SettingList()
      .add("engine", to_string(config.engine), {.decides = false})
      .add("device_index", config.device_index, {.decides = false})
      .add("devices", devices, {.decides = false})
      .add("user_size_m", config.user_size_m, {"user-size"})
      .add("point_spacing_m", config.point_spacing_m, {"spacing"})
      .add("spacing_by_detail", config.spacing_by_detail, {config.spacing_by_detail ? "spacing-by-detail" : ""})
      .add("max_incidence_deg", config.max_incidence, {"incidence"})
      .add("noise", config.noise)
      .add("seed", config.seed, {"seed"})
      .add("validation", config.validation, {.decides = false})
      .add("max_rays_per_dispatch", config.max_rays_per_dispatch, {.decides = false})
      .take();
}

const SettingTable<std::optional<BeamOptions>>& beam_settings() {
  using Beam = std::optional<BeamOptions>;
  const auto own = [](Beam& beam) -> BeamOptions& { return beam ? *beam : beam.emplace(); };
  const auto given = [](const Beam& beam) { return beam.has_value(); };
  static const SettingTable<Beam> table =
      SettingRows<Beam>()
          .group("Beam")
          .custom(
              "returns", "WHICH",
              "Give the beam its width, and take the first, strongest or last return of each ray, or all",
              [own](Beam& beam, const std::string& text, const std::string& what) {
                own(beam).returns = named(what, [&] { return returns_from_string(text); });
              },
              given)
          .custom(
              "sub-rays", "N", "Sub-rays of a beam with a width: 7 or 19; 7 otherwise",
              [own](Beam& beam, const std::string& text, const std::string& what) {
                own(beam).sub_rays = static_cast<std::uint32_t>(parse_count(text, what, 7, 19));
              },
              given)
          .custom(
              "pulse", "M", "Length of a pulse: surfaces nearer together than half of it share a return; 1 otherwise",
              [own](Beam& beam, const std::string& text, const std::string& what) {
                own(beam).pulse_m = parse_number(text, what, kMeasurable);
              },
              given)
          .checked([](const Beam& beam, const std::string& what) {
            if (beam) check_number(beam->pulse_m, what, kMeasurable);
          })
          .take();
  return table;
}

}  // namespace vantage
