// SPDX-License-Identifier: Apache-2.0
#include "ranks.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <limits>
#include <memory>
#include <numeric>
#include <thread>

#include "core/philox.hpp"
#include "core/text.hpp"
#include "map/chart.hpp"
#include "ranks/mpi_transport.hpp"
#include "ranks/rank_tracers.hpp"
#include "ranks_model.hpp"
#include "vantage/error.hpp"
#include "vantage/optimiser.hpp"

namespace vantage::bench {
namespace {

using ranks::Reader;
using ranks::Writer;

std::vector<Network> networks_around(const Network& given, std::size_t many, double spread_m) {
  RandomStream random(1);
  const auto moved = [&](double x) { return x + (random.uniform() * 2 - 1) * spread_m; };
  std::vector<Network> all(many, given);
  for (Network& network : all)
    for (Station& station : network)
      station.position.x = moved(station.position.x), station.position.y = moved(station.position.y);
  return all;
}

// Times networks one by one and all together: the cost of a network, and of a call whatever its size.
void measure_networks(RanksModel& model, const RanksOptions& options, NetworkCounts& counts) {
  const Scene scene = Scene::load(options.site.scene);
  Simulator simulator = options.site.simulator(scene);
  const std::vector<Network> networks = networks_around(options.site.stations(), options.networks, options.spread_m);
  const SampleOptions sample{.voxels = options.sample, .overlap = true, .count_to = CountTo::goal};
  const auto run = [&](std::span<const Network> some) {
    const Stopwatch watch;
    counts = simulator.evaluate_sampled(some, sample).front();
    return watch.seconds();
  };
  run(networks);
  const double all = run(networks);
  double each = 0;
  for (const Network& network : networks) model.network_s.push_back(run({&network, 1})), each += model.network_s.back();
  const auto many = static_cast<double>(networks.size());
  model.piece_s = std::max(0.0, (each - all) / (many - 1));
  for (double& seconds : model.network_s) seconds *= all / each;
  std::printf("# %s on %s\n", to_string(simulator.engine().engine).c_str(), simulator.engine().device.c_str());
}

// Message sizes for a network, and rank 0's work for it and for a rank: the best of several, least disturbed by other
// work of the machine.
void measure_messages(RanksModel& model, const RanksOptions& options, const NetworkCounts& counts) {
  constexpr std::size_t many = 200;
  constexpr int rounds = 20, threads = 64;
  std::vector<TraceStation> stations;
  for (const Station& station : options.site.stations())
    stations.push_back({{static_cast<float>(station.position.x), static_cast<float>(station.position.y),
                         static_cast<float>(station.position.z)},
                        static_cast<std::uint32_t>(stations.size())});
  const std::vector<std::vector<TraceStation>> networks(many, stations);
  const std::vector<std::uint32_t> sizes(many, static_cast<std::uint32_t>(stations.size()));
  const std::vector<NetworkCounts> all(many, counts);
  model.messages_s = model.member_s = std::numeric_limits<double>::infinity();
  for (int round = 0; round < rounds; ++round) {
    Writer there;
    ranks::write_counts(there, all);
    const ranks::Message answer = there.take();
    const Stopwatch watch;
    Writer writer;
    ranks::write_networks(writer, networks, sizes);
    const ranks::Message question = writer.take();
    Reader reader(answer);
    ranks::read_counts(reader);
    model.messages_s = std::min(model.messages_s, watch.seconds() / many);
    model.ask_bytes = static_cast<double>(question.size()) / many;
    model.answer_bytes = static_cast<double>(answer.size()) / many;
  }
  for (int round = 0; round < rounds; ++round) {
    const Stopwatch watch;
    std::vector<std::jthread> begun;
    for (int k = 0; k < threads; ++k) begun.emplace_back([] {});
    begun.clear();
    model.member_s = std::min(model.member_s, watch.seconds() / threads);
  }
}

// Work of the search itself: MO-CMA-ES, with two objectives that cost nothing. In processor time, since an iteration is
// too long to avoid other work of the machine.
double search_seconds(std::size_t stations, std::size_t population) {
  const std::size_t dimension = 2 * stations;
  OptimiserConfig config{.population = population, .bounds = Bounds::uniform(dimension, 0, 1)};
  config.mo.scheme = MoScheme::generational;
  MoCmaEs optimiser(dimension, 2, config);
  double best = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < 8; ++iteration) {
    const std::clock_t begun = std::clock();
    const std::span<const double> xs = optimiser.ask();
    std::vector<double> f;
    for (std::size_t k = 0; k < xs.size(); k += dimension) {
      const auto x = xs.subspan(k, dimension);
      const double rest = std::accumulate(x.begin() + 1, x.end(), 0.0) / static_cast<double>(dimension);
      f.push_back(x[0]), f.push_back((1 - x[0]) * (1 + rest) / 2);
    }
    optimiser.tell(f);
    // The first is told of points alone, not yet of parents and offspring.
    const double seconds = static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
    if (iteration > 1) best = std::min(best, seconds / static_cast<double>(xs.size() / dimension));
  }
  return best;
}

double mean_seconds(const RanksModel& model, std::size_t ranks, std::size_t population) {
  constexpr std::uint64_t rounds = 10;
  double sum = 0;
  for (std::uint64_t seed = 1; seed <= rounds; ++seed) sum += seconds_a_population(model, ranks, population, seed);
  return sum / rounds;
}

struct RankDot {
  std::size_t population, ranks;
  double times;
};

constexpr std::array<Colour, 4> kRankColours{{style::kBlue, style::kOrange, {0.10, 0.50, 0.32}, {0.48, 0.25, 0.60}}};

void draw(const RanksOptions& options, const RanksModel& model, const std::vector<RankDot>& dots) {
  constexpr double kWidth = 860, kHeight = 560;
  Canvas canvas(kWidth, kHeight);
  const double most = static_cast<double>(std::ranges::max(options.ranks));
  const Axis x{.label = "Ranks", .low = 0.85, .high = most * 1.2, .logarithmic = true};
  const Axis y{.label = "Times the rate of one", .low = 0.85, .high = most * 1.2, .logarithmic = true};
  const double mean = std::accumulate(model.network_s.begin(), model.network_s.end(), 0.0) /
                      static_cast<double>(model.network_s.size());
  const Chart chart(canvas, {86, 76, kWidth - 86 - 210, kHeight - 76 - 70}, x, y, "How a search scales over ranks",
                    "simulated: " + fixed(1e3 * mean, 2) + " ms a network, " +
                        fixed((model.ask_bytes + model.answer_bytes) / 1e3, 1) + " kB of messages, " +
                        fixed(1e6 * model.round_trip_s, 0) + " µs there and back, " + fixed(options.gbit, 0) +
                        " Gbit/s at rank 0");
  const Pen ideal{.colour = style::kFaint, .width = 1.2, .dashes = {5, 4}};
  canvas.line(chart.at(1, 1), chart.at(most, most), ideal);
  Point at{kWidth - 190, 100};
  for (std::size_t p = 0; p < options.populations.size(); ++p) {
    const Colour colour = kRankColours[p % kRankColours.size()];
    std::vector<Point> line;
    double highest = 0;
    for (const RankDot& dot : dots) {
      if (dot.population != options.populations[p]) continue;
      line.push_back(chart.at(static_cast<double>(dot.ranks), dot.times));
      highest = std::max(highest, dot.times);
    }
    canvas.path(line, {.colour = colour, .width = 2.2});
    for (const Point& point : line) canvas.disc(point, 4, colour);
    canvas.text(at, grouped(options.populations[p]) + " at once", {.size = 13.5, .bold = true, .colour = colour});
    canvas.text({at.x, at.y + 18}, "at most " + fixed(highest, 0) + " times", {.size = 12.5});
    at.y += 48;
  }
  canvas.line({at.x, at.y}, {at.x + 26, at.y}, ideal);
  canvas.text({at.x + 34, at.y}, "ideal", {.size = 12.5});
  canvas.save(options.picture);
}

// Takes as long as a network, and answers with the same counts.
class Sleeper final : public Tracer {
 public:
  Sleeper(const RanksModel& model, NetworkCounts counts) : model_(model), counts_(std::move(counts)) {}
  const EngineInfo& info() const override { return info_; }
  std::uint64_t preferred_scan_rays(std::uint32_t) const override { return 1; }
  void scan(const TraceStation&, std::uint64_t, std::uint64_t, std::uint32_t, RawChunk&) override {}
  NetworkCounts count(std::span<const TraceStation>, std::uint32_t, const CountOptions&, const Progress&) override {
    return counts_;
  }
  std::vector<NetworkCounts> count_sampled(std::span<const std::vector<TraceStation>> networks,
                                           std::span<const std::uint32_t>, const SampleJob&, const Progress&) override {
    double seconds = model_.piece_s;
    for (std::size_t k = 0; k < networks.size(); ++k) seconds += model_.network_s[next_++ % model_.network_s.size()];
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
    return std::vector<NetworkCounts>(networks.size(), counts_);
  }

