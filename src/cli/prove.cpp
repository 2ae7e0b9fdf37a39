// SPDX-License-Identifier: Apache-2.0
#include "cli/prove.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/first_numbers.hpp"

namespace vantage::cli {

Estimate captured_by(const AttainableCounts& attainable, const CoverageMatrix& matrix,
                     std::span<const std::size_t> chosen) {
  std::vector<double> amounts(matrix.elements());
  for (const std::size_t k : chosen)
    for (const CoverageMatrix::Entry& one : matrix.column(k)) amounts[one.element] += one.amount;
  return attainable.captured(amounts);
}

void prove(const std::filesystem::path& file, Site& site, std::span<const PlacedStation> stations, std::size_t kept,
           bool of_attainable, Program& program) {
  if (stations.size() <= kept) return;
  ProgressLine line(program.console, "bound");
  const Progress progress{.report = [&](double done) { line.update(done); }, .stop = program.abort};
  const Candidates candidates = find_candidates(site, {.first = 1024, .most = 1024}, progress);
  SampledCoverage sampled = candidates.coverage();
  const std::size_t first = sampled.size(), placed = stations.size() - kept;
  sampled.append(sample_coverage(site.simulator(), stations, sampled.sample_voxels(), progress));
  if (sampled.cancelled()) {
    spdlog::warn("stopped: {} is not written", file.string());
    return;
  }
  // The plan is evaluated on the voxels of the bound, so that the sample favours neither.
  const std::vector<std::size_t> plan = first_numbers(stations.size(), first);
  AttainableCounts attainable = candidates.attainable_counts();
  CoverageMatrix matrix = sampled.matrix();
  for (const std::size_t k : plan)
    for (const CoverageMatrix::Entry& one : matrix.column(k)) attainable.raise(one.element, one.amount);
  if (of_attainable) matrix.set_goals(attainable.counts());
  const auto reached_by = [&](std::span<const std::size_t> chosen) {
    return of_attainable ? captured_by(attainable, matrix, chosen) : sampled.coverage(chosen);
  };
  const Estimate reached = reached_by(plan);
  const CoverSolution bound =
      max_cover({.matrix = matrix, .existing = first_numbers(kept, first), .most = placed}, {}, progress);
  const double gap = CoverSolution::relative_gap(bound.bound, reached.value);
  spdlog::info(
      "within {:.1f} % of the best that any {} stations can do: {} {:.4f} ± {:.4f} on a sample, where no network "
      "of {} candidates has more than {:.4f}; twice as many candidates raised that by {:.4f}",
      100 * gap, placed, of_attainable ? "captured" : "coverage", reached.value, reached.standard_error,
      candidates.stations().size(), bound.bound, bound.spacing_term);
  nlohmann::json chosen = nlohmann::json::array();
  for (const std::size_t k : bound.chosen) {
    const Vec3& head = (k < first ? candidates.stations()[k] : stations[k - first]).position;
    chosen.push_back({head.x, head.y, head.z});
  }
  write_text(file, nlohmann::json{{"stations", placed},
                                  {"existing", kept},
                                  {"measure", of_attainable ? "captured" : "coverage"},
                                  {"reached", reached.value},
                                  {"reached_se", reached.standard_error},
                                  {"bound", bound.bound},
                                  {"gap", gap},
                                  {"complete", bound.complete},
                                  {"spacing_term", bound.spacing_term},
                                  {"candidates", candidates.stations().size()},
                                  {"spacing", candidates.spacing_m()},
                                  {"attainable", attainable.coverage().value},
                                  {"attainable_se", attainable.coverage().standard_error},
                                  {"best_of_candidates", reached_by(bound.chosen).value},
                                  {"chosen", std::move(chosen)},
                                  {"sample", sampled.voxels().size()}}
                           .dump(2) +
                       "\n");
}

}  // namespace vantage::cli
