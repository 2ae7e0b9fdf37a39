// SPDX-License-Identifier: Apache-2.0
#include "report/accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "map/voxel_errors.hpp"
#include "report/place_names.hpp"

namespace vantage {
namespace {

constexpr std::uint64_t kJudged = 400'000;  // voxels

struct Sums {
  double squares = 0, worst_mm = 0;
  std::size_t voxels = 0, beyond = 0;
};

}  // namespace

std::optional<Accuracy> accuracy_of(const Evaluation& network, const VoxelField* field, const Simulator& simulator) {
  const std::uint64_t voxels = simulator.voxel_count();
  if (!network.registration || !field || field->stations.empty() || voxels == 0) return std::nullopt;
  const std::vector<std::uint32_t> sample = simulator.sampled_voxels(std::min(kJudged, voxels));
  const std::vector<float> errors = voxel_errors_mm(simulator, *field, *network.registration, sample);
  const std::vector<VoxelPatch> patches = simulator.voxel_patches(sample);
  const PlaceNames names(simulator.scene());
  const double allowed_mm = 1000 * largest_error_m(network.accuracy_class);
  std::map<std::string, Sums> sums;
  for (std::size_t k = 0; k < sample.size(); ++k) {
    if (errors[k] < 0) continue;
    Sums& sum = sums[names.of(patches[k])];
    const double error_mm = error_at_95_percent(errors[k]);
    sum.squares += error_mm * error_mm;
    sum.worst_mm = std::max(sum.worst_mm, error_mm);
    sum.beyond += error_mm > allowed_mm ? 1 : 0;
    ++sum.voxels;
  }
  Accuracy accuracy{.by_room = !simulator.scene().rooms().empty()};
  for (const auto& [name, sum] : sums) {
    const auto all = static_cast<double>(sum.voxels);
    accuracy.places.push_back({.name = name.empty() ? "(no name)" : name,
                               .mean_m = std::sqrt(sum.squares / all) / 1000,
                               .worst_m = sum.worst_mm / 1000,
                               .beyond = static_cast<double>(sum.beyond) / all});
  }
  std::ranges::stable_sort(accuracy.places, std::ranges::greater{}, &PlaceAccuracy::worst_m);
  return accuracy;
}

}  // namespace vantage
