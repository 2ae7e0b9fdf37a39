// SPDX-License-Identifier: Apache-2.0
// The engine interface: stations in; points, counts and station masks out. An engine knows rays, triangles and voxels,
// but no objective. To add an engine: one folder, one enumerator, one line in make_tracer.cpp; the conformance suite
// then includes it.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "scene/scene_data.hpp"
#include "trace/direction_list.hpp"
#include "trace/pass_field.hpp"
#include "vantage/progress.hpp"
#include "vantage/trace.hpp"
#include "voxel/voxel_grid.hpp"
#include "voxel/voxel_triangles.hpp"

namespace vantage {

// Directions of all rays in the scanner's frame, as products of table entries: d(i, j) = (sin_zenith[i]·cos_azimuth[j],
// sin_zenith[i]·sin_azimuth[j], cos_zenith[i]). The tables are computed in double and rounded once, so the result does
// not depend on an engine's sine. A list of directions without a grid has a row for each and one column.
struct RayPattern {
  std::vector<float> sin_zenith, cos_zenith;       // rows
  std::vector<float> sin_azimuth, cos_azimuth;     // columns
  std::shared_ptr<const DirectionList> list = {};  // has the azimuths of a list's rays; null: a grid
  // rays start at min_range and end at max_range, as in the paper: anything nearer is ignored
  float min_range = 0, max_range = 0;
  // Radians; used by the inverse, rays_of_box(). Rows that are not all one step apart have no zenith_step, and their
  // zeniths, ascending, are listed.
  double zenith_step = 0, azimuth_step = 0;
  std::vector<double> zeniths = {};
  double first_zenith = 0, first_azimuth = 0;  // of ray (0, 0)
  std::uint32_t rows() const { return static_cast<std::uint32_t>(sin_zenith.size()); }
  std::uint32_t columns() const { return static_cast<std::uint32_t>(sin_azimuth.size()); }
  Float3 direction(std::uint64_t row, std::uint64_t column) const {
    const float sine = sin_zenith[row];
    if (list) return {sine * list->cos_azimuth[row], sine * list->sin_azimuth[row], cos_zenith[row]};
    return {sine * cos_azimuth[column], sine * sin_azimuth[column], cos_zenith[row]};
  }
  // Returns the angle between two rows.
  double rows_apart(std::uint32_t upper, std::uint32_t lower) const {
    return zeniths.empty() ? (lower - upper) * zenith_step : zeniths[lower] - zeniths[upper];
  }
  // Returns the product of the steps of zenith and azimuth; uneven rows and lists count as even.
  double cell() const {
    if (zeniths.size() < 2) return (zenith_step > 0 ? zenith_step : azimuth_step) * azimuth_step;
    return (zeniths.back() - zeniths.front()) / static_cast<double>(zeniths.size() - 1) * azimuth_step;
  }
};

// Algorithm 1: σ by bilinear interpolation over normalised distance (columns) and reflectivity (rows), both in [0, 1],
// in steps of 0.01.
struct NoiseModel {
  static constexpr std::uint32_t kSide = 101;
  std::vector<float> sigma;  // kSide × kSide, row-major [reflectivity][distance]; empty: no noise
  float min_range = 0;       // normalised distance = (t − min_range) · inverse_span
  float inverse_span = 0;
  std::uint64_t seed = 0;
  float reach = 0;  // no point moves further: 5 · max σ
  bool enabled() const { return !sigma.empty(); }
};

// Limits that a point must meet to count. They are checked on the hit itself, before noise moves the point
// (docs/method.md). 0: no limit.
struct LimitModel {
  struct Limits {
    float least_cosine_square = 0;       // angle between ray and normal
    float largest_footprint_square = 0;  // major axis of the beam on the surface, metres squared
    float largest_sigma = 0;             // range, metres
    // Squared distance, in metres squared, from which an echo at normal incidence is just detected. A scan has no point
    // that misses this limit, on blocking meshes either.
    float largest_reach_square = 0;
    friend bool operator==(const Limits&, const Limits&) = default;
  };
  std::vector<Limits> meshes;                    // one per mesh of the scene; empty: every point counts
  float exit_diameter = 0;                       // of the beam, metres
  float divergence = 0;                          // full angle, radians
  std::shared_ptr<const NoiseModel> noise = {};  // table for σ, whether noise is applied or not; set if σ is limited
  // A ray's echo is lost if its random bits are below this (shared/noise_types.h); 0: no echo is lost.
  std::uint32_t lost_below = 0;
  std::uint64_t seed = 0;  // that of the scanner's noise
  bool glass = false;      // glass weakens echoes, and reflects the beam near its normal; only if the scene has glass
  bool enabled() const { return !meshes.empty(); }
};

// A scanner as an engine sees it.
struct TraceScanner {
  std::shared_ptr<const RayPattern> pattern;
  std::shared_ptr<const NoiseModel> noise;        // null: no noise
  std::shared_ptr<const LimitModel> limits = {};  // null: every point counts
};

struct RegistrationJob;  // trace/registration_sums.hpp
struct SceneDifference;  // scene/scene_difference.hpp

// Method by which the CPU engine finds the hits of whole scans. All give the same results.
enum class WholeScans : std::uint8_t {
  faster,  // the faster one, by the scene's triangles and the rays
  drawn,   // except from a head that lies in a surface
  traced
};

// Input to an engine's constructor. Borrowed for that call only, unless the engine says otherwise.
struct TraceScene {
  std::shared_ptr<const SceneData> scene;
  std::shared_ptr<const VoxelGrid> grid;
  std::vector<TraceScanner> scanners;       // at least one
  std::uint64_t max_rays_per_dispatch = 0;  // 0: the engine's choice
  bool validation = false;
  // Triangles of each sampled voxel, shared among devices. Null: each engine finds them itself.
  std::shared_ptr<SampleTriangles> sample_triangles = nullptr;
  WholeScans whole_scans = WholeScans::faster;  // another only for tests and measurements
  bool sort_triangles = true;  // for drivers that build on the given order; off only to measure the gain of sorting
};

// Returns true if glass weakens the echoes of any scanner.
inline bool weakens_through_glass(const TraceScene& scene) {
  return std::ranges::any_of(scene.scanners, [](const TraceScanner& s) { return s.limits && s.limits->glass; });
}

// A rotation as engines apply it to directions. Rows are rounded once from double and products are summed from the
// left, so every engine turns a direction into the same bits.
struct Turn {
  Float3 x, y, z;
  Float3 operator()(const Float3& d) const {
    return {x.x * d.x + x.y * d.y + x.z * d.z, y.x * d.x + y.y * d.y + y.z * d.z, z.x * d.x + z.y * d.y + z.z * d.z};
  }
};

// A station as an engine sees it.
struct TraceStation {
  Float3 origin;              // head, local frame
  std::uint32_t place = 0;    // index in its network; keys the noise
  std::uint32_t scanner = 0;  // index into TraceScene::scanners
  // Rotation from the scanner's frame to the local one. Empty: upright, with the pattern's own directions.
  std::optional<Turn> turn = std::nullopt;
  // Returns the bit in a mask and index among a call's stations. Their places all lie within one run of `mask_bits`
  // that begins at a multiple of it.
  std::uint32_t bit() const { return place % static_cast<std::uint32_t>(mask_bits); }
};

// One engine on one device. Not thread-safe.
class Tracer {
 public:
  virtual ~Tracer() = default;
  virtual const EngineInfo& info() const = 0;

