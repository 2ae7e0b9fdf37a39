// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/vulkan_tracer.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <deque>
#include <numeric>
#include <string>

#include "core/normal_table.hpp"
#include "shared/trace_types.h"
#include "trace/noise_reach.hpp"
#include "trace/triangle_gap.hpp"
#include "trace/vulkan/commands.hpp"
#include "trace/vulkan/compute_bvh/bvh.hpp"
#include "trace/vulkan/kernels.hpp"
#include "trace/vulkan/ray_query/acceleration_structure.hpp"
#include "vantage/error.hpp"
#include "voxel/voxel_triangles.hpp"

namespace vantage {
namespace {

using namespace vulkan;

static_assert(std::is_trivially_copyable_v<TraceParameters> && sizeof(Float3) == sizeof(vec3));

constexpr std::uint32_t group_size = 128;
// A dispatch of so many rays takes a fraction of a watchdog's limit even on a slow device of its kind.
constexpr double seconds_per_submission = 0.25;
// A population of samples is one submission where it takes no longer than this, half of the shortest usual limit.
constexpr double seconds_per_sampled_submission = 1, first_sampled_rays_per_submission = 1e9;
constexpr std::uint32_t stations_per_submission = 16, parts_per_submission = 256;
constexpr std::uint32_t dispatch_words = 3;  // of an indirect dispatch
constexpr std::uint64_t hardware_rays_per_dispatch = std::uint64_t{1} << 26,
                        software_rays_per_dispatch = std::uint64_t{1} << 19;

std::uint32_t groups_of(std::uint64_t threads, std::uint32_t size = group_size) {
  return static_cast<std::uint32_t>((threads + size - 1) / size);
}

std::string join(const std::vector<std::string>& parts) {
  return std::accumulate(parts.begin(), parts.end(), std::string(), [](std::string all, const std::string& part) {
    return all.empty() ? part : std::move(all) + ", " + part;
  });
}

EngineInfo describe(Engine engine, const DeviceAbilities& abilities, std::uint32_t index) {
  EngineInfo info;
  info.engine = engine;
  info.device = abilities.name;
  info.driver = abilities.driver;
  info.device_index = index;
  info.software = abilities.software();
  std::vector<std::string> lacks = abilities.compute_lacks;
  if (engine == Engine::ray_query)
    lacks.insert(lacks.end(), abilities.ray_query_lacks.begin(), abilities.ray_query_lacks.end());
  info.usable = lacks.empty();
  if (!info.usable) {
    info.reason = "lacks " + join(lacks);
    if (engine == Engine::ray_query && info.software && abilities.compute_lacks.empty())
      info.reason += "; install mesa-vulkan-drivers >= 24.1";
  } else {
    info.reason = info.software ? "a software device" : "usable";
  }
  return info;
}

bool validation_wanted(const TraceScene& scene) {
  const char* variable = std::getenv("VANTAGE_VALIDATION");
  return scene.validation || (variable && *variable && std::string(variable) != "0");
}

// Part of a batch of networks whose rays one list probably holds: slots × sampled voxels, or some rows of a single pair.
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

class VulkanTracer final : public Tracer {
 public:
  VulkanTracer(const EngineInfo& info, std::shared_ptr<Instance> instance, VkPhysicalDevice physical,
               const DeviceAbilities& abilities, const TraceScene& scene)
      : info_(info),
        scene_(scene),
        device_(std::move(instance), physical, abilities, info.engine == Engine::ray_query),
        commands_(device_),
        set_(build_traversal()),
        kernels_(device_, info.engine, set_) {
    if (scene.pattern->rows() > 0xFFFFu * block_rows ||
        std::uint64_t{scene.pattern->rows()} * scene.pattern->columns() >= std::uint64_t{1} << 31)
      throw Error(Errc::invalid_argument, "the scan pattern has " + std::to_string(scene.pattern->rows()) + " x " +
                                              std::to_string(scene.pattern->columns()) +
                                              " rays; this engine takes fewer than 2^31 a station: use larger steps");
    rays_per_submission_ = rays_per_dispatch();
    if (!info_.software) sampled_rays_per_submission_ = first_sampled_rays_per_submission;
    upload_scene();
  }

  const EngineInfo& info() const override { return info_; }
  std::uint64_t preferred_scan_rays() const override {
    const std::uint64_t columns = scene_.pattern->columns();
    return std::max<std::uint64_t>(std::min(rays_per_dispatch(), std::uint64_t{1} << 22) / columns, 1) * columns;
  }

