// SPDX-License-Identifier: Apache-2.0
/// Simulates stations: point clouds of one, counts per surveyed voxel of a network.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vantage/progress.hpp"
#include "vantage/scanner.hpp"
#include "vantage/scene.hpp"
#include "vantage/station_setup.hpp"
#include "vantage/trace.hpp"

namespace vantage {

struct SimulatorConfig {
  Engine engine = Engine::automatic;
  std::optional<std::uint32_t> device_index = std::nullopt;  ///< Empty: the best that has the engine.
  /// Several that share the work, in place of `engine` and `device_index`. Results are those of one device, bit for
  /// bit, where all have the same engine; engines differ by rounding at edges, and so do results then.
  std::vector<DeviceChoice> devices = {};
  /// Told, on the calling thread, of a device that failed and was dropped: the others do its work again, and the last
  /// one's failure is an `Error`.
  std::function<void(const std::string&)> warn = {};
  double user_size_m = 0.1;       ///< Upper bound of the voxel size (equation 2).
  double point_spacing_m = 0.01;  ///< Wanted spacing n of points; goal density = voxel_size² / n².
  /// Of a mesh that asks for a detail (`MeshInfo::detail_m`) that is the wanted spacing: where meshes differ, so do the
  /// goals of their voxels. A voxel of several goes by the finest, and none wants less than a point.
  bool spacing_by_detail = false;
  bool noise = true;  ///< Apply the scanner's noise table, if it has one.
  /// Largest angle between a ray and the normal of the surface at which its point counts, above 0° and at most 90°.
  /// Empty: `default_max_incidence` where any surveyed mesh has a detail or accuracy (`MeshInfo`), otherwise none.
  std::optional<Angle> max_incidence = std::nullopt;
  std::uint64_t seed = 1;                   ///< Of noise and of the voxel sample.
  bool validation = false;                  ///< Load the Vulkan validation layer; its errors become `Error`s.
  std::uint64_t max_rays_per_dispatch = 0;  ///< 0: chosen so that a dispatch stays well below a watchdog's limit.
  /// Where `estimate_memory` comes to more, nothing is built. 0: half of what is free.
  std::uint64_t max_memory_bytes = 0;
};

/// At 60° the beam's footprint is twice as long as square on, and a matt surface sends back half as much.
inline constexpr Angle default_max_incidence = Angle::degrees(60);

Settings settings(const SimulatorConfig& config);

/// What a simulation takes of the host's memory, told from triangles and areas, before any of it is taken.
struct MemoryEstimate {
  std::uint64_t voxels = 0;  ///< Surveyed ones, about: cells of the grid that the surfaces meet.
  std::uint64_t bytes = 0;   ///< Of a whole process, at most at once, scene included; tracing on the CPU.
};
MemoryEstimate estimate_memory(const Scene& scene, double user_size_m, std::size_t stations = mask_bits);

/// A station is the position of the scanner's head in the survey frame, and how it is set up there.
struct Station {
  Vec3 position;
  bool active = true;  ///< False: in a hole or a clash. Keeps its place in the network but is not simulated.
  StationSetup setup = {};
};
using Network = std::vector<Station>;

/// Which arrays of a `ScanChunk` are computed, allocated and transferred. Or them together.
enum ScanOutput : std::uint32_t {
  scan_range = 1,         ///< metres from the head, noise included; +infinity where nothing was hit in range
  scan_position = 2,      ///< local frame: survey position = `Simulator::origin()` + this
  scan_normal = 4,        ///< unit, turned towards the scanner
  scan_reflectivity = 8,  ///< R·(I·(−N)) in [0, 1]
  scan_ids = 16,          ///< mesh and primitive
  scan_colour = 32,       ///< RGBA of `ScanOptions::colour` where one is given, else of the material
  scan_voxel = 64,        ///< surveyed voxel the point counts in
};

/// How `Simulator::scan` works.
struct ScanOptions {
  std::uint32_t outputs = scan_position;  ///< `ScanOutput` bits.
  std::uint32_t place = 0;                ///< The station's place in its network: it keys the noise.
  /// Colour of a point, 0xAABBGGRR, by its ray's direction in the scanner's frame, as in the paper: that of a picture
  /// (`Panorama::colour`), say. It is called from several threads at once. Empty: the colour of the material.
  std::function<std::uint32_t(Angle zenith, Angle azimuth)> colour = {};
};

/// Results of consecutive rays, dense: element k belongs to ray first_ray + k. Arrays that were not asked for are
/// empty.
struct ScanChunk {
  std::uint64_t first_ray = 0;
  std::uint64_t ray_count = 0;
  std::vector<float> range_m;
  /// Local frame, in which floats are fine enough: survey position = `Simulator::origin()` + this. NaN without a hit.
  std::vector<std::array<float, 3>> position;
  std::vector<std::array<float, 3>> normal;
  std::vector<float> reflectivity;
  std::vector<std::int32_t> mesh;        ///< Index into Scene::meshes(); −1 without a hit.
  std::vector<std::uint32_t> primitive;  ///< Triangle of the scene (all meshes in order); 2³²−1 without a hit.
  std::vector<std::uint32_t> colour;     ///< 0xAABBGGRR, sRGB; 0 without a hit.
  /// Rank of the surveyed voxel in Morton order; 2³²−1 where the point does not count.
  std::vector<std::uint32_t> voxel;
};

/// Sums over one scan.
struct ScanSummary {
  std::uint64_t rays = 0, points = 0;
  std::uint64_t points_on_surveyed = 0;  ///< On a surveyed mesh and inside a surveyed voxel: the points that count.
  std::uint64_t hits_on_surveyed = 0;    ///< On a surveyed mesh, wherever noise then moved the point.
  double trace_seconds = 0;
  bool cancelled = false;
};

/// How `Simulator::evaluate` works.
struct EvaluateOptions {
  bool overlap = true;  ///< Keep station masks and count pairs.
  bool skip = true;     ///< Leave out rays and ray parts that cannot reach a surveyed voxel. Counts do not change.
  VoxelField* field = nullptr;  ///< Where to put the voxel field, if wanted.
  /// Where given, `NetworkCounts::registration` is filled. Needs `overlap`.
  std::optional<RegistrationModel> registration = std::nullopt;
};

/// What a sampled evaluation draws.
struct SampleOptions {
  std::uint64_t voxels = 20'000;  ///< Number of surveyed voxels; as many as there are: all of them.
  /// So many voxels are passed over first, in the order of the draw. Samples from 0, n, 2n, … of n voxels each have
  /// none in common until all voxels were in one; a smaller one from the same place is part of a larger.
  std::uint64_t from = 0;
  bool overlap = true;
  bool stop_at_goal = false;  ///< Stop counting a voxel's points at the goal density.
  /// Where wanted: told the points of every network in each voxel of the sample (`Simulator::sampled_voxels`, in that
  /// order), once for each network that was counted to its end, in any order, on the calling thread. A voxel at the
  /// goal may have fewer than it got where `stop_at_goal`.
  std::function<void(std::size_t network, std::span<const std::uint32_t> points)> points = {};
  /// Where given, `NetworkCounts::registration` is filled. Needs `overlap`.
  std::optional<RegistrationModel> registration = std::nullopt;
  /// Fill `NetworkCounts::groups` and `successive_difference_sum`, which standard errors need; a search can do without.
  bool groups = true;
};

/// The surface in a voxel, as the plane that most of it lies in.
struct VoxelPatch {
  Vec3 point;              ///< The middle of that plane's surface in the voxel, survey frame.
  Vec3 normal;             ///< Unit, either way round.
  double area_m2 = 0;      ///< Of all surface in the voxel, at most that of a face; 0 where triangles only touch it.
  std::uint32_t mesh = 0;  ///< Index into `Scene::meshes()` of the mesh that has most surface in it.
};

/// Owns device, acceleration structure and voxel grid; keeps a share of the scene.
/// Same inputs, seed and engine: same result, bit for bit. Several simulators work side by side, on threads or in tasks
/// of a caller's TBB arena, to whose threads the work on the CPU then keeps. Of one, const calls may be made from
/// several threads at once; any other call goes alone. What a callback throws leaves the call as it is, and the
/// simulator as it was. A child of fork() has none of the threads, nor the device: it may exec or _exit, and no more.
class Simulator {
 public:
  /// Throws Error: invalid_argument (densest goal below 1, with the smallest user size that works; bad scanner; a
  /// detail or accuracy without the scanner's beam or noise table; a bad incidence), no_suitable_device, out_of_memory.
  Simulator(const Scene& scene, const Scanner& scanner, const SimulatorConfig& config = {});
  /// With several scanners, which stations choose from by `StationSetup::scanner`: other models, or one with other
  /// steps. Throws as above, and Error invalid_argument for none.
  Simulator(const Scene& scene, std::span<const Scanner> scanners, const SimulatorConfig& config = {});
  /// The same, but tells how far the voxels are, of which a large site has many millions, and is empty where it was
  /// stopped meanwhile.
  static std::optional<Simulator> build(const Scene& scene, std::span<const Scanner> scanners,
                                        const SimulatorConfig& config, const Progress& progress);
  Simulator(Simulator&&) noexcept;
  Simulator& operator=(Simulator&&) noexcept;
  ~Simulator();

