// SPDX-License-Identifier: Apache-2.0
#include "optimise/step_strategy.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace vantage::optimise {
namespace {

// A shape that is neither round nor aligned, with a path of its own.
StepStrategy slanted(double success) {
  Shape shape;
  shape.factor = Eigen::MatrixXd::Zero(3, 3);
  shape.factor << 1.2, 0, 0, -0.4, 0.7, 0, 0.25, 0.1, 2.1;
  shape.path = Eigen::Vector3d(0.3, -0.2, 0.9);
  return {.sigma = 0.5, .success = success, .shape = std::make_shared<const Shape>(shape)};
}

// The covariance and the path after a step, by matrices: Igel, Hansen, Roth, Covariance Matrix Adaptation for
// Multi-objective Optimization, 2007, procedure updateCovariance.
void expect_learned(double success) {
  StepStrategy strategy = slanted(success);
  const Eigen::MatrixXd before = strategy.shape->factor * strategy.shape->factor.transpose();
  const Eigen::Vector3d step(-0.8, 0.5, 0.1);
  const double n = 3, c_c = 2 / (n + 2), c_cov = 2 / (n * n + 6);
  Eigen::VectorXd path = (1 - c_c) * strategy.shape->path;
  Eigen::MatrixXd kept = before;
  if (success < 0.44) {
    path += std::sqrt(c_c * (2 - c_c)) * step;
    kept *= 1 - c_cov;
  } else {
    kept *= 1 - c_cov + c_cov * c_c * (2 - c_c);
  }
  const Eigen::MatrixXd after = kept + c_cov * path * path.transpose();
  strategy.adapt_shape(step);
  EXPECT_LT((strategy.shape->path - path).norm(), 1e-14);
  EXPECT_LT((strategy.shape->factor * strategy.shape->factor.transpose() - after).norm(), 1e-13);
}

TEST(StepStrategy, LearnsTheStepWhileSuccessIsRare) { expect_learned(0.2); }

TEST(StepStrategy, KeepsToItsPathWhileSuccessIsCommon) { expect_learned(0.6); }

TEST(StepStrategy, WidensWithSuccessAndNarrowsWithout) {
  StepStrategy up = slanted(0.2), down = up;
  const double target = 1 / 5.5, rate = target / (2 + target), damping = 1 + 3.0 / 2;
  up.adapt_sigma(true);
  down.adapt_sigma(false);
  EXPECT_NEAR(up.success, (1 - rate) * 0.2 + rate, 1e-15);
  EXPECT_NEAR(down.success, (1 - rate) * 0.2, 1e-15);
  for (const StepStrategy* const one : {&up, &down})
    EXPECT_NEAR(one->sigma, 0.5 * std::exp((one->success - target) / (damping * (1 - target))), 1e-15);
}

}  // namespace
}  // namespace vantage::optimise
