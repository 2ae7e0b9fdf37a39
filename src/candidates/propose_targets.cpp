// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "evaluate/sight_targets.hpp"
#include "objective/registered_sample.hpp"
#include "objective/registration_adjustment.hpp"
#include "placement/in_the_way.hpp"
#include "vantage/candidates.hpp"
#include "vantage/error.hpp"
#include "vantage/evaluation.hpp"
#include "vantage/site.hpp"
#include "vantage/targets.hpp"

namespace vantage {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr std::size_t kPlaces = 400;
constexpr std::uint64_t kSampleVoxels = 100'000;
// Share of a station's part of the mean square error that another target must take away.
constexpr double kLeastGain = 0.2;
constexpr double kTargetClearance_m = 0.15;  // free space around a target's stand
constexpr double kFromStations_m = 1.0;      // a scanner's tripod and its operator
constexpr double kUnderGround_m = 0.1;       // what lies so deep carries a stand
// Least height of a triangle of targets that one scan measures, as a share of its longest side.
constexpr double kLeastHeight = 0.05;
// Sightings that a place is judged by, the most accurate ones: beyond them another scan adds little.
constexpr std::size_t kJudgedSightings = 12;

// A pane of glass with nothing solid under it.
bool on_glass(const ClashChecker& clash, const Vec3& centre, const Vec3& ground) {
  const Vec3 below = ground - Vec3{0, 0, kUnderGround_m};
  return !clash.sees(centre, below) && clash.ray_passes(centre, below);
}

std::vector<Target> places_of(Site& site, std::span<const PlacedStation> stations, const TargetOptions& options) {
  const ClashChecker& clash = site.clash();
  std::vector<Target> places;
  for (const PlacedStation& place : candidate_positions(site, kPlaces)) {
    const Vec3 centre = place.ground + Vec3{0, 0, options.height_m};
    const auto near = [&](const PlacedStation& station) {
      const Vec3 between = station.ground - place.ground;
      return std::hypot(between.x, between.y) < kFromStations_m && std::abs(between.z) < options.height_m;
    };
    if (std::ranges::any_of(stations, near) || clash.distance(centre, kTargetClearance_m) < kTargetClearance_m)
      continue;
    if (on_glass(clash, centre, place.ground)) continue;
    places.push_back({.centre = centre, .proposed = true});
  }
  return places;
}

// Places that some two stations measure, off passages and doors.
std::vector<Target> useful(const ClashChecker& clash, std::vector<Target> places) {
  std::erase_if(places, [&](const Target& place) {
    return place.stations.size() < 2 || in_passage(clash, place.centre) || in_swing(clash, place.centre);
  });
  return places;
}

// True if one station measures all three targets, and they lie nearly on a line.
bool on_a_line(const Target& a, const Target& b, const Target& c) {
  const bool together = std::ranges::any_of(a.stations, [&](std::size_t station) {
    return std::ranges::binary_search(b.stations, station) && std::ranges::binary_search(c.stations, station);
  });
  if (!together) return false;
  const Vec3 ab = b.centre - a.centre, ac = c.centre - a.centre, bc = c.centre - b.centre;
  const double longest = std::max({dot(ab, ab), dot(ac, ac), dot(bc, bc)});  // squared
  const double twice_area_squared = dot(ab, ab) * dot(ac, ac) - dot(ab, ac) * dot(ab, ac);
  return twice_area_squared < kLeastHeight * kLeastHeight * longest * longest;
}

bool on_a_line_with_any(const Target& target, std::span<const Target> others) {
  for (std::size_t i = 0; i < others.size(); ++i)
    for (std::size_t j = i + 1; j < others.size(); ++j)
      if (on_a_line(target, others[i], others[j])) return true;
  return false;
}

// Chooses places by their decrease of the mean square error, without an adjustment for each: a target's information is
// Uᵀ U with few rows, so the covariance follows by the matrix inversion lemma.
class TargetChooser {
 public:
  TargetChooser(const RegistrationAdjustment& adjustment, std::span<const RegistrationTarget> places)
      : adjustment_(adjustment), covariance_(adjustment.covariance()), metric_(adjustment.metric()) {
    weighted_ = covariance_ * metric_ * covariance_;
    for (const RegistrationTarget& place : places) rows_.push_back(rows_of(place));
  }

  double mean_square() const { return std::max((metric_.cwiseProduct(covariance_)).sum(), 0.0); }

  // Decrease of the mean square error by a target at a place; 0 if fewer than two stations measure it.
  double gain(std::size_t place) const {
    if (rows_[place].columns.empty()) return 0;
    return (identity(place) + product(place, covariance_)).llt().solve(product(place, weighted_)).trace();
  }
  // Increase of the mean square error without the target that was put at a place.
  double loss(std::size_t place) const {
    return (identity(place) - product(place, covariance_)).llt().solve(product(place, weighted_)).trace();
  }
  void put(std::size_t place) { change(place, 1); }
  void take_away(std::size_t place) { change(place, -1); }

