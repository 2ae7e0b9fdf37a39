// SPDX-License-Identifier: Apache-2.0
// Predicted registration errors, and figures of overlap, against the errors that an adjustment of simulated scans
// really has: over networks of a reference site, or of any other.
#include <spdlog/fmt/fmt.h>
#include <tbb/parallel_for.h>

#include <CLI/CLI.hpp>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <random>
#include <set>
#include <string>

#include "objective/registered_sample.hpp"
#include "simulated_adjustment.hpp"
#include "sites/site.hpp"
#include "vantage/candidates.hpp"
#include "vantage/error.hpp"
#include "vantage/export.hpp"
#include "vantage/measure.hpp"
#include "vantage/placement.hpp"
#include "vantage/registration.hpp"
#include "vantage/site.hpp"
#include "vantage/targets.hpp"

namespace vantage::bench {
namespace {

using Eigen::MatrixXd;

struct Options {
  std::string site = "office", csv;
  std::size_t stations = 6, pool = 18, networks = 30, trials = 20, points = 3000, samples = 0;
  std::uint64_t sample = std::numeric_limits<std::uint64_t>::max(), seed = 1;
  std::vector<double> calibration = {0, 0, 0};  // arc seconds, millimetres, millionths
  double step_deg = 0.25, user_size_m = 0.15, connected = 0.02;
  bool growing = false;
  std::vector<std::string> plans;  // tables of stations: networks that are given
};

std::vector<double> ranks(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> rank(values.size());
  for (std::size_t k = 0; k < order.size();) {
    std::size_t end = k;
    while (end < order.size() && values[order[end]] == values[order[k]]) ++end;
    for (std::size_t e = k; e < end; ++e) rank[order[e]] = 0.5 * static_cast<double>(k + end - 1);
    k = end;
  }
  return rank;
}

double spearman(const std::vector<double>& a, const std::vector<double>& b) {
  const std::vector<double> x = ranks(a), y = ranks(b);
  const double mean = 0.5 * (static_cast<double>(a.size()) - 1);
  double xy = 0, xx = 0, yy = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    xy += (x[k] - mean) * (y[k] - mean);
    xx += (x[k] - mean) * (x[k] - mean);
    yy += (y[k] - mean) * (y[k] - mean);
  }
  return xx > 0 && yy > 0 ? xy / std::sqrt(xx * yy) : 0;
}

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const double at = share * static_cast<double>(values.size() - 1);
  const auto low = static_cast<std::size_t>(at);
  const std::size_t high = std::min(low + 1, values.size() - 1);
  return values[low] + (values[high] - values[low]) * (at - static_cast<double>(low));
}

// Measures of overlap, of practice and of the method; more is better for each.
struct Figures {
  static constexpr std::array<const char*, 6> names{"lambda2",      "weakest_link", "weakest_share",
                                                    "mean_overlap", "min_overlap",  "clustering"};
  std::array<double, 6> values{};
};

Figures figures(const NetworkCounts& counts) {
  const OverlapMatrix overlap = overlap_matrix(counts);
  const std::size_t n = overlap.size();
  const auto size = static_cast<Eigen::Index>(n);
  MatrixXd laplacian = MatrixXd::Zero(size, size);
  OverlapMatrix shares(n);
  double sum = 0, least = 1;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j) {
      const double o = overlap(i, j);
      const auto a = static_cast<Eigen::Index>(i), b = static_cast<Eigen::Index>(j);
      laplacian(a, b) = laplacian(b, a) = -o;
      laplacian(a, a) += o;
      laplacian(b, b) += o;
      sum += o;
      least = std::min(least, o);
      const std::uint64_t smaller = std::min(counts.seen[i], counts.seen[j]);
      if (smaller > 0) shares.set(i, j, static_cast<double>(counts.shared_by(i, j)) / static_cast<double>(smaller));
    }
  return {{Eigen::SelfAdjointEigenSolver<MatrixXd>(laplacian).eigenvalues()(1),
           connectivity(overlap, 0).weakest_overlap, connectivity(shares, 0).weakest_overlap,
           2 * sum / static_cast<double>(n * (n - 1)), least, clustering_coefficient(overlap)}};
}

