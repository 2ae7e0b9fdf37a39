// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "core/parallel.hpp"
#include "scene/changed_scene.hpp"
#include "scene/scene_data.hpp"
#include "taken/depth_picture.hpp"
#include "taken/model_surface.hpp"
#include "vantage/taken_scans.hpp"

namespace vantage {
namespace {

// Fewer points in a cell are strays; smaller things hide little.
constexpr std::uint64_t kLeastPoints = 3;
constexpr std::size_t kLeastCells = 5;
constexpr std::int32_t kReach = 2;  // cells this far apart belong to one thing: flat sides have few points
constexpr double kLeastThing_m = 0.3, kLeastOpening_m2 = 0.25;
// A ray sees through a surface if it continues behind it for some tolerances, meets it no nearer to the scanner than
// this, and not at too flat an angle.
constexpr double kBehind = 2, kFromScanner_m = 0.3, kLeastCosine = 0.3;
// A mesh is missing if this share of its extent was seen through in its two longest directions.
constexpr double kWholeMesh = 0.6;
// Shift of the grid, in cells: planes of models mostly lie at round coordinates, and cells' faces must not.
constexpr double kGridShift = 0.37;

struct CellContent {
  std::uint64_t points = 0, scans = 0;  // scans: a bit each, modulo 64
  Box box;

  void add(const glm::dvec3& p, std::uint64_t count, std::size_t scan) {
    points += count, scans |= std::uint64_t{1} << scan % 64;
    box.extend(to_vec3(p));
  }
};

struct CellHash {
  std::size_t operator()(const SolidCell& cell) const {
    std::uint64_t hash = 0;
    for (const std::int32_t c : cell) hash = (hash ^ static_cast<std::uint32_t>(c)) * 0x9E3779B97F4A7C15;
    return static_cast<std::size_t>(hash ^ hash >> 32);
  }
};

// Sparse cells of a grid.
class FoundCells {
 public:
  FoundCells(const Vec3& corner, double cell_m) : corner_(to_glm(corner)), cell_m_(cell_m) {}

  SolidCell cell_of(const glm::dvec3& p) const {
    const glm::dvec3 at = floor((p - corner_) / cell_m_);
    return {static_cast<std::int32_t>(at.x), static_cast<std::int32_t>(at.y), static_cast<std::int32_t>(at.z)};
  }
  CellContent& at(const glm::dvec3& p) { return cells_[cell_of(p)]; }
  void drop(const auto& unwanted) {
    std::erase_if(cells_, [&](const auto& entry) { return unwanted(entry.first, entry.second); });
  }
  std::size_t size() const { return cells_.size(); }
  bool has(const SolidCell& cell) const { return cells_.contains(cell); }
  const CellContent& content(const SolidCell& cell) const { return cells_.at(cell); }

  // Calls `use(cells)` for each group of cells that touch or have one cell between them, ordered by their least cell.
  template <class Use>
  void for_clusters(Use&& use) const {
    std::vector<SolidCell> all;
    for (const auto& entry : cells_) all.push_back(entry.first);
    std::ranges::sort(all);
    std::unordered_set<SolidCell, CellHash> reached;
    for (const SolidCell& start : all) {
      if (!reached.insert(start).second) continue;
      std::vector<SolidCell> cluster{start};
      for (std::size_t k = 0; k < cluster.size(); ++k)
        for (std::int32_t x = -kReach; x <= kReach; ++x)
          for (std::int32_t y = -kReach; y <= kReach; ++y)
            for (std::int32_t z = -kReach; z <= kReach; ++z) {
              const SolidCell beside{cluster[k][0] + x, cluster[k][1] + y, cluster[k][2] + z};
              if (cells_.contains(beside) && reached.insert(beside).second) cluster.push_back(beside);
            }
      use(cluster);
    }
  }

