// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include "candidates/rooms.hpp"
#include "candidates/why_missed.hpp"
#include "core/parallel.hpp"
#include "evaluate/field_of_view.hpp"
#include "scan/captured_share.hpp"
#include "scene/meshes_by_name.hpp"
#include "trace/embree/glass_panes.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

// Voxels between two checks for a stop.
constexpr std::size_t kVoxelsAtOnce = 4096;
// Enough for shares to a tenth of a percent, few enough for seconds.
constexpr std::uint64_t kJudgedVoxels = 50'000;

double length(const Vec3& v) { return std::sqrt(dot(v, v)); }

// Share of the way from `from` to `to` before it enters the cube of half side `half` around `centre`; 0 if `from` lies
// inside.
double entry(const Vec3& from, const Vec3& to, const Vec3& centre, double half) {
  double in = 0;
  const auto clip = [&](double a, double b, double middle) {
    const double way = b - a;
    if (way == 0) return;
    in = std::max(in, std::min((middle - half - a) / way, (middle + half - a) / way));
  };
  clip(from.x, to.x, centre.x);
  clip(from.y, to.y, centre.y);
  clip(from.z, to.z, centre.z);
  return std::clamp(in, 0.0, 1.0);
}

class Judge {
 public:
  Judge(Site& site, std::span<const PlacedStation> candidates, const MissedOptions& options)
      : simulator_(site.simulator()),
        clash_(site.clash()),
        candidates_(candidates),
        steepest_(std::cos(options.flat.in_radians())),
        per_steradian_(
            1 / (simulator_.scanner().azimuth_step.in_radians() * simulator_.scanner().zenith_step.in_radians())) {
    const auto kept = std::make_shared<const Scene>(simulator_.scene());
    const std::shared_ptr<const SceneData> scene(kept, &kept->data());
    if (simulator_.scanner().detection_range_m > 0 && scene->has_glass())
      glass_ = std::make_unique<const GlassPanes>(scene, std::make_shared<Planes>(scene));
  }

  // `captured` is the share of the goal that the network has.
  VoxelStatus status(std::uint32_t voxel, const VoxelPatch& patch, double captured) const {
    const Scanner& scanner = simulator_.scanner();
    const Vec3 centre = simulator_.voxel_centre(voxel);
    const double half = simulator_.voxel_size_m() / 2;
    // The nearest first: few lines decide most voxels.
    std::vector<std::pair<double, std::size_t>> order(candidates_.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = {length(patch.point - candidates_[k].position), k};
    // Most lines are never examined, so a heap orders only those that are.
    std::ranges::make_heap(order, std::greater<>{});
    std::size_t left = order.size();
    bool free_line = false, in_range = false, steep = false, bright = false;
    const double reach_square = scanner.detection_range_m * scanner.detection_range_m *
                                simulator_.scene().meshes()[patch.mesh].diffuse / scanner.detection_reflectivity;
    const double goal = simulator_.goal_density(voxel);
    double best = 0;
    while (left > 0) {
      std::ranges::pop_heap(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(left), std::greater<>{});
      const auto [range, k] = order[--left];
      const Vec3 head = candidates_[k].position, way = patch.point - head;
      const bool reached = range >= scanner.min_range_m && range <= scanner.max_range_m;
      // A line that cannot change the answer is not traced.
      if (free_line && !reached) continue;
      if (!clash_.ray_passes(head, head + way * entry(head, patch.point, centre, half))) continue;
      free_line = true;
      if (!reached) continue;
      in_range = true;
      const double incidence = range > 0 ? std::abs(dot(way, patch.normal)) / range : 1;
      if (incidence < steepest_) continue;
      steep = true;
      if (scanner.detection_range_m > 0 && range * range > reach_square * incidence * passed(head, way, range))
        continue;
      bright = true;
      if (!in_field_of_view(scanner, way, range)) continue;
      const double across = std::sqrt(std::max(way.x * way.x + way.y * way.y, 1e-12)) / range;  // sin zenith
      best = std::max(best, patch.area_m2 * incidence / (range * range) * per_steradian_ / across);
      if (best >= goal) break;
    }
    const WhyMissed why = best >= goal ? WhyMissed::not_chosen
                          : !free_line ? WhyMissed::hidden
                          : !in_range  ? WhyMissed::far
                          : !steep     ? WhyMissed::flat
                          : !bright    ? WhyMissed::dark
                                       : WhyMissed::sparse;
    return {why, static_cast<float>(captured), static_cast<float>(std::max(captured, std::min(best / goal, 1.0)))};
  }

 private:
  // Share of an echo's strength that passes glass.
  double passed(const Vec3& head, const Vec3& way, double range) const {
    if (!glass_ || range == 0) return 1;
    return glass_->share(narrow(head - simulator_.origin()), narrow(way * (1 / range)), 0, static_cast<float>(range));
  }

  const Simulator& simulator_;
  const ClashChecker& clash_;
  std::span<const PlacedStation> candidates_;
  double steepest_, per_steradian_;
  std::unique_ptr<const GlassPanes> glass_;  // null: glass weakens no echo
};

}  // namespace