 private:
  const RanksModel& model_;
  NetworkCounts counts_;
  EngineInfo info_;
  std::size_t next_ = 0;
};

// Median round trip between two ranks over the transport.
double round_trip_seconds(ranks::Session& session, const ranks::Message& open) {
  std::vector<double> seconds;
  for (int k = 0; k < 101; ++k) {
    const Stopwatch watch;
    session.answer(1, session.request(1, ranks::Kind::open, open), {});
    seconds.push_back(watch.seconds());
  }
  std::ranges::nth_element(seconds, seconds.begin() + 50);
  return seconds[50];
}

// In a job, with real messages and real pulling.
void hold_against(RanksModel model, const RanksOptions& options, const NetworkCounts& counts) {
  std::unique_ptr<ranks::MpiTransport> transport = ranks::join_job();
  const Network given = options.site.stations();
  const TracedSite site = options.site.traced(Scene::load(options.site.scene), given);
  constexpr std::uint64_t nobody_compares = 0;
  if (transport->rank() > 0) {
    ranks::Server server(*transport, "here", [&] { transport->leave(0); });
    ranks::Worker other(server);
    const auto own = other.make(std::make_unique<Sleeper>(model, counts), site.scene, nobody_compares);
    server.serve([] {});
    for (;;) std::this_thread::sleep_for(std::chrono::hours(1));  // for the transport to end the process
  }
  const auto session = std::make_shared<ranks::Session>(*transport);
  ranks::Coordinator first(
      session, [](const std::string&) {}, [](const std::string&) {});
  const auto tracer = first.make(std::make_unique<Sleeper>(model, counts), site.scene, nobody_compares);
  Writer open;
  pass(open, ranks::identity_of(site.scene, nobody_compares));
  model.round_trip_s = round_trip_seconds(*session, open.take());
  model.bytes_a_second = 4e9;  // through memory
  std::printf("# %.0f µs there and back\nranks,population,simulated_s,measured_s\n", 1e6 * model.round_trip_s);
  const std::vector<std::uint32_t> sample(100);
  for (const std::size_t population : options.populations) {
    const std::vector<std::vector<TraceStation>> networks(population, site.stations);
    const std::vector<std::uint32_t> sizes(population, static_cast<std::uint32_t>(given.size()));
    std::vector<double> seconds;
    for (int round = 0; round < 6; ++round) {
      const Stopwatch watch;
      tracer->count_sampled(networks, sizes, {.sample = sample}, {});
      if (round > 0) seconds.push_back(watch.seconds());  // the first shows how fast each is
    }
    std::ranges::nth_element(seconds, seconds.begin() + 2);
    const auto ranks = static_cast<std::size_t>(transport->size());
    std::printf("%zu,%zu,%.4f,%.4f\n", ranks, population, mean_seconds(model, ranks, population), seconds[2]);
    std::fflush(stdout);
  }
  session->end();
  transport.reset();  // before what it hands messages to
}

}  // namespace