 private:
  glm::dvec3 corner_;
  double cell_m_;
  std::unordered_map<SolidCell, CellContent, CellHash> cells_;
};

double longest(const Vec3& size) { return std::max({size.x, size.y, size.z}); }

// Verdict of one point.
struct PointSays {
  std::optional<std::uint32_t> near = {};  // the nearest mesh, if it is near
  bool through = false;
  std::uint32_t through_mesh = 0;
  glm::dvec3 met{};  // where the ray went through
};

PointSays judge(const ModelSurface& model, const glm::dvec3& head, const glm::dvec3& p, double tolerance_m) {
  PointSays says;
  if (const auto near = model.nearest(p, tolerance_m)) says.near = near->mesh;
  const double range = length(p - head);
  if (!(range > kFromScanner_m)) return says;
  const glm::dvec3 way = (p - head) / range;
  const auto met = model.first(head, way);
  if (!met || met->distance < kFromScanner_m || met->distance > range - kBehind * tolerance_m ||
      std::abs(dot(met->normal, way)) < kLeastCosine)
    return says;
  says.through = true, says.through_mesh = met->mesh, says.met = head + met->distance * way;
  return says;
}

class ChangeFinder {
 public:
  ChangeFinder(const Scene& scene, double tolerance_m)
      : scene_(scene),
        model_(scene),
        cell_m_(tolerance_m),
        corner_(scene.data().origin + Vec3{1, 1, 1} * (kGridShift * tolerance_m)),
        off_(corner_, cell_m_) {}

  void add(const TakenScan& scan, std::size_t number) {
    pictures_.emplace_back(scan);
    const glm::dvec3 head = to_glm(scan.head);
    const auto place = [&](std::size_t k) {
      const auto& o = scan.thinned[k].offset;
      return head + glm::dvec3(o[0], o[1], o[2]);
    };
    std::vector<PointSays> says(scan.thinned.size());
    parallel::for_all(std::size_t{0}, says.size(),
                      [&](std::size_t k) { says[k] = judge(model_, head, place(k), cell_m_); });
    for (std::size_t k = 0; k < says.size(); ++k) {
      const std::uint64_t points = scan.thinned[k].points;
      FoundCells& cells = says[k].near ? of(seen_, *says[k].near) : off_;
      cells.at(place(k)).add(place(k), points, number);
      if (says[k].through) of(through_, says[k].through_mesh).at(says[k].met).add(says[k].met, points, number);
    }
  }

  SiteChanges found() {
    SiteChanges changes;
    changes.cell_m = cell_m_, changes.corner = corner_;
    find_things(changes);
    for (auto& [mesh, cells] : through_) find_openings(mesh, cells, changes);
    std::ranges::sort(changes.removed);
    return changes;
  }

 private:
  using ByMesh = std::map<std::uint32_t, FoundCells>;
  FoundCells& of(ByMesh& meshes, std::uint32_t mesh) {
    return meshes.try_emplace(mesh, corner_, cell_m_).first->second;
  }

  void find_things(SiteChanges& changes) {
    off_.drop([](const SolidCell&, const CellContent& content) { return content.points < kLeastPoints; });
    std::vector<std::pair<std::size_t, FoundThing>> things;
    off_.for_clusters([&](const std::vector<SolidCell>& cluster) {
      FoundThing thing;
      std::uint64_t scans = 0;
      for (const SolidCell& cell : cluster) {
        const CellContent& content = off_.content(cell);
        thing.box.extend(content.box.min), thing.box.extend(content.box.max);
        thing.points += content.points, scans |= content.scans;
      }
      if (cluster.size() < kLeastCells || longest(thing.box.size()) < kLeastThing_m) return;
      thing.scans = static_cast<std::size_t>(std::popcount(scans));
      if (thing.scans == 1 && others_saw_through(cluster, static_cast<std::size_t>(std::countr_zero(scans)))) {
        changes.passing.push_back(thing);
        return;
      }
      for (const SolidCell& cell : cluster) add_with_seam(cell, changes.cells);
      things.emplace_back(cluster.size(), thing);
    });
    std::ranges::sort(changes.cells);
    const auto twice = std::ranges::unique(changes.cells);
    changes.cells.erase(twice.begin(), twice.end());
    std::ranges::stable_sort(things, [](const auto& a, const auto& b) { return a.first > b.first; });
    for (auto& [size, thing] : things) changes.things.push_back(thing);
  }

  // Returns true if other scans saw well behind most of a thing seen by one scan, a number modulo 64.
  bool others_saw_through(const std::vector<SolidCell>& cluster, std::size_t scan) const {
    std::size_t through = 0;
    for (const SolidCell& cell : cluster) {
      const glm::dvec3 middle = to_glm(corner_) + cell_m_ * (glm::dvec3(cell[0], cell[1], cell[2]) + 0.5);
      for (std::size_t k = 0; k < pictures_.size(); ++k)
        if (k % 64 != scan && pictures_[k].beyond(middle) > kBehind * cell_m_) {
          ++through;
          break;
        }
    }
    return 2 * through > cluster.size();
  }

