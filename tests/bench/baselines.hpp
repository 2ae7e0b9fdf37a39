// SPDX-License-Identifier: Apache-2.0
// Baselines for the library's optimisers behind the same interface: NSGA-II and random search. Both need bounds.
#pragma once

#include <memory>
#include <string>

#include "optimise/mo_common.hpp"

namespace vantage::bench {

enum class Algorithm { cma_es, mo_cma_es, nsga2, random_search };
std::string to_string(Algorithm algorithm);
Algorithm algorithm_from_string(const std::string& name);  // throws Error invalid_argument
std::unique_ptr<Optimiser> make_optimiser(Algorithm algorithm, std::size_t dimension, std::size_t objectives,
                                          const OptimiserConfig& config);

class Baseline : public Optimiser {
 public:
  Baseline(std::string name, std::size_t dimension, std::size_t objectives, const OptimiserConfig& config);

  std::size_t dimension() const noexcept final { return common_.dimension; }
  std::size_t objectives() const noexcept final { return common_.objectives; }
  std::span<const double> ask() final;
  void replace(std::size_t index, std::span<const double> x) final;
  std::span<const double> resample(std::size_t index, std::span<const std::size_t> coordinates) final;
  void tell(std::span<const double> values) final;
  void reassess(std::span<const double> values) final;
  StopReason stop_reason() const noexcept final { return common_.stop_reason(); }
  std::vector<ParetoPoint> front() const final { return optimise::front_of(optimise::pointers(members_)); }
  std::vector<ParetoPoint> population() const final;
  double hypervolume() const final { return common_.hypervolume(members_); }
  std::size_t evaluations() const noexcept final { return common_.evaluations; }
  std::size_t iterations() const noexcept final { return common_.iterations(); }
  void save(std::ostream& out) const final;
  void load(std::istream& in) final;

 protected:
  // Makes one more point, in the user's coordinates, once there is a population.
  virtual std::vector<double> make_point() = 0;
  // Marks those of members and offspring together that stay in the population.
  virtual std::vector<char> choose(std::span<const double> fitness) const = 0;
  virtual void before_offspring() {}

  optimise::MoCommon common_;
  std::vector<optimise::Solution> members_;
};

// Deb, Pratap, Agarwal, Meyarivan: A Fast and Elitist Multiobjective Genetic Algorithm: NSGA-II, 2002.
class Nsga2 final : public Baseline {
 public:
  Nsga2(std::size_t dimension, std::size_t objectives, const OptimiserConfig& config)
      : Baseline("NSGA-II", dimension, objectives, config) {}

 private:
  std::vector<double> make_point() override;
  std::vector<char> choose(std::span<const double> fitness) const override;
  void before_offspring() override;
  std::size_t tournament();

  std::vector<std::size_t> rank_;
  std::vector<double> crowding_;
};

// Uniform points, of which it keeps those that MO-CMA-ES would keep, by rank and hypervolume.
class RandomSearch final : public Baseline {
 public:
  RandomSearch(std::size_t dimension, std::size_t objectives, const OptimiserConfig& config)
      : Baseline("random search", dimension, objectives, config) {}

 private:
  std::vector<double> make_point() override { return common_.random_point(); }
  std::vector<char> choose(std::span<const double> fitness) const override {
    return optimise::select(fitness, common_.reference, common_.config.population);
  }
};

}  // namespace vantage::bench