// Heads above places where a person can stand, spread over the site's rooms and grounds by their area.
std::vector<Vec3> draw_heads(const test::KnownSite& site, const Scene& scene, const Scanner& scanner, std::size_t many,
                             std::mt19937_64& random) {
  const ClashChecker clash(scene, {.radius_m = 0.4});
  std::vector<double> areas;
  for (const test::Place& p : site.places) areas.push_back((p.x1 - p.x0) * (p.y1 - p.y0));
  std::discrete_distribution<std::size_t> place(areas.begin(), areas.end());
  std::uniform_real_distribution<double> unit(0.02, 0.98);
  std::vector<Vec3> heads;
  for (int tries = 0; heads.size() < many && tries < 100'000; ++tries) {
    const test::Place& p = site.places[place(random)];
    const double u = unit(random), v = unit(random);
    const Vec3 ground = Vec3{p.x0 + (p.x1 - p.x0) * u, p.y0 + (p.y1 - p.y0) * v, p.z} + site.offset;
    if (site.at(ground).surface == test::Surface::floor && !clash.clashes(ground))
      heads.push_back(ground + Vec3{0, 0, scanner.height_m});
  }
  if (heads.size() < many) throw Error(Errc::invalid_argument, "the site has no room for so many stations");
  return heads;
}

// Heads over the ground that a person can reach from the entrance of any site.
std::vector<Vec3> draw_heads(Site& site, std::size_t many, std::mt19937_64& random) {
  constexpr std::size_t kPlaces = 2000;
  std::vector<PlacedStation> places = candidate_positions(site, kPlaces);
  std::shuffle(places.begin(), places.end(), random);
  if (places.size() < many) throw Error(Errc::invalid_argument, "the site has no room for so many stations");
  std::vector<Vec3> heads;
  for (std::size_t k = 0; k < many; ++k) heads.push_back(places[k].position);
  return heads;
}

// Overlaps of all pairs of scans, by the voxels that they have points in.
OverlapMatrix overlaps_of(const std::vector<ThinnedScan>& scans) {
  OverlapMatrix overlap(scans.size());
  std::vector<std::uint32_t> both;
  for (std::size_t i = 0; i < scans.size(); ++i)
    for (std::size_t j = i + 1; j < scans.size(); ++j) {
      const auto &a = scans[i].voxels, &b = scans[j].voxels;
      both.clear();
      std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
      overlap.set(i, j, static_cast<double>(both.size()) / static_cast<double>(a.size() + b.size() - both.size()));
    }
  return overlap;
}

bool connected(const OverlapMatrix& all, const std::vector<std::size_t>& picked, double least) {
  OverlapMatrix some(picked.size());
  for (std::size_t i = 0; i < picked.size(); ++i)
    for (std::size_t j = i + 1; j < picked.size(); ++j) some.set(i, j, all(picked[i], picked[j]));
  return connectivity(some, least).parts == 1;
}

// A third each: anywhere; in two clumps; in one clump with three elsewhere.
std::vector<std::size_t> draw_network(const std::vector<Vec3>& heads, std::size_t stations, std::size_t kind,
                                      std::mt19937_64& random) {
  std::vector<std::size_t> all(heads.size()), network;
  std::iota(all.begin(), all.end(), 0u);
  std::shuffle(all.begin(), all.end(), random);
  const auto take = [&](std::size_t k) {
    if (network.size() < stations && std::find(network.begin(), network.end(), k) == network.end())
      network.push_back(k);
  };
  const auto take_near = [&](std::size_t middle, std::size_t many) {
    std::vector<std::size_t> near = all;
    std::sort(near.begin(), near.end(), [&](std::size_t a, std::size_t b) {
      const Vec3 x = heads[a] - heads[middle], y = heads[b] - heads[middle];
      return dot(x, x) < dot(y, y);
    });
    near.resize(std::min(near.size(), many + 2));
    std::shuffle(near.begin(), near.end(), random);
    for (std::size_t k = 0; k < many && k < near.size(); ++k) take(near[k]);
  };
  if (kind % 3 == 1) {
    take_near(all[0], stations / 2);
    take_near(all[1], stations - stations / 2);
  }
  if (kind % 3 == 2) take_near(all[0], stations > 3 ? stations - 3 : 1);
  for (const std::size_t k : all) take(k);
  return network;
}