  // Adds a cell, and cells near the model that close the seam. Points of a thing near the model, such as a closed door
  // beside its frame, pass for the model's.
  void add_with_seam(const SolidCell& cell, std::vector<SolidCell>& cells) const {
    cells.push_back(cell);
    for (std::int32_t x = -1; x <= 1; ++x)
      for (std::int32_t y = -1; y <= 1; ++y)
        for (std::int32_t z = -1; z <= 1; ++z) {
          const SolidCell beside{cell[0] + x, cell[1] + y, cell[2] + z};
          const glm::dvec3 middle = to_glm(corner_) + cell_m_ * (glm::dvec3(beside[0], beside[1], beside[2]) + 0.5);
          if (model_.nearest(middle, cell_m_)) cells.push_back(beside);
        }
  }

  void find_openings(std::uint32_t mesh, FoundCells& cells, SiteChanges& changes) {
    const FoundCells& seen = of(seen_, mesh);
    cells.drop([&](const SolidCell& cell, const CellContent& content) {
      return content.points < kLeastPoints || seen.has(cell);
    });
    const SceneData& data = scene_.data();
    const MeshRange& range = data.ranges[mesh];
    Box whole;
    for (std::uint32_t t = range.first_triangle; t < range.first_triangle + range.triangle_count; ++t)
      for (const Float3& p : data.corners(t)) whole.extend(data.origin + widen(p));
    cells.for_clusters([&](const std::vector<SolidCell>& cluster) {
      SeenThrough opening{.mesh = data.meshes[mesh].name};
      for (const SolidCell& cell : cluster) {
        const Box& part = cells.content(cell).box;
        opening.box.extend(part.min), opening.box.extend(part.max);
      }
      opening.area_m2 = cell_m_ * cell_m_ * static_cast<double>(cluster.size());
      if (opening.area_m2 < kLeastOpening_m2) return;
      opening.removed = cluster.size() > seen.size() && (data.meshes[mesh].door || most_of(whole, opening.box));
      if (opening.removed && (changes.removed.empty() || changes.removed.back() != mesh))
        changes.removed.push_back(mesh);
      changes.seen_through.push_back(std::move(opening));
    });
  }

  // Returns true if a part reaches over most of the whole in its two longest directions.
  static bool most_of(const Box& whole, const Box& part) {
    std::array<std::pair<double, double>, 3> sizes{
        std::pair{whole.size().x, part.size().x}, {whole.size().y, part.size().y}, {whole.size().z, part.size().z}};
    std::ranges::sort(sizes, std::greater{}, [](const auto& s) { return s.first; });
    return sizes[0].second > kWholeMesh * sizes[0].first && sizes[1].second > kWholeMesh * sizes[1].first;
  }

  Scene scene_;
  ModelSurface model_;
  double cell_m_;
  Vec3 corner_;
  FoundCells off_;
  ByMesh seen_, through_;
  std::vector<DepthPicture> pictures_;  // one for each scan
};

}  // namespace

SiteChanges changes_of(Site& site, std::span<const TakenScan> scans, double tolerance_m, const Progress& progress) {
  ChangeFinder finder(site.scene(), tolerance_m);
  for (std::size_t k = 0; k < scans.size(); ++k) {
    if (progress.stopped()) return {};
    finder.add(scans[k], k);
    progress(static_cast<double>(k + 1) / static_cast<double>(scans.size()));
  }
  return finder.found();
}

Site changed_site(Site& site, const SiteChanges& changes) {
  SiteOptions options = site.options();
  options.weigh_ground = false;  // the scene has the weights
  options.log = {};              // all is said
  // Keeps the site's choices: lengths may depend on the bounds, and the density on the meshes.
  options.scanners.assign(site.scanners().begin(), site.scanners().end());
  options.user_size_m = site.simulator_config().user_size_m;
  options.spacing_m = site.simulator_config().point_spacing_m;
  options.spacing_by_detail = site.simulator_config().spacing_by_detail;
  const UnknownSpace& unknown = changes.unknown;
  return Site(changed_scene(site.scene(), {changes.corner, changes.cell_m, changes.cells}, changes.removed,
                            {unknown.corner, unknown.cell_m, unknown.cells}, unknown_weight),
              std::move(options), site.name());
}

}  // namespace vantage
