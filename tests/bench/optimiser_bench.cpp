// SPDX-License-Identifier: Apache-2.0
// The optimisers beside other libraries on reference problems: hypervolume after so many evaluations, evaluations to a
// target, and the optimiser's own time. docs/evidence/optimisers.md explains the tables.
#include <tbb/parallel_for.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "bench/baselines.hpp"
#include "optimise/normal_stream.hpp"
#include "optimiser_problems.hpp"
#include "survey_problem.hpp"
#include "vantage/optimiser.hpp"

namespace vantage::bench {
namespace {

using Scheme = MoScheme;

constexpr int kRedraws = 8;  // of stations in holes, as PlanConfig has it

// A line of optimiser_references.csv.
struct Reference {
  std::string kind, problem;
  std::size_t dimension = 0;
  double target = 0;
  std::size_t evaluations = 0;
  std::string library;
  double mean = 0, sd = 0;
};

std::vector<Reference> read_references(const std::string& path) {
  std::ifstream in(path);
  if (!in) throw std::runtime_error("cannot read " + path);
  std::vector<Reference> result;
  bool header = true;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with('#') || std::exchange(header, header && line.starts_with('#'))) continue;
    std::istringstream fields(line);
    std::string field[8];
    for (std::string& f : field) std::getline(fields, f, ',');
    const auto number = [](const std::string& s) { return s.empty() ? 0.0 : std::stod(s); };
    result.push_back({field[0], field[1], std::stoul(field[2]), number(field[3]), std::stoul(field[4]), field[5],
                      number(field[6]), number(field[7])});
  }
  return result;
}

struct Options {
  std::size_t seeds = 11, first_seed = 1, evaluations = 50000, batch = 1;
  std::vector<std::string> problems, parts;
  std::string scheme, algorithm = "mo_cma_es", references = VANTAGE_OPTIMISER_REFERENCES;
  std::size_t survey_population = 20;
  bool blocks = true;
  OptimiserConfig search{.population = 100};

  bool wants(const std::string& part, const std::string& problem) const {
    const auto has = [](const auto& list, const std::string& name) {
      return list.empty() || std::ranges::find(list, name) != list.end();
    };
    return has(parts, part) && has(problems, problem);
  }
};

struct Summary {
  double mean = 0, sd = 0, median = 0, lowest = 0;
};

Summary summarise(std::vector<double> values) {
  Summary s;
  for (const double v : values) s.mean += v / static_cast<double>(values.size());
  for (const double v : values) s.sd += (v - s.mean) * (v - s.mean);
  s.sd = values.size() > 1 ? std::sqrt(s.sd / static_cast<double>(values.size() - 1)) : 0;
  std::ranges::sort(values);
  s.median = values[values.size() / 2];
  s.lowest = values.front();
  return s;
}

// Runs every seed, on all cores.
template <typename Run>
Summary over_seeds(const Options& options, const Run& run) {
  std::vector<double> values(options.seeds);
  tbb::parallel_for(
      std::size_t{0}, options.seeds, [&](std::size_t i) { values[i] = run(options.first_seed + i); },
      tbb::simple_partitioner());
  return summarise(values);
}

// Draws stations in holes again, as the planner does.
void place(const MoProblem& problem, Optimiser& optimiser, std::span<const double> points) {
  const std::size_t n = problem.dimension;
  for (std::size_t k = 0; k < points.size() / n && problem.misplaced; ++k) {
    for (int redraw = 0; redraw < kRedraws; ++redraw) {
      const auto coordinates = problem.misplaced(points.subspan(k * n, n));
      if (coordinates.empty()) break;
      optimiser.resample(k, coordinates);
    }
  }
}

// One iteration, or a batch of it.
void step(const MoProblem& problem, Optimiser& optimiser, std::vector<double>& values) {
  const auto points = optimiser.ask();
  const std::size_t n = problem.dimension, m = problem.objectives;
  values.resize(points.size() / n * m);
  place(problem, optimiser, points);
  for (std::size_t k = 0; k < points.size() / n; ++k)
    problem.evaluate(points.subspan(k * n, n), std::span(values).subspan(k * m, m));
  optimiser.tell(values);
}

