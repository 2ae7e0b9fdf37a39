// SPDX-License-Identifier: Apache-2.0
#include "cli/missed.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>

#include "cli/options.hpp"

namespace vantage::cli {
namespace {

// Enough for shares to a tenth of a percent, few enough for seconds.
constexpr std::uint64_t most_voxels = 50'000;

bool known(const std::string& extension) {
  return extension == ".csv" || extension == ".ply" || extension == ".png" || extension == ".svg";
}

}  // namespace

void MissedFiles::add(CLI::App& command) {
  add_texts(command, "--missed", "FILE",
            "Write why voxels are not captured: .csv a table by node, .ply a cloud, .png or .svg a picture; may be "
            "repeated",
            files)
      ->group("Results");
}

void MissedFiles::check() const {
  for (const std::string& file : files)
    if (!known(std::filesystem::path(file).extension().string()))
      throw Error(Errc::invalid_argument, "--missed: " + file + " is none of .csv, .ply, .png and .svg");
}

std::optional<JudgedVoxels> judge_missed(Site& site, const Simulator& simulator, const VoxelField& field,
                                         Program& program) {
  if (simulator.voxel_count() == 0) return std::nullopt;
  const MissedOptions options;
  const std::vector<PlacedStation> candidates =
      candidate_positions(site.area(), site.clash(), site.scanner(), options.candidates);
  JudgedVoxels judged{.ranks = simulator.sampled_voxels(std::min(most_voxels, simulator.voxel_count()))};
  for (const std::uint32_t rank : judged.ranks) judged.points.push_back(field.count[rank]);
  ProgressLine line(program.console, "why missed");
  judged.why = why_missed(simulator, site.clash(), candidates, judged.ranks, judged.points, options,
                          {.report = [&](double done) { line.update(done); }, .stop = program.abort});
  if (judged.why.empty()) return std::nullopt;
  judged.shares = missed_by_node(simulator, judged.ranks, judged.why);
  const MissedShare& all = judged.shares.front();
  spdlog::info(
      "of the surveyed voxels {:.1f} % are captured, {:.1f} % could be by other stations; {:.1f} % are hidden from "
      "{} positions all over the ground, {:.1f} % out of range, {:.1f} % seen too flatly, {:.1f} % too sparsely",
      100 * all.share(WhyMissed::captured), 100 * all.share(WhyMissed::not_chosen), 100 * all.share(WhyMissed::hidden),
      candidates.size(), 100 * all.share(WhyMissed::far), 100 * all.share(WhyMissed::flat),
      100 * all.share(WhyMissed::sparse));
  return judged;
}

void write_missed(std::span<const std::filesystem::path> files, const JudgedVoxels& judged, const Simulator& simulator,
                  std::span<const PlacedStation> stations) {
  for (const std::filesystem::path& file : files) {
    if (file.extension() == ".csv")
      write_missed_csv(file, judged.shares);
    else if (file.extension() == ".ply")
      write_missed_ply(file, simulator, judged.ranks, judged.why, judged.points);
    else
      draw_missed(file, simulator, judged.ranks, judged.why, stations, "Why surfaces are not captured");
  }
}

}  // namespace vantage::cli
