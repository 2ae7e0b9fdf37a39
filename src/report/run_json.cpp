// SPDX-License-Identifier: Apache-2.0
#include "report/run_json.hpp"

#include <cstdio>

#include "vantage/export.hpp"
#include "vantage/version.hpp"

namespace vantage {
namespace {

using nlohmann::ordered_json;

ordered_json to_json(const Vec3& v) { return {v.x, v.y, v.z}; }

ordered_json to_json(std::span<const Vec3> points) {
  ordered_json array = ordered_json::array();
  for (const Vec3& p : points) array.push_back(to_json(p));
  return array;
}

ordered_json scene_json(const Scene& scene) {
  char fingerprint[17];
  std::snprintf(fingerprint, sizeof fingerprint, "%016llx", static_cast<unsigned long long>(scene.fingerprint()));
  std::size_t surveyed = 0;
  for (const MeshInfo& mesh : scene.meshes()) surveyed += mesh.role == Role::surveyed ? 1 : 0;
  const Box box = scene.bounds();
  return {{"fingerprint", fingerprint},
          {"triangles", scene.triangle_count()},
          {"meshes", scene.meshes().size()},
          {"surveyed_meshes", surveyed},
          {"bounds", {to_json(box.min), to_json(box.max)}}};
}

ordered_json scanner_json(const Scanner& scanner) {
  return {{"name", scanner.name},
          {"heading_deg", scanner.heading.in_degrees()},
          {"horizontal_angle_deg", scanner.horizontal_angle.in_degrees()},
          {"vertical_angle_deg", scanner.vertical_angle.in_degrees()},
          {"azimuth_step_deg", scanner.azimuth_step.in_degrees()},
          {"zenith_step_deg", scanner.zenith_step.in_degrees()},
          {"rays", scanner.rays()},
          {"height_m", scanner.height_m},
          {"min_range_m", scanner.min_range_m},
          {"max_range_m", scanner.max_range_m},
          {"noise",
           {{"distances_m", scanner.noise.distances_m},
            {"reflectivities", scanner.noise.reflectivities},
            {"sigma_m", scanner.noise.sigma_m}}}};
}

ordered_json plan_json(const PlanConfig& plan) {
  ordered_json json = {{"problem", to_string(plan.problem)},
                       {"stations_min", plan.stations_min},
                       {"stations_max", plan.stations_max},
                       {"population", plan.population},
                       {"iterations", plan.iterations},
                       {"sigma0", plan.sigma0},
                       {"algorithm", to_string(plan.algorithm)},
                       {"scheme", plan.scheme == MoCmaEsConfig::Scheme::generational ? "generational" : "steady-state"},
                       {"batch", plan.batch},
                       {"sample_voxels", plan.sample_voxels},
                       {"redraws", plan.redraws},
                       {"min_link_overlap", plan.min_link_overlap},
                       {"heights_m", nullptr},
                       {"start", to_json(plan.start)},
                       {"fixed", to_json(plan.fixed)},
                       {"max_seconds", plan.max_seconds},
                       {"target_hypervolume", nullptr},
                       {"stagnation_iterations", plan.stagnation_iterations},
                       {"seed", plan.seed}};
  if (plan.fitness)
    json["fitness"] = {{"coverage", plan.fitness->coverage},
                       {"station_count", plan.fitness->station_count},
                       {"visibility", plan.fitness->visibility}};
  if (plan.heights_m) json["heights_m"] = *plan.heights_m;
  if (plan.target_hypervolume) json["target_hypervolume"] = *plan.target_hypervolume;
  return json;
}

// What registration will hang by. Stations are numbered from 1, as in the tables and pictures.
ordered_json links_json(const OverlapMatrix& overlap, double min_overlap) {
  const Connectivity graph = connectivity(overlap, min_overlap);
  ordered_json bridges = ordered_json::array();
  for (const auto& [i, j] : graph.bridges) bridges.push_back({i + 1, j + 1});
  ordered_json json = {
      {"min_overlap", min_overlap}, {"parts", graph.parts}, {"bridges", std::move(bridges)}, {"weakest", nullptr}};
  if (graph.parts == 1 && overlap.size() > 1)
    json["weakest"] = {{"stations", {graph.weakest_link.first + 1, graph.weakest_link.second + 1}},
                       {"overlap", graph.weakest_overlap}};
  return json;
}

ordered_json entry_json(const PlanEntry& entry, const PlanConfig& config) {
  ordered_json stations = ordered_json::array();
  for (std::size_t i = 0; i < entry.stations.size(); ++i) {
    const PlacedStation& s = entry.stations[i];
    ordered_json station = {{"position", nullptr}, {"uv", {s.uv.u, s.uv.v}}, {"status", to_string(s.status)}};
    if (s.status != StationStatus::hole) station["position"] = to_json(s.position);
    if (entry.confirmed && i < entry.points_on_surveyed.size())
      station["points_on_surveyed"] = entry.points_on_surveyed[i];
    stations.push_back(std::move(station));
  }
  ordered_json json = {{"coverage", entry.coverage},
                       {"coverage_se", entry.coverage_se},
                       {"overlap", entry.overlap},
                       {"overlap_se", entry.overlap_se},
                       {"station_count", entry.stations.size()},
                       {"exact", nullptr},
                       {"stations", std::move(stations)},
                       {"x", entry.x}};
  if (entry.confirmed) {
    json["exact"] = {
        {"coverage", entry.exact_coverage}, {"overlap", entry.exact_overlap}, {"dominated", entry.dominated}};
    json["links"] = links_json(entry.exact_overlap_matrix, link_overlap(config));
  }
  return json;
}

}  // namespace

ordered_json run_parameters(const Simulator& simulator, const PlanConfig* plan) {
  const SimulatorConfig& config = simulator.config();
  ordered_json json = {{"version", version()},
                       {"engine", to_string(simulator.engine().engine)},
                       {"device", simulator.engine().device},
                       {"driver", simulator.engine().driver},
                       {"scene", scene_json(simulator.scene())},
                       {"scanner", scanner_json(simulator.scanner())},
                       {"user_size_m", config.user_size_m},
                       {"point_spacing_m", config.point_spacing_m},
                       {"noise", config.noise && !simulator.scanner().noise.empty()},
                       {"seed", config.seed},
                       {"voxels", simulator.voxel_count()},
                       {"voxel_size_m", simulator.voxel_size_m()},
                       {"goal_density", simulator.goal_density()}};
  if (plan) json["plan"] = plan_json(*plan);
  return json;
}

std::string run_parameters_json(const Simulator& simulator, const PlanConfig* plan) {
  return run_parameters(simulator, plan).dump(2);
}

std::string front_json(const PlanResult& result, const PlanConfig& config, const Simulator& simulator) {
  ordered_json front = ordered_json::array();
  for (const PlanEntry& entry : result.front) front.push_back(entry_json(entry, config));
  ordered_json json = {{"problem", to_string(config.problem)}, {"objectives", objective_names(config)},
                       {"hypervolume", result.hypervolume},    {"exact_hypervolume", result.exact_hypervolume},
                       {"evaluations", result.evaluations},    {"stations_drawn", result.drawn},
                       {"stations_redrawn", result.redrawn},   {"stop_reason", to_string(result.stop_reason)}};
  if (!result.front.empty()) json["compromise"] = compromise(result, config);
  json["front"] = std::move(front);
  json["seconds"] = {{"total", result.seconds}, {"trace", result.trace_seconds}};
  json["engine"] = to_string(simulator.engine().engine);
  json["device"] = simulator.engine().device;
  json["seed"] = config.seed;
  json["version"] = version();
  json["parameters"] = run_parameters(simulator, &config);
  return json.dump(2) + "\n";
}

}  // namespace vantage
