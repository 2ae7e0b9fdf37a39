// SPDX-License-Identifier: Apache-2.0
#include "optimise/common.hpp"

#include <cmath>
#include <utility>

#include "vantage/error.hpp"

namespace vantage::optimise {
namespace {

constexpr std::size_t kMaxObjectives = 6;

[[noreturn]] void fail(const std::string& message) { throw Error(Errc::invalid_argument, message); }

OptimiserConfig with_population(OptimiserConfig config, std::size_t population) {
  if (config.population == 0) config.population = population;
  return config;
}

}  // namespace

Common::Common(std::string n, std::size_t d, std::size_t m, const OptimiserConfig& c, std::size_t population)
    : name(std::move(n)),
      dimension(d),
      objectives(m),
      config(with_population(c, population)),
      box(d, c.bounds),
      reference(c.reference.empty() ? std::vector<double>(m, 1.0) : c.reference),
      random(c.seed) {
  if (m < 1 || m > kMaxObjectives)
    fail(name + ": " + std::to_string(m) + " objectives; it takes 1 to " + std::to_string(kMaxObjectives));
  if (reference.size() != m)
    fail(name + ": the reference point has " + std::to_string(reference.size()) + " coordinates for " +
         std::to_string(m) + " objectives");
  for (const double r : reference)
    if (!std::isfinite(r)) fail(name + ": the reference point holds " + std::to_string(r) + "; it must be finite");
  if (config.population > kMaxPopulation)
    fail(name + ": a population of " + std::to_string(config.population) + " is above " +
         std::to_string(kMaxPopulation));
  if (!(config.sigma0 > 0) || !std::isfinite(config.sigma0))
    fail(name + ": sigma0 is " + std::to_string(config.sigma0) + ", it must be positive");
  if (!(config.x_tolerance >= 0) || !(config.stagnation_tolerance >= 0) || !(config.cma.f_tolerance >= 0))
    fail(name + ": tolerances must not be negative");
  for (const auto& x : config.start) box.require_inside(x);
}

void Common::begin_ask(std::size_t count) {
  points_.resize(count * dimension);
  asked_ = count;
}

void Common::require_not_asked(const char* what) const {
  if (asked_ != 0) fail(name + ": " + what + "() between ask() and tell(); tell first");
}

void Common::require_point(const char* what, std::size_t index) const {
  if (asked_ == 0) fail(name + ": " + what + "() needs points from ask() first");
  if (index >= asked_)
    fail(name + ": point " + std::to_string(index) + " of " + std::to_string(asked_) + " does not exist");
}

void Common::require_coordinates(std::span<const std::size_t> coordinates) const {
  for (const std::size_t c : coordinates)
    if (c >= dimension)
      fail(name + ": coordinate " + std::to_string(c) + " of " + std::to_string(dimension) + " does not exist");
}

void Common::take(std::span<const double> values) {
  if (asked_ == 0) fail(name + ": tell() needs points from ask() first");
  if (values.size() != asked_ * objectives)
    fail(name + ": " + std::to_string(values.size()) + " values for " + std::to_string(asked_) + " points of " +
         std::to_string(objectives) + " objectives; give all objectives of each");
  evaluations += asked_;
  asked_ = 0;
}

void Common::require_reassessable(std::span<const double> values, std::size_t points) const {
  require_not_asked("reassess");
  if (values.size() != points * objectives)
    fail(name + ": " + std::to_string(values.size()) + " values for a population of " + std::to_string(points) +
         " points of " + std::to_string(objectives) + " objectives; give all objectives of each");
}

void Common::judge(StopReason own, std::size_t iterations, const std::function<double()>& hypervolume) {
  const StopReason rule = rules_.judge(config, evaluations, iterations, hypervolume);
  reason_ = own != StopReason::running ? own : rule;
}

void Common::save(StateWriter& w) const {
  w.put(std::uint64_t{dimension});
  w.put(std::uint64_t{objectives});
  w.put(std::uint64_t{config.population});
  w.put(config.sigma0);
  w.put(box.lower());
  w.put(box.upper());
  w.put(reference);
  w.put(random.seed());
  w.put(random.block());
  w.put(std::uint64_t{evaluations});
  rules_.save(w);
}

void Common::load(StateReader& r) {
  r.expect(std::uint64_t{dimension}, "dimension");
  r.expect(std::uint64_t{objectives}, "number of objectives");
  r.expect(std::uint64_t{config.population}, "population");
  r.expect(config.sigma0, "sigma0");
  r.expect(box.lower(), "lower bound");
  r.expect(box.upper(), "upper bound");
  r.expect(reference, "reference");
  const std::uint64_t seed = r.integer();
  random.seek(seed, r.integer());
  evaluations = r.size(std::size_t{1} << 62);
  rules_.load(r);
}

}  // namespace vantage::optimise
