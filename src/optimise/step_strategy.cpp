// SPDX-License-Identifier: Apache-2.0
#include "optimise/step_strategy.hpp"

#include <algorithm>
#include <cmath>

namespace vantage::optimise {
namespace {

constexpr double kSuccessThreshold = 0.44;
constexpr double kMinSigma = 1e-300, kMaxSigma = 1e6;  // keep samples finite where every step fails, or succeeds

}  // namespace

std::shared_ptr<const Shape> Shape::identity(std::size_t dimension) {
  const auto n = static_cast<Eigen::Index>(dimension);
  return std::make_shared<const Shape>(Shape{Eigen::MatrixXd::Identity(n, n), Eigen::VectorXd::Zero(n)});
}

void StepStrategy::adapt_sigma(bool succeeded) {
  const double rate = kTargetSuccess / (2 + kTargetSuccess);
  const double damping = 1 + static_cast<double>(shape->path.size()) / 2;
  success = (1 - rate) * success + (succeeded ? rate : 0.0);
  sigma *= std::exp((success - kTargetSuccess) / (damping * (1 - kTargetSuccess)));
  sigma = std::clamp(sigma, kMinSigma, kMaxSigma);
}

void StepStrategy::adapt_shape(const Eigen::VectorXd& step) {
  const double n = static_cast<double>(step.size()), c_c = 2 / (n + 2), c_cov = 2 / (n * n + 6);
  Shape next = *shape;
  next.path *= 1 - c_c;
  double decay = 1 - c_cov;
  if (success < kSuccessThreshold) {
    next.path += std::sqrt(c_c * (2 - c_c)) * step;
  } else {
    decay += c_cov * c_c * (2 - c_c);
  }
  const bool sound = update_factor(next.factor, decay, c_cov, next.path) && next.factor.allFinite();
  shape =
      sound ? std::make_shared<const Shape>(std::move(next)) : Shape::identity(static_cast<std::size_t>(step.size()));
}

bool update_factor(Eigen::MatrixXd& factor, double decay, double gain, Eigen::VectorXd v) {
  const Eigen::Index n = factor.rows();
  const double scale = std::sqrt(decay);
  double b = 1;
  for (Eigen::Index j = 0; j < n; ++j) {
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
