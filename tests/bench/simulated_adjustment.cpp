// SPDX-License-Identifier: Apache-2.0
#include "simulated_adjustment.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <random>

#include "core/philox.hpp"

namespace vantage::bench {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double fit_radius_m = 0.22;  // of the points that a normal is fitted to
constexpr double match_m = 0.15;       // points further apart are no match
constexpr std::size_t least_matches = 20;

std::uint64_t packed(std::int64_t x, std::int64_t y, std::int64_t z) {
  constexpr std::int64_t offset = 1 << 20;
  return static_cast<std::uint64_t>(x + offset) << 42 | static_cast<std::uint64_t>(y + offset) << 21 |
         static_cast<std::uint64_t>(z + offset);
}
std::uint64_t cell_of(const Vector3d& p, double size) {
  return packed(static_cast<std::int64_t>(std::floor(p.x() / size)),
                static_cast<std::int64_t>(std::floor(p.y() / size)),
                static_cast<std::int64_t>(std::floor(p.z() / size)));
}

// A standard normal number that belongs to (seed, place).
double normal_of(std::uint64_t seed, std::uint64_t place) {
  const auto bits =
      philox4x32(seed, {static_cast<std::uint32_t>(place), static_cast<std::uint32_t>(place >> 32), 7, 9});
  const double u = (bits[0] + 0.5) * 0x1p-32, v = bits[1] * 0x1p-32;
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * EIGEN_PI * v);
}

// A scan's own error of the surface: smooth, and of the same power at every place. It is so much alike within a patch
// that its mean over a large surface has the variance ρ²L²/A.
double modelling_error(std::uint64_t seed, const Vector3d& p, const Vector3d& n, const AdjustmentTruth& truth) {
  Eigen::Index axis = 0;
  n.cwiseAbs().maxCoeff(&axis);
  const double a = p[(axis + 1) % 3] / truth.patch_m, b = p[(axis + 2) % 3] / truth.patch_m;
  const double fa = a - std::floor(a), fb = b - std::floor(b);
  const std::int64_t layer = std::llround(p[axis] / truth.patch_m) * 8 + axis * 2 + (n[axis] > 0 ? 1 : 0);
  double error = 0;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j)
      error += (i ? fa : 1 - fa) * (j ? fb : 1 - fb) *
               normal_of(seed, packed(static_cast<std::int64_t>(std::floor(a)) + i,
                                      static_cast<std::int64_t>(std::floor(b)) + j, layer));
  return truth.rho_m * error;
}

Matrix3d rotation(const Vector3d& turn) {
  const double angle = turn.norm();
  if (angle < 1e-15) return Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
}
Vector3d turn_of(const Matrix3d& r) {
  const Eigen::AngleAxisd a(r);
  return a.axis() * a.angle();
}
Matrix3d cross_matrix(const Vector3d& v) {
  Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

// An instrument's errors in one trial.
struct Instrument {
  double index = 0, collimation = 0, trunnion = 0, offset_m = 0, scale = 0;

  // The place where the scan that begins in direction `start` has a point: its range and angles, changed and read back.
  Vector3d measured(const Vector3d& head, double start, const Vector3d& point) const {
    const Vector3d v = point - head;
    const double range = v.norm(), level = std::max(std::hypot(v.x(), v.y()), 0.05 * range);
    double azimuth = std::atan2(v.y(), v.x()), zenith = std::atan2(level, v.z());
    const double face = std::sin(azimuth - start) > 0 ? 1 : -1;
    azimuth += face * (collimation * range + trunnion * v.z()) / level;
    zenith += face * index;
    const double wrong = range * (1 + scale) + offset_m;
    // The offset from the place that unchanged angles give: that place is `point`, apart from the clamp above.
    const Vector3d to(std::sin(zenith) * std::cos(azimuth), std::sin(zenith) * std::sin(azimuth), std::cos(zenith));
    const double before = std::atan2(level, v.z()), around = std::atan2(v.y(), v.x());
    const Vector3d from(std::sin(before) * std::cos(around), std::sin(before) * std::sin(around), std::cos(before));
    return point + wrong * to - range * from;
  }
};

double sigma_of(const NoiseTable& table, double range, double reflectivity) {
  if (table.empty()) return 0;
  const auto cell = [](const std::vector<double>& nodes, double x) {
    std::size_t low = 0;
    while (low + 2 < nodes.size() && x > nodes[low + 1]) ++low;
    return std::pair{low, nodes.size() < 2 ? 0 : (x - nodes[low]) / (nodes[low + 1] - nodes[low])};
  };
  const auto [c, cs] = cell(table.distances_m, range);
  const auto [r, rs] = cell(table.reflectivities, reflectivity);
  const auto at = [&, r = r, c = c](std::size_t dr, std::size_t dc) {
    return table.sigma_m[std::min(r + dr, table.reflectivities.size() - 1) * table.distances_m.size() +
                         std::min(c + dc, table.distances_m.size() - 1)];
  };
  return std::max(0.0, (at(0, 0) * (1 - cs) + at(0, 1) * cs) * (1 - rs) + (at(1, 0) * (1 - cs) + at(1, 1) * cs) * rs);
}

}  // namespace