  const EngineInfo& engine() const noexcept;
  const Scanner& scanner() const noexcept;             ///< The first.
  std::span<const Scanner> scanners() const noexcept;  ///< All of them.
  const Scene& scene() const noexcept;
  const SimulatorConfig& config() const noexcept;
  Vec3 origin() const noexcept;                ///< Local origin; survey = local + origin.
  std::uint64_t voxel_count() const noexcept;  ///< N_v of equation 8.
  double voxel_size_m() const noexcept;
  double goal_density() const noexcept;  ///< Points wanted in a voxel: where goals differ, the densest of them.
  /// Points wanted in that voxel (`SimulatorConfig::spacing_by_detail`). REQUIRES: rank < voxel_count().
  double goal_density(std::uint64_t rank) const;
  /// What `max_incidence` comes to; empty: points have no limits of any kind, and all on surveyed voxels count.
  std::optional<Angle> max_incidence() const noexcept;
  Vec3 voxel_centre(std::uint64_t rank) const;  ///< Survey frame. REQUIRES: rank < voxel_count().
  /// What a voxel counts in coverage (`MeshInfo::weight`). REQUIRES: rank < voxel_count().
  std::uint32_t voxel_weight(std::uint64_t rank) const;
  /// What a point in it is worth: as in `NetworkCounts::point_worth`. REQUIRES: rank < voxel_count().
  std::uint32_t point_worth(std::uint64_t rank) const;
  /// Their surfaces. REQUIRES: ranks ascending, without duplicates, all below voxel_count().
  std::vector<VoxelPatch> voxel_patches(std::span<const std::uint32_t> ranks) const;
  /// Ranks of the voxels that `evaluate_sampled` draws for `SampleOptions::voxels` and `from`, ascending. Fixed by the
  /// seed. Throws Error invalid_argument for none.
  std::vector<std::uint32_t> sampled_voxels(std::uint64_t voxels, std::uint64_t from = 0) const;