// Hypervolume at the end of an algorithm's run.
double run(const MoProblem& problem, const Options& options, Algorithm algorithm, OptimiserConfig config) {
  config.bounds = problem.bounds;
  if (options.blocks) config.blocks = problem.blocks, config.blocks_in_use = problem.blocks_in_use;
  const auto optimiser = make_optimiser(algorithm, problem.dimension, problem.objectives, config);
  std::vector<double> values;
  while (optimiser->stop_reason() == StopReason::running) step(problem, *optimiser, values);
  return optimiser->hypervolume();
}

// Hypervolume of the population against (reference, …) after so many evaluations.
double run_front(const MoProblem& problem, const Options& options, Scheme scheme, double reference,
                 std::size_t evaluations, std::uint64_t seed) {
  OptimiserConfig config = options.search;
  config.mo.scheme = scheme;
  config.mo.batch = options.batch;
  config.reference.assign(problem.objectives, reference);
  config.max_evaluations = evaluations;
  config.seed = seed;
  return run(problem, options, algorithm_from_string(options.algorithm), config);
}

Summary front_over_seeds(const std::string& name, std::size_t dimension, const Options& options, Scheme scheme,
                         double reference, std::size_t evaluations) {
  return over_seeds(options, [&](std::uint64_t seed) {
    return run_front(mo_problem(name, dimension, seed), options, scheme, reference, evaluations, seed);
  });
}

const char* yes_no(bool reached) { return reached ? "yes" : "NO"; }

// References of one problem follow each other; the better of them counts.
void print_fronts(const std::vector<Reference>& references, const Options& options) {
  bool first = true;
  std::size_t reached = 0, total = 0;
  for (auto r = references.begin(); r != references.end();) {
    auto end = r;
    auto better = r;
    for (; end != references.end() && end->kind == r->kind && end->problem == r->problem &&
           end->dimension == r->dimension;
         ++end)
      if (end->mean > better->mean) better = end;
    const auto group = std::exchange(r, end);
    if (group->kind != "hypervolume" || !options.wants("hypervolume", group->problem)) continue;
    if (std::exchange(first, false))
      std::printf(
          "\nHypervolume after %zu evaluations, mu = %zu, %zu seeds\n%-8s %3s %9s %-12s %11s %9s | %-23s %11s %9s | "
          "%11s %s\n",
          options.evaluations, options.search.population, options.seeds, "problem", "n", "reference", "scheme", "mean",
          "sd", "better of the others", "mean", "sd", "target", "reached");
    // NSGA-II's own figure spreads little: there the target is 1 % below it.
    const double target = better->library.starts_with("pagmo") ? 0.99 * better->mean : better->mean - better->sd;
    for (const Scheme scheme : {Scheme::steady_state, Scheme::generational}) {
      const std::string scheme_name = scheme == Scheme::steady_state ? "steady" : "generational";
      if (!options.scheme.empty() && options.scheme != scheme_name) continue;
      const Summary s =
          front_over_seeds(group->problem, group->dimension, options, scheme, group->target, options.evaluations);
      std::printf("%-8s %3zu %9g %-12s %11.6f %9.2g | %-23s %11.6f %9.2g | %11.6f %s\n", group->problem.c_str(),
                  group->dimension, group->target, scheme_name.c_str(), s.mean, s.sd, better->library.c_str(),
                  better->mean, better->sd, target, yes_no(s.mean >= target));
      std::fflush(stdout);
      if (scheme == Scheme::steady_state) reached += s.mean >= target, ++total;
    }
  }
  if (total > 0) std::printf("steady state reaches %zu of %zu\n", reached, total);
}