std::string to_string(WhyMissed why) {
  switch (why) {
    case WhyMissed::captured: return "captured";
    case WhyMissed::hidden: return "hidden";
    case WhyMissed::far: return "out_of_range";
    case WhyMissed::flat: return "too_flat";
    case WhyMissed::dark: return "too_dark";
    case WhyMissed::sparse: return "too_sparse";
    case WhyMissed::not_chosen: return "not_chosen";
  }
  return "";
}

std::vector<VoxelStatus> why_missed(Site& site, std::span<const PlacedStation> candidates,
                                    std::span<const std::uint32_t> voxels, std::span<const std::uint32_t> points,
                                    const MissedOptions& options, const Progress& progress) {
  const Simulator& simulator = site.simulator();
  if (voxels.size() != points.size())
    throw Error(Errc::invalid_argument, "why_missed: " + std::to_string(voxels.size()) + " voxels, but counts of " +
                                            std::to_string(points.size()));
  if (candidates.empty() || options.candidates == 0)
    throw Error(Errc::invalid_argument, "why_missed: there are no candidates to look from");
  for (const std::uint32_t voxel : voxels)
    if (voxel >= simulator.voxel_count())
      throw Error(Errc::invalid_argument, "why_missed: there is no voxel " + std::to_string(voxel) + " of " +
                                              std::to_string(simulator.voxel_count()));
  const Judge judge(site, candidates.first(std::min(candidates.size(), options.candidates)), options);
  std::vector<VoxelStatus> status(voxels.size(), {WhyMissed::captured, 1, 1});
  std::vector<std::size_t> missed;
  for (std::size_t i = 0; i < voxels.size(); ++i)
    if (points[i] < simulator.goal_density(voxels[i])) missed.push_back(i);
  for (std::size_t first = 0; first < missed.size(); first += kVoxelsAtOnce) {
    if (progress.stopped()) return {};
    const std::span<const std::size_t> here =
        std::span(missed).subspan(first, std::min(kVoxelsAtOnce, missed.size() - first));
    std::vector<std::uint32_t> of;
    for (const std::size_t i : here) of.push_back(voxels[i]);
    const std::vector<VoxelPatch> patches = simulator.voxel_patches(of);
    parallel::for_all(std::size_t{0}, here.size(), [&](std::size_t k) {
      status[here[k]] = judge.status(of[k], patches[k], points[here[k]] / simulator.goal_density(of[k]));
    });
    progress(static_cast<double>(first + here.size()) / static_cast<double>(missed.size()));
  }
  return status;
}

namespace {
// Sums of shares of goal points, each with its voxels' weight.
class ShareSum {
 public:
  explicit ShareSum(MissedShare& share) : share_(share) {}
  void add(const VoxelStatus& status, double weight) {
    const auto part = [&](WhyMissed why, double of) { share_.shares[static_cast<std::size_t>(why)] += weight * of; };
    ++share_.voxels;
    weights_ += weight;
    part(WhyMissed::captured, status.captured);
    part(WhyMissed::not_chosen, status.attainable - status.captured);
    part(status.why, 1 - status.attainable);
  }
  void finish() const {
    for (double& share : share_.shares) share /= std::max(weights_, 1.0);
  }

