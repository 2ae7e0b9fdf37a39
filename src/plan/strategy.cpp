// SPDX-License-Identifier: Apache-2.0
#include "plan/strategy.hpp"

#include <algorithm>
#include <utility>

namespace vantage {
namespace {

class SingleObjective final : public Strategy {
 public:
  SingleObjective(std::size_t dimension, const CmaEsConfig& config) : optimiser_(dimension, config) {}
  std::span<const double> ask() override { return optimiser_.ask(); }
  std::span<const double> resample(std::size_t index, std::span<const std::size_t> coordinates) override {
    return optimiser_.resample(index, coordinates);
  }
  void tell(std::span<const double> values) override { optimiser_.tell(values); }
  std::vector<ParetoPoint> front() const override {
    if (optimiser_.best().x.empty()) return {};
    return {optimiser_.best()};
  }
  double hypervolume() const override {
    return optimiser_.best().f.empty() ? 0 : std::max(0.0, 1 - optimiser_.best().f[0]);
  }
  std::size_t evaluations() const override { return optimiser_.evaluations(); }
  StopReason stop_reason() const override { return optimiser_.stop_reason(); }
  void save(std::ostream& out) const override { optimiser_.save(out); }
  void load(std::istream& in) override { optimiser_.load(in); }

 private:
  CmaEs optimiser_;
};

class MultiObjective final : public Strategy {
 public:
  explicit MultiObjective(std::unique_ptr<MultiObjectiveOptimiser> optimiser) : optimiser_(std::move(optimiser)) {}
  std::span<const double> ask() override { return optimiser_->ask(); }
  std::span<const double> resample(std::size_t index, std::span<const std::size_t> coordinates) override {
    return optimiser_->resample(index, coordinates);
  }
  void tell(std::span<const double> values) override { optimiser_->tell(values); }
  std::vector<ParetoPoint> front() const override { return optimiser_->front(); }
  double hypervolume() const override { return optimiser_->hypervolume(); }
  std::size_t evaluations() const override { return optimiser_->evaluations(); }
  StopReason stop_reason() const override { return optimiser_->stop_reason(); }
  void save(std::ostream& out) const override { optimiser_->save(out); }
  void load(std::istream& in) override { optimiser_->load(in); }

 private:
  std::unique_ptr<MultiObjectiveOptimiser> optimiser_;
};

constexpr std::size_t kRestarts = 1'000'000;  // enough to spend any budget
// When to restart: less is to be gained than a sample's standard error, or stations move by less than 1/250 of the
// search area.
constexpr double kCoverageTolerance = 1e-3, kStepTolerance = 0.02;

}  // namespace

std::size_t population_of(const PlanConfig& config) {
  if (config.population > 0) return config.population;
  if (config.fitness) return 20;
  return has_one_objective(config) ? 10 : 100;
}

std::unique_ptr<Strategy> make_strategy(const DecisionSpace& space, const PlanConfig& config, std::size_t batch) {
  // The space outlives the strategy.
  const auto in_use = [&space](std::span<const double> x) { return space.placed_count(x); };
  if (has_one_objective(config)) {
    CmaEsConfig cma{.population = population_of(config),
                    .sigma0 = config.sigma0,
                    .bounds = space.bounds(),
                    .restarts = kRestarts,
                    .f_tolerance = kCoverageTolerance,
                    .x_tolerance = kStepTolerance,
                    .seed = config.seed};
    cma.blocks = space.blocks();
    if (space.minimises_stations()) cma.blocks_in_use = in_use;
    if (!config.start.empty()) cma.start = space.encode(config.start);
    return std::make_unique<SingleObjective>(space.dimension(), cma);
  }
  MoCmaEsConfig mo{.scheme = config.scheme,
                   .population = population_of(config),
                   .batch = batch,
                   .sigma0 = config.sigma0,
                   .blocks = space.blocks(),
                   .bounds = space.bounds(),
                   .restarts = kRestarts,
                   .seed = config.seed};
  if (space.minimises_stations()) mo.blocks_in_use = in_use;
  if (!config.start.empty()) mo.start = space.encode_each(config.start);
  if (mo.start.size() > mo.population) mo.start.resize(mo.population);
  return std::make_unique<MultiObjective>(make_optimiser(config.algorithm, space.dimension(), space.objectives(), mo));
}

}  // namespace vantage
