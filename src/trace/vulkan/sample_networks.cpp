// SPDX-License-Identifier: Apache-2.0
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>

#include "trace/triangle_gap.hpp"
#include "trace/vulkan/vulkan_tracer.hpp"
#include "voxel/voxel_triangles.hpp"

namespace vantage::vulkan {
namespace {

// A population of samples is one submission where it takes no longer than this, half of the shortest usual limit.
constexpr double seconds_per_sampled_submission = 1;

}  // namespace

// Part of a batch of networks whose rays one list probably holds: slots × sampled voxels, or some rows of a single
// pair.
struct SampleChunk {
  std::uint32_t first_slot, end_slot, first_voxel, end_voxel, first_row, end_row;

  std::uint64_t pairs() const { return std::uint64_t{end_slot - first_slot} * (end_voxel - first_voxel); }
  std::array<SampleChunk, 2> halves() const {
    SampleChunk a = *this, b = *this;
    if (end_slot - first_slot > 1) {
      a.end_slot = b.first_slot = first_slot + (end_slot - first_slot) / 2;
    } else if (end_voxel - first_voxel > 1) {
      a.end_voxel = b.first_voxel = first_voxel + (end_voxel - first_voxel) / 2;
    } else {
      a.end_row = b.first_row = first_row + (end_row - first_row) / 2;
    }
    return {a, b};
  }
};

void VulkanTracer::upload_sample(std::span<const std::uint32_t> sample,
                                 std::span<const std::vector<TraceStation>> networks) {
  const VoxelGrid& grid = *scene_.grid;
  const SceneData& scene = *scene_.scene;
  // Wider than the slack of cube_of in shaders/lib/sample.glsl for any station within range.
  const Box& bounds = scene.local_bounds;
  const double largest = std::max({std::abs(bounds.min.x), std::abs(bounds.min.y), std::abs(bounds.min.z),
                                   std::abs(bounds.max.x), std::abs(bounds.max.y), std::abs(bounds.max.z)}) +
                         static_cast<double>(scene_.pattern->max_range);
  const double margin = sample_reach(networks) + largest * 0x1p-17;
  if (sample_voxels_ && margin <= sample_margin_ && std::ranges::equal(sample, sample_)) return;
  const VoxelTriangles touching = triangles_touching(scene, grid, sample, margin);
  std::vector<SampleVoxel> voxels(sample.size() + 1);
  std::vector<SampleTriangle> triangles(touching.triangle.size());
  const auto corner = [](const Float3& p) { return vec3{p.x, p.y, p.z}; };
  tbb::parallel_for(std::size_t{0}, sample.size(), [&](std::size_t k) {
    const auto cell = morton_decode(grid.key(sample[k]));
    voxels[k] = {cell[0], cell[1], cell[2], touching.offset[k]};
    for (std::uint32_t i = touching.offset[k]; i < touching.offset[k + 1]; ++i) {
      const Triangle& t = scene.triangles[touching.triangle[i]];
      const Float3 &a = scene.positions[t[0]], &b = scene.positions[t[1]], &c = scene.positions[t[2]];
      triangles[i] = {corner(a), corner(b), corner(c), triangle_gap(a, b, c, grid, cell)};
    }
    std::sort(triangles.begin() + touching.offset[k], triangles.begin() + touching.offset[k + 1],
              [](const SampleTriangle& one, const SampleTriangle& other) { return one.gap < other.gap; });
  });
  voxels.back() = {0, 0, 0, touching.offset.back()};
  if (weights_) {
    std::vector<std::uint8_t> weights;
    for (const std::uint32_t rank : sample) weights.push_back(grid.weights()[rank]);
    sample_weights_ = bytes_to_device(weights, "sample weights");
  }
  sample_voxels_ = to_device<SampleVoxel>(voxels, "sample voxels");
  sample_triangles_ = to_device<SampleTriangle>(triangles, "sample triangles");
  sample_.assign(sample.begin(), sample.end());
  sample_margin_ = margin;
}

// How far noise may move a point into a voxel, seen from any station of the networks.
double VulkanTracer::sample_reach(std::span<const std::vector<TraceStation>> networks) const {
  if (!noise()) return 0;
  const VoxelGrid& grid = *scene_.grid;
  const double side = std::ldexp(grid.voxel_size(), static_cast<int>(grid.depth()));
  double farthest = grid.voxel_size();
  for (const auto& network : networks) {
    for (const TraceStation& station : network) {
      const double head[3] = {station.origin.x, station.origin.y, station.origin.z};
      double square = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const double from_low = head[axis] - grid.min()[axis];
        const double most = std::max(std::abs(from_low), std::abs(from_low - side));
        square += most * most;
      }
      farthest = std::max(farthest, std::sqrt(square));
    }
  }
  // In coarse steps, so that lists made for some networks mostly do for the next.
  farthest = std::exp2(std::ceil(4 * std::log2(farthest)) / 4);
  return static_cast<double>(
      reach_within(*scene_.noise, reaches_, static_cast<float>(farthest) + parameters_.noise_reach));
}

