// SPDX-License-Identifier: Apache-2.0
#include "search/search_evaluator.hpp"

#include <utility>

#include "core/archive.hpp"
#include "search/sample_schedule.hpp"
#include "search/sample_statistics.hpp"

namespace vantage {
namespace {

// One sample throughout.
class SampledEvaluator : public SearchEvaluator {
 public:
  SampledEvaluator(NetworkEvaluator& evaluator, VoxelWindow window)
      : evaluator_(evaluator), cache_(evaluator), window_(window) {}

  std::size_t chunk() const override { return 0; }
  std::optional<SearchValues> evaluate(std::span<const PlacedNetwork> networks, const Progress& progress) override {
    return cache_.evaluate(networks, window_, progress);
  }
  double trace_seconds() const override { return evaluator_.trace_seconds(); }
  VoxelWindow reported_by() const override { return window_; }

 protected:
  NetworkEvaluator& evaluator_;

 private:
  CachingEvaluator cache_;
  VoxelWindow window_;
};

class ExactEvaluator final : public SampledEvaluator {
 public:
  explicit ExactEvaluator(NetworkEvaluator& evaluator) : SampledEvaluator(evaluator, {}) {}
  // A small chunk, so that a search can often be stopped and saved.
  std::size_t chunk() const override { return evaluator_.chunk(); }
};

// Redraws the sample regularly.
class ResampledEvaluator final : public SearchEvaluator, public ArchiveEvaluator {
 public:
  ResampledEvaluator(NetworkEvaluator& evaluator, const PlanConfig& config, std::size_t measures)
      : evaluator_(evaluator),
        cache_(evaluator),
        schedule_(config.sample_voxels, config.renew_iterations.value_or(0)),
        statistics_(measures) {}

  std::size_t chunk() const override { return 0; }
  std::optional<SearchValues> evaluate(std::span<const PlacedNetwork> networks, const Progress& progress) override {
    auto values = cache_.evaluate(networks, schedule_.window(), progress);
    if (!values) return std::nullopt;
    for (std::vector<double>& own : *values) statistics_.correct(own);
    return values;
  }
  double trace_seconds() const override { return evaluator_.trace_seconds(); }
  VoxelWindow reported_by() const override { return schedule_.verification(); }

  ArchiveEvaluator* archive() override { return this; }
  bool due(std::span<const ParetoPoint> archive, std::uint64_t iterations) override {
    statistics_.keep_only(archive);
    return schedule_.due(iterations);
  }
  std::optional<SearchValues> re_evaluate(const SearchArchive& archive, std::uint64_t iterations,
                                          const Progress& progress) override {
    const SampleSchedule next = schedule_.redrawn(iterations);
    auto values = evaluator_.evaluate(archive.networks, next.window(), progress);
    if (!values) return std::nullopt;
    schedule_ = next;
    statistics_.average(archive.points, *values);
    return values;
  }
  // No choice depended on these voxels.
  std::optional<SearchEstimates> verify(const SearchArchive& archive, std::uint64_t iterations,
                                        const Progress& progress) override {
    const SampleSchedule next = schedule_.redrawn(iterations);
    auto found =
        evaluator_.estimate(archive.networks, next.verification(), NetworkEvaluator::Which::searched, progress);
    if (!found) return std::nullopt;
    schedule_ = next;
    return statistics_.pooled(archive.points, *std::move(found), SampleSchedule::kVerification);
  }

  std::string state() const override {
    ArchiveWriter writer;
    writer.raw(schedule_.state());
    writer.whole(statistics_.state().known.size());
    for (const auto& [x, sums] : statistics_.state().known)
      writer.array(x), writer.array(sums.sum), writer.whole(sums.count);
    writer.array(statistics_.state().shift);
    return writer.take();
  }
  void restore(std::string_view state) override {
    ArchiveReader reader(state, Errc::malformed_file, "the checkpoint's samples are damaged; start again without it");
    schedule_.restore(reader.raw<SampleSchedule::State>());
    SampleStatistics::State statistics;
    const std::size_t measures = statistics_.state().shift.size();
    for (std::size_t left = reader.size(3 + measures * sizeof(double)); left > 0; --left) {
      std::vector<double> x;
      reader.array(x);
      SampleStatistics::Sums& sums = statistics.known[std::move(x)];
      reader.array(sums.sum), reader.whole(sums.count);
      if (sums.sum.size() != measures) reader.fail();
    }
    reader.array(statistics.shift);
    if (statistics.shift.size() != measures || !reader.at_end()) reader.fail();
    statistics_.restore(std::move(statistics));
  }

 private:
  NetworkEvaluator& evaluator_;
  CachingEvaluator cache_;
  SampleSchedule schedule_;
  SampleStatistics statistics_;
};

}  // namespace

std::unique_ptr<SearchEvaluator> make_search_evaluator(NetworkEvaluator& evaluator, const PlanConfig& config,
                                                       std::size_t measures) {
  if (config.sample_voxels == 0) return std::make_unique<ExactEvaluator>(evaluator);
  if (config.renew_iterations.value_or(0) == 0)
    return std::make_unique<SampledEvaluator>(evaluator, VoxelWindow{.voxels = config.sample_voxels});
  return std::make_unique<ResampledEvaluator>(evaluator, config, measures);
}

}  // namespace vantage
