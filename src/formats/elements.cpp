// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include "core/atomic_file.hpp"
#include "core/parallel.hpp"
#include "core/text.hpp"
#include "map/voxel_errors.hpp"
#include "scan/captured_share.hpp"
#include "scene/meshes_by_name.hpp"
#include "scene/scene_data.hpp"
#include "vantage/error.hpp"
#include "vantage/export.hpp"
#include "words/csv_cell.hpp"

namespace vantage {
namespace {

constexpr std::uint64_t kMostVoxels = 50'000;  // whose surfaces are looked at, as for what is missed

// Names as the importer of IFC makes them: "IfcWall North wall 2O2Fr$t4X7Zf8NOew3FLOH".
void split_ifc_name(ElementShare& element) {
  constexpr std::size_t kGlobalId = 22;
  const std::string_view name = element.name;
  const std::size_t first = std::min(name.find(' '), name.size());
  const auto letter = [](unsigned char c) { return std::isalnum(c) != 0; };
  if (!name.starts_with("Ifc") || first <= 3 || !std::ranges::all_of(name.substr(0, first), letter)) return;
  element.ifc_class = name.substr(0, first);
  const std::string_view last = name.substr(std::min(name.rfind(' ') + 1, name.size()));
  const auto of_id = [&](unsigned char c) { return letter(c) || c == '_' || c == '$'; };
  // 128 bits in 22 digits of six: the first digit is one of four.
  if (last.size() == kGlobalId && last[0] >= '0' && last[0] <= '3' && std::ranges::all_of(last, of_id))
    element.global_id = last;
}

double area_of(const SceneData& scene, const MeshRange& range) {
  double area = 0;
  for (std::uint32_t t = range.first_triangle; t < range.first_triangle + range.triangle_count; ++t) {
    const auto [a, b, c] = scene.corners(t);
    const Vec3 p = widen(a), normal = cross(widen(b) - p, widen(c) - p);
    area += std::sqrt(dot(normal, normal)) / 2;
  }
  return area;
}

std::optional<double> median(std::vector<float>& values) {
  if (values.empty()) return std::nullopt;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

// The cosine of the steepest sight of a voxel's surface among the stations that have points in it; 0: none has.
float steepest_sight(const VoxelPatch& patch, std::size_t voxel, const VoxelField& field,
                     std::span<const PlacedStation> stations) {
  double best = 0;
  field.stations.for_each_station(voxel, [&](std::size_t station) {
    const Vec3 way = patch.point - stations[station].position;
    const double range = std::sqrt(dot(way, way));
    best = std::max(best, range > 0 ? std::abs(dot(way, patch.normal)) / range : 1);
  });
  return static_cast<float>(std::min(best, 1.0));
}

struct Seen {
  double captured = 0, weights = 0, squares_mm = 0;
  std::size_t with_error = 0;
  std::vector<float> cosines, distances_m;
};

}  // namespace

std::vector<ElementShare> element_shares(const Simulator& simulator, const Evaluation& evaluation,
                                         const VoxelField& field) {
  const std::uint64_t voxels = simulator.voxel_count();
  if (field.count.size() != voxels || (!field.stations.empty() && field.stations.voxels() != voxels))
    throw Error(Errc::invalid_argument, "elements: the evaluation has not the points of every voxel of this simulator");
  const SceneData& scene = simulator.scene().data();
  const MeshesByName meshes = meshes_by_name(scene.meshes, true);
  std::vector<ElementShare> elements;
  for (const std::string& name : meshes.names) split_ifc_name(elements.emplace_back(ElementShare{.name = name}));
  for (std::size_t m = 0; m < scene.meshes.size(); ++m)
    if (scene.meshes[m].role == Role::surveyed) elements[meshes.of_mesh[m]].area_m2 += area_of(scene, scene.ranges[m]);
  if (voxels == 0) return elements;

  const std::vector<std::uint32_t> sample = simulator.sampled_voxels(std::min(kMostVoxels, voxels));
  const std::vector<VoxelPatch> patches = simulator.voxel_patches(sample);
  std::vector<float> errors_mm, cosines(sample.size(), 0);
  const bool masks = !field.stations.empty();
  if (evaluation.registration && masks) errors_mm = voxel_errors_mm(simulator, field, *evaluation.registration, sample);
  if (masks)
    parallel::for_all(std::size_t{0}, sample.size(), [&](std::size_t k) {
      cosines[k] = steepest_sight(patches[k], sample[k], field, evaluation.stations);
    });
  std::vector<Seen> seen(elements.size());
  for (std::size_t k = 0; k < sample.size(); ++k) {
    const std::uint32_t voxel = sample[k];
    const std::size_t element = meshes.of_mesh[patches[k].mesh];
    Seen& sum = seen[element];
    const double weight = simulator.voxel_weight(voxel);
    ++elements[element].voxels;
    sum.weights += weight;
    sum.captured += weight * captured_share(simulator, voxel, field.count[voxel]);
    if (field.count[voxel] > 0 && patches[k].area_m2 > 0)
      sum.distances_m.push_back(static_cast<float>(std::sqrt(patches[k].area_m2 / field.count[voxel])));
    if (cosines[k] > 0) sum.cosines.push_back(cosines[k]);
    if (!errors_mm.empty() && errors_mm[k] >= 0)
      sum.squares_mm += static_cast<double>(errors_mm[k]) * errors_mm[k], ++sum.with_error;
  }
  for (std::size_t e = 0; e < elements.size(); ++e) {
    ElementShare& element = elements[e];
    Seen& sum = seen[e];
    if (element.voxels > 0) element.captured = sum.captured / sum.weights;
    if (const auto cosine = median(sum.cosines)) element.incidence = Angle::radians(std::acos(*cosine));
    element.point_distance_m = median(sum.distances_m);
    if (sum.with_error > 0)
      element.deviation_m = std::sqrt(sum.squares_mm / static_cast<double>(sum.with_error)) / 1000;
  }
  return elements;
}

void write_elements_csv(const std::filesystem::path& file, std::span<const ElementShare> elements) {
  std::string text = "name,class,global_id,area_m2,voxels,captured,incidence,point_distance_mm,deviation_mm\n";
  const auto cell = [](const std::optional<double>& value, int digits) {
    return "," + (value ? fixed(*value, digits) : std::string());
  };
  for (const ElementShare& one : elements) {
    const auto in = [](std::optional<double> value, double factor) { return value ? *value * factor : value; };
    text += csv_cell(one.name) + "," + csv_cell(one.ifc_class) + "," + csv_cell(one.global_id) + "," +
            fixed(one.area_m2, 3) + "," + number(one.voxels) + cell(one.captured, 4) +
            cell(one.incidence ? std::optional(one.incidence->in_degrees()) : std::nullopt, 1) +
            cell(in(one.point_distance_m, 1000), 1) + cell(in(one.deviation_m, 1000), 1) + "\n";
  }
  write_atomically(file, text);
}

}  // namespace vantage
