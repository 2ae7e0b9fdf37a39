// SPDX-License-Identifier: Apache-2.0
#include "vantage/candidates.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>

#include "candidates/spread_positions.hpp"
#include "core/parse.hpp"
#include "core/setting_list.hpp"
#include "site/placement_oracle.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

// Candidates between two checks of the clock.
constexpr std::size_t kCandidatesAtOnce = 64;
constexpr std::size_t kExpected = 512;
// Candidates grow at least until all ground has one within this distance, and every place sees one within this multiple
// of their spacing. Candidates nearer than the width of a room do not miss it.
constexpr double kFarthest_m = 3, kSeenWithin = 2, kNarrowest_m = 1;

SpreadPositions spread_or_refuse(Site& site, std::size_t most) {
  const PlacementOracle oracle = make_placement_oracle(site);
  SpreadPositions spread = spread_positions(oracle, site.area().mesh(), oracle.height_m, most);
  if (spread.stations.empty())
    throw Error(Errc::invalid_argument,
                "no position of the search area is allowed: the scanner would stand too near to something, or off the "
                "ground, everywhere; check the settings security and height, and the search area");
  return spread;
}

void check(const CandidateConfig& config, std::size_t scanners) {
  if (config.scanner >= scanners)
    throw Error(Errc::invalid_argument, "candidates: scanner " + std::to_string(config.scanner) +
                                            " is asked for; the simulator has " + std::to_string(scanners) +
                                            ", counted from 0");
  if (config.first < 1 || config.most < config.first)
    throw Error(Errc::invalid_argument, "candidates: from " + std::to_string(config.first) + " to " +
                                            std::to_string(config.most) + " are asked for; at least 1 is needed");
  check_number(config.change, "candidates: the change", kNotNegative);
  check_number(config.max_seconds, "candidates: the time limit", kAnySeconds);
  if (config.sample_voxels == 0) throw Error(Errc::invalid_argument, "candidates: a sample has at least one voxel");
}

}  // namespace

Settings settings(const CandidateConfig& config) {
  return SettingList()
      .add("candidates_first", config.first)
      .add("candidates_most", config.most)
      .add("candidates_change", config.change)
      .add("candidates_sample_voxels", config.sample_voxels)
      .add("candidates_scanner", config.scanner)
      .add("candidates_max_seconds", config.max_seconds)
      .take();
}

std::vector<PlacedStation> candidate_positions(Site& site, std::size_t most) {
  return spread_or_refuse(site, most).stations;
}

CoverageMatrix Candidates::captured_matrix() const {
  CoverageMatrix matrix = coverage_.matrix();
  matrix.set_goals(attainable_counts_.counts());
  return matrix;
}

// Small rooms may lie between two candidates. Adds those of `others` that see none.
void Candidates::add_unseen(Candidates& found, Site& site, std::span<const PlacedStation> others,
                            const Progress& progress) {
  const PlacementOracle oracle = make_placement_oracle(site);
  std::vector<PlacedStation> unseen = unseen_positions(oracle, found.stations_, others, kSeenWithin * found.spacing_m_);
  if (unseen.empty()) return;
  for (PlacedStation& station : unseen) station.setup = found.stations_.front().setup;
  const std::size_t first = found.coverage_.size();
  found.coverage_.append(sample_coverage(site.simulator(), unseen, found.coverage_.sample_voxels(), progress));
  found.raise_attainable(first);
  found.attainable_ = found.attainable_counts_.coverage();
  found.stations_.insert(found.stations_.end(), unseen.begin(),
                         unseen.begin() + static_cast<std::ptrdiff_t>(found.coverage_.size() - first));
  if (found.coverage_.cancelled()) found.ended_ = "cancelled";
}

void Candidates::raise_attainable(std::size_t first) {
  const CoverageMatrix& matrix = coverage_.matrix();
  for (std::size_t k = first; k < matrix.candidates(); ++k)
    for (const CoverageMatrix::Entry& one : matrix.column(k)) attainable_counts_.raise(one.element, one.amount);
}

Candidates find_candidates(Site& site, const CandidateConfig& config, const Progress& progress) {
  Simulator& simulator = site.simulator();
  check(config, simulator.scanners().size());
  const auto begun = std::chrono::steady_clock::now();
  const auto out_of_time = [&] {
    return config.max_seconds > 0 &&
           std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count() >= config.max_seconds;
  };
  SpreadPositions spread = spread_or_refuse(site, config.most);
  for (PlacedStation& station : spread.stations) station.setup.scanner = config.scanner;

  const std::uint64_t sample =
      std::max<std::uint64_t>(config.sample_voxels == every_voxel ? simulator.voxel_count() : config.sample_voxels, 1);
  Candidates found;
  found.coverage_ = SampledCoverage(simulator, sample);
  found.attainable_counts_ = AttainableCounts(simulator, sample);
  std::size_t goal = std::min(config.first, spread.stations.size());
  double before = -1;
  while (found.ended_.empty()) {
    while (found.coverage_.size() < goal && found.ended_.empty()) {
      const std::size_t first = found.coverage_.size(), here = std::min(kCandidatesAtOnce, goal - first);
      const auto share = [&](double done) {
        // The number of doublings is not known yet; `kExpected` candidates is the most common end.
        const std::size_t expected = std::min(std::max(goal, kExpected), spread.stations.size());
        progress((static_cast<double>(first) + done * static_cast<double>(here)) / static_cast<double>(expected));
      };
      found.coverage_.append(sample_coverage(simulator, std::span(spread.stations).subspan(first, here),
                                             found.coverage_.sample_voxels(), {share, progress.stop}));
      found.raise_attainable(first);
      if (found.coverage_.cancelled())
        found.ended_ = "cancelled";
      else if (found.coverage_.size() < goal && out_of_time())
        found.ended_ = "time";
    }
    found.attainable_ = found.attainable_counts_.coverage();
    if (!found.ended_.empty()) break;
    const double now = found.attainable_.value;
    if (before >= 0) found.change_ = now > 0 ? (now - before) / now : 0;
    if (before >= 0 && found.change_ < config.change && spread.spacing_m[goal - 1] <= kFarthest_m)
      found.ended_ = "enough";
    else if (goal == config.most)
      found.ended_ = "most";
    else if (goal == spread.stations.size())
      found.ended_ = "all";
    else if (out_of_time())
      found.ended_ = "time";
    before = now;
    goal = std::min(2 * goal, spread.stations.size());
  }
  const auto taken = static_cast<std::ptrdiff_t>(found.coverage_.size());
  found.stations_.assign(spread.stations.begin(), spread.stations.begin() + taken);
  found.spacing_m_ = taken > 0 ? spread.spacing_m[static_cast<std::size_t>(taken) - 1] : 0;
  if (found.spacing_m_ > kNarrowest_m && found.ended_ != "cancelled" && found.ended_ != "time") {
    std::vector<PlacedStation> others(spread.stations.begin() + taken, spread.stations.end());
    others.insert(others.end(), spread.others.begin(), spread.others.end());
    Candidates::add_unseen(found, site, others, {.stop = progress.stop});
  }
  progress(1);
  return found;
}

}  // namespace vantage