ThinnedScan thinned_scan(Simulator& simulator, const Vec3& head) {
  struct Cell {
    Vector3d sum = Vector3d::Zero();
    double variance = 0;
    int points = 0;
  };
  ThinnedScan scan;
  scan.head = {head.x, head.y, head.z};
  std::map<std::uint64_t, Cell> cells;
  const Vector3d origin(simulator.origin().x, simulator.origin().y, simulator.origin().z);
  simulator.scan({.position = head}, {.outputs = scan_range | scan_position | scan_reflectivity | scan_voxel},
                 [&](const ScanChunk& chunk) {
                   for (std::size_t k = 0; k < chunk.ray_count; ++k) {
                     if (!std::isfinite(chunk.range_m[k])) continue;
                     if (chunk.voxel[k] != 0xFFFFFFFFu) scan.voxels.push_back(chunk.voxel[k]);
                     const auto& p = chunk.position[k];
                     const double sigma = sigma_of(simulator.scanner().noise, chunk.range_m[k], chunk.reflectivity[k]);
                     const Vector3d point = Vector3d(p[0], p[1], p[2]) + origin;
                     Cell& cell = cells[cell_of(point - scan.head, ThinnedScan::cell_m)];
                     cell.sum += point;
                     cell.variance += sigma * sigma;
                     ++cell.points;
                   }
                 });
  std::sort(scan.voxels.begin(), scan.voxels.end());
  scan.voxels.erase(std::unique(scan.voxels.begin(), scan.voxels.end()), scan.voxels.end());

  std::vector<Vector3d> means;
  std::vector<double> variances;
  for (const auto& [key, cell] : cells) {
    means.push_back(cell.sum / cell.points);
    variances.push_back(cell.variance / cell.points / cell.points);
  }
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> near;
  for (std::uint32_t k = 0; k < means.size(); ++k) near[cell_of(means[k], fit_radius_m)].push_back(k);
  for (std::uint32_t k = 0; k < means.size(); ++k) {
    Vector3d sum = Vector3d::Zero();
    Matrix3d square = Matrix3d::Zero();
    int n = 0;
    for (int cell = 0; cell < 27; ++cell) {
      const Vector3d step(cell % 3 - 1, cell / 3 % 3 - 1, cell / 9 - 1);
      const auto found = near.find(cell_of(means[k] + step * fit_radius_m, fit_radius_m));
      if (found == near.end()) continue;
      for (const std::uint32_t other : found->second) {
        const Vector3d e = means[other] - means[k];
        if (e.squaredNorm() > fit_radius_m * fit_radius_m) continue;
        sum += e;
        square += e * e.transpose();
        ++n;
      }
    }
    if (n < 6) continue;
    const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(square / n - sum * sum.transpose() / (double(n) * n));
    Vector3d normal = solver.eigenvectors().col(0);
    if (normal.dot(scan.head - means[k]) < 0) normal = -normal;
    const double cosine = normal.dot((scan.head - means[k]).normalized());
    scan.points.push_back(means[k].cast<float>());
    scan.normals.push_back(normal.cast<float>());
    scan.variances.push_back(static_cast<float>(variances[k] * cosine * cosine));
    // Flat to 15 mm, and spread in two directions.
    scan.planar.push_back(solver.eigenvalues()[0] < 0.015 * 0.015 && solver.eigenvalues()[1] > 0.04 * 0.04);
  }
  return scan;
}

