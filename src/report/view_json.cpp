// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "map/plan_levels.hpp"
#include "report/coverage_cells.hpp"
#include "report/packed.hpp"
#include "report/report_json.hpp"
#include "report/surface_mesh.hpp"

namespace vantage {
namespace {

using nlohmann::ordered_json;

// Limits that keep a page of a large site below 5 MB (docs/files.md).
constexpr std::size_t kTriangles = 200'000, kCells = 250'000, kNetworks = 16;
constexpr std::uint64_t kVoxels = 1'000'000;     // represented by cells
constexpr std::uint64_t kSampled = 400'000;      // voxels traced for all networks together, at most
constexpr std::uint64_t kLeastSampled = 10'000;  // and for each, at least

ordered_json mesh_json(const SurfaceMesh& mesh) {
  // Neighbours differ little: each coordinate is stored as its difference from the one before, modulo 2^16.
  std::vector<std::uint16_t> steps;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::uint16_t last = 0;
    for (const auto& p : mesh.positions) {
      steps.push_back(static_cast<std::uint16_t>(p[axis] - last));
      last = p[axis];
    }
  }
  // An index is stored as its distance below the first unused one: 0 for a new vertex.
  std::vector<std::uint32_t> back;
  std::uint32_t fresh = 0;
  for (const std::uint32_t index : mesh.triangles) {
    back.push_back(fresh - index);
    if (index == fresh) ++fresh;
  }
  return {{"low", point_json(mesh.box.min)},
          {"high", point_json(mesh.box.max)},
          {"surveyed_low", point_json(mesh.surveyed.min)},
          {"surveyed_high", point_json(mesh.surveyed.max)},
          {"vertices", mesh.positions.size()},
          {"triangles", mesh.triangles.size() / 3},
          {"error_m", mesh.error_m},
          {"positions", packed(byte_planes<std::uint16_t>(steps))},
          {"kinds", packed(mesh.kinds)},
          {"indices", packed(byte_planes<std::uint32_t>(back))}};
}

// Traces each station alone on a sample of the voxels; the sum is the network's.
CellColours sampled_colours(const CoverageCells& cells, std::span<const PlacedStation> stations,
                            std::span<const std::uint32_t> voxel_indices, Simulator& simulator, std::stop_token stop,
                            bool& cancelled) {
  std::vector<Network> alone;
  std::vector<std::size_t> number;
  for (std::size_t k = 0; k < stations.size(); ++k) {
    if (!active(stations[k])) continue;
    alone.push_back({{.position = stations[k].position, .setup = stations[k].setup}});
    number.push_back(k);
  }
  std::vector<std::uint32_t> counts(voxel_indices.size(), 0);
  std::vector<Seer> seen_by(voxel_indices.size(), 0);
  const auto add = [&](std::size_t network, std::span<const std::uint32_t> points) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      counts[i] += points[i];
      if (points[i] > 0) seen_by[i] = together(seen_by[i], static_cast<Seer>(number[network] + 1));
    }
  };
  if (!alone.empty())
    for (const NetworkCounts& done : simulator.evaluate_sampled(
             alone, {.voxels = voxel_indices.size(), .overlap = false, .points = add}, {.stop = std::move(stop)}))
      cancelled = cancelled || done.cancelled;
  return cell_colours(cells, voxel_indices, counts, seen_by, simulator);
}

CellColours exact_colours(const CoverageCells& cells, const VoxelField& field, const Simulator& simulator) {
  std::vector<std::uint32_t> counts;
  std::vector<Seer> seen_by;
  for (const std::uint32_t voxel : cells.voxels) {
    counts.push_back(field.count[voxel]);
    seen_by.push_back(seer_of(field, voxel));
  }
  return cell_colours(cells, cells.voxels, counts, seen_by, simulator);
}

// The answer, and others spread evenly over the front.
std::vector<std::size_t> coloured_networks(const Report& report) {
  const std::size_t all = report.networks.size(), some = std::min(all, kNetworks);
  std::vector<std::size_t> chosen{report.answer};
  for (std::size_t k = 0; k < some; ++k) chosen.push_back(some > 1 ? k * (all - 1) / (some - 1) : 0);
  std::ranges::sort(chosen);
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  return chosen;
}

