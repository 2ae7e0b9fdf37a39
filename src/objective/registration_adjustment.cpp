// SPDX-License-Identifier: Apache-2.0
#include "objective/registration_adjustment.hpp"

#include <algorithm>
#include <cmath>

namespace vantage {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;

constexpr std::size_t kOfPair = RegistrationSums::of_pair, kOfStation = RegistrationSums::of_station;
constexpr double kLeastScale_m = 1;  // least scale of rotations, for tiny surfaces
// From this many stations on, most pairs have no common view, and a sparse factor is cheaper.
constexpr std::size_t kSparseStations = 64;

Vector3d to_eigen(const Vec3& v) { return {v.x, v.y, v.z}; }

Matrix3d cross_matrix(const Vector3d& v) {
  Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

double weight_of(double sigma) { return sigma > 0 ? 1 / (sigma * sigma) : 0; }

void describe_head(StationError& station, const Matrix3d& covariance) {
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(station.covariance.data()) = covariance;
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(covariance);
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d v = solver.eigenvectors().col(2 - axis) * std::sqrt(std::max(solver.eigenvalues()[2 - axis], 0.0));
    station.axes[static_cast<std::size_t>(axis)] = {v.x(), v.y(), v.z()};
  }
}

}  // namespace

Matrix36d displacement(const Vector3d& q) {
  Matrix36d m;
  m << -cross_matrix(q), Matrix3d::Identity();
  return m;
}

Moments::Moments(const double* m) : mass(m[0]), first(m[1], m[2], m[3]) {
  second << m[4], m[5], m[6], m[5], m[7], m[8], m[6], m[8], m[9];
}

void Moments::add(const Moments& other) {
  mass += other.mass;
  first += other.first;
  second += other.second;
}

Moments Moments::moved(const Vector3d& centre, double scale) const {
  Moments m;
  m.mass = mass;
  m.first = (first - mass * centre) / scale;
  m.second = (second - first * centre.transpose() - centre * first.transpose() + mass * centre * centre.transpose()) /
             (scale * scale);
  return m;
}

Matrix6d Moments::quadratic() const {
  Matrix6d m;
  m << second.trace() * Matrix3d::Identity() - second, cross_matrix(first), -cross_matrix(first),
      mass * Matrix3d::Identity();
  return m;
}

RegistrationAdjustment::RegistrationAdjustment(const RegistrationSums& sums, double share,
                                               const RegistrationSums& covered, const RegistrationOptions& options,
                                               std::span<const RegistrationTarget> targets)
    : sums_(sums),
      share_(share),
      options_(options),
      targets_(targets),
      unknowns_(options.tilt.in_radians() > 0 ? 6 : 4) {
  Moments all;
  const Vector3d offset = to_eigen(sums.centre - covered.centre) / covered.radius_m;
  for (std::size_t k = 0; k < sums.heads.size(); ++k) {
    const Moments own =
        Moments(covered.surface.data() + k * kOfStation).moved(offset, sums.radius_m / covered.radius_m);
    if (!(own.mass > 0) && !(sums.surface[k * kOfStation] > 0)) continue;
    stations_.push_back(k);
    moments_.push_back(own);
    all.add(own);
  }
  if (!(all.mass > 0)) return;
  centre_ = all.first / all.mass;
  const double spread = (all.second.trace() / all.mass - centre_.squaredNorm());
  scale_ = std::max(std::sqrt(std::max(spread, 0.0)), kLeastScale_m / sums.radius_m);
  mass_ = all.mass;
  for (Moments& own : moments_) own = own.moved(centre_, scale_);
}

