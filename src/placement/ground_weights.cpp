// SPDX-License-Identifier: Apache-2.0
#include "placement/ground_weights.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "core/parallel.hpp"
#include "core/plastic_number.hpp"
#include "core/text.hpp"
#include "scene/scene_data.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

constexpr double kUpwardCosine = 0.7071067811865476;  // cosine of 45°
constexpr double kLeastStoodOn = 0.25;
constexpr std::uint32_t kHeaviestWeight = 255;
// Largest distance from a search area to the surfaces it was made of, for thin covers such as a carpet or a kerb.
constexpr double kSameSurface_m = 0.15;
// Number of points tested over all upward surfaces.
constexpr double kSamples = 20'000;
constexpr int kMostSamples = 4096;  // per triangle

struct Area {
  double all = 0, up = 0, stood_on = 0;
};

}  // namespace

bool ground_is_unmarked(const Scene& scene, const SearchArea& area) {
  if (!area.derived() || !scene.options().surveyed.empty() || !scene.options().weights.empty()) return false;
  // Once the file marks a mesh as surveyed, unmarked meshes are blocking.
  const bool patterns_block = !scene.options().blocking.empty();
  // Nor does anybody mark panes and mirrors, which are blocking by nature.
  return std::ranges::all_of(scene.meshes(), [&](const MeshInfo& mesh) {
    return mesh.weight == 1 && (mesh.role == Role::surveyed || mesh.glass || mesh.mirror || patterns_block);
  });
}

GroundWeights ground_weights(const Scene& scene, const SearchArea& area) {
  const SceneData& data = scene.data();
  std::vector<Area> areas(data.meshes.size());
  const auto for_each_surveyed = [&](auto&& with) {
    parallel::for_all(std::size_t{0}, data.meshes.size(), [&](std::size_t m) {
      if (data.meshes[m].role != Role::surveyed) return;
      const MeshRange& range = data.ranges[m];
      for (std::uint32_t t = range.first_triangle; t < range.first_triangle + range.triangle_count; ++t) {
        const auto p = data.corners(t);
        const Vec3 a = widen(p[0]), b = widen(p[1]), c = widen(p[2]), normal = cross(b - a, c - a);
        const double twice = std::sqrt(dot(normal, normal));
        // Models are wound either way, so a ceiling may count as upward, too; nobody stands on it.
        if (twice > 0) with(areas[m], a, b, c, twice / 2, std::abs(normal.z) >= kUpwardCosine * twice);
      }
    });
  };
  for_each_surveyed([&](Area& of, const Vec3&, const Vec3&, const Vec3&, double size, bool is_up) {
    of.all += size;
    if (is_up) of.up += size;
  });
  double all = 0, up = 0;
  for (const Area& of : areas) all += of.all, up += of.up;
  GroundWeights found;
  found.weights.assign(data.meshes.size(), 1);
  if (!(all > 0 && up > 0)) return found;
  // Points of each triangle by a low-discrepancy walk, in proportion to its share of the upward surface.
  for_each_surveyed([&](Area& of, const Vec3& a, const Vec3& b, const Vec3& c, double size, bool is_up) {
    if (!is_up) return;
    const int n = std::clamp(static_cast<int>(std::ceil(kSamples * size / up)), 1, kMostSamples);
    int on = 0;
    for (int k = 0; k < n; ++k) {
      const double s = 0.5 + (k + 1) / kPlastic, t = 0.5 + (k + 1) / (kPlastic * kPlastic);
      const double root = std::sqrt(s - std::floor(s)), along = t - std::floor(t);
      const Vec3 p = data.origin + a * (1 - root) + b * (root * (1 - along)) + c * (root * along);
      const auto uv = area.project(p);
      const auto ground = uv ? area.locate(*uv) : std::nullopt;
      if (ground && std::abs(ground->z - p.z) <= kSameSurface_m) ++on;
    }
    of.stood_on += size * on / n;
  });
  double ground = 0;
  for (std::size_t m = 0; m < areas.size(); ++m) {
    if (!(areas[m].up > 0 && areas[m].stood_on >= kLeastStoodOn * areas[m].up)) continue;
    found.ground.push_back(m);
    ground += areas[m].all;
  }
  const double others = all - ground;
  found.share = found.weighted_share = ground / all;
  if (found.share <= kMostGroundShare) return found;
  std::string names;
  for (std::size_t k = 0; k < std::min<std::size_t>(found.ground.size(), 3); ++k)
    names += (k > 0 ? ", " : "") + data.meshes[found.ground[k]].name;
  if (found.ground.size() > 3) names += ", …";
  const std::string percent = fixed(100 * found.share, 0) + " %";
  if (!(others > 0)) {
    found.told =
        "all of the surveyed surface is ground, or one mesh with it (" + names +
        "), so things on the ground cannot weigh more; mark them with the setting surveyed, or give them a mesh "
        "of their own";
    return found;
  }
  // ground / (ground + w · others) <= 1/3
  const double wanted = ground * (1 - kMostGroundShare) / (kMostGroundShare * others);
  const auto weight = static_cast<std::uint32_t>(std::clamp(std::ceil(wanted - 1e-9), 1.0, double{kHeaviestWeight}));
  for (std::size_t m = 0; m < found.weights.size(); ++m)
    if (!std::ranges::binary_search(found.ground, m)) found.weights[m] = weight;
  found.changes = weight > 1;
  found.weighted_share = ground / (ground + weight * others);
  found.told = "nothing is marked as surveyed, and " + percent + " of the surface is ground to stand on (" + names +
               "): everything else has the weight " + std::to_string(weight) + " in coverage, which leaves ground " +
               fixed(100 * found.weighted_share, 0) + " % of it; the settings weight and surveyed change this";
  return found;
}

Scene with_weights(const Scene& scene, const std::vector<std::uint32_t>& weights) {
  auto data = std::make_shared<SceneData>(scene.data());
  if (weights.size() != data->meshes.size() ||
      std::ranges::any_of(weights, [](std::uint32_t w) { return w < 1 || w > kHeaviestWeight; }))
    throw Error(Errc::invalid_argument,
                "weights: one of 1 to 255 is wanted for each of " + std::to_string(data->meshes.size()) + " meshes");
  for (std::size_t m = 0; m < weights.size(); ++m) data->meshes[m].weight = weights[m];
  return Scene(std::move(data));
}

}  // namespace vantage