 private:
  MissedShare& share_;
  double weights_ = 0;
};
}  // namespace

std::vector<MissedShare> missed_by_node(const Simulator& simulator, std::span<const std::uint32_t> voxels,
                                        std::span<const VoxelStatus> status) {
  if (voxels.size() != status.size())
    throw Error(Errc::invalid_argument, "missed_by_node: " + std::to_string(voxels.size()) +
                                            " voxels, but reasons of " + std::to_string(status.size()));
  const MeshesByName meshes = meshes_by_name(simulator.scene().meshes());
  std::vector<MissedShare> shares(1);
  for (const std::string& name : meshes.names) shares.push_back({.node = name});
  std::vector<ShareSum> sums(shares.begin(), shares.end());
  const std::vector<VoxelPatch> patches = simulator.voxel_patches(voxels);
  for (std::size_t i = 0; i < voxels.size(); ++i)
    for (const std::size_t k : {std::size_t{0}, 1 + meshes.of_mesh[patches[i].mesh]})
      sums[k].add(status[i], simulator.voxel_weight(voxels[i]));
  for (const ShareSum& sum : sums) sum.finish();
  std::erase_if(shares, [&](const MissedShare& share) { return share.voxels == 0 && &share != &shares.front(); });
  return shares;
}

namespace {
// Coverage of all voxels in place of the sample's; the sample splits the rest.
void take_whole_coverage(MissedShare& all, const Simulator& simulator, const VoxelField& field) {
  double captured = 0, weights = 0;
  for (std::uint32_t voxel = 0; voxel < field.count.size(); ++voxel) {
    const double weight = simulator.voxel_weight(voxel);
    captured += weight * captured_share(simulator, voxel, field.count[voxel]);
    weights += weight;
  }
  captured /= weights;
  double& sampled = all.shares[static_cast<std::size_t>(WhyMissed::captured)];
  const double rest = 1 - sampled;
  sampled = captured;
  for (std::size_t k = 0; k < why_missed_count; ++k)
    if (k != static_cast<std::size_t>(WhyMissed::captured) && rest > 0) all.shares[k] *= (1 - captured) / rest;
}

std::vector<RoomShare> missed_by_room(Site& site, const MissedVoxels& judged) {
  const Simulator& simulator = site.simulator();
  const std::span<const Room> rooms = simulator.scene().rooms();
  if (rooms.empty()) return {};
  std::vector<RoomShare> shares = shares_by_room(rooms, site.area());
  std::vector<ShareSum> sums;
  for (std::size_t k = 0; k < rooms.size(); ++k)
    shares[k].share.node = rooms[k].name, sums.emplace_back(shares[k].share);
  const std::vector<VoxelPatch> patches = simulator.voxel_patches(judged.voxels);
  for (std::size_t i = 0; i < judged.voxels.size(); ++i)
    if (const auto room = room_at(rooms, patches[i].point))
      sums[*room].add(judged.status[i], simulator.voxel_weight(judged.voxels[i]));
  for (const ShareSum& sum : sums) sum.finish();
  return shares;
}
}  // namespace

MissedVoxels missed_voxels(Site& site, const VoxelField& field, const MissedOptions& options,
                           const Progress& progress) {
  const Simulator& simulator = site.simulator();
  if (simulator.voxel_count() == 0) return {};
  const std::vector<PlacedStation> candidates = candidate_positions(site, options.candidates);
  MissedVoxels judged{.voxels = simulator.sampled_voxels(std::min(kJudgedVoxels, simulator.voxel_count()))};
  for (const std::uint32_t voxel : judged.voxels) judged.points.push_back(field.count[voxel]);
  judged.status = why_missed(site, candidates, judged.voxels, judged.points, options, progress);
  if (judged.status.empty()) return {};
  judged.shares = missed_by_node(simulator, judged.voxels, judged.status);
  take_whole_coverage(judged.shares.front(), simulator, field);
  judged.rooms = missed_by_room(site, judged);
  judged.candidates = candidates.size();
  return judged;
}

}  // namespace vantage