// The steady state after a fifth of the evaluations of a generational run.
void print_budget(const Options& options) {
  bool first = true;
  for (const auto& [name, n] : {std::pair{"ZDT1", 30}, std::pair{"ZDT2", 30}, std::pair{"ELLI1", 10}}) {
    if (!options.wants("budget", name)) continue;
    if (std::exchange(first, false))
      std::printf("\nSteady state after %zu evaluations beside generational after %zu\n%-8s %11s %12s %9s %s\n",
                  options.evaluations / 5, options.evaluations, "problem", "steady", "generational", "ratio",
                  "within 0.3 %");
    const auto dimension = static_cast<std::size_t>(n);
    const Summary steady =
        front_over_seeds(name, dimension, options, Scheme::steady_state, 1.1, options.evaluations / 5);
    const Summary whole = front_over_seeds(name, dimension, options, Scheme::generational, 1.1, options.evaluations);
    std::printf("%-8s %11.6f %12.6f %9.6f %s\n", name, steady.mean, whole.mean, steady.mean / whole.mean,
                yes_no(steady.mean >= 0.997 * whole.mean));
    std::fflush(stdout);
  }
}

// Evaluations to the target.
double run_single(const std::string& name, std::size_t n, double target, std::uint64_t seed) {
  const auto f = so_problem(name, n, seed);
  optimise::NormalStream random(seed);
  std::vector<double> start(n), values;
  for (double& v : start) v = 10 * random.uniform() - 5;
  CmaEs optimiser(
      n, {.sigma0 = 2, .start = {start}, .max_evaluations = 10000 * n, .seed = seed, .cma = {.target = target}});
  while (optimiser.stop_reason() == StopReason::running) {
    const auto points = optimiser.ask();
    values.clear();
    for (std::size_t k = 0; k < points.size(); k += n) values.push_back(f(points.subspan(k, n)));
    optimiser.tell(values);
  }
  // A local minimum (Rosenbrock's function has one) counts as never: the median says so.
  return optimiser.stop_reason() == StopReason::target_reached ? static_cast<double>(optimiser.evaluations())
                                                               : INFINITY;
}

// Hypervolume on the stand-in for planning after few evaluations, where guided parents and spread steps are to pay.
void print_station(const Options& options) {
  for (const std::string problem : {"STATION", "WALLS", "YARD"}) {
    if (!options.wants("station", problem)) continue;
    std::printf("\nHypervolume on %s against (1, 1), n = 16\n%-12s %14s %14s %14s %14s\n", problem.c_str(),
                "evaluations", "mean", "sd", "lowest", "scheme");
    for (const Scheme scheme : {Scheme::steady_state, Scheme::generational}) {
      const std::string scheme_name = scheme == Scheme::steady_state ? "steady" : "generational";
      if (!options.scheme.empty() && options.scheme != scheme_name) continue;
      for (const std::size_t share : {50, 10, 5, 1}) {
        const std::size_t evaluations = options.evaluations / share;
        const Summary s = front_over_seeds(problem, 16, options, scheme, 1, evaluations);
        std::printf("%-12zu %14.4f %14.2g %14.4f %14s\n", evaluations, s.mean, s.sd, s.lowest, scheme_name.c_str());
        std::fflush(stdout);
      }
    }
  }
}

// The optimiser's own milliseconds for each candidate, in the steady state.
double own_ms(std::size_t stations, const Options& options, std::size_t full_covariance) {
  const std::size_t n = 2 * stations, batch = 50;
  OptimiserConfig config = options.search;
  config.bounds = Bounds::uniform(n, 0, 1);
  config.mo.batch = batch;
  config.mo.full_covariance = full_covariance;
  for (std::size_t i = 0; i < n; i += 2) config.blocks.push_back({i, i + 1});
  MoCmaEs optimiser(n, 2, config);
  std::chrono::steady_clock::duration own{};
  std::size_t candidates = 0;
  std::vector<double> values;
  while (candidates < config.population + 4 * batch) {
    const auto begin = std::chrono::steady_clock::now();
    const auto points = optimiser.ask();
    const auto asked = std::chrono::steady_clock::now();
    values.clear();
    for (std::size_t k = 0; k < points.size(); k += n) {
      double low = 0, high = 0;
      for (const double x : points.subspan(k, n)) low += x * x, high += (1 - x) * (1 - x);
      values.insert(values.end(), {low / static_cast<double>(n), high / static_cast<double>(n)});
    }
    const auto evaluated = std::chrono::steady_clock::now();
    optimiser.tell(values);
    if (candidates >= config.population) own += (asked - begin) + (std::chrono::steady_clock::now() - evaluated);
    candidates += points.size() / n;
  }
  return std::chrono::duration<double, std::milli>(own).count() / static_cast<double>(4 * batch);
}

