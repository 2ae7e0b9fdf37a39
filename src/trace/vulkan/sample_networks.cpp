// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <array>
#include <bit>
#include <iterator>
#include <limits>
#include <utility>

#include "core/parallel.hpp"
#include "trace/sample_runs.hpp"
#include "trace/vulkan/pair_schedule.hpp"
#include "trace/vulkan/vulkan_tracer.hpp"

namespace vantage::vulkan {

const DeviceSample& VulkanTracer::upload_sample(std::span<const std::uint32_t> sample) {
  return samples_.get([&](const DeviceSample& one) { return std::ranges::equal(sample, one.voxel_indices); },
                      [&] { return device_sample(sample); });
}

// Orders voxels run by run, so that chunks have similar numbers of rays.
static std::vector<SampleVoxel> in_order_of_chunks(std::span<const SampleVoxel> voxels) {
  const SampleRuns runs(voxels.size());
  std::vector<SampleVoxel> ordered;
  ordered.reserve(voxels.size());
  for (std::size_t k = 0; k < runs.size(); ++k) std::ranges::copy(runs.run(voxels, k), std::back_inserter(ordered));
  return ordered;
}

DeviceSample VulkanTracer::device_sample(std::span<const std::uint32_t> sample) {
  const VoxelGrid& grid = *scene_.grid;
  std::vector<SampleVoxel> voxels(sample.size());
  parallel::for_all(std::size_t{0}, sample.size(), [&](std::size_t k) {
    const auto cell = morton_decode(grid.key(sample[k]));
    voxels[k] = {cell[0], cell[1], cell[2], static_cast<std::uint32_t>(k)};
  });
  return {.voxel_indices = {sample.begin(), sample.end()},
          .voxels = make_device_buffer<SampleVoxel>(device_, commands_, voxels, "sample voxels"),
          .in_order_of_chunks =
              make_device_buffer<SampleVoxel>(device_, commands_, in_order_of_chunks(voxels), "voxels of chunks"),
          .demands = make_device_demands(device_, commands_, grid.demands().of(sample))};
}

// Networks go in batches that share counts and masks. Within a batch, stations go scanner by scanner, upright and
// turned ones apart, so that a dispatch has one kind. They go in chunks whose rays fit one list, as many in a
// submission as are quick enough together (pair_schedule.hpp). The last chunk of a batch brings its reduction, which is
// repeated if some of the chunk must be.
class VulkanTracer::SampledCount {
 public:
  SampledCount(VulkanTracer& tracer, std::span<const std::vector<TraceStation>> networks,
               std::span<const std::uint32_t> station_counts, const SampleJob& job)
      : t_(tracer),
        networks_(networks),
        station_counts_(station_counts),
        job_(job),
        voxels_(static_cast<std::uint32_t>(job.sample.size())),
        most_stations_(*std::max_element(station_counts.begin(), station_counts.end())),
        mask_words_(job.masks ? (most_stations_ > 32 ? 2 : 1) : 0),
        stride_(totals_seen + most_stations_ + most_stations_ * (most_stations_ - 1) / 2),
        room_(tracer.room_for_sample()),
        batch_size_(static_cast<std::size_t>(
            std::clamp<std::uint64_t>(kEntriesPerBatch / std::max(voxels_, 1u), 1, networks.size()))),
        groups_(std::max(job.groups, 1u)),
        rays_(networks.size()),
        totals_(networks.size() * groups_ * stride_) {}

  std::vector<NetworkCounts> run(const Progress& progress) {
    t_.device_scene_.upload_triangles();
    t_.device_scene_.upload_neighbours();
    sample_ = &t_.upload_sample(job_.sample);
    ensure_buffers();
    reduction_ = reduction();
    bool cancelled = false;
    for (std::size_t first = 0; first < networks_.size() && !cancelled; first += batch_size_)
      cancelled = !count_batch({first, std::min(first + batch_size_, networks_.size())}, progress);
    std::vector<NetworkCounts> results(networks_.size());
    t_.read_totals(results, station_counts_, totals_, reduction_, stride_);
    for (std::size_t n = 0; n < registration_.size(); ++n) take_registration(results[n], std::move(registration_[n]));
    for (std::size_t n = 0; n < results.size(); ++n) {
      results[n].rays = rays_[n];
      if (!job_.groups) results[n].successive_difference_sum = std::numeric_limits<double>::infinity();
      results[n].cancelled = cancelled;
      results[n].trace_seconds = seconds_ / static_cast<double>(results.size());
    }
    return results;
  }