  // Traces `ray_count` rays from `first_ray` (both multiples of the columns of the station's pattern) and fills the
  // arrays of `chunk` named by `outputs`. The host derives mesh and colour from `primitive` and `barycentric`.
  struct RawChunk {
    std::vector<float> range;              // noisy; +infinity without a hit
    std::vector<Float3> position, normal;  // local frame
    std::vector<float> reflectivity;
    std::vector<std::uint32_t> primitive;  // scene triangle; 2^32 − 1 without a hit
    std::vector<Float2> barycentric;       // weights of the triangle's second and third vertex
    std::vector<std::uint32_t> voxel;      // kNoVoxel if the point does not count
  };
  enum RawOutput : std::uint32_t {
    range = 1,
    position = 2,
    normal = 4,
    reflectivity = 8,
    primitive = 16,
    barycentric = 32,
    voxel = 64
  };
  virtual void scan(const TraceStation& station, std::uint64_t first_ray, std::uint64_t ray_count,
                    std::uint32_t outputs, RawChunk& chunk) = 0;
  virtual std::uint64_t preferred_scan_rays(std::uint32_t scanner) const = 0;  // a good chunk for scan(): whole rows

  // Exact: counts all rays of all stations. The caller leaves out inactive stations; `station_count` is N_stations with
  // them.
  struct CountOptions {
    bool masks = true;  // keep station masks, fill seen and shared
    bool skip = true;   // leave out work that cannot change a count; `points` is then empty
    PassField* field = nullptr;
  };
  virtual NetworkCounts count(std::span<const TraceStation> stations, std::uint32_t station_count,
                              const CountOptions& options, const Progress& progress) = 0;