RegistrationError RegistrationAdjustment::error() const {
  RegistrationError result;
  result.stations.resize(sums_.heads.size());
  result.poses.resize(sums_.heads.size());
  result.centre = sums_.centre;
  if (!(mass_ > 0)) {
    result.rms_m = result.random_m = result.worst_m = std::sqrt(3.0) * options_.position_m;
    return result;
  }
  const Vector3d centre = centre_ * sums_.radius_m;
  result.centre = result.centre + Vec3{centre.x(), centre.y(), centre.z()};
  result.scale_m = scale_ * sums_.radius_m;
  const MatrixXd mean = this->mean(), instrument = this->instrument();
  MatrixXd right(mean.cols(), mean.rows() + instrument.cols());
  right << mean.transpose(), instrument;
  PartialInverse absolute = inverse_times(right);
  const MatrixXd motions = absolute.times.rightCols(instrument.cols());  // motion by each error of the instrument
  absolute.times.conservativeResize(Eigen::NoChange, mean.rows());
  const MatrixXd mean_motion = mean * motions;
  auto covariances = relative_covariances(absolute, mean);
  double total = 0, random_total = 0, absolute_total = 0;
  const Eigen::Index d = unknowns_, skipped = 6 - d;
  for (std::size_t k = 0; k < stations_.size(); ++k) {
    const std::size_t place = stations_[k];
    const Matrix6d quadratic = moments_[k].quadratic();
    random_total += std::max((quadratic * covariances[k]).trace(), 0.0);
    const MatrixXd motion = motions.middleRows(static_cast<Eigen::Index>(k) * d, d), relative = motion - mean_motion;
    covariances[k].block(skipped, skipped, d, d) += relative * relative.transpose();
    absolute.blocks[k] += motion * motion.transpose();
    const double squares = std::max((quadratic * covariances[k]).trace(), 0.0);
    total += squares;
    absolute_total += (quadratic.block(skipped, skipped, d, d) * absolute.blocks[k]).trace();
    StationError& station = result.stations[place];
    station.rms_m = moments_[k].mass > 0 ? std::sqrt(squares / moments_[k].mass) : 0;
    if (station.rms_m > result.worst_m) {
      result.worst_m = station.rms_m;
      result.worst_station = place;
    }
    const Matrix36d at_head = displacement(head(place));
    describe_head(station, at_head * covariances[k] * at_head.transpose());
    Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(result.poses[place].data()) = covariances[k];
  }
  result.rms_m = std::sqrt(total / mass_), result.random_m = std::sqrt(random_total / mass_);
  const auto tied_to_the_site = [](const RegistrationTarget& target) {
    return target.control_m > 0 && !target.seen_by.empty();
  };
  if (std::ranges::any_of(targets_, tied_to_the_site))
    result.absolute_rms_m = std::sqrt(std::max(absolute_total, 0.0) / mass_);
  return result;
}

MatrixXd RegistrationAdjustment::covariance() const {
  const MatrixXd information = of_unknowns(this->information());
  return information.llt().solve(MatrixXd::Identity(information.rows(), information.rows()));
}

// Returns the matrix whose product with the unknowns is the mean of the stations' motions: d × all unknowns.
MatrixXd RegistrationAdjustment::mean() const {
  const Eigen::Index d = unknowns_, skipped = 6 - d;
  MatrixXd sum = MatrixXd::Zero(d, d), metric(d, static_cast<Eigen::Index>(moments_.size()) * d);
  for (std::size_t k = 0; k < moments_.size(); ++k) {
    const MatrixXd own = moments_[k].quadratic().block(skipped, skipped, d, d);
    metric.middleCols(static_cast<Eigen::Index>(k) * d, d) = own;
    sum += own;
  }
  return sum.completeOrthogonalDecomposition().solve(metric);
}

PartialInverse RegistrationAdjustment::inverse_times(const MatrixXd& right) const {
  const Eigen::Index d = unknowns_;
  if (stations_.size() >= kSparseStations) return partial_inverse(sparse_information(), right);
  const MatrixXd all = covariance();
  PartialInverse own{.blocks = {}, .times = all * right};
  for (std::size_t k = 0; k < stations_.size(); ++k) {
    const Eigen::Index at = static_cast<Eigen::Index>(k) * d;
    own.blocks.emplace_back(all.block(at, at, d, d));
  }
  return own;
}

MatrixXd RegistrationAdjustment::instrument() const {
  constexpr auto kErrors = static_cast<Eigen::Index>(RegistrationSums::instrument_errors);
  const Eigen::Index d = unknowns_;
  if (sums_.instrument.empty()) return MatrixXd(static_cast<Eigen::Index>(stations_.size()) * d, 0);
  using Sums = Eigen::Matrix<double, 6, kErrors, Eigen::RowMajor>;
  const Matrix6d moved = from_sums();
  MatrixXd all(static_cast<Eigen::Index>(stations_.size()) * d, kErrors);
  for (std::size_t k = 0; k < stations_.size(); ++k) {
    const Eigen::Map<const Sums> own(sums_.instrument.data() +
                                     stations_[k] * static_cast<std::size_t>(Sums::SizeAtCompileTime));
    all.middleRows(static_cast<Eigen::Index>(k) * d, d) = share_ * (moved * own).bottomRows(d);
  }
  return all;
}