 private:
  static constexpr std::uint64_t kEntriesPerBatch = std::uint64_t{1} << 25;  // in counts, and in masks
  static constexpr VkDeviceSize kWordBytes = sizeof(std::uint32_t);

  // Slots of one scanner, all turned or all upright.
  struct Run {
    const DeviceScanner* scanner;
    bool turned;
    std::uint32_t first_slot, end_slot;
  };
  struct Batch {
    std::size_t first, end;
    std::vector<SampleStation> slots = {};
    std::vector<Run> runs = {};
    std::size_t size() const { return end - first; }
  };

  // Part of a batch that one submission does.
  struct Submission {
    const Run* run;
    std::vector<SampleChunk> chunks;  // of the run
    bool first, last;                 // of the batch
  };

  void ensure_buffers() {
    const std::uint64_t entries = std::uint64_t{voxels_} * batch_size_;
    t_.ensure(t_.sample_.pairs, std::uint64_t{room_.pairs} * sizeof(SamplePair), "sample pairs");
    t_.ensure(t_.sample_.rays, std::uint64_t{room_.rays} * sizeof(SampleRay), "sample rays");
    t_.ensure(t_.sample_.sights, room_.parts * kWordBytes, "sample sights");
    t_.ensure(t_.sample_.items, std::uint64_t{room_.parts} * sizeof(SampleItem), "sample items");
    t_.ensure(t_.sums_.counts, entries * kWordBytes, "counts");
    if (mask_words_) t_.ensure(t_.sums_.masks, entries * mask_words_ * kWordBytes, "station masks");
    t_.ensure_totals(networks_.size(), groups_, stride_);
  }

  // Returns false if the caller stopped it before the end.
  bool count_batch(Batch batch, const Progress& progress) {
    fill_slots(batch);
    compile_kernels(batch);
    t_.ensure(t_.sample_.stations, batch.slots.size() * sizeof(SampleStation), "sample stations");
    t_.ensure(t_.sample_.slot_rays, batch.slots.size() * sizeof(std::uint64_t), "slot rays");
    slot_rays_.resize(batch.slots.size());
    double slots_done = 0;
    const auto all_slots = static_cast<double>(std::max<std::size_t>(batch.slots.size(), 1));
    for (const Run& run : batch.runs) {
      const std::uint32_t slots = run.end_slot - run.first_slot;
      const bool last_run = &run == &batch.runs.back();
      PairSchedule schedule(slots, voxels_, most_parts(*run.scanner), room_);
      for (bool first = &run == batch.runs.data(), more = true; more; first = false) {
        if (progress.stopped()) return false;
        Submission submission{&run, schedule.next(t_.sampled_sizer_.rays(), t_.pairs_seen_, t_.sampled_sizer_.rays()),
                              first, false};
        submission.last = last_run && schedule.finished();
        const auto [tallies, taken] = submit(batch, submission);
        seconds_ += taken;
        t_.sampled_sizer_.observe(schedule.settle(submission.chunks, tallies), taken);
        learn_of_pairs(submission.chunks, tallies);
        const double done = (slots_done + slots * schedule.done()) / all_slots;
        progress((static_cast<double>(batch.first) + static_cast<double>(batch.size()) * done) /
                 static_cast<double>(networks_.size()));
        more = !schedule.finished();
      }
      slots_done += slots;
    }
    for (std::size_t k = 0; k < batch.slots.size(); ++k) rays_[batch.first + batch.slots[k].network] += slot_rays_[k];
    if (job_.points) hand_out_points(batch);
    if (job_.station_masks) job_.station_masks(batch.first, masks_of(batch));
    if (job_.registration) register_batch(batch);
    return true;
  }

  // Makes at least one run, even without slots, since the batch must still be cleared and reduced.
  void fill_slots(Batch& batch) const {
    struct Placed {
      std::uint64_t place;
      const TraceStation* station;
      std::uint32_t network;
    };
    std::vector<Placed> placed;
    for (std::uint32_t scanner = 0; scanner < t_.scanners_.size(); ++scanner) {
      for (const bool turned : {false, true}) {
        placed.clear();
        for (std::size_t n = batch.first; n < batch.end; ++n)
          for (const TraceStation& s : networks_[n])
            if (s.scanner == scanner && s.turn.has_value() == turned)
              placed.push_back({place_along_curve(s.origin), &s, static_cast<std::uint32_t>(n - batch.first)});
        std::ranges::stable_sort(placed, {}, &Placed::place);
        const auto first = static_cast<std::uint32_t>(batch.slots.size());
        for (const auto& [place, s, network] : placed) {
          SampleStation& slot =
              batch.slots.emplace_back(SampleStation{{s->origin.x, s->origin.y, s->origin.z}, s->place, network, {}});
          set_turn(slot.turn, *s);
        }
        const auto end = static_cast<std::uint32_t>(batch.slots.size());
        if (end > first) batch.runs.push_back({&t_.scanners_[scanner], turned, first, end});
      }
    }
    if (batch.runs.empty()) batch.runs.push_back({&t_.scanners_.front(), false, 0, 0});
  }

