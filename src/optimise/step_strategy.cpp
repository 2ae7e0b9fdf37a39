// SPDX-License-Identifier: Apache-2.0
#include "optimise/step_strategy.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vantage::optimise {
namespace {

using Eigen::Index;

constexpr double kSuccessThreshold = 0.44;
constexpr double kMinSigma = 1e-300, kMaxSigma = 1e6;  // keep samples finite if every step fails, or succeeds

// Entries of all factors: the number of parameters of a covariance, up to a factor of about two.
Index entries(const std::vector<Group>& groups) {
  const Group& last = groups.back();
  return last.offset + last.size() * last.size();
}

}  // namespace

std::vector<Group> groups_of(std::size_t dimension, const Blocks& blocks, std::size_t most) {
  std::vector<std::vector<Index>> together;
  std::vector<char> grouped(dimension, 0);
  const bool split = dimension > most && !blocks.empty();
  if (split) {
    for (const auto& block : blocks) {
      together.emplace_back(block.begin(), block.end());
      for (const std::size_t i : block) grouped[i] = 1;
    }
  } else {
    together.emplace_back();
  }
  for (std::size_t i = 0; i < dimension; ++i) {
    if (grouped[i]) continue;
    if (split) together.emplace_back();
    together.back().push_back(static_cast<Index>(i));
  }
  std::vector<Group> groups;
  for (auto& coordinates : together) {
    const Index offset = groups.empty() ? 0 : entries(groups);
    groups.push_back({std::move(coordinates), offset});
  }
  return groups;
}

std::shared_ptr<const Shape> Shape::identity(std::vector<Group> groups) {
  Shape shape;
  Index n = 0;
  for (const Group& group : groups) n += group.size();
  shape.path = Eigen::VectorXd::Zero(n);
  shape.factors.resize(static_cast<std::size_t>(entries(groups)), 0.0);
  for (const Group& group : groups) shape.factor(group).diagonal().setOnes();
  shape.groups = std::make_shared<const std::vector<Group>>(std::move(groups));
  return std::make_shared<const Shape>(std::move(shape));
}

void Shape::add_step(Eigen::VectorXd& point, double scale, const Eigen::VectorXd& normals) const {
  for (const Group& group : *groups) {
    const auto a = factor(group);
    const Index n = group.size();
    Eigen::VectorXd part = point(group.coordinates);
    for (Index i = 0; i < n; ++i)
      part.tail(n - i) += (scale * normals[group.coordinates[static_cast<std::size_t>(i)]]) * a.col(i).tail(n - i);
    point(group.coordinates) = part;
  }
}

Eigen::MatrixXd Shape::whitened(const Eigen::MatrixXd& columns) const {
  Eigen::MatrixXd result = columns;
  for (const Group& group : *groups) {
    Eigen::MatrixXd part = columns(group.coordinates, Eigen::all);
    factor(group).triangularView<Eigen::Lower>().solveInPlace(part);
    result(group.coordinates, Eigen::all) = part;
  }
  return result;
}

Eigen::VectorXd Shape::deviations() const {
  Eigen::VectorXd result(path.size());
  for (const Group& group : *groups) result(group.coordinates) = factor(group).rowwise().norm();
  return result;
}

void StepStrategy::adapt_sigma(bool succeeded) {
  const double rate = kTargetSuccess / (2 + kTargetSuccess);
  const double damping = 1 + static_cast<double>(shape->path.size()) / 2;
  success = (1 - rate) * success + (succeeded ? rate : 0.0);
  sigma *= std::exp((success - kTargetSuccess) / (damping * (1 - kTargetSuccess)));
  sigma = std::clamp(sigma, kMinSigma, kMaxSigma);
}

void StepStrategy::adapt_shape(const Eigen::VectorXd& step) {
  // n² in one group. Fewer parameters are learnt faster: Ros, Hansen, A Simple Modification in CMA-ES Achieving Linear
  // Time and Space Complexity, 2008.
  const double n = static_cast<double>(step.size()), c_c = 2 / (n + 2);
  const double c_cov = 2 / (static_cast<double>(entries(*shape->groups)) + 6);
  Shape next = *shape;
  next.path *= 1 - c_c;
  double decay = 1 - c_cov;
  if (success < kSuccessThreshold) {
    next.path += std::sqrt(c_c * (2 - c_c)) * step;
  } else {
    decay += c_cov * c_c * (2 - c_c);
  }
  bool sound = true;
  for (const Group& group : *next.groups) {
    const auto factor = next.factor(group);
    sound = sound && update_factor(factor, decay, c_cov, next.path(group.coordinates)) && factor.allFinite();
  }
  shape = sound ? std::make_shared<const Shape>(std::move(next)) : Shape::identity(*shape->groups);
}

bool update_factor(Shape::Factor factor, double decay, double gain, Eigen::VectorXd v) {
  const Index n = factor.rows();
  const double scale = std::sqrt(decay);
  double b = 1;
  for (Index j = 0; j < n; ++j) {
    const double old = scale * factor(j, j), w = v[j];
    const double now = std::sqrt(old * old + gain / b * w * w);
    const double gamma = old * old * b + gain * w * w;
    if (!(old > 0) || !std::isfinite(now) || !(gamma > 0)) return false;
    auto column = factor.col(j).tail(n - j - 1);
    auto rest = v.tail(n - j - 1);
    rest -= (w * scale / old) * column;
    column = (scale * now / old) * column + (now * gain * w / gamma) * rest;
    factor(j, j) = now;
    b += gain * w * w / (old * old);
  }
  return true;
}

}  // namespace vantage::optimise