  void scan(const TraceStation& station, std::uint64_t first_ray, std::uint64_t ray_count, std::uint32_t outputs,
            RawChunk& chunk) override;
  NetworkCounts count(std::span<const TraceStation> stations, std::uint32_t station_count, const CountOptions& options,
                      const Progress& progress) override;
  std::vector<NetworkCounts> count_sampled(std::span<const std::vector<TraceStation>> networks,
                                           std::span<const std::uint32_t> station_counts, const SampleJob& job,
                                           const Progress& progress) override;

 private:
  TraceSet build_traversal();
  void upload_scene();
  void upload_shading();
  void record_chunk(VkCommandBuffer c, const SampleChunk& chunk, SamplePush push, std::size_t k, bool masks);
  void upload_sample(std::span<const std::uint32_t> sample, std::span<const std::vector<TraceStation>> networks);
  double sample_reach(std::span<const std::vector<TraceStation>> networks) const;
  void write_parameters() { commands_.upload(parameters_buffer_, &parameters_, sizeof parameters_); }
  bool noise() const { return scene_.noise && scene_.noise->enabled(); }
  std::uint64_t rays_per_dispatch() const {
    if (scene_.max_rays_per_dispatch > 0) return scene_.max_rays_per_dispatch;
    return info_.software ? software_rays_per_dispatch : hardware_rays_per_dispatch;
  }
  std::uint32_t goal_points() const {
    return static_cast<std::uint32_t>(std::min(std::ceil(goal_density_), static_cast<double>(count_limit)));
  }
  // So that even `voxels` squares of almost the goal fit in 64 bits: 0 for every goal that scanners reach.
  std::uint32_t difference_shift(std::uint32_t voxels) const {
    const int bits = 2 * static_cast<int>(std::bit_width(goal_points())) + static_cast<int>(std::bit_width(voxels));
    return static_cast<std::uint32_t>(std::max(0, bits - 62) / 2);
  }
  std::uint32_t rows_per_dispatch() const {
    const std::uint64_t rows = rays_per_dispatch() / scene_.pattern->columns() / tile_side * tile_side;
    return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(rows, tile_side, 0xFFFFu * std::uint64_t{block_rows}));
  }

  // Grows a buffer that is kept from call to call.
  void ensure(Buffer& buffer, VkDeviceSize bytes, const char* name, VkBufferUsageFlags extra = 0) {
    if (!buffer || buffer.size() < bytes) {
      buffer = Buffer();  // the old one goes first, so that both never exist at once
      buffer = Buffer(device_, bytes, Buffer::Where::device, name, extra);
    }
  }
  template <class T>
  Buffer to_device(std::span<const T> values, const char* name) {
    return make_device_buffer<T>(device_, commands_, values, name);
  }
  // In whole words, as shaders read them.
  Buffer bytes_to_device(std::span<const std::uint8_t> bytes, const char* name) {
    std::vector<std::uint8_t> padded(bytes.begin(), bytes.end());
    padded.resize((bytes.size() + 3) / 4 * 4);
    return to_device<std::uint8_t>(padded, name);
  }

  // Records the reduction of `networks` blocks of counts and masks, and reads totals back into counts.
  struct Reduction {
    std::uint64_t counts, masks;  // addresses
    std::uint32_t voxels, groups, mask_words;
    bool differences;
    std::uint64_t weights = 0;              // address, where voxels have any
    std::vector<std::uint64_t> weight = {};  // of each group then
  };
  void record_reduction(VkCommandBuffer c, const Reduction& r, std::uint32_t first_network, std::uint32_t networks,
                        std::uint32_t stride);
  void read_totals(std::span<NetworkCounts> counts, std::span<const std::uint32_t> station_counts,
                   std::span<const std::uint32_t> totals, const Reduction& r, std::uint32_t stride) const;
  void ensure_totals(std::size_t networks, std::uint32_t groups, std::uint32_t stride);
  void record_totals_start(VkCommandBuffer c, std::span<const std::uint32_t> station_counts);

  EngineInfo info_;
  TraceScene scene_;
  Device device_;
  Commands commands_;
  std::unique_ptr<AccelerationStructure> structure_;  // ray_query
  Buffer nodes_, bvh_triangles_;                      // compute_bvh
  TraceParameters parameters_{};                      // before set_, whose making fills a part of it
  Buffer parameters_buffer_;
  TraceSet set_;
  Kernels kernels_;
  Buffer sin_zenith_, cos_zenith_, sin_azimuth_, cos_azimuth_, bricks_, slots_;
  Buffer positions_, normals_, triangles_, diffuse_, sigma_, noise_reaches_, normal_table_;  // filled when first needed
  Buffer weights_;  // of voxels, where they have any
  Buffer counts_, masks_, station_counters_, totals_, station_counts_;
  Buffer tile_far_, tile_list_, tile_dispatch_, tile_rays_, tile_starts_;
  std::uint64_t rays_per_submission_ = 0;  // follows the speed seen; sizes the submissions, not the results