  // Places consecutive stations close together.
  std::uint64_t place_along_curve(const Float3& head) const {
    const Box& bounds = t_.scene_.scene->local_bounds;
    const auto cell = [](float at, double low, double high) {
      constexpr double kLast = (1 << 16) - 1;
      return high > low ? static_cast<std::uint32_t>(std::clamp((at - low) / (high - low), 0.0, 1.0) * kLast) : 0;
    };
    return morton_encode(cell(head.x, bounds.min.x, bounds.max.x), cell(head.y, bounds.min.y, bounds.max.y),
                         cell(head.z, bounds.min.z, bounds.max.z));
  }

  // Returns the parts of the longest walk, that of a cube around the station.
  static std::uint32_t most_parts(const DeviceScanner& scanner) {
    return static_cast<std::uint32_t>(std::max<std::uint64_t>(std::bit_ceil(scanner.longest_walk()) / sample_part, 1));
  }

  void hand_out_points(const Batch& batch) {
    std::vector<std::uint32_t> points(std::size_t{voxels_} * batch.size());
    t_.commands_.download(t_.sums_.counts, points.data(), points.size() * kWordBytes);
    for (std::size_t n = 0; n < batch.size(); ++n)
      job_.points(batch.first + n, std::span(points).subspan(n * voxels_, voxels_));
  }

  std::vector<std::uint64_t> masks_of(const Batch& batch) {
    const std::size_t of_network = std::size_t{voxels_} * mask_words_;
    std::vector<std::uint32_t> words(of_network * batch.size());
    t_.commands_.download(t_.sums_.masks, words.data(), words.size() * kWordBytes);
    std::vector<std::uint64_t> masks(std::size_t{voxels_} * batch.size());
    parallel::for_all(std::size_t{0}, batch.size(), [&](std::size_t n) {
      const std::uint32_t* low = words.data() + n * of_network;
      const std::uint32_t* high = mask_words_ > 1 ? low + voxels_ : nullptr;
      for (std::size_t v = 0; v < voxels_; ++v)
        masks[n * voxels_ + v] = low[v] | (high ? std::uint64_t{high[v]} << 32 : 0);
    });
    return masks;
  }

  // Sums on the device, with exceptions: standard errors, wanted only for the few networks of a front; samples whose
  // sums exceed 64 bits; stations with a special setup.
  void register_batch(const Batch& batch) {
    const RegistrationJob& job = *job_.registration;
    const auto networks = networks_.subspan(batch.first, batch.size());
    const auto station_counts = station_counts_.subspan(batch.first, batch.size());
    const Run& run = batch.runs.front();
    const bool usual = batch.runs.size() == 1 && run.scanner == &t_.scanners_.front() && !run.turned;
    if (!job.groups && voxels_ <= kPatchesIn64Bits && usual) {
      auto sums = t_.sum_registration(job, {networks, station_counts, voxels_, mask_words_});
      for (RegistrationSums& one : sums) registration_.push_back({std::move(one)});
      return;
    }
    const std::vector<std::uint64_t> masks = masks_of(batch);
    registration_.resize(batch.end);
    parallel::for_all(std::size_t{0}, batch.size(), [&](std::size_t k) {
      registration_[batch.first + k] =
          sum_patches(job, networks[k], station_counts[k], std::span(masks).subspan(k * voxels_, voxels_), job_.groups);
    });
  }