std::uint64_t Neighbours::key(std::int64_t x, std::int64_t y, std::int64_t z) { return packed(x, y, z); }

Neighbours::Neighbours(const ThinnedScan& scan) : scan_(&scan) {
  for (std::uint32_t k = 0; k < scan.points.size(); ++k)
    if (scan.planar[k]) cells_[cell_of(scan.points[k].cast<double>(), 2 * match_m)].push_back(k);
}

int Neighbours::nearest(const Vector3d& point, const Vector3d& normal) const {
  const Eigen::Vector3f p = point.cast<float>(), n = normal.cast<float>();
  float best = static_cast<float>(match_m * match_m);
  int found = -1;
  // Cells are twice as wide as a match reaches: eight hold every match.
  std::array<std::int64_t, 3> low;
  for (int axis = 0; axis < 3; ++axis)
    low[axis] = static_cast<std::int64_t>(std::floor(point[axis] / (2 * match_m) - 0.5));
  for (int cell = 0; cell < 8; ++cell) {
    const auto at = cells_.find(key(low[0] + (cell & 1), low[1] + (cell >> 1 & 1), low[2] + (cell >> 2)));
    if (at == cells_.end()) continue;
    for (const std::uint32_t k : at->second) {
      const float d = (scan_->points[k] - p).squaredNorm();
      if (d < best && scan_->normals[k].dot(n) > 0.9f) {
        best = d;
        found = static_cast<int>(k);
      }
    }
  }
  return found;
}

std::vector<std::uint32_t> matching_points(const ThinnedScan& scan, const Neighbours& other) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t k = 0; k < scan.points.size(); ++k)
    if (scan.planar[k] && other.nearest(scan.points[k].cast<double>(), scan.normals[k].cast<double>()) >= 0)
      found.push_back(k);
  return found;
}