  /// Scans one station in chunks of rows; `sink` sees them in ray order. An inactive station has no chunks. A cancelled
  /// scan says so in `cancelled`. Throws Error invalid_argument (a position or angle that is not finite, a scanner that
  /// is not there, unknown outputs).
  ScanSummary scan(const Station& station, const ScanOptions& options,
                   const std::function<void(const ScanChunk&)>& sink, const Progress& progress = {});

  /// Every ray of every station. REQUIRES: 1 to `max_stations` stations. A cancelled evaluation says so in `cancelled`.
  NetworkCounts evaluate(const Network& network, const EvaluateOptions& options = {}, const Progress& progress = {});

  /// Each network as evaluate() does it, shared out over the devices. Where cancelled, those that were not reached say
  /// so. REQUIRES: no field.
  std::vector<NetworkCounts> evaluate_each(std::span<const Network> networks, const EvaluateOptions& options = {},
                                           const Progress& progress = {});

  /// Networks on a sample of the voxels; one submission for all.
  std::vector<NetworkCounts> evaluate_sampled(std::span<const Network> networks, const SampleOptions& options = {},
                                              const Progress& progress = {});

 private:
  friend Simulator surroundings_of(const Simulator& simulator);
  // Registration goes by the scans of these scanners, for whose rays fewer stand here. One for each of `scanners()`.
  void stand_for(std::span<const Scanner> scanners);
  struct Impl;
  explicit Simulator(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// A coarser simulator over the same site with every mesh surveyed, for how scans overlap: registration goes by all
/// that they share, wanted or not. Voxels of a hundredth of the site's largest extent at most, 0.5 m at most, never
/// finer than those of `simulator`; rays so that two of them pass a voxel across at the site's far end or the range's,
/// never finer than the scanner's; no noise. Registration's sums are those of the scanner's own scans. Same engine,
/// device and seed. Costs memory and time of another simulator.
Simulator surroundings_of(const Simulator& simulator);

}  // namespace vantage