// Networks, as places in a pool of heads.
struct Pool {
  std::vector<Vec3> heads = {};
  std::vector<std::vector<std::size_t>> given = {};
};

Pool read_plans(const std::vector<std::string>& files) {
  Pool pool;
  for (const std::string& file : files) {
    std::vector<std::size_t>& network = pool.given.emplace_back();
    for (const StationRow& row : read_stations_csv(file)) {
      if (!row.position) throw Error(Errc::invalid_argument, file + ": a station without x, y and z");
      network.push_back(pool.heads.size());
      pool.heads.push_back(*row.position);
    }
  }
  return pool;
}

// Errors of samples relative to the prediction from every voxel, network by network.
class Samples {
 public:
  void add(Simulator& simulator, const Network& network, std::uint64_t voxels, std::size_t draws) {
    const auto counts = [&](std::uint64_t many, std::uint64_t from) {
      return simulator
          .evaluate_sampled({&network, 1}, {.voxels = many, .from = from, .registration = RegistrationModel{}})
          .front();
    };
    const std::uint64_t all = simulator.voxel_count();
    const double truth = registration_estimate(counts(all, 0), all).value;
    double squares = 0;
    std::vector<double> told;
    for (std::size_t k = 0; k < draws; ++k) {
      const Estimate e = registration_estimate(counts(voxels, voxels * k % all), all);
      squares += (e.value / truth - 1) * (e.value / truth - 1) / static_cast<double>(draws);
      told.push_back(e.standard_error / truth);
      held_ += std::abs(e.value - truth) <= 1.959964 * e.standard_error;
    }
    drawn_ += draws;
    off_.push_back(std::sqrt(squares));
    told_.push_back(quantile(told, 0.5));
  }
  void print() const {
    std::printf(
        "samples are off by %.3f of the error (median; half of the networks %.3f to %.3f), at most 0.05 for %zu of "
        "%zu networks\nstandard errors told: median %.3f; 95 %% intervals held in %.3f\n",
        quantile(off_, 0.5), quantile(off_, 0.25), quantile(off_, 0.75),
        static_cast<std::size_t>(std::count_if(off_.begin(), off_.end(), [](double e) { return e <= 0.05; })),
        off_.size(), quantile(told_, 0.5), static_cast<double>(held_) / static_cast<double>(drawn_));
  }

 private:
  std::vector<double> off_, told_;
  std::size_t held_ = 0, drawn_ = 0;
};