 private:
  // U without its columns of zeros.
  struct Rows {
    std::vector<Index> columns;
    MatrixXd values;
  };

  // The k sightings of a target, its centre being unknown, have the information diag(W) − W (ΣW)⁻¹ Wᵀ, W: 3k × 3.
  Rows rows_of(const RegistrationTarget& place) const {
    std::vector<RegistrationTarget::Sighting> seen;
    for (const RegistrationTarget::Sighting& sighting : place.seen_by)
      if (std::ranges::count(adjustment_.stations(), sighting.station) > 0) seen.push_back(sighting);
    std::ranges::stable_sort(seen, {}, [](const RegistrationTarget::Sighting& sighting) {
      return 2 * sighting.across_m * sighting.across_m + sighting.along_m * sighting.along_m;
    });
    seen.resize(std::min(seen.size(), kJudgedSightings));
    Rows rows;
    if (seen.size() < 2) return rows;
    const auto many = static_cast<Index>(seen.size());
    Eigen::MatrixX3d weights(3 * many, 3);
    Eigen::Matrix3d total = Eigen::Matrix3d::Zero();
    for (Index k = 0; k < many; ++k)
      total += weights.middleRows<3>(3 * k) = adjustment_.sighting_weight(place, seen[static_cast<std::size_t>(k)]);
    MatrixXd laplacian = -weights * total.inverse() * weights.transpose();
    for (Index k = 0; k < many; ++k) laplacian.block<3, 3>(3 * k, 3 * k) += weights.middleRows<3>(3 * k);
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(laplacian);
    // Its first three eigenvalues are 0: motions of all.
    const Index held = 3 * (many - 1);
    const MatrixXd root = solver.eigenvalues().tail(held).cwiseMax(0).cwiseSqrt().asDiagonal() *
                          solver.eigenvectors().rightCols(held).transpose();
    const Index d = adjustment_.unknowns();
    const MatrixXd moves = adjustment_.displacement_at(place.centre);
    rows.values.resize(held, many * d);
    for (Index k = 0; k < many; ++k) {
      const auto found = std::ranges::find(adjustment_.stations(), seen[static_cast<std::size_t>(k)].station);
      const Index at = (found - adjustment_.stations().begin()) * d;
      for (Index c = 0; c < d; ++c) rows.columns.push_back(at + c);
      rows.values.middleCols(k * d, d) = root.middleCols<3>(3 * k) * moves;
    }
    return rows;
  }

  // U M Uᵀ
  MatrixXd product(std::size_t place, const MatrixXd& m) const {
    const Rows& rows = rows_[place];
    return rows.values * m(rows.columns, rows.columns) * rows.values.transpose();
  }
  MatrixXd identity(std::size_t place) const {
    return MatrixXd::Identity(rows_[place].values.rows(), rows_[place].values.rows());
  }
  // The covariance C becomes C ∓ B with B = C Uᵀ (I ± U C Uᵀ)⁻¹ U C, and C M C with it: a few rows by all columns.
  void change(std::size_t place, double sign) {
    const Rows& rows = rows_[place];
    MatrixXd uc = MatrixXd::Zero(rows.values.rows(), covariance_.cols());
    for (std::size_t c = 0; c < rows.columns.size(); ++c)
      uc += rows.values.col(static_cast<Index>(c)) * covariance_.row(rows.columns[c]);
    const MatrixXd solved = (identity(place) + sign * product(place, covariance_)).llt().solve(uc);
    const MatrixXd ucm = uc * metric_, ucmc = ucm * covariance_, inner = ucm * uc.transpose();
    const MatrixXd cross = solved.transpose() * ucmc;
    weighted_ += solved.transpose() * inner * solved - sign * (cross + cross.transpose());
    covariance_ -= sign * solved.transpose() * uc;
  }