MatrixXd RegistrationAdjustment::metric() const {
  const Eigen::Index d = unknowns_, size = static_cast<Eigen::Index>(stations_.size()) * d, skipped = 6 - d;
  MatrixXd all = MatrixXd::Zero(size, size), rows(d, size), sum = MatrixXd::Zero(d, d);
  for (std::size_t k = 0; k < moments_.size(); ++k) {
    const MatrixXd own = moments_[k].quadratic().block(skipped, skipped, d, d);
    const Eigen::Index at = static_cast<Eigen::Index>(k) * d;
    all.block(at, at, d, d) = own;
    rows.middleCols(at, d) = own;
    sum += own;
  }
  all -= rows.transpose() * sum.completeOrthogonalDecomposition().solve(rows);
  return all / mass_;
}

MatrixXd RegistrationAdjustment::displacement_at(const Vec3& local) const {
  return displacement(scaled(local - sums_.centre)).rightCols(unknowns_);
}

Vector3d RegistrationAdjustment::scaled(const Vec3& from_sums_centre) const {
  return (to_eigen(from_sums_centre) / sums_.radius_m - centre_) / scale_;
}

Vector3d RegistrationAdjustment::head(std::size_t place) const { return scaled(sums_.heads[place]); }

std::size_t RegistrationAdjustment::pair(std::size_t i, std::size_t j) const {
  const std::size_t n = sums_.heads.size();
  return (i * (2 * n - i - 1) / 2 + (j - i - 1)) * kOfPair;
}

// Returns true if two stations, the first before the second, see a common surface.
bool RegistrationAdjustment::tied(std::size_t i, std::size_t j) const {
  const std::span<const double> sums = std::span(sums_.pairs).subspan(pair(i, j), kOfPair);
  return std::ranges::any_of(sums, [](double sum) { return sum != 0; });
}

// Σ w_i w_j / Σw · J Jᵀ with J about the surface's centre and in its scale.
Matrix6d RegistrationAdjustment::information_of(std::size_t i, std::size_t j) const {
  const double* sum = sums_.pairs.data() + pair(i, j);
  Matrix6d h;
  for (int a = 0; a < 6; ++a)
    for (int b = a; b < 6; ++b) h(a, b) = h(b, a) = *sum++ * share_;
  const Matrix6d moved = from_sums();
  return moved * h * moved.transpose();
}

// Transforms J of the sums to J about the surface's centre and in its scale.
Matrix6d RegistrationAdjustment::from_sums() const {
  Matrix6d moved = Matrix6d::Identity();
  moved.topLeftCorner<3, 3>() /= scale_;
  moved.topRightCorner<3, 3>() = -cross_matrix(centre_) / scale_;
  return moved;
}

// Returns the prior of tilt, heading and head.
Matrix6d RegistrationAdjustment::prior_of(std::size_t place) const {
  const double scale = scale_ * sums_.radius_m;
  Matrix6d given = Matrix6d::Zero();
  given.diagonal() << weight_of(options_.tilt.in_radians() * scale), weight_of(options_.tilt.in_radians() * scale),
      weight_of(options_.heading.in_radians() * scale), 0, 0, 0;
  const Matrix36d at_head = displacement(head(place));
  return given + weight_of(options_.position_m) * at_head.transpose() * at_head;
}

// Calls add(a, b, h) for all information: between two stations, or on one station if a is b. Between two, h acts on the
// first, and hᵀ on the second.
template <class Add>
void RegistrationAdjustment::for_information(const Add& add) const {
  for (std::size_t a = 0; a < stations_.size(); ++a) {
    add(a, a, prior_of(stations_[a]));
    for (std::size_t b = a + 1; b < stations_.size(); ++b)
      if (tied(stations_[a], stations_[b])) add(a, b, information_of(stations_[a], stations_[b]));
  }
  for_targets(add);
}

MatrixXd RegistrationAdjustment::information() const {
  const auto size = static_cast<Eigen::Index>(stations_.size()) * 6;
  MatrixXd all = MatrixXd::Zero(size, size);
  for_information([&](std::size_t a, std::size_t b, const Matrix6d& h) {
    const auto i = static_cast<Eigen::Index>(a) * 6, j = static_cast<Eigen::Index>(b) * 6;
    all.block<6, 6>(i, i) += h;
    if (a == b) return;
    all.block<6, 6>(j, j) += h.transpose();
    all.block<6, 6>(i, j) -= h;
    all.block<6, 6>(j, i) -= h.transpose();
  });
  return all;
}

