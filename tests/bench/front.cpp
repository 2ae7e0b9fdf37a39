// SPDX-License-Identifier: Apache-2.0
#include "front.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <span>
#include <utility>

#include "bench/baselines.hpp"
#include "core/text.hpp"
#include "map/chart.hpp"
#include "search/decision_space.hpp"
#include "site/placement_oracle.hpp"
#include "support/site_of.hpp"
#include "vantage/error.hpp"
#include "vantage/planner.hpp"

namespace vantage::bench {
namespace {

std::uint64_t number_of(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    throw Error(Errc::invalid_argument, "\"" + std::string(text) + "\" is no number");
  return value;
}

std::pair<std::uint64_t, std::uint64_t> range_of(const std::string& text) {
  const auto dots = text.find("..");
  if (dots == std::string::npos) return {number_of(text), number_of(text)};
  return {number_of(text.substr(0, dots)), number_of(text.substr(dots + 2))};
}

// A front at some time of a search.
struct Look {
  double seconds = 0;
  std::uint64_t evaluations = 0;
  std::vector<ParetoPoint> front = {};
  double searched = 0, exact = 0;  // hypervolumes
};

struct Curve {
  std::string sample;
  std::uint64_t seed = 0;
  std::vector<Look> looks;
  Look confirmed = {};  // what the search answers in the end
};

// Objectives by every ray, each network once.
class EveryRay {
 public:
  EveryRay(Simulator& simulator, const DecisionSpace& space, const SurveyProblem& problem)
      : simulator_(simulator), space_(space), problem_(problem) {}

  std::vector<double> objectives(const std::vector<ParetoPoint>& front) {
    std::vector<Network> networks;
    std::vector<const ParetoPoint*> fresh;
    for (const ParetoPoint& point : front) {
      if (known_.contains(point.x)) continue;
      networks.push_back(to_network(space_.decode(point.x)));
      fresh.push_back(&point);
    }
    const std::vector<NetworkCounts> counts = simulator_.evaluate_each(networks);
    for (std::size_t k = 0; k < fresh.size(); ++k) {
      const std::vector<PlacedStation> stations = space_.decode(fresh[k]->x);
      const MeasuredNetwork measured{.counts = counts[k],
                                     .stations = stations,
                                     .goal_density = simulator_.goal_density(),
                                     .voxels = simulator_.voxel_count(),
                                     .overlap = overlap_matrix(counts[k])};
      std::vector<double> values;
      for (const Objective& objective : problem_.objectives) values.push_back(objective.value(measured));
      known_[fresh[k]->x] = scaled_objectives(problem_, fresh[k]->x, values);
    }
    std::vector<double> all;
    for (const ParetoPoint& point : front) {
      const std::vector<double>& f = known_.at(point.x);
      all.insert(all.end(), f.begin(), f.end());
    }
    return all;
  }

