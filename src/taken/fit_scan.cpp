// SPDX-License-Identifier: Apache-2.0
// Fits a scan to the model by point-to-plane iterations (Chen, Medioni: Object modelling by registration of multiple
// range images, 1992), on some thousand of its points, with Tukey's weights. A weak prior on the pose decides what the
// points leave open, such as the place along an even corridor.

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"
#include "core/text.hpp"
#include "taken/model_surface.hpp"
#include "vantage/taken_scans.hpp"

namespace vantage {
namespace {

constexpr std::size_t kFitPoints = 4000;
constexpr int kIterations = 40;
// Points this far from the model take part at first; the limit then shrinks.
constexpr double kFirstReach_m = 0.5, kReachShrinks = 0.8;
constexpr double kStepEnds = 1e-6;  // metres, and radians
// The prior: a point's distance against a rough pose.
constexpr double kPoint_m = 0.01, kPosition_m = 0.05, kTurn_rad = 0.01;
// Larger corrections mean a wrong site or frame.
constexpr double kMostShift_m = 0.75, kMostTurn_rad = 0.08, kLeastNear = 0.25;

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

Eigen::Vector3d eigen(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

// A pose's correction: points turn about the head and move with it.
struct Correction {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();

  Vector6 values() const {
    const Eigen::AngleAxisd axis(turn);
    Vector6 v;
    v << axis.angle() * axis.axis(), shift;
    return v;
  }
  void add(const Vector6& step) {
    const Eigen::Vector3d about = step.head<3>();
    const double angle = about.norm();
    if (angle > 0) turn = Eigen::AngleAxisd(angle, about / angle).toRotationMatrix() * turn;
    shift += step.tail<3>();
  }
};

struct FitPoint {
  Eigen::Vector3d offset;  // from the head
  std::optional<ModelSurface::Near> near = {};
};

class ScanFitter {
 public:
  ScanFitter(const ModelSurface& model, const TakenScan& scan, double tolerance_m)
      : model_(model), head_(eigen(to_glm(scan.head))), tolerance_m_(tolerance_m) {
    const std::size_t stride = 1 + scan.thinned.size() / kFitPoints;
    for (std::size_t k = 0; k < scan.thinned.size(); k += stride) {
      const auto& o = scan.thinned[k].offset;
      points_.push_back({{o[0], o[1], o[2]}});
    }
  }

  Correction run(ScanFit& fit) {
    Correction correction;
    double reach = kFirstReach_m;
    for (int k = 0; k < kIterations; ++k, reach = std::max(tolerance_m_, kReachShrinks * reach)) {
      look(correction, reach);
      const Vector6 step = step_of(correction, reach);
      correction.add(step);
      if (reach <= tolerance_m_ && step.cwiseAbs().maxCoeff() < kStepEnds) break;
    }
    look(correction, tolerance_m_);
    double squares = 0;
    std::size_t near = 0, flat = 0;
    for (const FitPoint& point : points_) {
      if (!point.near) continue;
      ++near;
      if (point.near->inside()) squares += point.near->height * point.near->height, ++flat;
    }
    fit.near_share = points_.empty() ? 0 : static_cast<double>(near) / static_cast<double>(points_.size());
    fit.residual_m = flat > 0 ? std::sqrt(squares / static_cast<double>(flat)) : 0;
    return correction;
  }

 private:
  void look(const Correction& correction, double reach) {
    parallel::for_all(std::size_t{0}, points_.size(), [&](std::size_t k) {
      const Eigen::Vector3d p = head_ + correction.shift + correction.turn * points_[k].offset;
      points_[k].near = model_.nearest({p.x(), p.y(), p.z()}, reach);
    });
  }

  Vector6 step_of(const Correction& correction, double reach) const {
    Vector6 prior;
    prior << Eigen::Vector3d::Constant(std::pow(kPoint_m / kTurn_rad, 2)),
        Eigen::Vector3d::Constant(std::pow(kPoint_m / kPosition_m, 2));
    Matrix6 normal = prior.asDiagonal();
    Vector6 right = -prior.cwiseProduct(correction.values());
    for (const FitPoint& point : points_) {
      if (!point.near || !point.near->inside()) continue;
      const Eigen::Vector3d n = eigen(point.near->normal);
      const double of_reach = point.near->height / reach, weight = std::pow(1 - of_reach * of_reach, 2);
      Vector6 row;
      row << (correction.turn * point.offset).cross(n), n;
      normal += weight * row * row.transpose();
      right -= weight * point.near->height * row;
    }
    return normal.ldlt().solve(right);
  }

  const ModelSurface& model_;
  Eigen::Vector3d head_;
  double tolerance_m_;
  std::vector<FitPoint> points_;
};

void move(TakenScan& scan, const Correction& correction) {
  scan.head = scan.head + Vec3{correction.shift.x(), correction.shift.y(), correction.shift.z()};
  const Eigen::Matrix3f turn = correction.turn.cast<float>();
  for (TakenPoint& point : scan.thinned) {
    const Eigen::Vector3f moved = turn * Eigen::Vector3f(point.offset[0], point.offset[1], point.offset[2]);
    point.offset = {moved.x(), moved.y(), moved.z()};
  }
  const double heading = std::atan2(correction.turn(1, 0), correction.turn(0, 0));
  scan.setup.heading = Angle::radians(scan.setup.heading.in_radians() + heading);
}

void fit_one(const ModelSurface& model, TakenScan& scan, double tolerance_m) {
  ScanFit& fit = scan.fit = {};
  const Correction correction = ScanFitter(model, scan, tolerance_m).run(fit);
  const Vector6 moved = correction.values();
  if (fit.near_share < kLeastNear) {
    fit.why = "does not fit the model, only " + percent(fit.near_share) +
              " of its points are near it: is it of this site, and in its frame?";
    return;
  }
  if (moved.tail<3>().norm() > kMostShift_m || moved.head<3>().norm() > kMostTurn_rad) {
    fit.why = "would fit the model " + fixed(moved.tail<3>().norm(), 2) + " m and " +
              fixed(Angle::radians(moved.head<3>().norm()).in_degrees(), 1) +
              "° from its pose, too far to be sure: register it better";
    return;
  }
  fit.fitted = true;
  fit.shift_m = moved.tail<3>().norm(), fit.turn = Angle::radians(moved.head<3>().norm());
  move(scan, correction);
}

}  // namespace

bool fit_to_model(Site& site, std::span<TakenScan> scans, double tolerance_m, const Progress& progress) {
  const ModelSurface model(site.scene());
  for (std::size_t k = 0; k < scans.size(); ++k) {
    if (progress.stopped()) return false;
    fit_one(model, scans[k], tolerance_m);
    progress(static_cast<double>(k + 1) / static_cast<double>(scans.size()));
  }
  return true;
}

}  // namespace vantage