std::vector<PoseError> adjust(const ScanNetwork& network, const AdjustmentTruth& truth, std::uint64_t seed) {
  const auto& [scans, neighbours, matches] = network;
  const std::size_t n = scans.size();
  std::mt19937_64 random(seed * 0x9E3779B97F4A7C15ull + 1);
  std::normal_distribution<double> gauss;
  const auto disturbance = [&](double a, double b, double c) {
    const double x = gauss(random) * a, y = gauss(random) * b, z = gauss(random) * c;
    return Vector3d(x, y, z);
  };
  std::vector<Vector3d> turn0(n), shift0(n), shift(n);
  std::vector<Matrix3d> turn(n);
  for (std::size_t i = 0; i < n; ++i) {
    turn0[i] = disturbance(truth.tilt, truth.tilt, truth.heading);
    shift[i] = shift0[i] = disturbance(truth.position_m, truth.position_m, truth.position_m);
    turn[i] = rotation(turn0[i]);
  }
  Instrument instrument;
  std::vector<double> starts(n, 0.0);
  if (truth.angle > 0 || truth.range_m > 0 || truth.range_share > 0) {
    instrument = {gauss(random) * truth.angle, gauss(random) * truth.angle, gauss(random) * truth.angle,
                  gauss(random) * truth.range_m, gauss(random) * truth.range_share};
    std::uniform_real_distribution<double> any(0, 2 * EIGEN_PI);
    for (double& start : starts) start = any(random);
  }
  // Error of each scan along the normal of a point.
  std::vector<std::vector<float>> wrong(n);
  for (std::size_t i = 0; i < n; ++i) wrong[i].assign(scans[i]->points.size(), std::numeric_limits<float>::quiet_NaN());
  const auto wrong_by = [&](std::size_t i, std::uint32_t k) -> double {
    float& w = wrong[i][k];
    if (std::isnan(w)) {
      const std::uint64_t own = seed * 1000 + i;
      const Vector3d point = scans[i]->points[k].cast<double>();
      w = static_cast<float>(
          scans[i]->normals[k].cast<double>().dot(instrument.measured(scans[i]->head, starts[i], point) - point) +
          modelling_error(own, scans[i]->points[k].cast<double>(), scans[i]->normals[k].cast<double>(), truth) +
          normal_of(own ^ 0xABCDEFull << 32, k) * std::sqrt(double(scans[i]->variances[k])));
    }
    return w;
  };
  // A point of scan i in the frame of scan j, by the poses that both are assumed to have.
  const auto seen_by = [&](std::size_t i, std::size_t j, const Vector3d& p) -> Vector3d {
    const Vector3d world = turn[i] * (p - scans[i]->head) + scans[i]->head + shift[i];
    return turn[j].transpose() * (world - scans[j]->head - shift[j]) + scans[j]->head;
  };
  struct Link {
    std::size_t from, to;
    std::vector<std::uint32_t> sample;
    double variance;  // of a sampled point
  };
  std::vector<Link> links;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      if (i == j || matches[i * n + j]->size() < least_matches) continue;
      Link link{i, j, *matches[i * n + j], 0};
      const auto all = static_cast<double>(link.sample.size());
      std::shuffle(link.sample.begin(), link.sample.end(), random);
      link.sample.resize(std::min(link.sample.size(), truth.samples));
      // area that a sampled point stands for
      const double area = ThinnedScan::cell_m * ThinnedScan::cell_m * all / static_cast<double>(link.sample.size());
      // Two scans' errors; each pair is matched both ways.
      link.variance = 2 * (2 * truth.rho_m * truth.rho_m * truth.patch_m * truth.patch_m / area);
      links.push_back(std::move(link));
    }
  constexpr std::array<double, 4> gates{0.15, 0.12, 0.08, 0.05};
  struct Row {
    double residual;
    std::array<Vector3d, 3> arms;  // of i, of j, and the normal
  };
  std::vector<Row> rows;
  std::vector<double> sizes;
  for (int iteration = 0; iteration < truth.iterations; ++iteration) {
    const auto size = static_cast<Eigen::Index>(6 * n);
    MatrixXd a = MatrixXd::Zero(size, size);
    VectorXd g = VectorXd::Zero(size);
    for (const Link& link : links) {
      const std::size_t i = link.from, j = link.to;
      rows.clear();
      sizes.clear();
      const Matrix3d there = turn[j].transpose() * turn[i];
      for (const std::uint32_t k : link.sample) {
        const Vector3d normal = scans[i]->normals[k].cast<double>();
        const Vector3d p = scans[i]->points[k].cast<double>() + normal * wrong_by(i, k);
        const Vector3d q = seen_by(i, j, p);
        const int match = neighbours[j]->nearest(q, there * normal);
        if (match < 0) continue;
        const auto m = static_cast<std::uint32_t>(match);
        const Vector3d other = scans[j]->normals[m].cast<double>();
        const double r = other.dot(q - scans[j]->points[m].cast<double>()) - wrong_by(j, m);
        if (std::abs(r) > gates[std::min<std::size_t>(static_cast<std::size_t>(iteration), 3)]) continue;
        rows.push_back({r, {turn[i] * (p - scans[i]->head), turn[j] * (q - scans[j]->head), turn[j] * other}});
        sizes.push_back(std::abs(r));
      }
      if (rows.size() < least_matches / 2) continue;
      double limit = std::numeric_limits<double>::infinity();
      if (iteration >= 4) {  // three robust standard deviations
        std::nth_element(sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2), sizes.end());
        limit = std::max(0.003, 3 * 1.4826 * sizes[sizes.size() / 2]);
      }
      Eigen::Matrix<double, 12, 12> b = Eigen::Matrix<double, 12, 12>::Zero();
      Eigen::Matrix<double, 12, 1> c = Eigen::Matrix<double, 12, 1>::Zero();
      for (const Row& row : rows) {
        if (std::abs(row.residual) > limit) continue;
        const auto& [own, others, normal] = row.arms;
        Eigen::Matrix<double, 12, 1> jacobian;
        jacobian << own.cross(normal), normal, -others.cross(normal), -normal;
        b.noalias() += jacobian * jacobian.transpose();
        c += jacobian * row.residual;
      }
      const std::array<Eigen::Index, 2> at{static_cast<Eigen::Index>(6 * i), static_cast<Eigen::Index>(6 * j)};
      for (int x = 0; x < 2; ++x) {
        g.segment<6>(at[x]) += c.segment<6>(6 * x) / link.variance;
        for (int y = 0; y < 2; ++y) a.block<6, 6>(at[x], at[y]) += b.block<6, 6>(6 * x, 6 * y) / link.variance;
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      Eigen::Matrix<double, 6, 1> weight, off;
      const auto w = [](double sigma) { return 1 / (sigma * sigma); };
      weight << w(truth.tilt), w(truth.tilt), w(truth.heading), Vector3d::Constant(w(truth.position_m));
      off << turn_of(turn[i]) - turn0[i], shift[i] - shift0[i];
      a.diagonal().segment<6>(static_cast<Eigen::Index>(6 * i)) += weight;
      g.segment<6>(static_cast<Eigen::Index>(6 * i)) += weight.cwiseProduct(off);
    }
    const VectorXd step = a.ldlt().solve(-g);
    double largest = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const auto at = static_cast<Eigen::Index>(6 * i);
      turn[i] = rotation(step.segment<3>(at)) * turn[i];
      shift[i] += step.segment<3>(at + 3);
      largest = std::max({largest, 10 * step.segment<3>(at).norm(), step.segment<3>(at + 3).norm()});
    }
    if (iteration >= 6 && largest < 2e-5) break;
  }
  std::vector<PoseError> errors;
  for (std::size_t i = 0; i < n; ++i) errors.push_back({scans[i]->head, turn_of(turn[i]), shift[i]});
  return errors;
}

