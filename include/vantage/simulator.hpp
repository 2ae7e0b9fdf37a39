// SPDX-License-Identifier: Apache-2.0
/// Simulates stations: point clouds of one station, counts per surveyed voxel of a network.
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
#include "vantage/work.hpp"

namespace vantage {

class TracerMaker;  // internal: see src/trace/tracer_maker.hpp

/// Settings of a simulator: devices, voxels, limits of points.
struct SimulatorConfig {
  Engine engine = Engine::automatic;                         ///< Engine that traces rays.
  std::optional<std::uint32_t> device_index = std::nullopt;  ///< Empty: the best device that has the engine.
  /// Several devices that share the work, in place of `engine` and `device_index`. If all have the same engine, results
  /// equal those of one device, bit for bit. Engines differ by rounding at edges, and so do results of a mixture.
  std::vector<DeviceChoice> devices = {};
  /// Called, on the calling thread, with a device that failed and was dropped. The other devices repeat its work;
  /// failure of the last one is an `Error`.
  std::function<void(const std::string&)> warn = {};
  /// Spans the work over other processes; made by the program's `vantage_ranks`. Null: this process works alone.
  std::shared_ptr<TracerMaker> shared = nullptr;
  double user_size_m = 0.1;       ///< Upper bound of the voxel size (equation 2).
  double point_spacing_m = 0.01;  ///< Wanted spacing n of points; goal density = voxel_size² / n².
  /// Uses a mesh's detail (`MeshInfo::detail_m`) as the wanted spacing of its voxels, so goals may differ between
  /// meshes. A voxel of several meshes takes the finest; every goal is at least one point.
  bool spacing_by_detail = false;
  bool noise = true;  ///< Applies the scanner's noise table, if it has one.
  /// Largest angle between a ray and the surface normal at which a point counts, above 0° and at most 90°. Empty:
  /// `default_max_incidence` if any surveyed mesh has a detail or accuracy (`MeshInfo`), otherwise no limit.
  std::optional<Angle> max_incidence = std::nullopt;
  std::uint64_t seed = 1;                   ///< Seed of noise and of the voxel sample.
  bool validation = false;                  ///< Loads the Vulkan validation layer; its errors become `Error`s.
  std::uint64_t max_rays_per_dispatch = 0;  ///< 0: chosen so that a dispatch stays well below a watchdog's limit.
  /// Nothing is built that is estimated to need more. 0: half of the free memory.
  std::uint64_t max_memory_bytes = 0;
};

/// At 60° the beam's footprint is twice as long as at 0°, and a matt surface returns half as much.
inline constexpr Angle default_max_incidence = Angle::degrees(60);

/// Its members as named values, for results and configuration files.
Settings settings(const SimulatorConfig& config);

/// Host memory that a simulation needs, estimated from triangles and areas before any is allocated.
struct MemoryEstimate {
  std::uint64_t voxels = 0;  ///< Approximate number of surveyed voxels: cells of the grid that the surfaces meet.
  std::uint64_t bytes = 0;   ///< Upper bound on the process's peak, scene included, when tracing on the CPU.
};
/// Estimates it for networks of so many stations. `user_size_m`: as in `SimulatorConfig`.
MemoryEstimate estimate_memory(const Scene& scene, double user_size_m, std::size_t stations = mask_bits);

/// A station: position of the scanner's head in the survey frame, and how it is set up there.
struct Station {
  Vec3 position;            ///< Scanner's head, survey frame, metres.
  bool active = true;       ///< False: in a hole or a clash. Keeps its place in the network but is not simulated.
  StationSetup setup = {};  ///< Which scanner, and how it is turned.
};
/// Stations that are simulated together.
using Network = std::vector<Station>;

/// Arrays of a `ScanChunk` to compute, allocate and transfer; combined by or.
enum ScanOutput : std::uint32_t {
  scan_range = 1,         ///< Metres from the head, noise included; +infinity without a hit in range.
  scan_position = 2,      ///< local frame: survey position = `Simulator::origin()` + this
  scan_normal = 4,        ///< unit, turned towards the scanner
  scan_reflectivity = 8,  ///< R·(I·(−N)) in [0, 1]
  scan_ids = 16,          ///< mesh and primitive
  scan_colour = 32,       ///< RGBA of `ScanOptions::colour` if given, else of the material.
  scan_voxel = 64,        ///< surveyed voxel in which the point counts
  scan_ghost = 128,       ///< whether the point was seen in a mirror
  scan_returns = 256,     ///< how many returns the ray has
};

/// Which returns of a beam become points.
enum class Returns : std::uint8_t {
  first,      ///< The nearest of each ray.
  strongest,  ///< The one with most energy.
  last,       ///< The farthest.
  all,        ///< Each of them.
};
std::string to_string(Returns);  ///< The name of the enumerator.
/// Throws Error invalid_argument and lists them.
Returns returns_from_string(const std::string& text);

/// A beam as wide as the scanner's, by its divergence and exit diameter: sub-rays over the footprint. Echoes from
/// surfaces nearer together than half a pulse's length merge into one return between them, a mixed point. Sub-rays are
/// traced on the processor, so every engine gives the same result.
struct BeamOptions {
  std::uint32_t sub_rays = 7;            ///< 7 or 19.
  Returns returns = Returns::strongest;  ///< `all`: up to 15 a ray.
  double pulse_m = 1;                    ///< Length of a pulse, above 0: the speed of light times its duration.
};

/// Settings of a beam; any of them gives the beam its width.
const SettingTable<std::optional<BeamOptions>>& beam_settings();

/// Settings of `Simulator::scan`.
struct ScanOptions {
  std::uint32_t outputs = scan_position;  ///< `ScanOutput` bits.
  std::uint32_t place = 0;                ///< Station's index in its network; it keys the noise.
  /// Colour of a point, 0xAABBGGRR, by its ray's direction in the scanner's frame, e.g. from a picture
  /// (`Panorama::colour`). Called from several threads at once. Empty: the colour of the material.
  std::function<std::uint32_t(Angle zenith, Angle azimuth)> colour = {};
  /// Gives the beam a width, at the cost of its sub-rays. Empty: a ray without one.
  std::optional<BeamOptions> beam = std::nullopt;
  /// Moves ranges and positions as an instrument with these errors measures them (`draw_instrument_errors()`). Counts,
  /// voxels and all else stay those of the rays. Empty: no errors.
  std::optional<InstrumentErrors> instrument = std::nullopt;
};

/// Results of consecutive rays, dense: element k belongs to ray first_ray + k. Arrays not asked for are empty. If a
/// beam has several returns, there is a chunk of the same rays for each number of a return.
struct ScanChunk {
  std::uint32_t return_number = 1;  ///< Number of the return that the points are, from 1.
  std::uint64_t first_ray = 0;      ///< Number of the first ray in the scanner's pattern.
  std::uint64_t ray_count = 0;      ///< Number of rays, and elements of each array.
  std::vector<float> range_m;       ///< Metres from the head, noise included; +infinity without a hit.
  /// Local frame, where floats are fine enough: survey position = `Simulator::origin()` + this. NaN without a hit.
  std::vector<std::array<float, 3>> position;
  std::vector<std::array<float, 3>> normal;  ///< Unit, turned towards the scanner.
  std::vector<float> reflectivity;           ///< R·(I·(−N)), in [0, 1].
  std::vector<std::int32_t> mesh;            ///< Index into Scene::meshes(); −1 without a hit.
  std::vector<std::uint32_t> primitive;      ///< Triangle of the scene (all meshes in order); 2³²−1 without a hit.
  std::vector<std::uint32_t> colour;         ///< 0xAABBGGRR, sRGB; 0 without a hit.
  /// Index of the surveyed voxel in Morton order; 2³²−1 if the point does not count.
  std::vector<std::uint32_t> voxel;
  /// 1: a ghost. The ray was reflected, and its point lies behind the mirror; mesh and colour are those of what it met.
  std::vector<std::uint8_t> ghost;
  std::vector<std::uint8_t> returns;  ///< Returns of the ray; 0 without a hit.
};

/// Sums over one scan.
struct ScanSummary {
  std::uint64_t rays = 0, points = 0;    ///< Rays traced, and points of them, on all meshes.
  std::uint64_t points_on_surveyed = 0;  ///< Points that count: on a surveyed mesh and inside a surveyed voxel.
  std::uint64_t hits_on_surveyed = 0;    ///< Hits on a surveyed mesh, wherever noise then moved the point.
  std::uint64_t ghosts = 0;              ///< Points seen in a mirror (`MeshInfo::mirror`), which never count.
  MixedPoints mixed;                     ///< Points of a beam between surfaces.
  double trace_seconds = 0;              ///< Time of tracing; not reproducible.
  bool cancelled = false;                ///< It was stopped before the last ray.
};

/// The points of one scan, in ray order for each number of a return: rays without a hit are left out. Arrays not asked
/// for are empty.
struct ScanPoints {
  std::vector<std::uint64_t> ray;            ///< Row ray / columns and column ray % columns of the station's scanner.
  std::vector<Vec3> position;                ///< Survey frame, metres.
  std::vector<float> range_m;                ///< Metres from the head, noise included.
  std::vector<std::array<float, 3>> normal;  ///< Unit, turned towards the scanner; survey frame.
  std::vector<float> reflectivity;           ///< R·(I·(−N)), in [0, 1].
  std::vector<std::int32_t> mesh;            ///< Index into `Scene::meshes()`.
  std::vector<std::uint32_t> primitive;      ///< Triangle of the scene (all meshes in order).
  std::vector<std::uint32_t> colour;         ///< 0xAABBGGRR, sRGB.
  std::vector<std::uint32_t> voxel;          ///< Index of the surveyed voxel; 2³²−1 if the point does not count.
  std::vector<std::uint8_t> ghost;           ///< 1: seen in a mirror.
  /// Number of the return, from 1, and how many its ray has (`scan_returns`). Returns of a ray do not follow each
  /// other.
  std::vector<std::uint8_t> return_number, returns;
  ScanSummary summary;  ///< Sums over all of it.
};

/// As the size of a sample: all surveyed voxels.
inline constexpr std::uint64_t every_voxel = std::numeric_limits<std::uint64_t>::max();

/// Settings of `Simulator::evaluate` and `evaluate_each`, which trace every ray.
struct EveryRayOptions {
  bool overlap = true;  ///< Keeps station masks and counts pairs.
  bool skip = true;     ///< Leaves out rays and parts of rays that cannot reach a surveyed voxel. Counts do not change.
  VoxelField* field = nullptr;  ///< Receives the voxel field, if given.
  /// Fills `NetworkCounts::registration`, if given. Needs `overlap`.
  std::optional<RegistrationModel> registration = std::nullopt;
  bool meshes = false;  ///< Fills `NetworkCounts::meshes`. Keeps the points of every voxel meanwhile.
  /// Voxels that registration is summed over, in groups: a sample costs the planes of its own voxels alone. It grows
  /// fourfold until `registration_known` returns true for the counts of a network, by its number, or has every voxel.
  std::uint64_t registration_voxels = every_voxel;
  std::function<bool(std::size_t network, const NetworkCounts&)> registration_known = {};  ///< Empty: at once.
  /// Gives the beam a width, at the cost of its sub-rays, none of which are left out. Empty: rays without one.
  std::optional<BeamOptions> beam = std::nullopt;
};

/// Points of a voxel that are counted. Fewer rays do for fewer.
enum class CountTo {
  all,   ///< Every point.
  goal,  ///< Up to the goal density: a voxel there may show fewer points than it got.
  one,   ///< Until there is any: pairs and registration are right, and no coverage.
};

/// Sample and outputs of `Simulator::evaluate_sampled`.
struct SampleOptions {
  std::uint64_t voxels = 20'000;  ///< Number of surveyed voxels, capped at all of them.
  /// Number of voxels passed over first, in the order of the draw. Samples of n voxels from 0, n, 2n, … are disjoint
  /// until all voxels were drawn; a smaller sample from the same place is part of a larger one.
  std::uint64_t from = 0;
  bool overlap = true;              ///< Keeps station masks and counts pairs.
  CountTo count_to = CountTo::all;  ///< Points of a voxel that are counted.
  /// Called with the points of a network in each voxel of the sample, in the order of `Simulator::sampled_voxels`.
  /// Called once for each network that was counted to its end, in any order, on the calling thread.
  std::function<void(std::size_t network, std::span<const std::uint32_t> points)> points = {};
  /// Fills `NetworkCounts::registration`, if given. Needs `overlap`.
  std::optional<RegistrationModel> registration = std::nullopt;
  bool meshes = false;  ///< Fills `NetworkCounts::meshes`. Not with `CountTo::one`.
  /// Fills `NetworkCounts::groups` and `successive_difference_sum`. Standard errors need them; a search can do without.
  bool groups = true;
  /// Optional, a byte for each voxel of the sample: those that are not 0 need not be counted, and the results are then
  /// without the points there, or with them.
  std::span<const std::uint8_t> leave_out = {};
};

/// The surface in a voxel, as the plane that holds most of it.
struct VoxelPatch {
  Vec3 point;              ///< Middle of that plane's surface in the voxel, survey frame.
  Vec3 normal;             ///< Unit; either sign.
  double area_m2 = 0;      ///< Area of all surface in the voxel, at most that of a face; 0 if triangles only touch it.
  std::uint32_t mesh = 0;  ///< Index into `Scene::meshes()` of the mesh with most surface in it.
};

class VoxelPlanes;

/// Owns device, acceleration structure and voxel grid; shares ownership of the scene. The same inputs, seed and engine
/// give the same result, bit for bit.
/// Several simulators work side by side, on threads or in tasks of a caller's TBB arena; CPU work then keeps to that
/// arena's threads. One simulator may be called from several threads: const calls run at any time, and each other call
/// waits until the one before it has returned. A callback must not call the simulator that called it: on the calling
/// thread that throws Error invalid_argument, on another thread (`ScanOptions::colour`) it would wait forever. Moving
/// and destroying a simulator must run alone, and so must `set_scene` and `set_scanners`.
/// An exception from a callback ends the call and leaves the simulator unchanged. A child of fork() has neither the
/// threads nor the device: it may only exec or _exit.
class Simulator {
 public:
  /// Throws Error: invalid_argument (densest goal below 1, with the smallest user size that works; bad scanner; a
  /// detail or accuracy without the scanner's beam or noise table; a bad incidence), no_suitable_device, out_of_memory.
  Simulator(const Scene& scene, const Scanner& scanner, const SimulatorConfig& config = {});
  /// With several scanners, from which stations choose by `StationSetup::scanner`: other models, or one model with
  /// other steps. Throws as above, and Error invalid_argument for none.
  Simulator(const Scene& scene, std::span<const Scanner> scanners, const SimulatorConfig& config = {});
  /// The same, with progress of making the voxels, many millions on a large site. Empty if stopped meanwhile.
  static std::optional<Simulator> build(const Scene& scene, std::span<const Scanner> scanners,
                                        const SimulatorConfig& config, const Progress& progress);
  Simulator(Simulator&&) noexcept;
  Simulator& operator=(Simulator&&) noexcept;
  ~Simulator();