// Records the listing and tracing of one chunk, whose control words are number k of the submission.
void VulkanTracer::record_chunk(VkCommandBuffer c, const SampleChunk& chunk, SamplePush push, std::size_t k,
                                bool masks) {
  push.control = sample_control_.address() + k * control_words * sizeof(std::uint32_t);
  push.first_voxel = chunk.first_voxel;
  push.end_voxel = chunk.end_voxel;
  push.first_slot = chunk.first_slot;
  push.first_row = chunk.first_row;
  push.end_row = chunk.end_row;
  const VkDeviceSize dispatch = (k * control_words + control_dispatch) * sizeof(std::uint32_t);
  shader_after_shader(c);  // the chunk before still reads the list
  kernels_.get(Kernel::sample_list)
      .dispatch(c, push, groups_of(chunk.end_voxel - chunk.first_voxel), chunk.end_slot - chunk.first_slot);
  shader_after_shader(c);
  kernels_.get(Kernel::sample_arguments, {false}).dispatch(c, push, 1);
  shader_after_shader(c);
  kernels_.get(Kernel::sample_queue).bind(c, &push);
  vkCmdDispatchIndirect(c, sample_control_.handle(), dispatch);
  shader_after_shader(c);
  kernels_.get(Kernel::sample_arguments, {true}).dispatch(c, push, 1);
  shader_after_shader(c);
  kernels_.get(Kernel::sample_trace, {noise(), masks}).bind(c, &push);
  vkCmdDispatchIndirect(c, sample_control_.handle(), dispatch);
}