// Prediction of evaluations by every ray, whose sample grows, and that of every voxel.
class Growing {
 public:
  void add(Simulator& simulator, const Network& network) {
    const RegistrationOptions registration;
    const std::uint64_t all = simulator.voxel_count();
    const RequiredInputs needs{.pairs = true, .registration = registration.model};
    const NetworkCounts some = simulator.evaluate(network, count_surveyed(needs, registration, simulator));
    const Estimate told = registration_estimate(some, all, registration);
    const double truth =
        registration_error(simulator.evaluate(network, {.registration = registration.model}), all, registration).rms_m;
    off_.push_back(std::abs(told.value / truth - 1));
    told_.push_back(told.standard_error / truth);
    voxels_.push_back(static_cast<double>(some.registration.voxels) / static_cast<double>(all));
    predicted_.push_back(told.value), true_.push_back(truth);
    held_ += std::abs(told.value - truth) <= std::max(1.959964 * told.standard_error, 1e-9 * truth);
    for (const AccuracyClass one : {AccuracyClass::loa30, AccuracyClass::loa40, AccuracyClass::loa50}) {
      const auto meets = [&](double rms_m) { return error_at_95_percent(rms_m) <= largest_error_m(one); };
      same_verdicts_ += meets(told.value) == meets(truth), ++verdicts_;
    }
  }
  void print() const {
    std::printf(
        "off by %.3f (median; 90 %% of the networks at most %.3f), told %.3f; 95 %% intervals hold for %zu of %zu; "
        "Spearman %+.3f; same verdict of LOA30, LOA40, LOA50 in %zu of %zu; %.2f of the voxels (median)\n",
        quantile(off_, 0.5), quantile(off_, 0.9), quantile(told_, 0.5), held_, off_.size(), spearman(predicted_, true_),
        same_verdicts_, verdicts_, quantile(voxels_, 0.5));
  }

 private:
  std::vector<double> off_, told_, voxels_, predicted_, true_;
  std::size_t held_ = 0, same_verdicts_ = 0, verdicts_ = 0;
};