  /// Takes another scene, mostly the same one with some meshes moved, added or removed (`with_changes`,
  /// `SceneBuilder`). Counts, points and voxels are then those of a new simulator of that scene, bit for bit (but for
  /// `NetworkCounts::rays` of samples). On `embree` only what differs is made anew, and `compute_bvh` follows meshes
  /// that move; otherwise the engine's structure is rebuilt, as it is if much differs, if the scene has another local
  /// origin or shares meshes. Voxels are all made anew where the grid moves, or meshes have several weights or wanted
  /// details. Returns whether the rest was kept. The simulator is unchanged after an error. Throws Error as the
  /// constructor does, and invalid_argument for a simulator of `surroundings_of` or one that works over other
  /// processes. Must run alone, const calls included.
  bool set_scene(const Scene& scene);
  /// Takes other scanners. Counts and points are then those of a new simulator with them, bit for bit. Voxels are kept,
  /// and the engine's structure is rebuilt. The simulator is unchanged after an error. Throws Error as `set_scene`.
  void set_scanners(std::span<const Scanner> scanners);

  const EngineInfo& engine() const noexcept;           ///< Engine and device in use.
  const Scanner& scanner() const noexcept;             ///< The first scanner.
  std::span<const Scanner> scanners() const noexcept;  ///< All scanners.
  const Scene& scene() const noexcept;                 ///< The scene that it simulates.
  const SimulatorConfig& config() const noexcept;      ///< As it was given.
  Vec3 origin() const noexcept;                        ///< Local origin; survey = local + origin.
  std::uint64_t voxel_count() const noexcept;          ///< N_v of equation 8.
  double voxel_size_m() const noexcept;                ///< Edge of a voxel: at most `SimulatorConfig::user_size_m`.
  double goal_density() const noexcept;                ///< Points wanted in a voxel; the densest goal if goals differ.
  /// Points wanted in one voxel (`SimulatorConfig::spacing_by_detail`). REQUIRES: voxel < voxel_count().
  double goal_density(std::uint64_t voxel) const;
  /// Limit of incidence in force, from `SimulatorConfig::max_incidence`. Empty: there is none.
  std::optional<Angle> max_incidence() const noexcept;
  Vec3 voxel_centre(std::uint64_t voxel) const;  ///< Survey frame. REQUIRES: voxel < voxel_count().
  /// Weight of a voxel in coverage (`MeshInfo::weight`). REQUIRES: voxel < voxel_count().
  std::uint32_t voxel_weight(std::uint64_t voxel) const;
  /// Point weight in a voxel, as `NetworkCounts::point_weight`. REQUIRES: voxel < voxel_count().
  std::uint32_t point_weight(std::uint64_t voxel) const;
  /// Surfaces of voxels. REQUIRES: voxels ascending, without duplicates, all below voxel_count().
  std::vector<VoxelPatch> voxel_patches(std::span<const std::uint32_t> voxels) const;
  /// Indices of the voxels that `evaluate_sampled` draws for `SampleOptions::voxels` and `from`, ascending. Fixed by
  /// the seed. Throws Error invalid_argument for 0 voxels.
  std::vector<std::uint32_t> sampled_voxels(std::uint64_t voxels, std::uint64_t from = 0) const;