  // Returns the outcome of each chunk, and the seconds spent on the device.
  std::pair<std::vector<SampleTally>, double> submit(const Batch& batch, const Submission& submission) {
    const std::vector<SampleChunk>& chunks = submission.chunks;
    std::vector<std::uint32_t> control(std::max<std::size_t>(chunks.size(), 1) * control_words);
    t_.ensure(t_.sample_.control, control.size() * kWordBytes, "sample control", VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
    std::vector<Commands::Download> wanted{{t_.sample_.control, control.data(), control.size() * kWordBytes}};
    if (submission.last)
      wanted.push_back({t_.sample_.slot_rays, slot_rays_.data(), slot_rays_.size() * sizeof slot_rays_[0]});
    if (submission.last && batch.end == networks_.size())
      wanted.push_back({t_.sums_.totals, totals_.data(), totals_.size() * kWordBytes});
    const auto record = [&](const Recorder& r) {
      if (submission.first) record_start(r, batch);
      r.zero(t_.sample_.control);
      if (submission.last) {
        const VkDeviceSize of_network = std::uint64_t{groups_} * stride_ * kWordBytes;
        r.zero(t_.sums_.totals, batch.first * of_network, batch.size() * of_network);
      }
      r.shader_after_transfer();
      for (std::size_t k = 0; k < chunks.size(); ++k) record_chunk(r, *submission.run, chunks[k], k);
      if (!submission.last) return;
      r.shader_after_shader();
      t_.record_reduction(r, reduction_, static_cast<std::uint32_t>(batch.first),
                          static_cast<std::uint32_t>(batch.size()), stride_);
    };
    const double taken = t_.commands_.run_and_download(record, wanted);
    std::vector<SampleTally> tallies;
    for (std::size_t k = 0; k < chunks.size(); ++k) {
      const std::uint32_t* of_chunk = control.data() + k * control_words;
      tallies.push_back({.pairs = of_chunk[control_pairs],
                         .probed = of_chunk[control_probed],
                         .rays = of_chunk[control_rays],
                         .parts = of_chunk[control_parts],
                         .rest = of_chunk[control_rest]});
    }
    return {std::move(tallies), taken};
  }

  void record_start(const Recorder& r, const Batch& batch) {
    if (batch.first == 0) r.update(t_.sums_.station_counts, station_counts_.data(), station_counts_.size_bytes());
    r.update(t_.sample_.stations, batch.slots.data(), batch.slots.size() * sizeof(SampleStation));
    r.zero(t_.sample_.slot_rays);
    r.zero(t_.sums_.counts);
    if (mask_words_) r.zero(t_.sums_.masks);
  }

  KernelVariant variant(const Run& run, Kernel kernel) const {
    const bool traces = kernel == Kernel::sample_probe || kernel == Kernel::sample_trace;
    const DeviceScanner& scanner = *run.scanner;
    if (!traces) return {kernel, {}, run.turned, scanner.listed()};
    return {kernel,
            {scanner.noise(), scanner.limits(), job_.masks, t_.traversal_->is_watertight()},
            run.turned,
            scanner.listed()};
  }

  // Compiles kernels of exact counts, too, on a graphics card: exact counts of the answer follow sampled ones.
  void compile_kernels(const Batch& batch) const {
    std::vector<KernelVariant> wanted{{Kernel::reduce}};
    for (const Run& run : batch.runs)
      for (const Kernel kernel : {Kernel::sample_trace, Kernel::sample_probe, Kernel::sample_arguments,
                                  Kernel::sample_list, Kernel::sample_sights, Kernel::sample_queue})
        wanted.push_back(variant(run, kernel));
    t_.kernels_.compile(wanted);
    if (t_.info_.software) return;
    for (const Run& run : batch.runs)
      t_.kernels_.compile(t_.count_kernels(*run.scanner, run.turned, t_.skipping_grids({})));
  }

  // Probes, lists and traces one chunk; its control words are number k of the submission.
  void record_chunk(const Recorder& r, const Run& run, const SampleChunk& chunk, std::size_t k) const {
    const auto pipeline = [&](Kernel kernel) { return t_.kernels_.get(run.scanner->set(), variant(run, kernel)); };
    const VkDeviceSize dispatch = (k * control_words + control_dispatch) * kWordBytes;
    SamplePush push = push_of(chunk, k);
    // Dispatches one thread for each item that the control word counts at that time.
    const auto over = [&](std::uint32_t control, const BoundPipeline& kernel) {
      const SampleArgumentsPush arguments{push.control, control, room_.pairs, push.ray_capacity, push.item_capacity};
      r.shader_after_shader();
      r.dispatch(pipeline(Kernel::sample_arguments), arguments, 1);
      r.shader_after_shader();
      r.dispatch_indirect(kernel, push, t_.sample_.control, dispatch);
    };
    const std::uint32_t groups = groups_of(chunk.pairs());
    r.shader_after_shader();  // the previous chunk still reads the lists
    r.dispatch(pipeline(Kernel::sample_probe), probe_push_of(push, run, chunk), std::min(groups, groups_in_row),
               groups_of(groups, groups_in_row));
    push.list = control_rays;
    over(control_pairs, pipeline(Kernel::sample_list));
    over(control_rays, pipeline(Kernel::sample_trace));
    push.list = control_rest;
    over(control_sights, pipeline(Kernel::sample_sights));
    over(control_items, pipeline(Kernel::sample_queue));
    over(control_rest, pipeline(Kernel::sample_trace));
  }

  SamplePush push_of(const SampleChunk& chunk, std::size_t k) const {
    SamplePush push{};
    push.voxels = sample_->voxels.address();
    push.stations = t_.sample_.stations.address();
    push.pairs = t_.sample_.pairs.address();
    push.rays = t_.sample_.rays.address();
    push.sights = t_.sample_.sights.address();
    push.items = t_.sample_.items.address();
    push.control = t_.sample_.control.address() + k * control_words * kWordBytes;
    push.counts = t_.sums_.counts.address();
    push.masks = mask_words_ ? t_.sums_.masks.address() : 0;
    push.slot_rays = t_.sample_.slot_rays.address();
    push.voxel_count = voxels_;
    push.first_part = chunk.first_part;
    push.end_part = chunk.end_part;
    push.ray_capacity = room_.rays;
    push.item_capacity = room_.parts;
    push.mask_words = mask_words_;
    push.stop_at = job_.stop_at;
    push.first_traced = chunk.first_traced;
    return push;
  }

  SampleProbePush probe_push_of(const SamplePush& push, const Run& run, const SampleChunk& chunk) const {
    return {.voxels = sample_->in_order_of_chunks.address(),
            .stations = push.stations,
            .pairs = push.pairs,
            .control = push.control,
            .counts = push.counts,
            .masks = push.masks,
            .slot_rays = push.slot_rays,
            .voxel_count = push.voxel_count,
            .first_voxel = chunk.first_voxel,
            .end_voxel = chunk.end_voxel,
            .first_slot = run.first_slot + chunk.first_slot,
            .end_slot = run.first_slot + chunk.end_slot,
            .mask_words = push.mask_words,
            .stop_at = push.stop_at,
            .probed = chunk.probed,
            .pair_capacity = room_.pairs};
  }

  Reduction reduction() const {
    Reduction reduction{t_.sums_.counts.address(),
                        mask_words_ ? t_.sums_.masks.address() : 0,
                        voxels_,
                        groups_,
                        mask_words_,
                        job_.groups > 0,
                        sample_->demands.addresses()};
    if (reduction.demands.weights) {
      reduction.weight.resize(groups_);
      for (std::size_t k = 0; k < job_.sample.size(); ++k)
        reduction.weight[k % groups_] += t_.scene_.grid->demands().weight(job_.sample[k]);
    }
    return reduction;
  }

  void learn_of_pairs(std::span<const SampleChunk> chunks, std::span<const SampleTally> tallies) {
    constexpr std::uint64_t kTellingPairs = 1000;  // fewer pairs say little about the rest
    const auto learn = [](double& seen, double now) { seen = 0.5 * (seen + now); };
    for (std::size_t k = chunks.size(); k-- > 0;) {
      const auto pairs = static_cast<double>(chunks[k].pairs());
      const SampleTally& tally = tallies[k];
      if (chunks[k].pairs() <= kTellingPairs) continue;
      learn(t_.pairs_seen_.open, tally.pairs / pairs);
      if (tally.pairs <= room_.pairs)
        learn(t_.pairs_seen_.rays, (static_cast<double>(tally.probed) + tally.rays) / pairs);
    }
  }

  VulkanTracer& t_;
  const DeviceSample* sample_ = nullptr;
  std::span<const std::vector<TraceStation>> networks_;
  std::span<const std::uint32_t> station_counts_;
  SampleJob job_;
  std::uint32_t voxels_, most_stations_, mask_words_, stride_;
  SampleRoom room_;
  std::size_t batch_size_;
  std::uint32_t groups_;  // groups of the sums, at least one
  Reduction reduction_{};
  double seconds_ = 0;
  std::vector<std::uint64_t> rays_;  // per network
  // Read back from the device.
  std::vector<std::uint32_t> totals_;
  std::vector<std::uint64_t> slot_rays_;                     // of one batch
  std::vector<std::vector<RegistrationSums>> registration_;  // per network, if asked for
};

std::vector<NetworkCounts> VulkanTracer::count_sampled(std::span<const std::vector<TraceStation>> networks,
                                                       std::span<const std::uint32_t> station_counts,
                                                       const SampleJob& job, const Progress& progress) {
  if (networks.empty()) return {};
  return SampledCount(*this, networks, station_counts, job).run(progress);
}

}  // namespace vantage::vulkan
