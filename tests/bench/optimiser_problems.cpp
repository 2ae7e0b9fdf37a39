// SPDX-License-Identifier: Apache-2.0
#include "optimiser_problems.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "optimise/normal_stream.hpp"
#include "survey_problem.hpp"

namespace vantage::bench {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using std::numbers::pi;

MatrixXd rotation(std::size_t n, optimise::NormalStream& random) {
  const auto size = static_cast<Eigen::Index>(n);
  MatrixXd a(size, size);
  random.fill_normal({a.data(), n * n});
  // Gram–Schmidt with positive diagonal: uniform over the orthogonal group.
  const Eigen::HouseholderQR<MatrixXd> qr(a);
  MatrixXd q = qr.householderQ();
  for (Eigen::Index j = 0; j < size; ++j)
    if (qr.matrixQR()(j, j) < 0) q.col(j) *= -1;
  return q;
}

VectorXd as_vector(std::span<const double> x) {
  return Eigen::Map<const VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
}

double mean_tail(std::span<const double> x) {
  double sum = 0;
  for (std::size_t i = 1; i < x.size(); ++i) sum += x[i];
  return sum / static_cast<double>(x.size() - 1);
}

void zdt(int which, std::span<const double> x, std::span<double> f) {
  const double n = static_cast<double>(x.size());
  f[0] = x[0];
  double g = 1 + 9 * mean_tail(x);
  if (which == 4) {
    g = 1 + 10 * (n - 1);
    for (std::size_t i = 1; i < x.size(); ++i) g += x[i] * x[i] - 10 * std::cos(4 * pi * x[i]);
  } else if (which == 6) {
    f[0] = 1 - std::exp(-4 * x[0]) * std::pow(std::sin(6 * pi * x[0]), 6);
    g = 1 + 9 * std::pow(mean_tail(x), 0.25);
  }
  const double ratio = f[0] / g;
  f[1] = which == 2 || which == 6 ? g * (1 - ratio * ratio) : g * (1 - std::sqrt(ratio));
  if (which == 3) f[1] -= f[0] * std::sin(10 * pi * f[0]);
}

// y[i]² a^{2i/(n−1)} or the cigar's axes, around `centre`.
double ellipsoid(const VectorXd& y, double centre) {
  const double a = 1000, n = static_cast<double>(y.size());
  double sum = 0;
  for (Eigen::Index i = 0; i < y.size(); ++i)
    sum += std::pow(a, 2 * static_cast<double>(i) / (n - 1)) * (y[i] - centre) * (y[i] - centre);
  return sum / (a * a * n);
}
double cigar_tablet(const VectorXd& y, double centre) {
  const double a = 1000;
  double sum = 0;
  for (Eigen::Index i = 0; i < y.size(); ++i) {
    const double weight = i == 0 ? 1 : i + 1 == y.size() ? a * a : a;
    sum += weight * (y[i] - centre) * (y[i] - centre);
  }
  return sum / (a * a * static_cast<double>(y.size()));
}

void ihr(int which, const MatrixXd& o, std::span<const double> x, std::span<double> f) {
  const VectorXd y = o * as_vector(x);
  const double n = static_cast<double>(x.size()), limit = 1 / o.row(0).cwiseAbs().maxCoeff();
  double g = which == 4 ? 1 + 10 * (n - 1) : 0;
  for (Eigen::Index i = 1; i < y.size(); ++i) {
    g += which == 4 ? y[i] * y[i] - 10 * std::cos(4 * pi * y[i]) : y[i] * y[i] / (std::abs(y[i]) + 0.1);
  }
  if (which != 4) g = 1 + 9 * g / (n - 1);
  const double h = 1 / (1 + std::exp(-y[0] / std::sqrt(n)));
  f[0] = std::abs(y[0]);
  const double shape = which == 2 ? 1 - (y[0] / g) * (y[0] / g) : 1 - std::sqrt(h / g);
  f[1] = g * (std::abs(y[0]) <= limit ? shape : 1 + std::abs(y[0]));
}

void dtlz2(std::span<const double> x, std::span<double> f) {
  const std::size_t m = f.size();
  double g = 0;
  for (std::size_t i = m - 1; i < x.size(); ++i) g += (x[i] - 0.5) * (x[i] - 0.5);
  for (std::size_t j = 0; j < m; ++j) {
    f[j] = 1 + g;
    for (std::size_t i = 0; i + 1 < m - j; ++i) f[j] *= std::cos(x[i] * pi / 2);
    if (j > 0) f[j] *= std::sin(x[m - 1 - j] * pi / 2);
  }
}

// n/2 stations on the unit square. Six discs stand on it: they block sight, and a station inside one sees nothing. The
// first objective is the share of a 24 × 24 grid of free targets that no station sees within 0.35; the second is the
// length of the walk that visits the stations from (0.5, 0.05), always to the nearest next, as a share of what
// could be needed at most.
void station(std::span<const double> x, std::span<double> f) {
  struct Disc {
    double x, y, r;
  };
  static constexpr std::array<Disc, 6> kDiscs = {{{0.22, 0.25, 0.09},
                                                  {0.55, 0.18, 0.07},
                                                  {0.82, 0.35, 0.1},
                                                  {0.35, 0.6, 0.11},
                                                  {0.68, 0.66, 0.08},
                                                  {0.2, 0.86, 0.06}}};
  constexpr int kGrid = 24;
  constexpr double kRange = 0.35;
  const auto in_disc = [](double px, double py) {
    return std::any_of(kDiscs.begin(), kDiscs.end(),
                       [&](const Disc& d) { return std::hypot(px - d.x, py - d.y) < d.r; });
  };
  const auto blocked = [](double ax, double ay, double bx, double by) {
    const double dx = bx - ax, dy = by - ay, squared = dx * dx + dy * dy;
    return std::any_of(kDiscs.begin(), kDiscs.end(), [&](const Disc& d) {
      const double s = squared == 0 ? 0 : std::clamp(((d.x - ax) * dx + (d.y - ay) * dy) / squared, 0.0, 1.0);
      const double ex = ax + s * dx - d.x, ey = ay + s * dy - d.y;
      return ex * ex + ey * ey < d.r * d.r;
    });
  };
  const std::size_t stations = x.size() / 2;
  std::vector<char> works(stations);
  for (std::size_t s = 0; s < stations; ++s) works[s] = !in_disc(x[2 * s], x[2 * s + 1]);
  int targets = 0, seen = 0;
  for (int i = 0; i < kGrid; ++i) {
    for (int j = 0; j < kGrid; ++j) {
      const double px = (i + 0.5) / kGrid, py = (j + 0.5) / kGrid;
      if (in_disc(px, py)) continue;
      ++targets;
      for (std::size_t s = 0; s < stations; ++s) {
        if (!works[s] || std::hypot(px - x[2 * s], py - x[2 * s + 1]) > kRange) continue;
        if (blocked(x[2 * s], x[2 * s + 1], px, py)) continue;
        ++seen;
        break;
      }
    }
  }
  std::vector<char> visited(stations, 0);
  double px = 0.5, py = 0.05, walk = 0;
  for (std::size_t step = 0; step < stations; ++step) {
    std::size_t nearest = 0;
    double distance = 1e9;
    for (std::size_t s = 0; s < stations; ++s) {
      const double d = std::hypot(x[2 * s] - px, x[2 * s + 1] - py);
      if (!visited[s] && d < distance) {
        distance = d;
        nearest = s;
      }
    }
    visited[nearest] = 1;
    walk += distance;
    px = x[2 * nearest];
    py = x[2 * nearest + 1];
  }
  f[0] = 1 - static_cast<double>(seen) / targets;
  f[1] = walk / (1 + std::sqrt(2.0 * static_cast<double>(stations)));
}

}  // namespace