// One covariance for all coordinates of a network, and one for each of its stations.
void print_covariances(const Options& options) {
  if (!options.wants("covariances", "YARD")) return;
  constexpr std::size_t all = std::numeric_limits<std::size_t>::max();
  std::printf(
      "\nHypervolume on YARD after %zu evaluations, and ms a candidate of the optimiser's own\n%-9s %17s %17s %17s "
      "%17s\n",
      options.evaluations, "stations", "one covariance", "a station each", "ms", "ms");
  for (const std::size_t stations : {8, 16, 32, 64, 256, 1024}) {
    std::printf("%-9zu", stations);
    for (const std::size_t full : {all, std::size_t{0}}) {
      if (stations > 64) {
        std::printf(" %17s", "");
        continue;
      }
      Options set = options;
      set.search.mo.full_covariance = full;
      const Summary s = front_over_seeds("YARD", 2 * stations, set, Scheme::steady_state, 1, options.evaluations);
      std::printf(" %8.4f %8.4f", s.mean, s.lowest);
    }
    std::printf(" %17.3f %17.3f\n", own_ms(stations, options, all), own_ms(stations, options, 0));
    std::fflush(stdout);
  }
}

// One objective, CMA-ES set as the planner sets it.
double run_survey(const MoProblem& problem, const Options& options, std::uint64_t seed) {
  return run(problem, options, Algorithm::cma_es,
             {.population = options.survey_population,
              .restarts = 1000,
              .x_tolerance = 0.02,
              .max_evaluations = options.evaluations,
              .seed = seed,
              .cma = {.f_tolerance = 1e-3}});
}

void print_survey(const Options& options) {
  bool first = true;
  for (const auto& [name, good] : {std::pair{"FITNESS", 0.93}, std::pair{"COVERAGE", 0.887}}) {
    if (!options.wants("survey", name)) continue;
    if (std::exchange(first, false))
      std::printf(
          "\nCMA-ES on planning with one objective, %zu evaluations, %zu seeds\n%-10s %10s %10s %10s %10s %10s\n",
          options.evaluations, options.seeds, "problem", "mean", "sd", "lowest", "good from", "share");
    const MoProblem problem = std::string(name) == "FITNESS" ? fitness_problem() : coverage_problem("WALLS", 8);
    std::vector<double> values(options.seeds);
    const Summary s = over_seeds(options, [&](std::uint64_t seed) {
      return values[seed - options.first_seed] = run_survey(problem, options, seed);
    });
    const auto reached = std::ranges::count_if(values, [&, g = good](double v) { return v >= g; });
    std::printf("%-10s %10.4f %10.2g %10.4f %10g %10.3f\n", name, s.mean, s.sd, s.lowest, good,
                static_cast<double>(reached) / static_cast<double>(options.seeds));
    std::fflush(stdout);
  }
}

void print_single(const std::vector<Reference>& references, const Options& options) {
  bool first = true;
  for (const Reference& r : references) {
    if (r.kind != "evaluations" || !options.wants("cma-es", r.problem)) continue;
    if (std::exchange(first, false))
      std::printf("\nCMA-ES: median evaluations to the target, %zu seeds\n%-8s %3s %8s %8s | %-9s %8s %7s %s\n",
                  options.seeds, "problem", "n", "target", "median", "library", "median", "ratio", "within 5 %");
    const Summary s =
        over_seeds(options, [&](std::uint64_t seed) { return run_single(r.problem, r.dimension, r.target, seed); });
    const double ratio = s.median / static_cast<double>(r.evaluations);
    std::printf("%-8s %3zu %8g %8.0f | %-9s %8zu %7.3f %s\n", r.problem.c_str(), r.dimension, r.target, s.median,
                r.library.c_str(), r.evaluations, ratio, yes_no(ratio <= 1.05));
    std::fflush(stdout);
  }
}