  /// Scans one station in chunks of rows; `sink` gets them in ray order. An inactive station has no chunks. Sets
  /// `cancelled` if stopped. Throws Error invalid_argument (a position or angle that is not finite, a scanner that does
  /// not exist, unknown outputs).
  ScanSummary scan(const Station& station, const ScanOptions& options,
                   const std::function<void(const ScanChunk&)>& sink, const Progress& progress = {});

  /// The points of one station, all at once. `scan` needs less memory. Throws as `scan`.
  ScanPoints scan_points(const Station& station, const ScanOptions& options = {}, const Progress& progress = {});

  /// Counts every ray of every station. Sets `cancelled` if stopped. REQUIRES: 1 to `max_stations` stations.
  NetworkCounts evaluate(const Network& network, const EveryRayOptions& options = {}, const Progress& progress = {});

  /// Evaluates each network as evaluate() does, spread over the devices. If stopped, networks that were not reached
  /// have `cancelled` set. REQUIRES: no field.
  std::vector<NetworkCounts> evaluate_each(std::span<const Network> networks, const EveryRayOptions& options = {},
                                           const Progress& progress = {});

  /// Evaluates networks on a sample of the voxels; one submission for all.
  std::vector<NetworkCounts> evaluate_sampled(std::span<const Network> networks, const SampleOptions& options = {},
                                              const Progress& progress = {});