MoProblem mo_problem(const std::string& name, std::size_t n, std::uint64_t seed) {
  optimise::NormalStream random(seed);
  const MatrixXd o1 = rotation(n, random), o2 = rotation(n, random);
  const auto family = name.substr(0, name.size() - 1);
  const int which = name.empty() ? 0 : name.back() - '0';
  MoProblem p{name, n, 2, Bounds::uniform(n, 0, 1), {}};
  if (family == "ZDT") {
    if (which == 4) {
      p.bounds = Bounds::uniform(n, -5, 5);
      p.bounds.lower[0] = 0;
      p.bounds.upper[0] = 1;
    }
    p.evaluate = [which](auto x, auto f) { zdt(which, x, f); };
  } else if (family == "IHR") {
    p.bounds = which == 4 ? Bounds::uniform(n, -5, 5) : Bounds::uniform(n, -1, 1);
    p.evaluate = [which, o1](auto x, auto f) { ihr(which, o1, x, f); };
  } else if (family == "ELLI" || family == "CIGTAB") {
    p.bounds = Bounds::uniform(n, -10, 10);
    const auto quadratic = family == "ELLI" ? ellipsoid : cigar_tablet;
    p.evaluate = [which, quadratic, o1, o2](auto x, auto f) {
      const VectorXd y = o1 * as_vector(x);
      f[0] = quadratic(y, 0);
      f[1] = quadratic(which == 1 ? y : o2 * as_vector(x), 2);
    };
  } else if (name == "DTLZ2") {
    p.objectives = 3;
    p.evaluate = dtlz2;
  } else if (name == "STATION") {
    p.evaluate = station;
  } else if (name == "WALLS" || name == "YARD") {
    return survey_problem(name, n);
  } else {
    throw std::invalid_argument("unknown problem " + name);
  }
  return p;
}

std::function<double(std::span<const double>)> so_problem(const std::string& name, std::size_t n, std::uint64_t seed) {
  if (name == "sphere") {
    return [](std::span<const double> x) { return as_vector(x).squaredNorm(); };
  }
  if (name == "ellirot") {
    optimise::NormalStream random(seed);
    const MatrixXd o = rotation(n, random);
    return [o](std::span<const double> x) {
      const VectorXd y = o * as_vector(x);
      double sum = 0;
      for (Eigen::Index i = 0; i < y.size(); ++i)
        sum += std::pow(1e6, static_cast<double>(i) / static_cast<double>(y.size() - 1)) * y[i] * y[i];
      return sum;
    };
  }
  if (name == "rosen") {
    return [](std::span<const double> x) {
      double sum = 0;
      for (std::size_t i = 0; i + 1 < x.size(); ++i) {
        const double a = x[i + 1] - x[i] * x[i], b = 1 - x[i];
        sum += 100 * a * a + b * b;
      }
      return sum;
    };
  }
  throw std::invalid_argument("unknown problem " + name);
}

}  // namespace vantage::bench