  // Counts each network as count() does. networks[k] lists the active stations of network k, station_counts[k] is its
  // N_stations. When cancelled, networks that were not reached have `cancelled` set. An engine may change the order,
  // and trace a station common to several networks once; `rays` is what each network would take alone. REQUIRES: no
  // field.
  virtual std::vector<NetworkCounts> count_each(std::span<const std::vector<TraceStation>> networks,
                                                std::span<const std::uint32_t> station_counts,
                                                const CountOptions& options, const Progress& progress);

  // Sampled: the same counts, but only over the voxels of `sample` (ascending indices), for many networks in one
  // submission. networks[k] lists the active stations of network k; station_counts[k] is its N_stations.
  struct SampleJob {
    std::span<const std::uint32_t> sample;
    // Interleaved groups: voxel number i of the sample is in group i % groups. 0: omits what standard errors need,
    // `NetworkCounts::groups` and `successive_difference_sum`.
    std::uint32_t groups = 20;
    bool masks = true;
    std::uint32_t stop_at = 0;  // goal rounded up: points of a voxel need not be counted beyond it; 0: no limit
    // Optional. Called with the points in each voxel of the sample, once for every network that was counted to its end,
    // in any order, on the calling thread.
    std::function<void(std::size_t network, std::span<const std::uint32_t> points)> points = {};
    // Optional, with masks. Called with the station masks [network][voxel of the sample] of consecutive networks, once
    // for every network that was counted to its end, on the calling thread.
    std::function<void(std::size_t first_network, std::span<const std::uint64_t> masks)> station_masks = {};
    const RegistrationJob* registration = nullptr;  // optional, with masks
    // Optional, a byte for each voxel of the sample: an engine need not count those that are not 0.
    std::span<const std::uint8_t> leave_out = {};
  };
  virtual std::vector<NetworkCounts> count_sampled(std::span<const std::vector<TraceStation>> networks,
                                                   std::span<const std::uint32_t> station_counts, const SampleJob& job,
                                                   const Progress& progress) = 0;
  // Takes a changed scene in place of its own, and remakes what differs. Returns false, and changes nothing, if the
  // engine cannot, or if a new engine is as fast. An error changes nothing either.
  virtual bool take(const TraceScene&, const SceneDifference&) { return false; }
  // Returns the bytes copied to the device's own memory since it was set up.
  virtual std::uint64_t uploaded_bytes() const { return 0; }
  // Goal density: a voxel with count >= goal is saturated. Set once after construction.
  virtual void set_goal_density(double goal) { goal_density_ = goal; }

 protected:
  double goal_density_ = 1;
};

// Builds the engine named by `engine`; choose_engine.hpp resolves `automatic`. A Vulkan engine that fails with its
// device is set up anew, with a call to `warn`. Throws Error no_suitable_device with every refusal.
std::unique_ptr<Tracer> make_tracer(Engine engine, std::optional<std::uint32_t> device_index, const TraceScene& scene,
                                    std::function<void(const std::string&)> warn = {});
// Device that make_tracer() takes, with the free part of its own memory; unknown if it has none, or if its driver keeps
// no account.
struct ChosenDevice {
  Engine engine;
  bool software = false;
  std::optional<std::uint64_t> free_bytes = std::nullopt;
};
ChosenDevice choose_device(Engine engine, std::optional<std::uint32_t> device_index);
// Builds one tracer over several devices; calls `warn` for each device that it loses. REQUIRES: at least one device.
std::unique_ptr<Tracer> make_tracer(std::span<const DeviceChoice> devices, const TraceScene& scene,
                                    std::function<void(const std::string&)> warn);

}  // namespace vantage