// An object for each network; null if its colours are not kept.
ordered_json colours_json(const Report& report, Simulator& simulator, const CoverageCells& cells,
                          const Progress& progress) {
  ordered_json colours = ordered_json::array();
  for (std::size_t k = 0; k < report.networks.size(); ++k) colours.push_back(nullptr);
  const std::vector<std::size_t> chosen = coloured_networks(report);
  const std::uint64_t voxels = std::min<std::uint64_t>(
      cells.voxels.size(), std::max(kLeastSampled, kSampled / static_cast<std::uint64_t>(chosen.size())));
  const std::vector<std::uint32_t> sample = simulator.sampled_voxels(voxels);
  double done = 0;
  for (const std::size_t k : chosen) {
    const VoxelField* const field = k == report.answer ? report.options.field : nullptr;
    bool cancelled = false;
    const CellColours network = field ? exact_colours(cells, *field, simulator)
                                      : sampled_colours(cells, report.networks[k].evaluation.stations, sample,
                                                        simulator, progress.stop, cancelled);
    if (!cancelled)
      colours[k] = {{"sample", field ? std::uint64_t{0} : voxels},
                    {"coverage", packed(network.coverage)},
                    {"only", packed(network.only)}};
    if (progress.report) progress.report(++done / static_cast<double>(chosen.size()));
  }
  return colours;
}

// Returns the storeys of a covered site, slices with walls and heads but no ceilings. Empty for an open site.
ordered_json levels_json(Site& site, std::span<const PlacedStation> stations) {
  const std::vector<PlanLevel> levels = cut_levels(site.scene(), site.area().mesh(), stations);
  if (levels.size() == 1 && !levels.front().cut) return ordered_json::array();
  double height = site.scanner().height_m;
  for (const PlacedStation& s : stations)
    if (s.status != StationStatus::hole) height = std::max(height, s.position.z - s.ground.z);
  const Box bounds = site.scene().bounds();
  ordered_json json = ordered_json::array();
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const double above = levels[k].floor + 1.1 * height;  // heads clear of the cut, below most ceilings
    json.push_back({{"floor", levels[k].floor},
                    {"low", k == 0 ? bounds.min.z : levels[k].low},
                    {"high", k + 1 < levels.size() ? std::min(above, levels[k + 1].floor) : above}});
  }
  return json;
}

}  // namespace

ordered_json site_json(Site& site, std::span<const PlacedStation> stations, const CoverageCells& cells) {
  const Simulator& simulator = site.simulator();
  ordered_json json = {{"origin", point_json(simulator.origin())},
                       {"mesh", mesh_json(surface_mesh(simulator.scene().data(), kTriangles))},
                       {"levels", levels_json(site, stations)},
                       {"voxel_m", simulator.voxel_size_m()},
                       {"goal", simulator.goal_density()},
                       {"cells", nullptr}};
  if (cells.keys.empty()) return json;
  std::vector<std::uint32_t> steps;
  for (std::size_t c = 0; c < cells.keys.size(); ++c) steps.push_back(cells.keys[c] - (c > 0 ? cells.keys[c - 1] : 0));
  json["cells"] = {{"corner", point_json(cells.corner)},
                   {"size_m", cells.size_m},
                   {"count", cells.keys.size()},
                   {"keys", packed(byte_planes<std::uint32_t>(steps))},
                   {"reasons", nullptr}};
  return json;
}

ordered_json view_json(const Report& report, Site& site, const Progress& progress) {
  Simulator& simulator = site.simulator();
  if (progress.stop.stop_requested()) return {};
  const CoverageCells cells = coverage_cells(simulator, kVoxels, kCells);
  if (progress.stop.stop_requested()) return {};
  ordered_json json = site_json(site, report.shown().stations, cells);
  if (cells.keys.empty()) return json;
  json["cells"]["networks"] = colours_json(report, simulator, cells, progress);
  if (const MissedVoxels* const missed = report.options.missed; missed && !missed->voxels.empty())
    json["cells"]["reasons"] = packed(cell_reasons(cells, missed->voxels, missed->status));
  return json;
}

}  // namespace vantage