double surface_error(const std::vector<PoseError>& errors, const std::vector<Vector3d>& points,
                     const std::vector<std::uint64_t>& masks) {
  Vector3d centre = Vector3d::Zero();
  for (const Vector3d& p : points) centre += p / static_cast<double>(points.size());
  // Motion that fits all displacements best; the stations that see a point share its displacement.
  Eigen::Matrix<double, 6, 6> a = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> b = Eigen::Matrix<double, 6, 1>::Zero();
  const auto each = [&](const auto& visit) {
    for (std::size_t k = 0; k < points.size(); ++k)
      for (std::size_t i = 0; i < errors.size(); ++i)
        if (masks[k] >> i & 1) {
          const PoseError& e = errors[i];
          visit(points[k] - centre, Vector3d(e.shift + e.turn.cross(points[k] - e.head)),
                1.0 / static_cast<double>(std::popcount(masks[k])));
        }
  };
  each([&](const Vector3d& p, const Vector3d& moved, double weight) {
    Eigen::Matrix<double, 3, 6> m;
    m << -cross_matrix(p), Matrix3d::Identity();
    a += weight * m.transpose() * m;
    b += weight * m.transpose() * moved;
  });
  const Eigen::Matrix<double, 6, 1> whole = a.ldlt().solve(b);
  double sum = 0, total = 0;
  each([&](const Vector3d& p, const Vector3d& moved, double weight) {
    const Vector3d left = moved - whole.tail<3>() - Vector3d(whole.head<3>()).cross(p);
    sum += weight * left.squaredNorm();
    total += weight;
  });
  return std::sqrt(sum / total);
}

}  // namespace vantage::bench
