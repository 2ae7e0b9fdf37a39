// SPDX-License-Identifier: Apache-2.0
#include "scan/limit_model.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "scan/noise_model.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

// Returns the first surveyed mesh with this wish; null if there is none.
const MeshInfo* first_with(const SceneData& scene, double MeshInfo::*wish) {
  const auto found = std::ranges::find_if(
      scene.meshes, [&](const MeshInfo& mesh) { return mesh.role == Role::surveyed && mesh.*wish > 0; });
  return found == scene.meshes.end() ? nullptr : &*found;
}

// Returns the square of the detection distance; 0 if every echo is detected. The power received from a matt surface
// larger than the beam is proportional to ρ·cos α / R² (laser radar equation of extended targets).
float reach_square(const Scanner& scanner, double reflectivity) {
  constexpr float kNowhere = 1e-20f;  // a black surface: nearer than any scanner measures, and not 0
  if (scanner.detection_range_m == 0) return 0;
  const double square = scanner.detection_range_m * scanner.detection_range_m;
  return std::max(static_cast<float>(square * reflectivity / scanner.detection_reflectivity), kNowhere);
}

}  // namespace

bool loses_echoes(const Scanner& scanner) { return scanner.detection_range_m > 0 || scanner.dropout > 0; }

std::optional<Angle> incidence_limit(const SceneData& scene, const SimulatorConfig& config) {
  if (config.max_incidence) return config.max_incidence;
  if (first_with(scene, &MeshInfo::detail_m) || first_with(scene, &MeshInfo::accuracy_m)) return default_max_incidence;
  return std::nullopt;
}

LimitModel make_limit_model(const SceneData& scene, const Scanner& scanner, const SimulatorConfig& config,
                            bool always) {
  LimitModel model;
  std::optional<Angle> incidence = incidence_limit(scene, config);
  if (!incidence && (always || loses_echoes(scanner))) incidence = Angle::degrees(90);
  if (!incidence) return model;
  const double degrees = incidence->in_degrees();
  if (!(degrees > 0 && degrees <= 90 + 1e-9))
    throw Error(Errc::invalid_argument,
                "the largest incidence is " + std::to_string(degrees) + "°; it must be above 0° and at most 90°");
  if (const MeshInfo* const mesh = first_with(scene, &MeshInfo::detail_m);
      mesh && scanner.beam_divergence.in_radians() == 0 && scanner.exit_diameter_m == 0) {
    throw Error(Errc::invalid_argument,
                "a detail is wanted of \"" + mesh->name + "\", but the beam of the scanner \"" + scanner.name +
                    "\" is not known: choose a scanner that states it, or give its divergence and exit diameter");
  }
  if (const MeshInfo* const mesh = first_with(scene, &MeshInfo::accuracy_m)) {
    if (scanner.noise.empty())
      throw Error(Errc::invalid_argument, "an accuracy is wanted of \"" + mesh->name + "\", but the scanner \"" +
                                              scanner.name + "\" has no noise table: give one");
    model.noise = std::make_shared<const NoiseModel>(make_noise_model(scanner, config.seed));
  }
  const double cosine = std::cos(incidence->in_radians());
  const float least = degrees < 90 - 1e-9 ? static_cast<float>(cosine * cosine) : 0.0f;
  model.exit_diameter = static_cast<float>(scanner.exit_diameter_m);
  model.divergence = static_cast<float>(scanner.beam_divergence.in_radians());
  model.lost_below = static_cast<std::uint32_t>(scanner.dropout * 0x1p32);
  model.seed = config.seed;
  model.glass = scanner.detection_range_m > 0 && scene.has_glass();
  for (const MeshInfo& mesh : scene.meshes) {
    // A mirror has no echo of its own that could be too weak.
    model.meshes.push_back({.largest_reach_square = mesh.mirror ? 0 : reach_square(scanner, mesh.diffuse)});
    if (mesh.role != Role::surveyed) continue;
    model.meshes.back() = {least, static_cast<float>(mesh.detail_m * mesh.detail_m),
                           static_cast<float>(mesh.accuracy_m), model.meshes.back().largest_reach_square};
  }
  if (model.noise && !model.noise->enabled()) {  // a table of zeros, which no point misses
    model.noise = nullptr;
    for (LimitModel::Limits& limits : model.meshes) limits.largest_sigma = 0;
  }
  return model;
}

}  // namespace vantage
