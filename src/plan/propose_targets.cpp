// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "evaluate/sight_targets.hpp"
#include "objective/registration_adjustment.hpp"
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
constexpr double kPassage_m = 0.65;          // a place with walls within this on both sides is a way through
// Sightings that a place is judged by, the most accurate ones: beyond them another scan adds little.
constexpr std::size_t kJudgedSightings = 12;

bool in_passage(const ClashChecker& clash, const Vec3& centre) {
  constexpr double diagonal = 0.70710678118654752;
  constexpr std::array<std::array<double, 2>, 4> ways{{{1, 0}, {0, 1}, {diagonal, diagonal}, {diagonal, -diagonal}}};
  return std::ranges::any_of(ways, [&](const auto& way) {
    const Vec3 step{way[0] * kPassage_m, way[1] * kPassage_m, 0};
    return !clash.sees(centre, centre + step) && !clash.sees(centre, centre - step);
  });
}

std::vector<Target> places_of(Site& site, std::span<const PlacedStation> stations, const TargetOptions& options) {
  std::vector<Target> places;
  for (const PlacedStation& place : candidate_positions(site, kPlaces)) {
    const Vec3 centre = place.ground + Vec3{0, 0, options.height_m};
    const auto near = [&](const PlacedStation& station) {
      const Vec3 between = station.ground - place.ground;
      return std::hypot(between.x, between.y) < kFromStations_m && std::abs(between.z) < options.height_m;
    };
    if (std::ranges::any_of(stations, near) || in_passage(site.clash(), centre)) continue;
    if (site.clash().distance(centre, kTargetClearance_m) < kTargetClearance_m) continue;
    places.push_back({.centre = centre, .proposed = true});
  }
  return places;
}

// Chooses places by what each takes from the mean square error, without an adjustment for each: a target's
// information is Uᵀ U with few rows, so the covariance follows by the matrix inversion lemma.
class TargetChooser {
 public:
  TargetChooser(const RegistrationAdjustment& adjustment, std::span<const RegistrationTarget> places)
      : adjustment_(adjustment),
        covariance_(adjustment.covariance()),
        metric_(adjustment.metric()),
        open_(places.size(), true) {
    for (const RegistrationTarget& place : places) rows_.push_back(rows_of(place));
  }

  double mean_square() const { return (metric_.cwiseProduct(covariance_)).sum(); }

  // Takes the best place that is left; empty if none gains the least share. REQUIRES: symmetric matrices.
  std::optional<std::size_t> take(double least_share) {
    const MatrixXd weighted = covariance_ * metric_ * covariance_;
    double best_gain = least_share * mean_square();
    std::optional<std::size_t> best;
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      if (!open_[k] || rows_[k].columns.empty()) continue;
      const double gain = inner(k).llt().solve(product(k, weighted)).trace();
      if (gain > best_gain) best_gain = gain, best = k;
    }
    if (!best) return best;
    open_[*best] = false;
    const Rows& rows = rows_[*best];
    MatrixXd by_covariance = MatrixXd::Zero(rows.values.rows(), covariance_.cols());
    for (std::size_t c = 0; c < rows.columns.size(); ++c)
      by_covariance += rows.values.col(static_cast<Index>(c)) * covariance_.row(rows.columns[c]);
    covariance_ -= by_covariance.transpose() * inner(*best).llt().solve(by_covariance);
    return best;
  }

 private:
  // U without its columns of zeros.
  struct Rows {
    std::vector<Index> columns;
    MatrixXd values;
  };

  // The k sightings of a target, its centre being unknown, have the information diag(w) − w wᵀ / Σw in each axis.
  Rows rows_of(const RegistrationTarget& place) const {
    std::vector<RegistrationTarget::Sighting> seen;
    for (const RegistrationTarget::Sighting& sighting : place.seen_by)
      if (std::ranges::count(adjustment_.stations(), sighting.station) > 0) seen.push_back(sighting);
    std::ranges::stable_sort(seen, {}, &RegistrationTarget::Sighting::sigma_m);
    seen.resize(std::min(seen.size(), kJudgedSightings));
    Rows rows;
    if (seen.size() < 2) return rows;
    const auto many = static_cast<Index>(seen.size());
    Eigen::VectorXd weights(many);
    for (Index k = 0; k < many; ++k) weights[k] = std::pow(seen[static_cast<std::size_t>(k)].sigma_m, -2);
    const MatrixXd laplacian = MatrixXd(weights.asDiagonal()) - weights * weights.transpose() / weights.sum();
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(laplacian);
    // Its first eigenvalue is 0: a motion of all.
    const MatrixXd root = solver.eigenvalues().tail(many - 1).cwiseMax(0).cwiseSqrt().asDiagonal() *
                          solver.eigenvectors().rightCols(many - 1).transpose();
    const Index d = adjustment_.unknowns();
    const MatrixXd moves = adjustment_.displacement_at(place.centre);
    rows.values.resize(3 * (many - 1), many * d);
    for (Index k = 0; k < many; ++k) {
      const auto found = std::ranges::find(adjustment_.stations(), seen[static_cast<std::size_t>(k)].station);
      const Index at = (found - adjustment_.stations().begin()) * d;
      for (Index c = 0; c < d; ++c) rows.columns.push_back(at + c);
      for (Index r = 0; r < many - 1; ++r) rows.values.block(3 * r, k * d, 3, d) = root(r, k) * moves;
    }
    return rows;
  }

  // U M Uᵀ
  MatrixXd product(std::size_t place, const MatrixXd& m) const {
    const Rows& rows = rows_[place];
    return rows.values * m(rows.columns, rows.columns) * rows.values.transpose();
  }
  // I + U C Uᵀ
  MatrixXd inner(std::size_t place) const {
    const Index size = rows_[place].values.rows();
    return MatrixXd::Identity(size, size) + product(place, covariance_);
  }

  const RegistrationAdjustment& adjustment_;
  MatrixXd covariance_, metric_;
  std::vector<Rows> rows_;
  std::vector<bool> open_;
};

}  // namespace

