// SPDX-License-Identifier: Apache-2.0
// The (1+1)-CMA-ES strategy that each member of MO-CMA-ES carries: step size by success, covariance by a triangular
// factor. Igel, Hansen, Roth: Covariance Matrix Adaptation for Multi-objective Optimization, 2007, algorithms 2 and 3.
#pragma once

#include <Eigen/Dense>
#include <memory>

namespace vantage::optimise {

// C = factor · factorᵀ and its evolution path. Never changed once made, so that parents and offspring share it.
struct Shape {
  Eigen::MatrixXd factor;  // lower triangular
  Eigen::VectorXd path;

  static std::shared_ptr<const Shape> identity(std::size_t dimension);
};

struct StepStrategy {
  static constexpr double kTargetSuccess = 1 / 5.5;

  double sigma = 0;
  double success = kTargetSuccess;  // smoothed
  std::shared_ptr<const Shape> shape;

  // Counts a success or a failure.
  void adapt_sigma(bool succeeded);
  // Learns the step that led here, divided by the sigma that it was drawn with. A covariance that rounding has broken
  // begins anew.
  void adapt_shape(const Eigen::VectorXd& step);
  // The longest standard deviation along a coordinate.
  double reach() const { return sigma * shape->factor.rowwise().norm().maxCoeff(); }
};

// factor · factorᵀ becomes decay · factor · factorᵀ + gain · v vᵀ in O(n²) (Krause, Igel: A More Efficient Rank-one
// Covariance Matrix Update for Evolution Strategies, 2015, algorithm 3.1). False if rounding broke it.
bool update_factor(Eigen::MatrixXd& factor, double decay, double gain, Eigen::VectorXd v);

}  // namespace vantage::optimise