void run(const Options& o) {
  const auto known = test::site_names();
  const bool own = std::ranges::find(known, o.site) == known.end();
  const Scanner scanner{.azimuth_step = Angle::degrees(o.step_deg),
                        .zenith_step = Angle::degrees(o.step_deg),
                        .height_m = 1.7,
                        .min_range_m = 0.5,
                        .max_range_m = 60,
                        .noise = rtc360_noise(),
                        .angle_accuracy = Angle::degrees(o.calibration[0] / 3600),
                        .range_accuracy_m = o.calibration[1] * 1e-3,
                        .range_accuracy_ppm = o.calibration[2]};
  std::optional<Site> opened;
  std::optional<Scene> made;
  if (own) {
    opened = Site::open(o.site, {.scanners = {scanner}, .engine = Engine::embree});
  } else {
    const auto file = std::filesystem::temp_directory_path() / fmt::format("registration_{}_{}.glb", o.site, o.seed);
    test::write_site(test::make_site(o.site), {}, file);
    made = Scene::load(file);
    std::filesystem::remove(file);
  }
  const Scene& scene = own ? opened->scene() : *made;
  Simulator simulator(
      scene, scanner,
      {.engine = Engine::embree, .user_size_m = o.user_size_m, .point_spacing_m = 0.05, .noise = false});
  std::mt19937_64 random(o.seed);
  Pool pool = read_plans(o.plans);
  if (pool.given.empty())
    pool.heads =
        own ? draw_heads(*opened, o.pool, random) : draw_heads(test::make_site(o.site), scene, scanner, o.pool, random);
  const std::vector<Vec3>& heads = pool.heads;
  const std::size_t networks = pool.given.empty() ? o.networks : pool.given.size();
  std::vector<ThinnedScan> scans;
  for (const Vec3& head : heads) scans.push_back(thinned_scan(simulator, head));
  std::vector<Neighbours> neighbours(scans.begin(), scans.end());
  std::vector<std::vector<std::uint32_t>> matches(scans.size() * scans.size());
  tbb::parallel_for(std::size_t{0}, matches.size(), [&](std::size_t k) {
    const std::size_t i = k / scans.size(), j = k % scans.size();
    if (i != j) matches[k] = matching_points(scans[i], neighbours[j]);
  });
  std::printf("%s: %zu triangles, %zu voxels of %.3f m, %zu stations scanned\n", o.site.c_str(), scene.triangle_count(),
              static_cast<std::size_t>(simulator.voxel_count()), simulator.voxel_size_m(), scans.size());
  std::fflush(stdout);

  const AdjustmentTruth truth{.angle = scanner.angle_accuracy.in_radians(),
                              .range_m = scanner.range_accuracy_m,
                              .range_share = scanner.range_accuracy_ppm * 1e-6};
  std::ofstream csv;
  if (!o.csv.empty()) {
    csv.open(o.csv);
    csv << "network,true_mm,predicted_mm,standard_error_mm";
    for (const char* name : Figures::names) csv << ',' << name;
    csv << '\n';
  }
  std::vector<double> true_mm, predicted_mm, ratios;
  std::array<std::vector<double>, 2> halves;  // true errors, from every other trial
  std::array<std::vector<double>, Figures::names.size()> overlaps;
  const OverlapMatrix of_pairs = overlaps_of(scans);
  std::set<std::vector<std::size_t>> taken;
  std::size_t drawn = 0;
  Samples samples;
  Growing growing;
  for (std::size_t k = 0; k < networks; ++k) {
    std::vector<std::size_t> picked;
    if (!pool.given.empty()) picked = pool.given[k];
    for (int tries = 0; pool.given.empty(); ++tries, ++drawn) {
      if (tries > 100'000) throw Error(Errc::invalid_argument, "too few networks are connected; use more stations");
      picked = draw_network(heads, o.stations, k, random);
      std::sort(picked.begin(), picked.end());
      if (connected(of_pairs, picked, o.connected) && taken.insert(picked).second) break;
    }
    Network network;
    for (const std::size_t p : picked) network.push_back({heads[p]});
    if (o.growing) {
      growing.add(simulator, network);
      continue;
    }
    if (o.samples > 0) {
      samples.add(simulator, network, o.sample, o.samples);
      continue;
    }
    const NetworkCounts counts =
        simulator.evaluate_sampled({&network, 1}, {.voxels = o.sample, .registration = RegistrationModel{}}).front();
    const Figures figure = figures(counts);
    const Estimate predicted = registration_estimate(counts, simulator.voxel_count());
    // The covered surface, as the scans have it.
    ScanNetwork chosen;
    for (const std::size_t i : picked) {
      chosen.scans.push_back(&scans[i]);
      chosen.neighbours.push_back(&neighbours[i]);
      for (const std::size_t j : picked) chosen.matches.push_back(&matches[i * scans.size() + j]);
    }
    std::vector<std::uint64_t> seen(simulator.voxel_count());
    for (std::size_t s = 0; s < picked.size(); ++s)
      for (const std::uint32_t voxel : scans[picked[s]].voxels) seen[voxel] |= std::uint64_t{1} << s;
    const auto covered =
        static_cast<std::size_t>(std::count_if(seen.begin(), seen.end(), [](auto m) { return m != 0; }));
    const std::size_t stride = std::max<std::size_t>(covered / o.points, 1);
    std::vector<Eigen::Vector3d> points;
    std::vector<std::uint64_t> masks;
    std::size_t number = 0;
    for (std::uint64_t v = 0; v < seen.size(); ++v)
      if (seen[v] != 0 && number++ % stride == 0) {
        const Vec3 c = simulator.voxel_centre(v);
        points.emplace_back(c.x, c.y, c.z);
        masks.push_back(seen[v]);
      }
    std::vector<double> squares(o.trials);
    tbb::parallel_for(std::size_t{0}, o.trials, [&](std::size_t t) {
      const double e = surface_error(adjust(chosen, truth, o.seed * 1'000'003 + k * 1009 + t), points, masks);
      squares[t] = e * e;
    });
    const double e = std::sqrt(std::accumulate(squares.begin(), squares.end(), 0.0) / static_cast<double>(o.trials));
    for (std::size_t half = 0; half < 2; ++half) {
      double sum = 0;
      for (std::size_t t = half; t < o.trials; t += 2) sum += squares[t];
      halves[half].push_back(sum);
    }
    true_mm.push_back(1e3 * e);
    predicted_mm.push_back(1e3 * predicted.value);
    ratios.push_back(e / predicted.value);
    if (csv)
      csv << fmt::format("{},{:.4f},{:.4f},{:.4f}", k, 1e3 * e, 1e3 * predicted.value, 1e3 * predicted.standard_error);
    for (std::size_t f = 0; f < overlaps.size(); ++f) {
      overlaps[f].push_back(figure.values[f]);
      if (csv) csv << fmt::format(",{:.5f}", figure.values[f]);
    }
    if (csv) csv << std::endl;
    if (!pool.given.empty())
      std::printf("%s: true error %.2f mm, predicted %.2f ± %.2f mm, clustering coefficient %.3f\n", o.plans[k].c_str(),
                  1e3 * e, 1e3 * predicted.value, 1e3 * predicted.standard_error, figure.values.back());
  }
  if (o.samples > 0) samples.print();
  if (o.growing) growing.print();
  if (o.growing || o.samples > 0 || !pool.given.empty()) return;
  std::printf("%zu connected networks of %zu stations (%zu drawn in all), %zu trials each\n", o.networks, o.stations,
              drawn + o.networks, o.trials);
  std::printf("true error %.2f to %.2f mm, 10 %% to 90 %%: a factor of %.1f\n", quantile(true_mm, 0),
              quantile(true_mm, 1), quantile(true_mm, 0.9) / quantile(true_mm, 0.1));
  std::printf("true over predicted: median %.2f, half of them %.2f to %.2f\n", quantile(ratios, 0.5),
              quantile(ratios, 0.25), quantile(ratios, 0.75));
  // If the ranks of two halves of the trials correlate by r, those of all trials correlate with the expected error by
  // √(2r / (1 + r)) (Spearman and Brown). No prediction can be expected to do better.
  const double alike = std::max(spearman(halves[0], halves[1]), 0.0);
  std::printf("halves of the trials rank by %+.2f; a perfect prediction would rank by %+.2f\n", alike,
              std::sqrt(2 * alike / (1 + alike)));
  std::printf("Spearman's rank correlation of the true error with\n  %-14s %+.2f\n", "predicted",
              spearman(true_mm, predicted_mm));
  for (std::size_t f = 0; f < overlaps.size(); ++f)
    std::printf("  %-14s %+.2f\n", Figures::names[f], spearman(true_mm, overlaps[f]));
}

}  // namespace
}  // namespace vantage::bench