  const RegistrationAdjustment& adjustment_;
  MatrixXd covariance_, metric_, weighted_;  // C, M and C M C
  std::vector<Rows> rows_;
};

// Places for targets, in the order of their choice: the fewest that greedy choice finds, without those that later ones
// made needless. `allowed`: mean square of random errors, m². Returns nothing if it was stopped.
std::optional<std::vector<std::size_t>> choose(TargetChooser& chooser, std::span<const Target> places,
                                               std::vector<Target> there, std::size_t stations,
                                               const TargetOptions& options, double allowed, const Progress& progress) {
  std::vector<std::size_t> chosen;
  std::vector<bool> open(places.size(), true);
  while (chosen.size() < options.most && (chooser.mean_square() > allowed || chosen.size() < options.least)) {
    if (progress.stopped()) return std::nullopt;
    std::vector<std::pair<double, std::size_t>> gains;
    for (std::size_t k = 0; k < places.size(); ++k)
      if (open[k]) gains.emplace_back(chooser.gain(k), k);
    std::ranges::stable_sort(gains, std::ranges::greater{}, &std::pair<double, std::size_t>::first);
    const double least =
        chosen.size() < options.least ? 0 : kLeastGain / static_cast<double>(stations) * chooser.mean_square();
    const auto best = std::ranges::find_if(gains, [&](const auto& one) {
      // Further targets do not mend a line.
      if (one.first > least && on_a_line_with_any(places[one.second], there)) open[one.second] = false;
      return open[one.second];
    });
    if (best == gains.end() || !(best->first > least)) break;
    open[best->second] = false;
    chooser.put(best->second);
    chosen.push_back(best->second);
    there.push_back(places[best->second]);
  }
  while (chosen.size() > options.least && chooser.mean_square() <= allowed) {
    const auto needless = std::ranges::min_element(chosen, {}, [&](std::size_t k) { return chooser.loss(k); });
    if (chooser.mean_square() + chooser.loss(*needless) > allowed) break;
    chooser.take_away(*needless);
    chosen.erase(needless);
  }
  return chosen;
}

}  // namespace

std::optional<TargetProposal> propose_targets(Site& site, std::span<const PlacedStation> stations,
                                              const RegistrationOptions& predicted_by, const TargetOptions& asked,
                                              std::vector<Target> given, const Progress& progress) {
  check(asked);
  const RegistrationOptions registration = levelled_by(predicted_by, site.scanners());
  const TargetOptions options = with_class_of(site.options(), asked);
  const bool all = registration.surfaces == RegistrationSurfaces::all;
  Simulator& simulator = site.simulator();
  const Network network = to_network(stations);
  const RequiredInputs needs{
      .pairs = true, .surroundings = all, .registration = registration.model, .surroundings_registration = all};
  const std::vector<NetworkCounts> counted =
      options.exact ? simulator.evaluate_each({&network, 1}, count_surveyed(needs, registration, simulator), progress)
                    : simulator.evaluate_sampled(
                          {&network, 1}, {.voxels = kSampleVoxels, .registration = registration.model}, progress);
  const NetworkCounts& counts = counted.front();
  NetworkCounts around;
  if (all && !counts.cancelled)
    around = site.surroundings().evaluate(
        network, count_surroundings(needs, registration, counted, simulator, site.surroundings()),
        {.stop = progress.stop});
  if (counts.cancelled || around.cancelled) return std::nullopt;
  const std::uint64_t around_voxels = all ? site.surroundings().voxel_count() : 0;
  const NetworkCounts* const surroundings = all ? &around : nullptr;
  const auto predicted = [&](std::span<const RegistrationTarget> targets) {
    return registration_error(counts, simulator.voxel_count(), registration, surroundings, around_voxels, targets);
  };

  TargetProposal proposal{.targets = std::move(given), .reach_m = target_reach_m(site.scanner(), options)};
  std::vector<RegistrationTarget> sighted = sight_targets(simulator, site.clash(), stations, proposal.targets, options);
  proposal.without = predicted({});
  proposal.with = sighted.empty() ? proposal.without : predicted(sighted);
  const bool enough = proposal.with.rms_m <= allowed_rms_m(options) && options.least == 0;
  if (enough || options.most == 0 || stations.size() < 2) return proposal;

  std::vector<Target> places = places_of(site, stations, options);
  sight_targets(simulator, site.clash(), stations, places, options);
  places = useful(site.clash(), std::move(places));
  const std::vector<RegistrationTarget> all_places = sight_targets(simulator, site.clash(), stations, places, options);
  const RegistrationInputs inputs =
      registration_inputs(counts, simulator.voxel_count(), registration, surroundings, around_voxels);
  const RegistrationAdjustment adjustment(inputs.held_by, inputs.share, inputs.covered, registration, sighted);
  if (!adjustment.covers_something() || places.empty()) return proposal;
  TargetChooser chooser(adjustment, all_places);
  // Targets lower random errors most; the instrument's are taken to stay.
  const auto square = [](double x) { return x * x; };
  const double allowed =
      std::max(square(allowed_rms_m(options)) - (square(proposal.with.rms_m) - square(proposal.with.random_m)), 0.0);
  const auto chosen =
      choose(chooser, places, proposal.targets, adjustment.stations().size(), options, allowed, progress);
  if (!chosen) return std::nullopt;
  std::set<std::string> names;
  for (const Target& target : proposal.targets) names.insert(target.name);
  std::size_t number = 0;
  for (const std::size_t k : *chosen) {
    Target& target = proposal.targets.emplace_back(places[k]);
    do target.name = "T" + std::to_string(++number);
    while (names.contains(target.name));
    sighted.push_back(all_places[k]);
  }
  if (!chosen->empty()) proposal.with = predicted(sighted);
  return proposal;
}

}  // namespace vantage