std::optional<TargetProposal> propose_targets(Site& site, std::span<const PlacedStation> stations,
                                              const RegistrationOptions& registration, const TargetOptions& options,
                                              std::vector<Target> given, const Progress& progress) {
  check(options);
  const bool all = registration.surfaces == RegistrationSurfaces::all;
  Simulator& simulator = site.simulator();
  const Network network = to_network(stations);
  const SampleOptions sampled{.voxels = kSampleVoxels, .registration = registration.model};
  const NetworkCounts counts = simulator.evaluate_sampled({&network, 1}, sampled, progress).front();
  NetworkCounts around;
  if (all && !counts.cancelled)
    around = site.surroundings().evaluate(network, {.registration = registration.model},
                                          {.report = {}, .stop = progress.stop});
  if (counts.cancelled || around.cancelled) return std::nullopt;
  const std::uint64_t around_voxels = all ? site.surroundings().voxel_count() : 0;
  const NetworkCounts* const surroundings = all ? &around : nullptr;

  TargetProposal proposal{.targets = std::move(given), .reach_m = target_reach_m(site.scanner(), options)};
  std::vector<RegistrationTarget> sighted = sight_targets(simulator, site.clash(), stations, proposal.targets, options);
  proposal.without =
      registration_error(counts, simulator.voxel_count(), registration, surroundings, around_voxels, sighted);

  std::vector<Target> places = places_of(site, stations, options);
  const std::vector<RegistrationTarget> all_places = sight_targets(simulator, site.clash(), stations, places, options);
  const RegistrationInputs inputs =
      registration_inputs(counts, simulator.voxel_count(), registration, surroundings, around_voxels);
  const RegistrationAdjustment adjustment(inputs.held_by, inputs.share, inputs.covered, registration, sighted);
  std::vector<RegistrationTarget> chosen = sighted;
  if (adjustment.covers_something()) {
    TargetChooser chooser(adjustment, all_places);
    for (std::size_t many = 0; many < options.most; ++many) {
      if (progress.stopped()) return std::nullopt;
      if (error_at_95_percent(std::sqrt(std::max(chooser.mean_square(), 0.0))) <= largest_error_m(options.wanted))
        break;
      const std::optional<std::size_t> best =
          chooser.take(kLeastGain / static_cast<double>(adjustment.stations().size()));
      if (!best) break;
      proposal.targets.push_back(places[*best]);
      proposal.targets.back().name = "T" + std::to_string(many + 1);
      chosen.push_back(all_places[*best]);
    }
  }
  proposal.with =
      registration_error(counts, simulator.voxel_count(), registration, surroundings, around_voxels, chosen);
  return proposal;
}

}  // namespace vantage