  std::vector<std::uint32_t> sample_;  // what the sample buffers hold
  double sample_margin_ = 0;           // how far from its voxel a triangle is listed there
  NoiseReaches reaches_{};             // where there is noise
  Buffer sample_voxels_, sample_triangles_, sample_stations_, sample_rays_, sample_items_, sample_control_,
      network_rays_, sample_weights_;
  // As seen so far; they size chunks and submissions, not the results.
  double rays_per_pair_ = 8;
  double sampled_rays_per_submission_ = 0;
};

TraceSet VulkanTracer::build_traversal() {
  parameters_buffer_ = Buffer(device_, sizeof parameters_, Buffer::Where::device, "trace parameters",
                              VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
  const SceneData& scene = *scene_.scene;
  std::vector<std::uint32_t> ids(scene.triangles.size());
  for (std::size_t m = 0; m < scene.ranges.size(); ++m) {
    const std::uint32_t bit = scene.meshes[m].role == Role::surveyed ? surveyed_bit : 0;
    for (std::uint32_t t = 0; t < scene.ranges[m].triangle_count; ++t)
      ids[scene.ranges[m].first_triangle + t] = (scene.ranges[m].first_triangle + t) | bit;
  }
  if (info_.engine == Engine::ray_query) {
    structure_ = std::make_unique<AccelerationStructure>(device_, commands_, scene.positions, scene.triangles, ids,
                                                         scene_.sort_triangles);
    parameters_.primitive_ids = structure_->primitive_ids();
    return TraceSet(device_, parameters_buffer_, structure_->handle());
  }
  const Bvh bvh = build_bvh(scene.positions, scene.triangles, ids);
  nodes_ = to_device<BvhNode>(bvh.nodes, "BVH nodes");
  bvh_triangles_ = to_device<BvhTriangle>(bvh.triangles, "BVH triangles");
  parameters_.nodes = nodes_.address();
  parameters_.bvh_triangles = bvh_triangles_.address();
  return TraceSet(device_, parameters_buffer_, VK_NULL_HANDLE);
}

void VulkanTracer::upload_scene() {
  const RayPattern& pattern = *scene_.pattern;
  const VoxelGrid& grid = *scene_.grid;
  sin_zenith_ = to_device<float>(pattern.sin_zenith, "sin zenith");
  cos_zenith_ = to_device<float>(pattern.cos_zenith, "cos zenith");
  sin_azimuth_ = to_device<float>(pattern.sin_azimuth, "sin azimuth");
  cos_azimuth_ = to_device<float>(pattern.cos_azimuth, "cos azimuth");
  if (!grid.weights().empty()) weights_ = bytes_to_device(grid.weights(), "voxel weights");
  bricks_ = to_device<VoxelBrick>(grid.bricks(), "voxel bricks");
  slots_ = to_device<BrickSlot>(grid.slots(), "brick slots");
  TraceParameters& p = parameters_;
  p.sin_zenith = sin_zenith_.address();
  p.cos_zenith = cos_zenith_.address();
  p.sin_azimuth = sin_azimuth_.address();
  p.cos_azimuth = cos_azimuth_.address();
  p.bricks = bricks_.address();
  p.slots = slots_.address();
  p.rows = pattern.rows();
  p.columns = pattern.columns();
  p.min_range = pattern.min_range;
  p.max_range = pattern.max_range;
  p.voxel_min = {grid.min()[0], grid.min()[1], grid.min()[2]};
  p.voxel_inverse_size = grid.inverse_size();
  p.voxel_cells = 1u << grid.depth();
  p.slot_mask = static_cast<std::uint32_t>(grid.slots().size() - 1);
  p.brick_count = static_cast<std::uint32_t>(grid.bricks().size());
  p.brick_size = static_cast<float>(grid.voxel_size() * (1u << brick_bits));
  const Box& bounds = scene_.scene->local_bounds;
  p.bounds_min = {static_cast<float>(bounds.min.x), static_cast<float>(bounds.min.y), static_cast<float>(bounds.min.z)};
  p.bounds_max = {static_cast<float>(bounds.max.x), static_cast<float>(bounds.max.y), static_cast<float>(bounds.max.z)};
  p.zenith_step = static_cast<float>(pattern.zenith_step);
  p.azimuth_step = static_cast<float>(pattern.azimuth_step);
  p.first_zenith = static_cast<float>(pattern.first_zenith);
  p.first_azimuth = static_cast<float>(pattern.first_azimuth);
  p.has_normals = scene_.scene->normals.empty() ? 0 : 1;
  if (noise()) {
    const NoiseModel& model = *scene_.noise;
    sigma_ = to_device<float>(model.sigma, "sigma table");
    normal_table_ = to_device<float>(normal_table(), "normal table");
    p.sigma = sigma_.address();
    reaches_ = noise_reaches(model);
    noise_reaches_ = to_device<float>(reaches_, "noise reaches");
    p.noise_reaches = noise_reaches_.address();
    p.normal_table = normal_table_.address();
    p.noise_reach = model.reach;
    p.noise_min_range = model.min_range;
    p.noise_inverse_span = model.inverse_span;
    p.seed_low = static_cast<std::uint32_t>(model.seed);
    p.seed_high = static_cast<std::uint32_t>(model.seed >> 32);
  }
  if (noise())
    upload_shading();
  else
    write_parameters();
}

void VulkanTracer::upload_shading() {
  if (positions_) return;
  const SceneData& scene = *scene_.scene;
  positions_ = to_device<Float3>(scene.positions, "positions");
  triangles_ = to_device<Triangle>(scene.triangles, "triangles");
  std::vector<float> diffuse(scene.triangles.size());
  for (std::size_t m = 0; m < scene.ranges.size(); ++m)
    std::fill_n(diffuse.begin() + scene.ranges[m].first_triangle, scene.ranges[m].triangle_count,
                static_cast<float>(scene.meshes[m].diffuse));
  diffuse_ = to_device<float>(diffuse, "diffuse coefficients");
  if (!scene.normals.empty()) normals_ = to_device<Float3>(scene.normals, "normals");
  parameters_.positions = positions_.address();
  parameters_.triangles = triangles_.address();
  parameters_.diffuse = diffuse_.address();
  parameters_.normals = scene.normals.empty() ? 0 : normals_.address();
  write_parameters();
}

void VulkanTracer::scan(const TraceStation& station, std::uint64_t first_ray, std::uint64_t ray_count,
                        std::uint32_t outputs, RawChunk& chunk) {
  const std::uint32_t columns = scene_.pattern->columns();
  if (outputs & (normal | reflectivity | barycentric)) upload_shading();
  const auto rows = static_cast<std::uint32_t>(ray_count / columns);

  ScanPush push{};
  push.origin = {station.origin.x, station.origin.y, station.origin.z};
  push.place = station.place;
  std::array<Buffer, 7> buffers;
  std::size_t used = 0;
  struct Copy {
    const Buffer* from;
    void* to;
    VkDeviceSize bytes;
  };
  std::vector<Copy> copies;
  const auto want = [&](std::uint32_t bit, auto& array, std::uint64_t& address, const char* name) {
    array.clear();
    if (!(outputs & bit)) return;
    array.resize(ray_count);
    const VkDeviceSize bytes = ray_count * sizeof array[0];
    Buffer& buffer = buffers[used++] = Buffer(device_, bytes, Buffer::Where::device, name);
    address = buffer.address();
    copies.push_back({&buffer, array.data(), bytes});
  };
  want(range, chunk.range, push.range, "scan range");
  want(position, chunk.position, push.position, "scan position");
  want(normal, chunk.normal, push.normal, "scan normal");
  want(reflectivity, chunk.reflectivity, push.reflectivity, "scan reflectivity");
  want(primitive, chunk.primitive, push.primitive, "scan primitive");
  want(barycentric, chunk.barycentric, push.barycentric, "scan barycentric");
  want(voxel, chunk.voxel, push.voxel, "scan voxel");

  // The arrays hold rays from first_ray on; a part's rows are counted from there, so its outputs move along.
  const ComputePipeline& pipeline = kernels_.get(Kernel::scan, {noise()});
  const auto first_row = static_cast<std::uint32_t>(first_ray / columns);
  for (std::uint32_t row = 0; row < rows; row += rows_per_dispatch()) {
    ScanPush part = push;
    part.first_row = first_row + row;
    part.row_count = std::min(rows_per_dispatch(), rows - row);
    const std::uint64_t skip = std::uint64_t{row} * columns;
    for (auto [address, size] : {std::pair{&part.range, sizeof(float)},
                                 {&part.position, sizeof(Float3)},
                                 {&part.normal, sizeof(Float3)},
                                 {&part.reflectivity, sizeof(float)},
                                 {&part.primitive, sizeof(std::uint32_t)},
                                 {&part.barycentric, sizeof(Float2)},
                                 {&part.voxel, sizeof(std::uint32_t)}})
      if (*address) *address += skip * size;
    commands_.run([&](VkCommandBuffer c) {
      pipeline.dispatch(c, part, groups_of(columns, block_columns), groups_of(part.row_count, block_rows));
    });
  }
  for (const Copy& copy : copies) commands_.download(*copy.from, copy.to, copy.bytes);
}

void VulkanTracer::ensure_totals(std::size_t networks, std::uint32_t groups, std::uint32_t stride) {
  ensure(totals_, networks * groups * stride * sizeof(std::uint32_t), "totals");
  ensure(station_counts_, networks * sizeof(std::uint32_t), "station counts");
}

void VulkanTracer::record_totals_start(VkCommandBuffer c, std::span<const std::uint32_t> station_counts) {
  record_update(c, station_counts_, station_counts.data(), station_counts.size_bytes());
  vkCmdFillBuffer(c, totals_.handle(), 0, VK_WHOLE_SIZE, 0);
}

void VulkanTracer::record_reduction(VkCommandBuffer c, const Reduction& r, std::uint32_t first_network,
                                    std::uint32_t networks, std::uint32_t stride) {
  ReducePush push{};
  push.counts = r.counts;
  push.masks = r.masks;
  push.totals = totals_.address();
  push.station_counts = station_counts_.address();
  push.weights = r.weights;
  push.voxel_count = r.voxels;
  push.goal = goal_points();
  push.difference_shift = difference_shift(r.voxels);
  push.mask_words = r.mask_words;
  push.groups = r.groups;
  push.totals_stride = stride;
  push.first_network = first_network;
  push.with_differences = r.differences ? 1 : 0;
  const std::uint32_t in_group = groups_of(r.voxels, r.groups);
  kernels_.get(Kernel::reduce)
      .dispatch(c, push, groups_of(in_group, reduce_voxels * reduce_rounds), r.groups, networks);
}

void VulkanTracer::read_totals(std::span<NetworkCounts> counts, std::span<const std::uint32_t> station_counts,
                               std::span<const std::uint32_t> totals, const Reduction& r, std::uint32_t stride) const {
  for (std::size_t n = 0; n < counts.size(); ++n) {
    NetworkCounts& sum = counts[n];
    const std::uint32_t stations = station_counts[n], pairs = stations * (stations - 1) / 2;
    sum.voxels = r.voxels;
    sum.stations = stations;
    if (r.mask_words) {
      sum.seen.assign(stations, 0);
      sum.shared.assign(pairs, 0);
    }
    std::uint64_t squares = 0, edge_points = 0, edges = 0;
    for (std::uint32_t g = 0; g < r.groups; ++g) {
      const std::uint32_t* t = totals.data() + (n * r.groups + g) * stride;
      NetworkCounts group;
      group.voxels = (r.voxels + r.groups - 1 - g) / r.groups;
      group.stations = stations;
      group.weight = r.weights ? r.weight[g] : group.voxels;
      group.saturated = t[totals_saturated] | std::uint64_t{t[totals_saturated + 1]} << 32;
      group.partial_points = t[totals_partial] | std::uint64_t{t[totals_partial + 1]} << 32;
      squares += t[totals_squares] | std::uint64_t{t[totals_squares + 1]} << 32;
      edge_points += t[totals_edge_points] | std::uint64_t{t[totals_edge_points + 1]} << 32;
      edges += t[totals_edges];
      if (r.mask_words) {
        group.seen.assign(t + totals_seen, t + totals_seen + stations);
        group.shared.assign(t + totals_seen + stations, t + totals_seen + stations + pairs);
        for (std::uint32_t k = 0; k < stations; ++k) sum.seen[k] += group.seen[k];
        for (std::uint32_t k = 0; k < pairs; ++k) sum.shared[k] += group.shared[k];
      }
      sum.weight += group.weight;
      sum.saturated += group.saturated;
      sum.partial_points += group.partial_points;
      if (r.groups > 1) sum.groups.push_back(std::move(group));
    }
    // Where one voxel is saturated, (1 − c / goal)² = 1 − 2 c / goal + c² / goal².
    const double unit = std::ldexp(1.0, static_cast<int>(difference_shift(r.voxels))) / goal_density_;
    sum.successive_difference_sum = static_cast<double>(squares) * unit * unit -
                                    2 * static_cast<double>(edge_points) * unit + static_cast<double>(edges);
  }
}

NetworkCounts VulkanTracer::count(std::span<const TraceStation> stations, std::uint32_t station_count,
                                  const CountOptions& options, const Progress& progress) {
  const auto voxels = static_cast<std::uint32_t>(scene_.grid->size());
  const std::uint32_t columns = scene_.pattern->columns(), rows = scene_.pattern->rows();
  const std::uint32_t mask_words = options.masks ? (station_count > 32 ? 2 : 1) : 0;
  ensure(counts_, voxels * sizeof(std::uint32_t), "counts");
  if (mask_words) ensure(masks_, std::uint64_t{voxels} * mask_words * sizeof(std::uint32_t), "station masks");
  ensure(station_counters_, 64 * 4 * sizeof(std::uint32_t), "station counters");
  const std::uint32_t tiles_in_row = groups_of(columns, tile_side), tiles = tiles_in_row * groups_of(rows, tile_side);
  const std::uint64_t list_words = std::uint64_t{tiles} * stations_per_submission + parts_per_submission;
  const bool with_starts = info_.engine == Engine::compute_bvh;
  if (options.skip) {
    ensure(tile_far_, std::uint64_t{tiles} * stations_per_submission * sizeof(std::uint32_t), "tile far");
    ensure(tile_list_, list_words * sizeof(std::uint32_t), "tile list");
    ensure(tile_dispatch_, parts_per_submission * dispatch_words * sizeof(std::uint32_t), "tile dispatch",
           VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
    ensure(tile_rays_, 2 * sizeof(std::uint32_t), "tile rays");
    if (with_starts) ensure(tile_starts_, list_words * tile_starts * sizeof(TileStart), "tile starts");
  }
  const std::array<std::uint32_t, 1> station_counts{station_count};
  const std::uint32_t stride = totals_seen + station_count + station_count * (station_count - 1) / 2;
  ensure_totals(1, 1, stride);
  Reduction reduction{counts_.address(), mask_words ? masks_.address() : 0, voxels, 1, mask_words, false};
  if (weights_) {
    reduction.weights = weights_.address();
    reduction.weight = {scene_.grid->total_weight()};
  }

  struct Part {  // rows of a station
    std::uint32_t station, first_row, row_count, slot;
    std::uint64_t list;  // its list of tiles within tile_list_, in words
  };
  const auto tile_push = [&](const Part& part, std::size_t k) {
    TilePush push{};
    push.tile_far = tile_far_.address() + std::uint64_t{part.slot} * tiles * sizeof(std::uint32_t);
    push.tile_list = tile_list_.address() + part.list * sizeof(std::uint32_t);
    push.dispatch = tile_dispatch_.address() + k * dispatch_words * sizeof(std::uint32_t);
    push.rays = tile_rays_.address();
    if (with_starts) push.starts = tile_starts_.address() + part.list * tile_starts * sizeof(TileStart);
    const Float3& origin = stations[part.station].origin;
    push.origin = {origin.x, origin.y, origin.z};
    push.first_row = part.first_row;
    push.row_count = part.row_count;
    return push;
  };
  std::uint64_t since_clamp = 0;
  const auto record_parts = [&](VkCommandBuffer c, std::span<const Part> parts) {
    if (options.skip) {
      vkCmdFillBuffer(c, tile_far_.handle(), 0, VK_WHOLE_SIZE, 0);
      vkCmdFillBuffer(c, tile_list_.handle(), 0, VK_WHOLE_SIZE, 0);
      vkCmdFillBuffer(c, tile_dispatch_.handle(), 0, VK_WHOLE_SIZE, 0);
    }
    shader_after_transfer(c);
    if (options.skip) {
      for (std::size_t k = 0; k < parts.size(); ++k)
        if (k == 0 || parts[k].slot != parts[k - 1].slot)
          kernels_.get(Kernel::tiles).dispatch(c, tile_push(parts[k], k), groups_of(scene_.grid->bricks().size()));
      shader_after_shader(c);
      for (std::size_t k = 0; k < parts.size(); ++k)
        kernels_.get(Kernel::tile_list)
            .dispatch(c, tile_push(parts[k], k),
                      groups_of(std::uint64_t{groups_of(parts[k].row_count, tile_side)} * tiles_in_row));
      shader_after_shader(c);
      for (std::size_t k = 0; with_starts && k < parts.size(); ++k)
        kernels_.get(Kernel::tile_starts)
            .dispatch(c, tile_push(parts[k], k),
                      groups_of(std::uint64_t{groups_of(parts[k].row_count, tile_side)} * tiles_in_row));
      if (with_starts) shader_after_shader(c);
    }
    // Counts are sums, so the parts need not wait for each other.
    const ComputePipeline& pipeline = kernels_.get(Kernel::count, {noise(), options.masks, options.skip});
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const Part& part = parts[k];
      const TraceStation& station = stations[part.station];
      const std::uint64_t rays = std::uint64_t{part.row_count} * columns;
      if (since_clamp + rays > count_limit - 1) {
        shader_after_shader(c);
        const std::uint32_t groups = groups_of(voxels);
        kernels_.get(Kernel::clamp)
            .dispatch(c, ClampPush{counts_.address(), voxels, 0}, std::min(groups, 32768u), groups_of(groups, 32768u));
        shader_after_shader(c);
        since_clamp = 0;
      }
      since_clamp += rays;
      CountPush push{};
      push.counts = counts_.address();
      push.masks =
          mask_words ? masks_.address() + std::uint64_t{station.place / 32} * voxels * sizeof(std::uint32_t) : 0;
      push.station_counters = station_counters_.address();
      push.origin = {station.origin.x, station.origin.y, station.origin.z};
      push.place = station.place;
      push.first_row = part.first_row;
      push.row_count = part.row_count;
      if (!options.skip) {
        pipeline.dispatch(c, push, groups_of(columns, block_columns), groups_of(push.row_count, block_rows));
        continue;
      }
      const TilePush tile = tile_push(part, k);
      push.tile_far = tile.tile_far;
      push.tile_list = tile.tile_list;
      push.starts = tile.starts;
      pipeline.bind(c, &push);
      vkCmdDispatchIndirect(c, tile_dispatch_.handle(), k * dispatch_words * sizeof(std::uint32_t));
    }
  };

  NetworkCounts result;
  std::array<std::uint64_t, 64 * 2> counters{};
  std::uint64_t tile_rays = 0;
  std::vector<std::uint32_t> totals(stride);
  std::vector<Commands::Download> wanted{{totals_, totals.data(), stride * sizeof(std::uint32_t)},
                                         {station_counters_, counters.data(), sizeof counters}};
  if (options.skip) wanted.push_back({tile_rays_, &tile_rays, sizeof tile_rays});

  // As much work a submission as reports and stops in time.
  const std::uint64_t all_rays = std::uint64_t{rows} * columns * stations.size();
  std::uint64_t done_rays = 0;
  std::uint32_t station = 0, row = 0;
  for (bool first = true, last = false; !last; first = false) {
    std::vector<Part> parts;
    std::uint64_t rays = 0, list = 0;
    std::uint32_t slots = 0;
    result.cancelled = progress.stopped();
    while (!result.cancelled && station < stations.size() && rays < rays_per_submission_ &&
           parts.size() < parts_per_submission) {
      const bool same_station = !parts.empty() && parts.back().station == station;
      if (!same_station && slots == stations_per_submission) break;
      if (!same_station) ++slots;
      const std::uint32_t row_count = std::min(rows_per_dispatch(), rows - row);
      parts.push_back({station, row, row_count, slots - 1, list});
      list += 1 + std::uint64_t{groups_of(row_count, tile_side)} * tiles_in_row;
      rays += std::uint64_t{row_count} * columns;
      row += row_count;
      if (row == rows) {
        row = 0;
        ++station;
      }
    }
    last = result.cancelled || station == stations.size();
    const auto record = [&](VkCommandBuffer c) {
      if (first) {
        vkCmdFillBuffer(c, counts_.handle(), 0, voxels * sizeof(std::uint32_t), 0);
        if (mask_words)
          vkCmdFillBuffer(c, masks_.handle(), 0, std::uint64_t{voxels} * mask_words * sizeof(std::uint32_t), 0);
        vkCmdFillBuffer(c, station_counters_.handle(), 0, VK_WHOLE_SIZE, 0);
        if (options.skip) vkCmdFillBuffer(c, tile_rays_.handle(), 0, VK_WHOLE_SIZE, 0);
        record_totals_start(c, station_counts);
      }
      record_parts(c, parts);
      if (!last) return;
      shader_after_shader(c);
      record_reduction(c, reduction, 0, 1, stride);
    };
    const double seconds = commands_.run_and_download(
        record, last ? std::span<const Commands::Download>(wanted) : std::span<const Commands::Download>());
    result.trace_seconds += seconds;
    done_rays += rays;
    if (rays >= rays_per_dispatch() && seconds > 0)
      rays_per_submission_ =
          static_cast<std::uint64_t>(std::clamp(static_cast<double>(rays) / seconds * seconds_per_submission,
                                                static_cast<double>(rays_per_dispatch()), 1e12));
    if (!result.cancelled) progress(static_cast<double>(done_rays) / static_cast<double>(all_rays));
  }
  read_totals({&result, 1}, station_counts, totals, reduction, stride);

  result.points_on_surveyed.assign(station_count, 0);
  if (!options.skip) result.points.assign(station_count, 0);
  for (const TraceStation& each : stations) {
    if (!options.skip) result.points[each.place] = counters[2 * each.place];
    result.points_on_surveyed[each.place] = counters[2 * each.place + 1];
  }
  result.rays = options.skip ? tile_rays : all_rays;
  if (options.field) {
    options.field->count.resize(voxels);
    commands_.download(counts_, options.field->count.data(), voxels * sizeof(std::uint32_t));
    options.field->stations.assign(options.masks ? voxels : 0, 0);
    std::vector<std::uint32_t> word(voxels);
    for (std::uint32_t w = 0; w < mask_words; ++w) {
      commands_.download(masks_, word.data(), voxels * sizeof(std::uint32_t),
                         std::uint64_t{w} * voxels * sizeof(std::uint32_t));
      for (std::uint32_t v = 0; v < voxels; ++v) options.field->stations[v] |= std::uint64_t{word[v]} << (32 * w);
    }
  }
  return result;
}

void VulkanTracer::upload_sample(std::span<const std::uint32_t> sample, std::span<const std::vector<TraceStation>> networks) {
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
  return static_cast<double>(reach_within(*scene_.noise, reaches_, static_cast<float>(farthest) + parameters_.noise_reach));
}

// Records the listing and tracing of one chunk, whose control words are number k of the submission.
void VulkanTracer::record_chunk(VkCommandBuffer c, const SampleChunk& chunk, SamplePush push, std::size_t k, bool masks) {
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

    // All of a batch goes into one submission where the device is quick enough for it; what turns out too long for the list comes again in
    // pieces, and the reduction with it.
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
      ensure(sample_control_, control.size() * sizeof control[0], "sample control", VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
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

}  // namespace

std::vector<EngineInfo> list_vulkan_engines() {
  std::vector<EngineInfo> engines;
  try {
    const auto instance = Instance::get(false);
    const auto devices = instance->physical_devices();
    for (std::uint32_t d = 0; d < devices.size(); ++d) {
      const DeviceAbilities abilities = abilities_of(devices[d]);
      engines.push_back(describe(Engine::ray_query, abilities, d));
      engines.push_back(describe(Engine::compute_bvh, abilities, d));
    }
    if (!devices.empty()) return engines;
    throw Error(Errc::no_suitable_device,
                "Vulkan finds no device; install a driver (Debian: mesa-vulkan-drivers >= 24.1)");
  } catch (const Error& error) {
    for (const Engine engine : {Engine::ray_query, Engine::compute_bvh}) {
      EngineInfo info;
      info.engine = engine;
      info.device = "none";
      info.reason = error.what();
      engines.push_back(info);
    }
  }
  return engines;
}

std::unique_ptr<Tracer> make_vulkan_tracer(Engine engine, std::optional<std::uint32_t> device,
                                           const TraceScene& scene) {
  const auto instance = Instance::get(validation_wanted(scene));
  const auto devices = instance->physical_devices();
  std::vector<std::string> refusals;
  std::optional<std::uint32_t> best;
  DeviceAbilities best_abilities;
  // Hardware before software, discrete before integrated, then the most memory.
  const auto better = [](const DeviceAbilities& a, const DeviceAbilities& b) {
    const auto rank = [](const DeviceAbilities& x) {
      return x.type == VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU     ? 3
             : x.type == VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU ? 2
             : x.software()                                     ? 0
                                                                : 1;
    };
    return rank(a) != rank(b) ? rank(a) > rank(b) : a.memory_bytes > b.memory_bytes;
  };
  for (std::uint32_t d = 0; d < devices.size(); ++d) {
    if (device && *device != d) continue;
    const DeviceAbilities abilities = abilities_of(devices[d]);
    const EngineInfo info = describe(engine, abilities, d);
    if (!info.usable)
      refusals.push_back("device " + std::to_string(d) + ", " + info.device + ": " + info.reason);
    else if (!best || better(abilities, best_abilities)) {
      best = d;
      best_abilities = abilities;
    }
  }
  if (device && *device >= devices.size())
    refusals.push_back("there are only " + std::to_string(devices.size()) + " devices, counted from 0");
  if (!best)
    throw Error(Errc::no_suitable_device,
                "no Vulkan device can run the engine " + to_string(engine) +
                    (engine == Engine::ray_query ? "; it needs VK_KHR_ray_query: a GPU with ray tracing, or "
                                                   "mesa-vulkan-drivers >= 24.1 for the software device"
                                                 : "; it needs Vulkan 1.2"),
                std::move(refusals));
  return std::make_unique<VulkanTracer>(describe(engine, best_abilities, *best), instance, devices[*best],
                                        best_abilities, scene);
}

}  // namespace vantage