  /// All work since it was built, but for scans. Not during a call.
  Work work() const;

 private:
  friend Simulator surroundings_of(const Simulator& simulator, bool through_glass);
  friend const VoxelPlanes* sides_of(const Simulator& simulator);
  friend void share_one_sided(const Simulator& simulator, NetworkCounts& counts, const Network& network,
                              std::span<const std::uint32_t> voxel_indices, std::span<const std::uint64_t> masks);
  // Makes registration use the scans of these scanners, for which fewer rays are traced, and pairs of stations share a
  // voxel only from one side of its surfaces. One for each of `scanners()`.
  void stand_for(std::span<const Scanner> scanners);
  struct Impl;
  explicit Simulator(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Returns a coarser simulator of the same site with every mesh surveyed. It measures how whole scans overlap:
/// registration uses everything they share, surveyed or not. Same engine, device and seed, no noise. Costs the memory
/// and time of another simulator.
/// A surface seen from behind is not the same surface: two stations share a voxel only if neither wall, board nor slab
/// in it, a flat surface at least 0.75 m wide, lies between their heads. Nor is anything seen through glass
/// (docs/method.md).
/// Voxels are at most a hundredth of the site's largest extent and at most 0.5 m, never finer than those of
/// `simulator`. Two rays cross a voxel at the site's far end or at the range's limit; the steps are never finer than
/// the scanner's. Registration's sums are those of the scanner's own scans.
/// `through_glass`: rays pass glass, to tell what scans share through it. No other process takes part then.
Simulator surroundings_of(const Simulator& simulator, bool through_glass = false);

}  // namespace vantage