int main(int argc, char** argv) {
  vantage::bench::Options o;
  CLI::App app("Predicted registration errors against simulated adjustments");
  app.add_option("site", o.site, "office, house, street or plant, or the file of any other site")->required();
  app.add_option("--stations", o.stations, "Of a network");
  app.add_option("--pool", o.pool, "Stations that networks are drawn from");
  app.add_option("--networks", o.networks, "How many");
  app.add_option("--trials", o.trials, "Adjustments of each");
  app.add_option("--sample", o.sample, "Voxels that predictions are made from; all of them if absent");
  app.add_option("--samples", o.samples, "Tell how far so many of these are off every voxel, and adjust nothing");
  app.add_flag("--growing", o.growing,
               "Tell how far the sample of evaluations by every ray is off every voxel, and adjust nothing");
  app.add_option("--calibration", o.calibration, "What it leaves: arc seconds, millimetres, millionths")
      ->delimiter(',')
      ->expected(3);
  app.add_option("--step", o.step_deg, "Of the scanner, degrees");
  app.add_option("--user-size", o.user_size_m, "Of voxels, metres");
  app.add_option("--connected", o.connected, "Least overlap of the weakest link of the strongest tree");
  app.add_option("--seed", o.seed, "Of places, networks and trials");
  app.add_option("--plan", o.plans,
                 "A table of stations, as stations.csv of a plan: adjust this network, and none drawn");
  app.add_option("--csv", o.csv, "Write a line for each network");
  CLI11_PARSE(app, argc, argv);
  try {
    vantage::bench::run(o);
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "%s\n", failure.what());
    return 1;
  }
  return 0;
}
