// SPDX-License-Identifier: Apache-2.0
// Simulated registration of a network: scans are moved off their places, matched with each other and adjusted together.
// It is the truth for predicted errors, so it shares no code with them.
#pragma once

#include <Eigen/Dense>
#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "vantage/simulator.hpp"

namespace vantage::bench {

// Errors of scans, and their prior.
struct AdjustmentTruth {
  double rho_m = 0.0015, patch_m = 0.5;  // modelling error of a scan, and over how far it is the same
  double position_m = 0.03, heading = 0.2 * 0.017453292519943295, tilt = 15.0 / 3600 * 0.017453292519943295;
  // Errors of the instrument, drawn once for a trial: vertical index, collimation and trunnion axis each; offset and
  // scale of ranges. Each scan begins in a direction of its own, and the mirror's two faces see angles with opposite
  // errors.
  double angle = 0, range_m = 0, range_share = 0;
  std::size_t samples = 800;  // points of a scan that are matched with another, at most
  int iterations = 12;
};

// One station's scan, thinned to means of cells; world frame, where the station really is.
struct ThinnedScan {
  static constexpr double cell_m = 0.1;
  Eigen::Vector3d head;
  std::vector<Eigen::Vector3f> points, normals;
  std::vector<float> variances;       // m² of range noise of each mean, along its normal
  std::vector<std::uint8_t> planar;   // flat enough to be matched
  std::vector<std::uint32_t> voxels;  // that the scan has points in, ascending
};

// Scans with every ray; normals are fitted to the points, as in a registration.
ThinnedScan thinned_scan(Simulator& simulator, const Vec3& head);

// Finds a scan's planar point next to a place.
class Neighbours {
 public:
  explicit Neighbours(const ThinnedScan& scan);
  // −1 if there is none nearby whose normal agrees.
  int nearest(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const;

 private:
  static std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z);
  const ThinnedScan* scan_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

// Error of a pose after the adjustment: a point p moves by shift + turn × (p − head).
struct PoseError {
  Eigen::Vector3d head, turn, shift;
};

// Planar points of a scan that have one of the other scan next to them.
std::vector<std::uint32_t> matching_points(const ThinnedScan& scan, const Neighbours& other);

// Scans to be adjusted together.
struct ScanNetwork {
  std::vector<const ThinnedScan*> scans;
  std::vector<const Neighbours*> neighbours;
  std::vector<const std::vector<std::uint32_t>*> matches;  // of scan i with scan j at i · scans.size() + j
};

// One trial: poses and scans are disturbed by `seed`, then adjusted.
std::vector<PoseError> adjust(const ScanNetwork& network, const AdjustmentTruth& truth, std::uint64_t seed);

// Root mean square of the displacement of the covered surface, without the best-fitting motion of the whole. `points`
// and `masks`: the surface, and the stations that see it.
double surface_error(const std::vector<PoseError>& errors, const std::vector<Eigen::Vector3d>& points,
                     const std::vector<std::uint64_t>& masks);

}  // namespace vantage::bench