std::vector<NetworkCounts> VulkanTracer::count_sampled(std::span<const std::vector<TraceStation>> networks,
                                                       std::span<const std::uint32_t> station_counts,
                                                       const SampleJob& job, const Progress& progress) {
  std::vector<NetworkCounts> results(networks.size());
  if (networks.empty()) return results;
  upload_sample(job.sample, networks);
  const auto voxels = static_cast<std::uint32_t>(job.sample.size());
  const std::uint32_t most = *std::max_element(station_counts.begin(), station_counts.end());
  const std::uint32_t mask_words = job.masks ? (most > 32 ? 2 : 1) : 0;
  const std::uint32_t stride = totals_seen + most + most * (most - 1) / 2;
  ensure_totals(networks.size(), job.groups, stride);

  // A batch of networks shares counts and masks; a chunk of a batch is what one list of rays can hold.
  const std::uint64_t entries = std::uint64_t{1} << 25;
  const std::size_t batch_size =
      static_cast<std::size_t>(std::clamp<std::uint64_t>(entries / std::max(voxels, 1u), 1, networks.size()));
  const std::uint32_t ray_capacity =
      std::max<std::uint32_t>(info_.software ? 1u << 20 : 1u << 24, 2 * scene_.pattern->columns());
  const std::uint32_t item_capacity = std::max(1u << 16, 2 * scene_.pattern->columns() / sample_part);
  ensure(sample_rays_, std::uint64_t{ray_capacity} * sizeof(SampleRay), "sample rays");
  ensure(sample_items_, std::uint64_t{item_capacity} * sizeof(SampleItem), "sample items");
  ensure(counts_, std::uint64_t{voxels} * batch_size * sizeof(std::uint32_t), "counts");
  if (mask_words)
    ensure(masks_, std::uint64_t{voxels} * batch_size * mask_words * sizeof(std::uint32_t), "station masks");
  ensure(network_rays_, networks.size() * sizeof(std::uint64_t), "network rays");

  SamplePush base{};
  base.voxels = sample_voxels_.address();
  base.triangles = sample_triangles_.address();
  base.rays = sample_rays_.address();
  base.items = sample_items_.address();
  base.counts = counts_.address();
  base.masks = mask_words ? masks_.address() : 0;
  base.voxel_count = voxels;
  base.ray_capacity = ray_capacity;
  base.item_capacity = item_capacity;
  base.mask_words = mask_words;
  base.stop_at = job.masks ? 0 : job.stop_at;

  bool cancelled = false;
  double seconds = 0;
  std::vector<std::uint32_t> totals(networks.size() * job.groups * stride);
  std::vector<std::uint64_t> rays(networks.size());
  Reduction reduction{counts_.address(), base.masks, voxels, job.groups, mask_words, true};
  if (weights_) {
    reduction.weights = sample_weights_.address();
    reduction.weight.resize(job.groups);
    for (std::size_t k = 0; k < job.sample.size(); ++k)
      reduction.weight[k % job.groups] += scene_.grid->weight(job.sample[k]);
  }
  for (std::size_t first = 0; first < networks.size() && !cancelled; first += batch_size) {
    const std::size_t end = std::min(first + batch_size, networks.size());
    std::vector<SampleStation> slots;
    for (std::size_t n = first; n < end; ++n)
      for (const TraceStation& s : networks[n])
        slots.push_back({{s.origin.x, s.origin.y, s.origin.z}, s.place, static_cast<std::uint32_t>(n - first)});
    ensure(sample_stations_, slots.size() * sizeof(SampleStation), "sample stations");
    base.stations = sample_stations_.address();
    base.network_rays = network_rays_.address() + first * sizeof(std::uint64_t);
    const auto record_start = [&](VkCommandBuffer c) {
      if (first == 0) {
        record_update(c, station_counts_, station_counts.data(), station_counts.size_bytes());
        vkCmdFillBuffer(c, network_rays_.handle(), 0, VK_WHOLE_SIZE, 0);
      }
      record_update(c, sample_stations_, slots.data(), slots.size() * sizeof(SampleStation));
      vkCmdFillBuffer(c, counts_.handle(), 0, VK_WHOLE_SIZE, 0);
      if (mask_words) vkCmdFillBuffer(c, masks_.handle(), 0, VK_WHOLE_SIZE, 0);
    };

    // All of a batch goes into one submission where the device is quick enough for it; what turns out too long for the
    // list comes again in pieces, and the reduction with it.
    std::deque<SampleChunk> todo;
    if (!slots.empty() && voxels > 0)
      todo.push_back({0, static_cast<std::uint32_t>(slots.size()), 0, voxels, 0, scene_.pattern->rows()});
    const double all_pairs = static_cast<double>(slots.size()) * voxels;
    double done_pairs = 0;
    bool started = false;
    do {
      if (progress.stopped()) {
        cancelled = true;
        break;
      }
      // Chunks from the front of what is left, as large as the list will probably hold.
      std::vector<SampleChunk> chunks;
      for (double expected = 0; !todo.empty() && (chunks.empty() || expected < sampled_rays_per_submission_);) {
        SampleChunk chunk = todo.front();
        todo.pop_front();
        // 65 535 groups a dimension is what every device offers.
        while (chunk.end_slot - chunk.first_slot > 0xFFFFu ||
               groups_of(chunk.end_voxel - chunk.first_voxel) > 0xFFFFu ||
               (chunk.pairs() > 1 && static_cast<double>(chunk.pairs()) * rays_per_pair_ * 1.5 > ray_capacity)) {
          const auto [a, b] = chunk.halves();
          todo.push_front(b);
          chunk = a;
        }
        expected += static_cast<double>(chunk.pairs()) * rays_per_pair_;
        chunks.push_back(chunk);
      }
      const bool last = todo.empty();
      std::vector<std::uint32_t> control(std::max<std::size_t>(chunks.size(), 1) * control_words);
      ensure(sample_control_, control.size() * sizeof control[0], "sample control",
             VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
      std::vector<Commands::Download> wanted{{sample_control_, control.data(), control.size() * sizeof control[0]}};
      if (last && end == networks.size()) {
        wanted.push_back({totals_, totals.data(), totals.size() * sizeof totals[0]});
        wanted.push_back({network_rays_, rays.data(), rays.size() * sizeof rays[0]});
      }
      const auto record = [&](VkCommandBuffer c) {
        if (!started) record_start(c);
        vkCmdFillBuffer(c, sample_control_.handle(), 0, VK_WHOLE_SIZE, 0);
        if (last) {
          const VkDeviceSize of_network = std::uint64_t{job.groups} * stride * sizeof totals[0];
          vkCmdFillBuffer(c, totals_.handle(), first * of_network, (end - first) * of_network, 0);
        }
        shader_after_transfer(c);
        for (std::size_t k = 0; k < chunks.size(); ++k) record_chunk(c, chunks[k], base, k, job.masks);
        if (!last) return;
        shader_after_shader(c);
        record_reduction(c, reduction, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(end - first),
                         stride);
      };
      const double taken = commands_.run_and_download(record, wanted);
      started = true;
      seconds += taken;
      double listed_rays = 0;
      for (std::size_t k = chunks.size(); k-- > 0;) {
        const std::uint32_t listed = control[k * control_words + control_rays],
                            queued = control[k * control_words + control_items];
        if (listed > ray_capacity || queued > item_capacity) {
          const auto [a, b] = chunks[k].halves();
          todo.push_front(b);
          todo.push_front(a);
        } else {
          done_pairs += static_cast<double>(chunks[k].pairs()) * (chunks[k].end_row - chunks[k].first_row) /
                        scene_.pattern->rows();
          listed_rays += listed;
        }
        if (chunks[k].pairs() > 1000)
          rays_per_pair_ =
              0.5 * (rays_per_pair_ + static_cast<double>(listed) / static_cast<double>(chunks[k].pairs()));
      }
      if (listed_rays > 0.5 * ray_capacity)
        sampled_rays_per_submission_ = listed_rays / std::max(taken, 1e-6) * seconds_per_sampled_submission;
      progress((static_cast<double>(first) + static_cast<double>(end - first) * done_pairs / std::max(all_pairs, 1.0)) /
               static_cast<double>(networks.size()));
    } while (!todo.empty());
  }
  read_totals(results, station_counts, totals, reduction, stride);
  for (std::size_t n = 0; n < results.size(); ++n) {
    results[n].rays = rays[n];
    results[n].cancelled = cancelled;
    results[n].trace_seconds = seconds / static_cast<double>(results.size());
  }
  return results;
}

}  // namespace vantage::vulkan