// Time between ask() and tell(), and in them, on one thread; the objectives themselves are not counted.
void print_overhead(const Options& options) {
  if (!options.wants("overhead", "DTLZ2")) return;
  std::printf("\nOwn time a generation (mu evaluations) at mu = 250, n = 41, 3 objectives, one core\n%-22s %9s %9s\n",
              "scheme", "median ms", "worst ms");
  const std::size_t n = 41, mu = 250;
  const MoProblem problem = mo_problem("DTLZ2", n, 1);
  for (const auto& [label, scheme, batch] :
       {std::tuple{"generational", Scheme::generational, std::size_t{1}},
        std::tuple{"steady state, batch 250", Scheme::steady_state, mu},
        std::tuple{"steady state, batch 25", Scheme::steady_state, mu / 10},
        std::tuple{"steady state, batch 1", Scheme::steady_state, std::size_t{1}}}) {
    OptimiserConfig config = options.search;
    config.mo.scheme = scheme;
    config.mo.batch = batch;
    config.population = mu;
    config.bounds = problem.bounds;
    config.reference.assign(3, 11.0);
    MoCmaEs optimiser(n, 3, config);
    std::vector<double> values, times;
    double own = 0;
    std::size_t iteration = 0;
    while (iteration < 60) {
      const auto begin = std::chrono::steady_clock::now();
      const auto points = optimiser.ask();
      const auto asked = std::chrono::steady_clock::now();
      const std::size_t count = points.size() / n;
      values.resize(count * 3);
      for (std::size_t k = 0; k < count; ++k)
        problem.evaluate(points.subspan(k * n, n), std::span(values).subspan(k * 3, 3));
      const auto evaluated = std::chrono::steady_clock::now();
      optimiser.tell(values);
      const auto told = std::chrono::steady_clock::now();
      own += std::chrono::duration<double, std::milli>((asked - begin) + (told - evaluated)).count();
      if (optimiser.iterations() == iteration) continue;
      iteration = optimiser.iterations();
      times.push_back(std::exchange(own, 0.0));
    }
    times.erase(times.begin());
    std::ranges::sort(times);
    std::printf("%-22s %9.3f %9.3f\n", label, times[times.size() / 2], times.back());
  }
}

}  // namespace
}  // namespace vantage::bench

int main(int argc, char** argv) {
  using namespace vantage::bench;
  Options options;
  CLI::App app{"Optimisers beside other libraries"};
  app.add_option("--seeds", options.seeds, "Runs of each problem")->check(CLI::Range(1, 1000));
  app.add_option("--first-seed", options.first_seed);
  app.add_option("--problem", options.problems, "Only these problems");
  app.add_option("--part", options.parts, "Only these tables")
      ->check(CLI::IsMember({"hypervolume", "budget", "station", "covariances", "survey", "cma-es", "overhead"}));
  app.add_option("--evaluations", options.evaluations, "Of each run");
  app.add_option("--scheme", options.scheme, "Only this one")->check(CLI::IsMember({"steady", "generational"}));
  app.add_option("--algorithm", options.algorithm);
  app.add_option("--population", options.search.population);
  app.add_option("--survey-population", options.survey_population, "Of CMA-ES on planning with one objective");
  app.add_option("--batch", options.batch, "Of the steady state");
  app.add_option("--sigma0", options.search.sigma0, "Share of the range");
  app.add_option("--guided", options.search.mo.guided);
  app.add_option("--spread", options.search.mo.spread);
  app.add_option("--recombined", options.search.mo.recombined);
  app.add_option("--swapped", options.search.mo.swapped);
  app.add_option("--full-covariance", options.search.mo.full_covariance, "Coordinates that have one for all");
  app.add_flag("!--no-blocks", options.blocks, "Do not tell which coordinates belong together");
  app.add_option("--references", options.references, "Figures of the other libraries");
  CLI11_PARSE(app, argc, argv);
  try {
    const auto references = read_references(options.references);
    print_fronts(references, options);
    print_budget(options);
    print_station(options);
    print_covariances(options);
    print_survey(options);
    print_single(references, options);
    print_overhead(options);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
}
