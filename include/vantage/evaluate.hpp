// SPDX-License-Identifier: Apache-2.0
/// Evaluates networks on parts that the caller made. `Site::evaluate` (vantage/site.hpp) does it on a site's own.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "vantage/evaluation.hpp"
#include "vantage/on_site.hpp"
#include "vantage/placement.hpp"
#include "vantage/progress.hpp"
#include "vantage/registration.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

/// Parts that an evaluation uses. Borrows all of it.
struct EvaluationSite {
  Simulator& simulator;                 ///< Traces the stations.
  Simulator* surroundings = nullptr;    ///< `surroundings_of(simulator)`, for scan overlaps. Null: none.
  const OnSite* on_site = nullptr;      ///< Makes rounds on site. Null: none.
  const ClashChecker* clash = nullptr;  ///< Needed by targets and by lines of sight between stations. Null: none.
  const SearchArea* area = nullptr;     ///< With `clash`: tells where stations may stand instead. Null: not told.
};

/// Surveyed voxels that a network leaves below their goal density.
struct UncoveredVoxels {
  std::vector<std::uint32_t> voxels;  ///< Voxel indices, ascending.
  std::vector<Vec3> centres;          ///< Survey frame.
  std::vector<std::uint32_t> meshes;  ///< Index into `Scene::meshes()` of the mesh with most surface in each.
  std::vector<std::uint32_t> points;  ///< Points of the network in each.
};
/// Voxels that an evaluated network does not capture. Throws Error invalid_argument unless the evaluation has the
/// points of every voxel of this simulator (`EvaluationOptions::field`).
UncoveredVoxels uncovered(const Simulator& simulator, const Evaluation& evaluation);

/// Evaluates a network. Scan overlaps take every ray of the coarser `surroundings`, sampled or not. A cancelled
/// evaluation has `counts.cancelled` set and no values. Throws Error invalid_argument if a measure needs something that
/// `site` lacks, for registration without overlap, for the field of a sample or a beam on one, and as the simulator
/// does.
Evaluation evaluate_stations(const EvaluationSite& site, std::span<const PlacedStation> stations,
                             const EvaluationOptions& options = {}, const Progress& progress = {});
/// Evaluates several networks at a time, on one sample if they are sampled. Throws as above, and if a field is wanted.
std::vector<Evaluation> evaluate_networks(const EvaluationSite& site,
                                          std::span<const std::vector<PlacedStation>> networks,
                                          const EvaluationOptions& options = {}, const Progress& progress = {});

/// Makes the figures of a measured network: the measures with standard errors, overlaps, and the registration error if
/// `registration` is given, by surfaces and `targets`. Links, attainable coverage and the round are left to the caller.
/// REQUIRES: counts of all that measures and registration need.
Evaluation evaluation_of(const MeasuredNetwork& measured, std::span<const Objective> measures,
                         const std::optional<RegistrationOptions>& registration = std::nullopt,
                         std::span<const RegistrationTarget> targets = {});

}  // namespace vantage
