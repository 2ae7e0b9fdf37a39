// SPDX-License-Identifier: Apache-2.0
// The (1+1)-CMA-ES strategy of each member of MO-CMA-ES: step size by success, covariance by triangular factors. Igel,
// Hansen, Roth: Covariance Matrix Adaptation for Multi-objective Optimization, 2007, algorithms 2 and 3.
#pragma once

#include <Eigen/Dense>
#include <memory>
#include <vector>

#include "optimise/blocks.hpp"

namespace vantage::optimise {

// Coordinates that vary together, independently of other groups.
struct Group {
  std::vector<Eigen::Index> coordinates;
  Eigen::Index offset = 0;  // of its factor in Shape::factors

  Eigen::Index size() const { return static_cast<Eigen::Index>(coordinates.size()); }
};

// One group of all coordinates. Above `most` coordinates, with blocks: one group per block, and one per coordinate
// outside blocks.
std::vector<Group> groups_of(std::size_t dimension, const Blocks& blocks, std::size_t most);

// C = A Aᵀ with a lower triangular A per group, and the evolution path. Immutable, so that parents and offspring share
// it.
struct Shape {
  using Factor = Eigen::Map<Eigen::MatrixXd>;
  using ConstFactor = Eigen::Map<const Eigen::MatrixXd>;

  std::shared_ptr<const std::vector<Group>> groups;
  std::vector<double> factors;  // column-major, one group after another
  Eigen::VectorXd path;

  static std::shared_ptr<const Shape> identity(std::vector<Group> groups);
  Factor factor(const Group& group) { return {factors.data() + group.offset, group.size(), group.size()}; }
  ConstFactor factor(const Group& group) const { return {factors.data() + group.offset, group.size(), group.size()}; }

  // point += scale · A · normals.
  void add_step(Eigen::VectorXd& point, double scale, const Eigen::VectorXd& normals) const;
  // A⁻¹ · columns.
  Eigen::MatrixXd whitened(const Eigen::MatrixXd& columns) const;
  Eigen::VectorXd deviations() const;  // standard deviation along each coordinate
};

struct StepStrategy {
  static constexpr double kTargetSuccess = 1 / 5.5;

  double sigma = 0;
  double success = kTargetSuccess;  // smoothed
  std::shared_ptr<const Shape> shape;

  // Counts a success or a failure.
  void adapt_sigma(bool succeeded);
  // Learns the successful step, divided by the sigma it was drawn with. Resets a covariance that rounding broke.
  void adapt_shape(const Eigen::VectorXd& step);
  // The longest standard deviation along a coordinate.
  double reach() const { return sigma * shape->deviations().maxCoeff(); }
};

// Changes factor · factorᵀ to decay · factor · factorᵀ + gain · v vᵀ in O(n²) (Krause, Igel: A More Efficient Rank-one
// Covariance Matrix Update for Evolution Strategies, 2015, algorithm 3.1). Returns false if rounding broke it.
bool update_factor(Shape::Factor factor, double decay, double gain, Eigen::VectorXd v);

}  // namespace vantage::optimise