// Returns only the information of the unknowns.
SparseBlocks RegistrationAdjustment::sparse_information() const {
  const Eigen::Index d = unknowns_;
  const auto of_unknowns = [d](const Matrix6d& h) -> SmallBlock { return h.bottomRightCorner(d, d); };
  SparseBlocks all{.diagonal = std::vector<SmallBlock>(stations_.size(), SmallBlock::Zero(d, d)), .pairs = {}};
  for_information([&](std::size_t a, std::size_t b, const Matrix6d& h) {
    all.diagonal[a] += of_unknowns(h);
    if (a == b) return;
    all.diagonal[b] += of_unknowns(h.transpose());
    all.pairs.push_back({std::max(a, b), std::min(a, b), -of_unknowns(a > b ? h : h.transpose())});
  });
  return all;
}

Matrix3d RegistrationAdjustment::sighting_weight(const RegistrationTarget& target,
                                                 const RegistrationTarget::Sighting& sighting) const {
  const Vector3d line = to_eigen(target.centre - sums_.centre - sums_.heads[sighting.station]).normalized();
  const double across = weight_of(sighting.across_m), along = weight_of(sighting.along_m);
  return across * Matrix3d::Identity() + (along - across) * line * line.transpose();
}

// A target's centre is unknown, so k sightings of weights W give W_i (ΣW)⁻¹ W_j for each pair, as a plane does, but
// along all three axes. A control point adds the weight of its coordinates, which belongs to no station.
template <class Add>
void RegistrationAdjustment::for_targets(const Add& add) const {
  for (const RegistrationTarget& target : targets_) {
    struct Seen {
      std::size_t station;
      Matrix3d weight;
    };
    std::vector<Seen> seen;
    const Matrix3d known = weight_of(target.control_m) * Matrix3d::Identity();
    Matrix3d total = known;
    for (const RegistrationTarget::Sighting& sighting : target.seen_by) {
      const auto found = std::ranges::find(stations_, sighting.station);
      if (found == stations_.end()) continue;
      seen.push_back({static_cast<std::size_t>(found - stations_.begin()), sighting_weight(target, sighting)});
      total += seen.back().weight;
    }
    if (seen.empty()) continue;
    const Matrix36d at_centre = displacement(scaled(target.centre - sums_.centre));
    const Matrix3d mean = total.inverse();
    const auto tie = [&](std::size_t a, std::size_t b, const Matrix3d& other) {
      add(seen[a].station, seen[b].station,
          Matrix6d(at_centre.transpose() * seen[a].weight * mean * other * at_centre));
    };
    for (std::size_t a = 0; a < seen.size(); ++a) {
      tie(a, a, known);
      for (std::size_t b = a + 1; b < seen.size(); ++b) tie(a, b, seen[b].weight);
    }
  }
}

// Leaves out the two tilts of each station if they are known.
MatrixXd RegistrationAdjustment::of_unknowns(const MatrixXd& all) const {
  if (unknowns_ == 6) return all;
  const Eigen::Index n = all.rows() / 6;
  MatrixXd some(4 * n, 4 * n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) some.block<4, 4>(4 * i, 4 * j) = all.block<4, 4>(6 * i + 2, 6 * j + 2);
  return some;
}

// Returns the covariance of each station's unknowns without the best-fitting motion of the whole: (I − 1 B) C (I − 1
// B)ᵀ. B x is that motion, the mean of the stations' motions in the metric of the surface that each sees.
std::vector<Matrix6d> RegistrationAdjustment::relative_covariances(const PartialInverse& c,
                                                                   const MatrixXd& mean) const {
  const Eigen::Index d = unknowns_, skipped = 6 - d;
  const MatrixXd of_mean = mean * c.times;
  std::vector<Matrix6d> all;
  for (std::size_t k = 0; k < moments_.size(); ++k) {
    const MatrixXd cross = c.times.middleRows(static_cast<Eigen::Index>(k) * d, d);
    Matrix6d own = Matrix6d::Zero();
    own.block(skipped, skipped, d, d) = c.blocks[k] - cross - cross.transpose() + of_mean;
    all.push_back(own);
  }
  return all;
}

}  // namespace vantage