void RanksOptions::add(CLI::App& command) {
  site.add(command);
  command.add_option("--populations", populations, "Networks that are asked for at once")
      ->delimiter(',')
      ->capture_default_str();
  command.add_option("--ranks", ranks, "Numbers of ranks")->delimiter(',')->capture_default_str();
  command.add_option("--sample", sample, "Voxels of the sample")->capture_default_str();
  command.add_option("--networks", networks, "Networks that are measured")->capture_default_str();
  command.add_option("--spread", spread_m, "How far stations move from where they are given, metres")
      ->capture_default_str();
  command.add_option("--round-trip", round_trip_us, "Microseconds of a message there and its answer back")
      ->capture_default_str();
  command.add_option("--gbit", gbit, "Gbit/s in and out of rank 0")->capture_default_str();
  command.add_option("--network-ms", network_ms, "Of a network, in place of what is measured here");
  command.add_option("-o", picture, "Draw it: .png or .svg");
}

void run_ranks(const RanksOptions& options) {
  RanksModel model;
  model.round_trip_s = 1e-6 * options.round_trip_us, model.bytes_a_second = options.gbit * 1e9 / 8;
  NetworkCounts counts;
  measure_networks(model, options, counts);
  measure_messages(model, options, counts);
  const auto mean = [&] {
    return std::accumulate(model.network_s.begin(), model.network_s.end(), 0.0) /
           static_cast<double>(model.network_s.size());
  };
  if (options.network_ms) {
    const double times = 1e-3 * *options.network_ms / mean();
    for (double& seconds : model.network_s) seconds *= times;
    model.piece_s *= std::min(1.0, times);
  }
  if (ranks::started_as_job()) return hold_against(model, options, counts);

  const auto [least, most] = std::ranges::minmax(model.network_s);
  std::printf(
      "# a network %.3f ms (%.3f to %.3f), a chunk %.3f ms, messages %.0f + %.0f bytes and %.1f µs, a rank %.1f µs\n",
      1e3 * mean(), 1e3 * least, 1e3 * most, 1e3 * model.piece_s, model.ask_bytes, model.answer_bytes,
      1e6 * model.messages_s, 1e6 * model.member_s);
  std::printf("population,search_us_a_network,ranks,networks_a_second,times_one,share_of_ideal\n");
  std::vector<RankDot> dots;
  for (const std::size_t population : options.populations) {
    model.search_s = search_seconds(options.site.stations().size(), population);
    const double alone = mean_seconds(model, 1, population);
    for (const std::size_t ranks : options.ranks) {
      const double seconds = mean_seconds(model, ranks, population);
      dots.push_back({population, ranks, alone / seconds});
      std::printf("%zu,%.1f,%zu,%.1f,%.2f,%.2f\n", population, 1e6 * model.search_s, ranks,
                  static_cast<double>(population) / seconds, alone / seconds,
                  alone / seconds / static_cast<double>(ranks));
    }
    std::fflush(stdout);
  }
  if (!options.picture.empty()) draw(options, model, dots);
}

}  // namespace vantage::bench