 private:
  Simulator& simulator_;
  const DecisionSpace& space_;
  const SurveyProblem& problem_;
  std::map<std::vector<double>, std::vector<double>> known_;
};

double volume(const std::vector<double>& f, std::size_t objectives) {
  return hypervolume(f, objectives, std::vector<double>(objectives, 1.0));
}

std::vector<double> flat(const std::vector<ParetoPoint>& front) {
  std::vector<double> f;
  for (const ParetoPoint& point : front) f.insert(f.end(), point.f.begin(), point.f.end());
  return f;
}

constexpr std::array<Colour, 4> kColours{{style::kOrange, style::kBlue, {0.10, 0.50, 0.32}, {0.48, 0.25, 0.60}}};

void draw(const std::string& file, const FrontOptions& options, const std::vector<Curve>& curves) {
  constexpr double kWidth = 860, kHeight = 520;
  Canvas canvas(kWidth, kHeight);
  double low = 1, high = 0, first = 1e9, last = 0;
  for (const Curve& curve : curves)
    for (const auto& looks : {std::span(curve.looks), std::span(&curve.confirmed, 1)})
      for (const Look& look : looks) {
        low = std::min({low, look.exact, look.searched}), high = std::max({high, look.exact, look.searched});
        first = std::min(first, look.seconds), last = std::max(last, look.seconds);
      }
  const Axis x{.label = "Seconds of search", .low = first / 1.1, .high = last * 1.1, .logarithmic = true};
  const Axis y = axis_over("Hypervolume", low, high, 0, 1);
  const Chart chart(canvas, {86, 72, kWidth - 86 - 220, kHeight - 72 - 70}, x, y, "What the front is worth",
                    std::filesystem::path(options.site.scene).stem().string() + ", " + options.problem + ", " +
                        options.stations + " stations, seeds side by side");
  const auto ring = [&](Point middle, Colour colour) {
    canvas.disc(middle, 6, colour);
    canvas.disc(middle, 3.5, {1, 1, 1});
  };
  Point at{kWidth - 196, 96};
  for (std::size_t s = 0; s < options.samples.size(); ++s) {
    const Colour colour = kColours[s % kColours.size()];
    for (const Curve& curve : curves) {
      if (curve.sample != options.samples[s]) continue;
      std::vector<Point> searched, exact;
      for (const Look& look : curve.looks) {
        searched.push_back(chart.at(look.seconds, look.searched));
        exact.push_back(chart.at(look.seconds, look.exact));
      }
      canvas.path(searched, {.colour = colour, .width = 1, .dashes = {4, 4}});
      canvas.path(exact, {.colour = colour, .width = 2});
      for (const Point& p : exact) canvas.disc(p, 3, colour);
      ring(chart.at(curve.confirmed.seconds, curve.confirmed.exact), colour);
    }
    canvas.text(at, options.samples[s] + " voxels", {.size = 13.5, .bold = true, .colour = colour});
    at.y += 24;
  }
  at.y += 12;
  canvas.path(std::vector<Point>{at, {at.x + 26, at.y}}, {.colour = style::kInk, .width = 2});
  canvas.text({at.x + 34, at.y}, "by every ray", {.size = 12.5});
  at.y += 22;
  canvas.path(std::vector<Point>{at, {at.x + 26, at.y}}, {.colour = style::kInk, .width = 1, .dashes = {4, 4}});
  canvas.text({at.x + 34, at.y}, "as searched", {.size = 12.5});
  at.y += 22;
  ring({at.x + 13, at.y}, style::kInk);
  canvas.text({at.x + 34, at.y}, "confirmed", {.size = 12.5});
  canvas.save(file);
}

}  // namespace

void FrontOptions::add(CLI::App& command) {
  site.add(command);
  command.add_option("--problem", problem, "One of the method's problems")->capture_default_str();
  command.add_option("--number", stations, "Stations: N, or N..M where the number is searched")->capture_default_str();
  command.add_option("--algorithm", algorithm, "mo_cma_es, or a baseline: nsga2, random_search")->capture_default_str();
  command.add_option("--population", population, "Networks of the front")->capture_default_str();
  command.add_option("--iterations", iterations, "Of so many evaluations each")->capture_default_str();
  command.add_option("--batch", batch, "Offspring at once; 0: by the engine")->capture_default_str();
  command
      .add_option("--samples", samples,
                  "Voxels to search with, N/R where they are redrawn every R iterations; a curve each")
      ->delimiter(',')
      ->capture_default_str();
  command.add_option("--seeds", seeds, "A search of each sample with each")->delimiter(',')->capture_default_str();
  command.add_option("--device", devices, "GPUs to search on, counted from 0; the best one otherwise")->delimiter(',');
  command.add_option("--first", first_s, "Seconds after which the front is first looked at")->capture_default_str();
  command.add_option("--ratio", ratio, "Of the times of two looks")->capture_default_str();
  command.add_option("-o", picture, "Draw it: .png or .svg");
}

void run_front(const FrontOptions& options) {
  Site site = test::site_of(options.site.simulator(Scene::load(options.site.scene), options.devices));
  Simulator& simulator = site.simulator();
  const auto [fewest, most] = range_of(options.stations);
  const SurveyProblem problem = survey_problem(options.problem, fewest, most);
  const std::size_t objectives = problem.objectives.size();
  const Algorithm algorithm = algorithm_from_string(options.algorithm);
  const PlacementOracle oracle = make_placement_oracle(site);
  const DecisionSpace space(oracle, problem);
  EveryRay every_ray(simulator, space, problem);

  std::printf("sample,seed,what,seconds,evaluations,networks,undominated,searched,every_ray,difference\n");
  std::vector<Curve> curves;
  for (const std::uint64_t seed : options.seeds)
    for (const std::string& sample : options.samples) {
      const auto slash = sample.find('/');
      const std::uint64_t voxels = number_of(sample.substr(0, slash));
      const std::size_t renew = slash == std::string::npos ? 0 : number_of(sample.substr(slash + 1));
      PlanConfig search{.population = options.population, .iterations = options.iterations, .batch = options.batch};
      search.sample_voxels = std::min(voxels, simulator.voxel_count());
      search.renew_iterations = renew;
      search.seed = seed;
      search.optimiser = [algorithm](std::size_t dimension, std::size_t count, const OptimiserConfig& config) {
        return make_optimiser(algorithm, dimension, count, config);
      };
      Curve& curve = curves.emplace_back(Curve{sample, seed, {}});
      const Stopwatch watch;
      double next = options.first_s, searched = 0;
      const PlanResult result =
          plan(site, problem, search, {.report = [&](const PlanProgress& progress) {
                 if (progress.phase == "search") searched = watch.seconds();
                 if (progress.phase != "search" || watch.seconds() < next || progress.front.empty()) return;
                 curve.looks.push_back({.seconds = watch.seconds(),
                                        .evaluations = progress.evaluations,
                                        .front = {progress.front.begin(), progress.front.end()}});
                 next = watch.seconds() * options.ratio;
               }});
      const double seconds = watch.seconds();
      for (Look& look : curve.looks) {
        look.searched = volume(flat(look.front), objectives);
        look.exact = volume(every_ray.objectives(look.front), objectives);
        std::printf("%s,%llu,look,%.2f,%llu,%zu,,%.4f,%.4f,%.4f\n", sample.c_str(),
                    static_cast<unsigned long long>(seed), look.seconds,
                    static_cast<unsigned long long>(look.evaluations), look.front.size(), look.searched, look.exact,
                    look.searched - look.exact);
        std::fflush(stdout);
      }
      curve.confirmed = {.seconds = seconds,
                         .evaluations = result.evaluations,
                         .searched = result.hypervolume,
                         .exact = result.exact_hypervolume};
      const auto undominated = std::ranges::count(result.front, false, &PlanEntry::dominated);
      std::printf("%s,%llu,end of search,%.2f,,,,,,\n", sample.c_str(), static_cast<unsigned long long>(seed),
                  searched);
      std::printf("%s,%llu,confirmed,%.2f,%llu,%zu,%lld,%.4f,%.4f,%.4f\n", sample.c_str(),
                  static_cast<unsigned long long>(seed), seconds, static_cast<unsigned long long>(result.evaluations),
                  result.front.size(), static_cast<long long>(undominated), result.hypervolume,
                  result.exact_hypervolume, result.hypervolume - result.exact_hypervolume);
      std::fflush(stdout);
    }
  if (!options.picture.empty()) draw(options.picture, options, curves);
}

}  // namespace vantage::bench
