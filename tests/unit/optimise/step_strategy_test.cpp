// SPDX-License-Identifier: Apache-2.0
#include "optimise/step_strategy.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace vantage::optimise {
namespace {

Shape::Factor factor_of(Shape& shape) { return shape.factor(shape.groups->front()); }
Eigen::MatrixXd covariance(const Shape& shape) {
  const auto factor = shape.factor(shape.groups->front());
  return factor * factor.transpose();
}

// A shape neither round nor aligned, with a path.
StepStrategy slanted(double success) {
  Shape shape = *Shape::identity(groups_of(3, {}, 3));
  factor_of(shape) << 1.2, 0, 0, -0.4, 0.7, 0, 0.25, 0.1, 2.1;
  shape.path = Eigen::Vector3d(0.3, -0.2, 0.9);
  return {.sigma = 0.5, .success = success, .shape = std::make_shared<const Shape>(shape)};
}

// The covariance and the path after a step, by matrices: Igel, Hansen, Roth, Covariance Matrix Adaptation for
// Multi-objective Optimization, 2007, procedure updateCovariance.
void expect_learned(double success) {
  StepStrategy strategy = slanted(success);
  const Eigen::MatrixXd before = covariance(*strategy.shape);
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
  EXPECT_LT((covariance(*strategy.shape) - after).norm(), 1e-13);
}

TEST(StepStrategy, LearnsTheStepWhileSuccessIsRare) { expect_learned(0.2); }

TEST(StepStrategy, KeepsToItsPathWhileSuccessIsCommon) { expect_learned(0.6); }

TEST(StepStrategy, KeepsBlocksInGroupsOnlyBeyondItsLimit) {
  const Blocks blocks{{1, 3}, {0, 4}};
  const auto coordinates = [&](std::size_t most) {
    std::vector<std::vector<Eigen::Index>> all;
    for (const Group& group : groups_of(5, blocks, most)) all.push_back(group.coordinates);
    return all;
  };
  EXPECT_EQ(coordinates(5), (std::vector<std::vector<Eigen::Index>>{{0, 1, 2, 3, 4}}));
  EXPECT_EQ(coordinates(4), (std::vector<std::vector<Eigen::Index>>{{1, 3}, {0, 4}, {2}}));
  EXPECT_EQ(groups_of(5, {}, 4).size(), 1u) << "without blocks";
  EXPECT_EQ(groups_of(5, blocks, 4).back().offset, 8);
}

// The whole matrix of a grouped shape, with zeros between groups.
Eigen::MatrixXd whole_factor(const Shape& shape) {
  const Eigen::Index n = shape.path.size();
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(n, n);
  for (const Group& group : *shape.groups) whole(group.coordinates, group.coordinates) = shape.factor(group);
  return whole;
}

TEST(StepStrategy, LearnsInEachGroupWhatTheRankOneUpdateHoldsThere) {
  StepStrategy strategy{.sigma = 0.5, .success = 0.2, .shape = Shape::identity(groups_of(5, {{1, 3}, {0, 4}}, 0))};
  const double n = 5, learnt = 4 + 4 + 1, c_c = 2 / (n + 2), c_cov = 2 / (learnt + 6);
  Eigen::VectorXd step(5), path = Eigen::VectorXd::Zero(5);
  step << 0.3, -1.2, 0.5, 0.8, -0.1;
  Eigen::MatrixXd expected = Eigen::MatrixXd::Identity(5, 5);
  for (int round = 0; round < 3; ++round, step = -0.5 * step) {
    path = (1 - c_c) * path + std::sqrt(c_c * (2 - c_c)) * step;
    expected = (1 - c_cov) * expected + c_cov * path * path.transpose();
    strategy.adapt_shape(step);
  }
  for (Eigen::Index i = 0; i < 5; ++i)
    for (Eigen::Index j = 0; j < 5; ++j)
      if (i != j && i + j != 4) expected(i, j) = 0;  // 1 and 3, 0 and 4 are together
  const Eigen::MatrixXd factor = whole_factor(*strategy.shape);
  EXPECT_LT((factor * factor.transpose() - expected).norm(), 1e-13);
  EXPECT_LT((strategy.shape->deviations() - expected.diagonal().cwiseSqrt()).norm(), 1e-13);

  Eigen::VectorXd point = Eigen::VectorXd::Ones(5), normals(5);
  normals << 1, -2, 0.5, 3, 0.25;
  strategy.shape->add_step(point, 0.7, normals);
  EXPECT_LT((point - Eigen::VectorXd::Ones(5) - 0.7 * factor * normals).norm(), 1e-13);
  const Eigen::MatrixXd columns = Eigen::MatrixXd::Random(5, 2);
  EXPECT_LT((factor * strategy.shape->whitened(columns) - columns).norm(), 1e-13);
}

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
