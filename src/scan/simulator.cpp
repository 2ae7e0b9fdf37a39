// SPDX-License-Identifier: Apache-2.0
#include "vantage/simulator.hpp"

#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <sstream>
#include <thread>
#include <utility>

#include "core/add_saturating.hpp"
#include "core/first_numbers.hpp"
#include "core/free_memory.hpp"
#include "core/lru_cache.hpp"
#include "core/parallel.hpp"
#include "core/parse.hpp"
#include "core/part_of.hpp"
#include "core/seconds_since.hpp"
#include "core/setting_table.hpp"
#include "core/site_reach.hpp"
#include "scan/instrument_errors.hpp"
#include "scan/limit_model.hpp"
#include "scan/memory_estimate.hpp"
#include "scan/noise_model.hpp"
#include "scan/pattern.hpp"
#include "scan/ray_follower.hpp"
#include "scan/scan_chunk.hpp"
#include "scan/sides_of.hpp"
#include "scan/voxel_sample.hpp"
#include "scan/wide_beam.hpp"
#include "scene/scene_difference.hpp"
#include "trace/field_counts.hpp"
#include "trace/one_sided.hpp"
#include "trace/passes.hpp"
#include "trace/registration_sums.hpp"
#include "trace/tracer.hpp"
#include "trace/tracer_maker.hpp"
#include "vantage/error.hpp"
#include "voxel/voxel_grid.hpp"
#include "voxel/voxel_surfaces.hpp"

namespace vantage {
namespace {

// Returns the number of points of a voxel at which counting may stop; 0: never.
std::uint32_t stop_at(CountTo count_to, double goal) {
  return count_to == CountTo::all ? 0 : count_to == CountTo::one ? 1 : static_cast<std::uint32_t>(std::ceil(goal));
}

constexpr std::uint32_t kSampleGroups = 20;
constexpr std::uint64_t kSampleGrowth = 4;  // of the voxels that registration is summed over
// Most voxels for which all planes are kept, some 700 MB; larger fields are registered in parts.
constexpr std::uint64_t kKeptPlanes = std::uint64_t{1} << 23, kPlanesAtOnce = std::uint64_t{1} << 22;
constexpr std::uint32_t kKnownOutputs = scan_range | scan_position | scan_normal | scan_reflectivity | scan_ids |
                                        scan_colour | scan_voxel | scan_ghost | scan_returns;

// Rounds up to six digits, so that the text, used as a user size, gives the voxel size that it states.
std::string rounded_up(double metres) {
  const double digit = std::pow(10.0, std::floor(std::log10(metres)) - 5);
  std::ostringstream text;
  text.precision(7);
  text << std::ceil(metres / digit + 1e-3) * digit;
  return text.str();
}

// Returns the wanted spacing of points on each mesh, metres.
std::vector<double> spacings_of(const SceneData& scene, const SimulatorConfig& config) {
  std::vector<double> spacings;
  for (const MeshInfo& mesh : scene.meshes)
    spacings.push_back(config.spacing_by_detail && mesh.detail_m > 0 ? mesh.detail_m : config.point_spacing_m);
  return spacings;
}

[[noreturn]] void refuse_goal_density(const VoxelGrid& grid, const SimulatorConfig& config, double spacing) {
  const double smallest = grid.voxel_size() >= spacing ? grid.voxel_size() : 2 * grid.voxel_size();
  std::ostringstream what;
  what << "a user size of " << config.user_size_m << " m makes voxels smaller than the point spacing of " << spacing
       << " m, so that the goal density is below 1: ";
  if (grid.voxel_size() < spacing && grid.depth() == 0)
    what << "all surveyed meshes fit in " << grid.voxel_size() << " m; choose a point spacing below that";
  else
    what << "choose a user size of at least " << rounded_up(smallest) << " m, or a smaller point spacing";
  throw Error(Errc::invalid_argument, what.str());
}

// Makes the voxels of a user size, without point weights. Empty if stopped.
using MakeGrid = std::function<std::optional<VoxelGrid>(double user_size_m)>;

// Returns null if stopped.
std::shared_ptr<const VoxelGrid> build_grid(const SceneData& scene, const SimulatorConfig& config,
                                            std::span<const double> spacings_m, const MakeGrid& make,
                                            const Progress& progress) {
  check_number(config.point_spacing_m, "the point spacing in metres", kMeasurable);
  // A user size below the spacing cannot work. The grid is then built for the spacing, to suggest a working size.
  const double finest = finest_spacing(scene, spacings_m);
  const bool too_small = config.user_size_m > 0 && config.user_size_m < finest;
  auto grid = make(too_small ? finest : config.user_size_m);
  if (!grid) return nullptr;
  if (too_small || grid->voxel_size() < finest) refuse_goal_density(*grid, config, finest);
  auto weights_of_points = point_weights(scene, *grid, spacings_m, {.stop = progress.stop});
  if (!weights_of_points) return nullptr;
  grid->set_point_weights(std::move(*weights_of_points));
  return std::make_shared<VoxelGrid>(std::move(*grid));
}

// Result for a network without active stations: the voxels, and zeros.
NetworkCounts nothing_seen(std::uint64_t voxels, std::uint64_t weight, std::uint32_t point_weight, std::size_t stations,
                           bool overlap, bool registration) {
  NetworkCounts counts;
  counts.voxels = voxels;
  counts.weight = weight;
  counts.point_weight = point_weight;
  counts.stations = static_cast<std::uint32_t>(stations);
  if (overlap) {
    counts.seen.assign(stations, 0);
    counts.shared.assign(stations * (stations - 1) / 2, 0);
  }
  if (registration) {
    counts.registration.voxels = voxels;
    counts.registration.heads.assign(stations, Vec3{});
    counts.registration.pairs.assign(stations * (stations - 1) / 2 * RegistrationSums::of_pair, 0);
    counts.registration.surface.assign(stations * RegistrationSums::of_station, 0);
  }
  return counts;
}

// Records the calling thread while its call runs.
class AsCaller {
 public:
  explicit AsCaller(std::atomic<std::thread::id>& caller) : caller_(caller) { caller_ = std::this_thread::get_id(); }
  AsCaller(const AsCaller&) = delete;
  AsCaller& operator=(const AsCaller&) = delete;
  ~AsCaller() { caller_ = std::thread::id(); }

 private:
  std::atomic<std::thread::id>& caller_;
};

void check_beam(const BeamOptions& beam, const Scanner& scanner) {
  if (beam.sub_rays != 7 && beam.sub_rays != 19)
    throw Error(Errc::invalid_argument, "a beam has 7 or 19 sub-rays, and not " + std::to_string(beam.sub_rays));
  check_number(beam.pulse_m, "the length of a pulse in metres", kMeasurable);
  if (scanner.beam_divergence.in_radians() == 0 && scanner.exit_diameter_m == 0)
    throw Error(Errc::invalid_argument, "the beam of the scanner \"" + scanner.name +
                                            "\" is not known: choose a scanner that states it, or give its divergence "
                                            "and exit diameter");
}

void check_registration(const std::optional<RegistrationModel>& registration, bool overlap) {
  if (registration && !overlap)
    throw Error(Errc::invalid_argument, "registration is summed from station masks, and so needs overlap");
}

// Surfaces of the voxels requested last, since tables and reports of an answer use the same sample.
class KnownPatches {
 public:
  std::optional<std::vector<VoxelPatch>> find(std::span<const std::uint32_t> voxels) const {
    const std::lock_guard lock(mutex_);
    if (voxels.empty() || !std::ranges::equal(voxels, voxels_)) return std::nullopt;
    return patches_;
  }
  void forget() { voxels_.clear(), patches_.clear(); }
  void keep(std::span<const std::uint32_t> voxels, const std::vector<VoxelPatch>& patches) {
    constexpr std::size_t kMost = 1 << 17;  // 11 MB
    if (voxels.size() > kMost) return;
    const std::lock_guard lock(mutex_);
    voxels_.assign(voxels.begin(), voxels.end());
    patches_ = patches;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<std::uint32_t> voxels_;
  std::vector<VoxelPatch> patches_;
};

}  // namespace

struct Simulator::Impl {
  // If stopped, it has no grid and must not be used.
  Impl(const Scene& s, std::span<const Scanner> all, const SimulatorConfig& c, const Progress& progress)
      : scene(s), scanners(all.begin(), all.end()), config(c) {
    check_scanners(scanners);
    if (config.max_incidence)
      check_number(whole_degrees(*config.max_incidence), "the largest incidence in degrees",
                   {.low = 0, .high = 90, .low_included = false});
    needed_bytes = require_memory(scene, scanners, config).bytes;
    const std::vector<double> spacings = spacings_of(data(), config);
    grid = build_grid(
        data(), config, spacings, [&](double user_size_m) { return VoxelGrid::build(data(), user_size_m, progress); },
        progress);
    if (!grid) return;
    goal = goal_of(*grid, data(), spacings);
    traced = trace_scanners(data(), scanners);
    registered = scanners;
    const TraceScene shared = trace_scene(share(scene), grid, traced);
    surfaces.emplace(shared.scene, grid, shared.sample_triangles);
    tracer = make_own_tracer(shared);
    if (config.shared) tracer = config.shared->make(std::move(tracer), shared, scene.fingerprint());
    tracer->set_goal_density(goal);
  }

  void refuse_if_fixed(const std::string& other) const {
    if (planes)
      throw Error(Errc::invalid_argument,
                  "a simulator of surroundings takes no " + other + "; make one of the simulator that has taken it");
    if (config.shared)
      throw Error(Errc::invalid_argument,
                  "a simulator that works over other processes takes no " + other + "; make another simulator");
  }

  // Implements Simulator::set_scene().
  bool set_scene(const Scene& later) {
    refuse_if_fixed("other scene");
    const SceneData& data_then = later.data();
    const std::vector<double> spacings = spacings_of(data_then, config);
    const std::optional<SceneDifference> differs = difference(data(), data_then);
    bool kept = differs.has_value();
    // Adds few changed meshes to the estimate; otherwise, or if the sum does not fit, examines all meshes.
    std::uint64_t needed_then = differs ? needed_bytes + bytes_of_new(data_then, *differs) : 0;
    bool all_looked_at = false;
    const auto look_at_all = [&] {
      if (!std::exchange(all_looked_at, true)) needed_then = require_memory(later, scanners, config).bytes;
    };
    if (!differs || needed_then > memory_limit(config.max_memory_bytes)) look_at_all();
    const std::shared_ptr<const VoxelGrid> grid_then =
        build_grid(data_then, config, spacings,
                   [&](double user_size_m) -> std::optional<VoxelGrid> {
                     // The grid before was made for this user size, unless that was refused.
                     if (differs && user_size_m == config.user_size_m) {
                       if (auto changed = grid->changed(data(), data_then, *differs, user_size_m)) return changed;
                     }
                     kept = false;
                     look_at_all();
                     return VoxelGrid::build(data_then, user_size_m, {});
                   },
                   {});
    const double goal_then = goal_of(*grid_then, data_then, spacings);
    std::vector<TraceScanner> traced_then = trace_scanners(data_then, scanners);
    const TraceScene shared = trace_scene(share(later), grid_then, traced_then);
    SurfaceFinder surfaces_then(shared.scene, grid_then, shared.sample_triangles);
    std::unique_ptr<Tracer> tracer_then;
    if (!differs || !tracer->take(shared, *differs)) {
      kept = false;
      look_at_all();
      tracer_then = make_own_tracer(shared);
    }
    // No error from here on.
    if (tracer_then) tracer = std::move(tracer_then);
    tracer->set_goal_density(goal_then);
    surfaces.emplace(std::move(surfaces_then));
    scene = later, grid = grid_then, goal = goal_then, traced = std::move(traced_then), needed_bytes = needed_then;
    samples = {}, patches = {}, voxel_meshes = {};
    known_patches.forget();
    mirrors.reset(), wide_beam.reset();
    return kept;
  }

  // Implements Simulator::set_scanners().
  void set_scanners(std::vector<Scanner> later) {
    refuse_if_fixed("other scanners");
    check_scanners(later);
    const std::uint64_t needed_then = require_memory(scene, later, config).bytes;
    std::vector<TraceScanner> traced_then = trace_scanners(data(), later);
    std::unique_ptr<Tracer> tracer_then = make_own_tracer(trace_scene(share(scene), grid, traced_then));
    // No error from here on.
    tracer = std::move(tracer_then);
    tracer->set_goal_density(goal);
    traced = std::move(traced_then), needed_bytes = needed_then;
    registered = later, scanners = std::move(later);
    patches = {}, patch_scanners = {};
    mirrors.reset(), wide_beam.reset();
  }

  static void check_scanners(std::span<const Scanner> scanners) {
    if (scanners.empty()) throw Error(Errc::invalid_argument, "no scanner given; a simulator has one at least");
    for (const Scanner& scanner : scanners) scanner.check();
  }

  std::uint64_t bytes_of_new(const SceneData& later, const SceneDifference& differs) const {
    std::vector<MeshRange> meshes;
    for (std::size_t m = 0; m < later.ranges.size(); ++m)
      if (differs.mesh_before[m] == SceneDifference::kNew) meshes.push_back(later.ranges[m]);
    return bytes_of_meshes(later, meshes, grid->voxel_size());
  }
  static double goal_of(const VoxelGrid& grid, const SceneData& data, std::span<const double> spacings) {
    const double wide = grid.voxel_size() / finest_spacing(data, spacings);
    return wide * wide;
  }
  std::vector<TraceScanner> trace_scanners(const SceneData& data, std::span<const Scanner> of) const {
    const bool some_echo_is_lost = std::ranges::any_of(of, loses_echoes);
    std::vector<TraceScanner> all;
    for (const Scanner& scanner : of) all.push_back(trace_scanner(data, scanner, some_echo_is_lost));
    return all;
  }
  TraceScene trace_scene(std::shared_ptr<const SceneData> shared_scene, std::shared_ptr<const VoxelGrid> shared_grid,
                         std::vector<TraceScanner> of_scanners) const {
    auto triangles = std::make_shared<SampleTriangles>(shared_scene, shared_grid);
    return {.scene = std::move(shared_scene),
            .grid = std::move(shared_grid),
            .scanners = std::move(of_scanners),
            .max_rays_per_dispatch = config.max_rays_per_dispatch,
            .validation = config.validation,
            .sample_triangles = std::move(triangles)};
  }
  // Makes a tracer on this process's devices.
  std::unique_ptr<Tracer> make_own_tracer(const TraceScene& shared) const {
    return config.devices.empty() ? make_tracer(config.engine, config.device_index, shared, config.warn)
                                  : make_tracer(config.devices, shared, config.warn);
  }

  TraceScanner trace_scanner(const SceneData& data, const Scanner& scanner, bool some_echo_is_lost) const {
    const auto noise =
        config.noise ? make_noise_model(scanner, config.seed) : NoiseModel{.sigma = {}, .seed = config.seed};
    return {.pattern = std::make_shared<const RayPattern>(make_pattern(scanner)),
            .noise = std::make_shared<const NoiseModel>(noise),
            .limits = std::make_shared<const LimitModel>(make_limit_model(data, scanner, config, some_echo_is_lost))};
  }

  // Either all scanners have point limits or none.
  bool limited() const { return traced.front().limits->enabled(); }

  const SceneData& data() const { return scene.data(); }
  std::shared_ptr<const SceneData> share_scene() const { return share(scene); }
  // Shares ownership of the scene's storage.
  static std::shared_ptr<const SceneData> share(const Scene& scene) {
    const auto kept = std::make_shared<const Scene>(scene);
    return {kept, &kept->data()};
  }

  TraceStation trace_station(const Station& station, std::size_t place) const {
    if (!in_reach(station.position, data().origin))
      refuse_position(station.position, "station " + std::to_string(place + 1) + " stands");
    const Vec3 local = station.position - data().origin;
    const StationSetup& setup = station.setup;
    if (!(std::isfinite(setup.heading.in_radians()) && std::isfinite(setup.tilt.in_radians())))
      throw Error(Errc::invalid_argument,
                  "station " + std::to_string(place + 1) + " has a heading or a tilt that is not finite");
    if (setup.scanner >= scanners.size())
      throw Error(Errc::invalid_argument, "station " + std::to_string(place + 1) + " has scanner number " +
                                              std::to_string(setup.scanner) + ", counted from 0, and there are " +
                                              std::to_string(scanners.size()));
    return {{static_cast<float>(local.x), static_cast<float>(local.y), static_cast<float>(local.z)},
            static_cast<std::uint32_t>(place),
            setup.scanner,
            make_turn(setup)};
  }

  std::vector<TraceStation> active_stations(const Network& network) const {
    if (network.empty() || network.size() > max_stations) {
      throw Error(Errc::invalid_argument, "a network has 1 to " + std::to_string(max_stations) +
                                              " stations; this one has " + std::to_string(network.size()));
    }
    std::vector<TraceStation> active;
    for (std::size_t place = 0; place < network.size(); ++place) {
      if (network[place].active) active.push_back(trace_station(network[place], place));
    }
    return active;
  }

  // Returns the weight of every `step`-th voxel of a sample.
  std::uint64_t weight_of(std::span<const std::uint32_t> voxel_indices, std::size_t first, std::size_t step) const {
    std::uint64_t sum = 0;
    for (std::size_t i = first; i < voxel_indices.size(); i += step) sum += grid->demands().weight(voxel_indices[i]);
    return sum;
  }

  std::vector<std::uint32_t> drawn(std::uint64_t size, std::uint64_t from) const {
    if (size == 0) throw Error(Errc::invalid_argument, "a sample must have at least one voxel");
    return voxel_sample(grid->size(), size, config.seed, from);
  }

  struct Sample {
    std::uint64_t size, from;
    std::vector<std::uint32_t> voxel_indices;
  };
  // A search requests few of them, repeatedly.
  const Sample& sample_of(std::uint64_t size, std::uint64_t from) {
    if (size >= grid->size()) size = grid->size(), from = 0;
    return samples.get([&](const Sample& one) { return one.size == size && one.from == from; },
                       [&] {
                         return Sample{size, from, drawn(size, from)};
                       });
  }

  // The mesh of each voxel of a sample, or of all voxels, which is the sample from 0.
  struct VoxelMeshes {
    std::uint64_t from;
    std::vector<std::uint32_t> mesh;
  };
  const std::vector<std::uint32_t>& meshes_of(std::span<const std::uint32_t> voxel_indices, std::uint64_t from) {
    return voxel_meshes
        .get([&](const VoxelMeshes& one) { return one.from == from && one.mesh.size() == voxel_indices.size(); },
             [&] {
               VoxelMeshes made{from, {}};
               made.mesh.reserve(voxel_indices.size());
               for (std::size_t first = 0; first < voxel_indices.size(); first += kPlanesAtOnce)
                 for (const VoxelSurface& surface : surfaces->find(voxel_indices.subspan(
                          first, std::min<std::size_t>(kPlanesAtOnce, voxel_indices.size() - first))))
                   made.mesh.push_back(surface.mesh);
               return made;
             })
        .mesh;
  }
  // Returns counts by mesh for each of some interleaved groups of voxels, given the points in each voxel.
  std::vector<std::vector<MeshVoxels>> count_meshes(std::span<const std::uint32_t> points,
                                                    std::span<const std::uint32_t> voxel_indices, std::uint64_t from,
                                                    std::size_t groups) {
    const std::vector<std::uint32_t>& mesh = meshes_of(voxel_indices, from);
    const VoxelDemands& demands = grid->demands();
    const double full = std::ceil(goal * demands.least_point_weight());
    std::vector counts(groups, std::vector<MeshVoxels>(data().meshes.size()));
    for (std::size_t k = 0; k < points.size(); ++k) {
      MeshVoxels& own = counts[k % groups][mesh[k]];
      const std::uint64_t weighted_points = std::uint64_t{points[k]} * demands.point_weight(voxel_indices[k]);
      own.voxels += 1;
      if (static_cast<double>(weighted_points) >= full) own.captured += 1;
    }
    return counts;
  }
  // Does the same for every voxel.
  std::vector<MeshVoxels> count_meshes(std::span<const std::uint32_t> points) {
    std::vector<std::uint32_t> voxel_indices = first_numbers<std::uint32_t>(grid->size());
    return std::move(count_meshes(points, voxel_indices, 0, 1).front());
  }
  // Fills the counts by mesh of a sample, and of its groups.
  void take_meshes(NetworkCounts& counts, const std::vector<std::vector<MeshVoxels>>& groups) {
    counts.meshes.resize(data().meshes.size());
    for (const std::vector<MeshVoxels>& group : groups)
      for (std::size_t m = 0; m < group.size(); ++m) {
        counts.meshes[m].voxels += group[m].voxels;
        counts.meshes[m].captured += group[m].captured;
      }
    for (std::size_t g = 0; g < counts.groups.size(); ++g) counts.groups[g].meshes = groups[g];
  }

  // Returns nothing if stopped, as planes of millions of voxels take seconds.
  Patches patches_of(std::span<const std::uint32_t> voxel_indices, const RegistrationModel& model,
                     const std::stop_token& stop) {
    if (!(model.rho_m > 0 && std::isfinite(model.rho_m) && model.patch_m > 0 && std::isfinite(model.patch_m))) {
      std::ostringstream what;
      what << "registration: the modelling error is " << model.rho_m << " m over patches of " << model.patch_m
           << " m; both must be above 0";
      throw Error(Errc::invalid_argument, what.str());
    }
    done.planes += voxel_indices.size();
    return make_patches(*surfaces, *grid, voxel_indices, make_pattern(registered.front()), model, stop);
  }
  // Returns the scanners with their range noise, whether it is simulated or not.
  const std::vector<PatchScanner>& scanners_of_patches() {
    if (patch_scanners.empty()) {
      const auto solid_angle = [](const Scanner& scanner) {
        return scanner.zenith_step.in_radians() * scanner.azimuth_step.in_radians();
      };
      for (const Scanner& scanner : registered)
        patch_scanners.push_back(
            {std::make_shared<const NoiseModel>(make_noise_model(scanner, config.seed)),
             static_cast<float>(solid_angle(registered.front()) / solid_angle(scanner)),
             static_cast<float>(scanner.angle_accuracy.in_radians()), static_cast<float>(scanner.range_accuracy_m),
             static_cast<float>(scanner.range_accuracy_ppm * 1e-6), static_cast<float>(scanner.max_range_m)});
    }
    return patch_scanners;
  }

  // Returns the planes of a sample, or of all voxels, which is the sample from 0. Empty if stopped.
  std::optional<RegistrationJob> registration_of(std::span<const std::uint32_t> voxel_indices, std::uint64_t from,
                                                 const RegistrationModel& model, bool groups,
                                                 const std::stop_token& stop) {
    const SamplePatches& own = patches.get(
        [&](const SamplePatches& one) {
          return one.from == from && one.patches->patches.size() == voxel_indices.size() && one.patches->model == model;
        },
        [&] {
          return SamplePatches{from, std::make_shared<Patches>(patches_of(voxel_indices, model, stop))};
        });
    if (own.patches->patches.size() < voxel_indices.size()) return std::nullopt;
    return RegistrationJob{own.patches, scanners_of_patches(), groups};
  }
  // Fills the sums of every voxel. Returns false if stopped.
  bool register_field(std::span<const TraceStation> stations, NetworkCounts& counts, const StationMasks& masks,
                      const RegistrationModel& model, const std::stop_token& stop) {
    const bool kept = grid->size() <= kKeptPlanes;
    const auto planes = [&](std::size_t first, std::size_t many) -> std::shared_ptr<const Patches> {
      std::vector<std::uint32_t> voxel_indices = first_numbers<std::uint32_t>(many, static_cast<std::uint32_t>(first));
      if (kept) {
        const std::optional<RegistrationJob> job = registration_of(voxel_indices, 0, model, false, stop);
        return job ? job->patches : nullptr;
      }
      auto made = std::make_shared<const Patches>(patches_of(voxel_indices, model, stop));
      return made->patches.size() < many ? nullptr : made;
    };
    auto sums =
        sum_patches(planes, kept ? grid->size() : kPlanesAtOnce, scanners_of_patches(), stations, counts, masks);
    if (!sums) return false;
    counts.registration = std::move(*sums);
    return true;
  }
  // Fills the sums of a growing sample until they are known well enough, or of every voxel. Returns false if stopped.
  bool register_enough(std::span<const TraceStation> stations, NetworkCounts& counts, const StationMasks& masks,
                       const EveryRayOptions& options, std::size_t network, const std::stop_token& stop) {
    for (std::uint64_t voxels = options.registration_voxels; voxels < grid->size(); voxels *= kSampleGrowth) {
      const std::vector<std::uint32_t>& sample = sample_of(voxels, 0).voxel_indices;
      const auto job = registration_of(sample, 0, *options.registration, true, stop);
      if (!job) return false;
      std::vector<std::uint64_t> words(sample.size() * masks.words());
      for (std::size_t w = 0; w < masks.words(); ++w)
        parallel::for_all(std::size_t{0}, sample.size(),
                          [&](std::size_t k) { words[w * sample.size() + k] = masks.word(w, sample[k]); });
      take_registration(counts, sum_patches(*job, stations, counts.stations, words, kSampleGroups));
      if (!options.registration_known || options.registration_known(network, counts)) return true;
      if (voxels > grid->size() / kSampleGrowth) break;
    }
    return register_field(stations, counts, masks, *options.registration, stop);
  }

  // Runs `work` alone. Isolation keeps oneTBB from giving this thread another task meanwhile, which could be a call of
  // the same simulator.
  template <class Work>
  auto alone(const Work& work) {
    if (caller.load(std::memory_order_relaxed) == std::this_thread::get_id())
      throw Error(Errc::invalid_argument,
                  "a callback of a simulator's call called that simulator; wait until the first call has returned, or "
                  "use another simulator");
    const std::lock_guard lock(running);
    const AsCaller named(caller);
    return tbb::this_task_arena::isolate(work);
  }

  ScanSummary scan(const Station& station, const ScanOptions& options,
                   const std::function<void(const ScanChunk&)>& sink, const Progress& progress);
  void follow_beams() {
    if (!wide_beam) wide_beam.emplace(share_scene(), grid);
  }
  // Works as Tracer::count() for a wide beam and any number of stations. Fills `field`.
  NetworkCounts count_beams(std::span<const TraceStation> stations, std::uint32_t station_count,
                            const BeamOptions& beam, bool masks, VoxelField& field, const Progress& progress);
  // `place`: the network's number among those of the caller.
  NetworkCounts evaluate(const Network& network, const EveryRayOptions& options, std::size_t place,
                         const Progress& progress);
  std::vector<NetworkCounts> evaluate_each(std::span<const Network> networks, const EveryRayOptions& options,
                                           const Progress& progress);
  std::vector<NetworkCounts> evaluate_sampled(std::span<const Network> networks, const SampleOptions& options,
                                              const Progress& progress);
  // Evaluates populations with a large network: its masks are merged on the host, and several at once would not fit.
  std::vector<NetworkCounts> evaluate_one_by_one(std::span<const Network> networks, const SampleOptions& options,
                                                 const Progress& progress);

  struct SamplePatches {
    std::uint64_t from;
    std::shared_ptr<const Patches> patches;
  };

  Scene scene;
  std::vector<Scanner> scanners;
  SimulatorConfig config;
  std::shared_ptr<const VoxelGrid> grid;
  double goal = 0;
  std::uint64_t needed_bytes = 0;    // upper bound on memory
  std::vector<TraceScanner> traced;  // of the scanners
  std::vector<Scanner> registered;   // scanners of the registered scans
  std::optional<SurfaceFinder> surfaces;
  std::optional<VoxelPlanes> planes;  // set if stations share a voxel only from one side of them
  LruCache<Sample> samples;
  LruCache<SamplePatches> patches;
  LruCache<VoxelMeshes> voxel_meshes;
  KnownPatches known_patches;
  std::vector<PatchScanner> patch_scanners;
  std::optional<RayFollower> mirrors;  // made for the first scan, if the scene has some
  std::optional<WideBeam> wide_beam;   // made for the first beam with one
  std::unique_ptr<Tracer> tracer;
  Work done;  // without the tracer's own figures
  std::mutex running;
  std::atomic<std::thread::id> caller;  // holds `running`
};

namespace {
constexpr std::array<std::pair<const char*, Returns>, 4> kReturns{
    {{"first", Returns::first}, {"strongest", Returns::strongest}, {"last", Returns::last}, {"all", Returns::all}}};
}  // namespace

std::string to_string(Returns returns) {
  return std::ranges::find(kReturns, returns, &std::pair<const char*, Returns>::second)->first;
}
Returns returns_from_string(const std::string& text) {
  for (const auto& [name, returns] : kReturns)
    if (text == name) return returns;
  throw Error(Errc::invalid_argument, "'" + text + "' is none of first, strongest, last, all");
}

Simulator::Simulator(const Scene& scene, const Scanner& scanner, const SimulatorConfig& config)
    : impl_(std::make_unique<Impl>(scene, std::span(&scanner, 1), config, Progress{})) {}
Simulator::Simulator(const Scene& scene, std::span<const Scanner> scanners, const SimulatorConfig& config)
    : impl_(std::make_unique<Impl>(scene, scanners, config, Progress{})) {}
Simulator::Simulator(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
std::optional<Simulator> Simulator::build(const Scene& scene, std::span<const Scanner> scanners,
                                          const SimulatorConfig& config, const Progress& progress) {
  auto impl = std::make_unique<Impl>(scene, scanners, config, progress);
  if (!impl->grid) return std::nullopt;
  return Simulator(std::move(impl));
}
Simulator::Simulator(Simulator&&) noexcept = default;
Simulator& Simulator::operator=(Simulator&&) noexcept = default;
Simulator::~Simulator() = default;

bool Simulator::set_scene(const Scene& scene) {
  return impl_->alone([&] { return impl_->set_scene(scene); });
}
void Simulator::set_scanners(std::span<const Scanner> scanners) {
  impl_->alone([&] { impl_->set_scanners({scanners.begin(), scanners.end()}); });
}

Work Simulator::work() const {
  Work work = impl_->done;
  work.uploaded_bytes = impl_->tracer->uploaded_bytes();
  return work;
}
const EngineInfo& Simulator::engine() const noexcept { return impl_->tracer->info(); }
const Scanner& Simulator::scanner() const noexcept { return impl_->scanners.front(); }
std::span<const Scanner> Simulator::scanners() const noexcept { return impl_->scanners; }
const Scene& Simulator::scene() const noexcept { return impl_->scene; }
const SimulatorConfig& Simulator::config() const noexcept { return impl_->config; }
Vec3 Simulator::origin() const noexcept { return impl_->data().origin; }
std::uint64_t Simulator::voxel_count() const noexcept { return impl_->grid->size(); }
double Simulator::voxel_size_m() const noexcept { return impl_->grid->voxel_size(); }
double Simulator::goal_density() const noexcept { return impl_->goal; }
double Simulator::goal_density(std::uint64_t voxel_index) const {
  const VoxelDemands& demands = impl_->grid->demands();
  return impl_->goal * demands.least_point_weight() / demands.point_weight(voxel_index);
}
std::optional<Angle> Simulator::max_incidence() const noexcept { return incidence_limit(impl_->data(), impl_->config); }

Vec3 Simulator::voxel_centre(std::uint64_t voxel_index) const {
  const auto [x, y, z] = morton_decode(impl_->grid->key(voxel_index));
  const auto& min = impl_->grid->min();
  const double size = impl_->grid->voxel_size();
  return origin() + Vec3{static_cast<double>(min[0]) + (x + 0.5) * size, static_cast<double>(min[1]) + (y + 0.5) * size,
                         static_cast<double>(min[2]) + (z + 0.5) * size};
}

std::uint32_t Simulator::point_weight(std::uint64_t voxel_index) const {
  return impl_->grid->demands().point_weight(voxel_index);
}
std::uint32_t Simulator::voxel_weight(std::uint64_t voxel_index) const {
  return impl_->grid->demands().weight(voxel_index);
}

std::vector<VoxelPatch> Simulator::voxel_patches(std::span<const std::uint32_t> voxel_indices) const {
  if (auto known = impl_->known_patches.find(voxel_indices)) return std::move(*known);
  std::vector<VoxelPatch> patches;
  patches.reserve(voxel_indices.size());
  for (const VoxelSurface& surface : impl_->surfaces->find(voxel_indices)) {
    const auto [x, y, z] = surface.point;
    patches.push_back({.point = origin() + Vec3{x, y, z},
                       .normal = {surface.normal.x, surface.normal.y, surface.normal.z},
                       .area_m2 = surface.extent,
                       .mesh = surface.mesh});
  }
  impl_->known_patches.keep(voxel_indices, patches);
  return patches;
}

std::vector<std::uint32_t> Simulator::sampled_voxels(std::uint64_t voxels, std::uint64_t from) const {
  return impl_->drawn(voxels, from);
}

void Simulator::stand_for(std::span<const Scanner> scanners) {
  impl_->registered.assign(scanners.begin(), scanners.end());
  impl_->planes.emplace(impl_->data(), *impl_->grid);
}
const VoxelPlanes* sides_of(const Simulator& simulator) {
  return simulator.impl_->planes ? &*simulator.impl_->planes : nullptr;
}
std::uint32_t count_sides(const Simulator& simulator, std::uint64_t voxel_index) {
  const VoxelPlanes* const planes = sides_of(simulator);
  return planes ? planes->sides(voxel_index) : 1;
}
std::uint32_t side_of(const Simulator& simulator, std::uint64_t voxel_index, const Vec3& place) {
  const VoxelPlanes* const planes = sides_of(simulator);
  const Vec3 local = place - simulator.origin();
  return planes ? planes->side(voxel_index,
                               {static_cast<float>(local.x), static_cast<float>(local.y), static_cast<float>(local.z)})
                : 0;
}
void share_one_sided(const Simulator& simulator, NetworkCounts& counts, const Network& network,
                     std::span<const std::uint32_t> voxel_indices, std::span<const std::uint64_t> masks) {
  if (const VoxelPlanes* const planes = sides_of(simulator); planes && !network.empty())
    share_one_sided(counts, simulator.impl_->active_stations(network), *planes, voxel_indices, masks);
}

ScanSummary Simulator::scan(const Station& station, const ScanOptions& options,
                            const std::function<void(const ScanChunk&)>& sink, const Progress& progress) {
  return impl_->alone([&] { return impl_->scan(station, options, sink, progress); });
}
NetworkCounts Simulator::evaluate(const Network& network, const EveryRayOptions& options, const Progress& progress) {
  return impl_->alone([&] {
    NetworkCounts counts = impl_->evaluate(network, options, 0, progress);
    impl_->done.networks += 1, impl_->done.rays += counts.rays;
    return counts;
  });
}
std::vector<NetworkCounts> Simulator::evaluate_each(std::span<const Network> networks, const EveryRayOptions& options,
                                                    const Progress& progress) {
  return impl_->alone([&] {
    std::vector<NetworkCounts> all = impl_->evaluate_each(networks, options, progress);
    for (const NetworkCounts& counts : all) impl_->done.networks += 1, impl_->done.rays += counts.rays;
    return all;
  });
}
std::vector<NetworkCounts> Simulator::evaluate_sampled(std::span<const Network> networks, const SampleOptions& options,
                                                       const Progress& progress) {
  return impl_->alone([&] {
    std::vector<NetworkCounts> all = impl_->evaluate_sampled(networks, options, progress);
    impl_->done.sampled_networks += all.size();
    for (const NetworkCounts& counts : all)
      impl_->done.sampled_voxels += counts.voxels, impl_->done.sampled_rays += counts.rays;
    return all;
  });
}

ScanSummary Simulator::Impl::scan(const Station& station, const ScanOptions& options,
                                  const std::function<void(const ScanChunk&)>& sink, const Progress& progress) {
  if (options.outputs & ~kKnownOutputs)
    throw Error(Errc::invalid_argument,
                "scan: unknown output bits " + std::to_string(options.outputs & ~kKnownOutputs));
  ScanSummary summary;
  if (!station.active) return summary;
  const TraceStation from = trace_station(station, options.place);
  const Scanner& scanner = scanners[from.scanner];
  const std::uint64_t columns = scanner.columns(), rays = scanner.rays();
  const std::uint64_t rows_at_once = std::max<std::uint64_t>(1, tracer->preferred_scan_rays(from.scanner) / columns);
  if (options.beam) {
    check_beam(*options.beam, scanner);
    follow_beams();
  } else if (!mirrors && std::ranges::any_of(data().meshes, &MeshInfo::mirror)) {
    mirrors.emplace(share_scene());
  }
  Tracer::RawChunk raw;
  ScanChunk chunk;
  std::vector<std::uint8_t> ghost, returns;
  for (std::uint64_t first = 0; first < rays; first += chunk.ray_count) {
    if (progress.stopped()) {
      summary.cancelled = true;
      break;
    }
    chunk.first_ray = first;
    chunk.ray_count = std::min(rows_at_once * columns, rays - first);
    const auto start = std::chrono::steady_clock::now();
    if (options.beam) {
      const TraceScanner& own = traced[from.scanner];
      const auto all = wide_beam->returns(scanner, own, from, *options.beam, first, chunk.ray_count);
      summary.trace_seconds += seconds_since(start);
      std::uint8_t most = 1;
      for (const WideBeam::Return& one : all) most = std::max(most, one.of);
      for (std::uint8_t number = 1; number <= most; ++number) {
        chunk.return_number = number;
        WideBeam::fill(all, number, first, chunk.ray_count, raw, ghost, returns, summary);
        if (options.instrument) apply(*options.instrument, scanner, from, first, raw);
        fill_chunk(chunk, raw, ghost, returns, options, data(), scanner, summary);
        if (sink) sink(chunk);
      }
    } else {
      tracer->scan(from, first, chunk.ray_count, raw_outputs(options), raw);
      ghost.assign(chunk.ray_count, 0);
      if (mirrors) mirrors->show_ghosts(traced[from.scanner], from, first, raw, ghost);
      summary.trace_seconds += seconds_since(start);
      returns.resize(chunk.ray_count);
      if (options.outputs & scan_returns)
        std::ranges::transform(raw.primitive, returns.begin(), [](std::uint32_t triangle) {
          return static_cast<std::uint8_t>(triangle == RayBundle::kNoHit ? 0 : 1);
        });
      if (options.instrument) apply(*options.instrument, scanner, from, first, raw);
      fill_chunk(chunk, raw, ghost, returns, options, data(), scanner, summary);
      if (sink) sink(chunk);
    }
    progress(static_cast<double>(first + chunk.ray_count) / static_cast<double>(rays));
  }
  return summary;
}

NetworkCounts Simulator::Impl::count_beams(std::span<const TraceStation> stations, std::uint32_t station_count,
                                           const BeamOptions& beam, bool masks, VoxelField& field,
                                           const Progress& progress) {
  for (const TraceStation& station : stations) check_beam(beam, scanners[station.scanner]);
  follow_beams();
  const auto start = std::chrono::steady_clock::now();
  const std::size_t voxels = grid->size();
  field.count.assign(voxels, 0);
  field.stations = masks ? StationMasks(voxels, station_count) : StationMasks();
  std::vector<std::uint32_t> points(voxels);
  std::vector<std::uint64_t> word(masks ? voxels : 0);  // of the 64 stations that are counted
  NetworkCounts sums;
  sums.points.resize(station_count), sums.points_on_surveyed.resize(station_count), sums.mixed.resize(station_count);
  if (limited()) sums.dropped.resize(station_count);
  for (std::size_t k = 0; k < stations.size() && !sums.cancelled; ++k) {
    const TraceStation& station = stations[k];
    const std::optional<WideBeam::Totals> own =
        wide_beam->count(scanners[station.scanner], traced[station.scanner], station, beam, points,
                         part_of(progress, k, stations.size()));
    sums.cancelled = !own;
    if (!own) break;
    sums.rays += scanners[station.scanner].rays();
    sums.points[station.place] = own->points;
    sums.points_on_surveyed[station.place] = own->points_on_surveyed;
    sums.mixed[station.place] = own->mixed;
    if (limited()) sums.dropped[station.place] = own->dropped;
    for (std::size_t v = 0; v < voxels; ++v) {
      add_saturating(field.count[v], points[v]);
      if (masks && points[v] > 0) word[v] |= std::uint64_t{1} << station.bit();
    }
    const std::size_t w = station.place / mask_bits;
    if (masks && (k + 1 == stations.size() || stations[k + 1].place / mask_bits != w)) {
      field.stations.set_words(w, word);
      std::ranges::fill(word, 0);
    }
  }
  NetworkCounts counts = reduce_field(field, station_count, goal, grid->demands());
  counts.rays = sums.rays, counts.cancelled = sums.cancelled, counts.trace_seconds = seconds_since(start);
  counts.points = std::move(sums.points), counts.points_on_surveyed = std::move(sums.points_on_surveyed);
  counts.dropped = std::move(sums.dropped), counts.mixed = std::move(sums.mixed);
  return counts;
}

NetworkCounts Simulator::Impl::evaluate(const Network& network, const EveryRayOptions& options, std::size_t place,
                                        const Progress& progress) {
  check_registration(options.registration, options.overlap);
  if (options.registration_voxels == 0) throw Error(Errc::invalid_argument, "a sample must have at least one voxel");
  const std::vector<TraceStation> active = active_stations(network);
  if (active.empty()) {
    const std::uint32_t point_weight = grid->demands().least_point_weight();
    if (options.field) {
      options.field->count.assign(grid->size(), 0);
      options.field->stations = StationMasks(grid->size(), network.size());
    }
    NetworkCounts counts = nothing_seen(grid->size(), grid->total_weight(), point_weight, network.size(),
                                        options.overlap, options.registration.has_value());
    counts.points_on_surveyed.assign(network.size(), 0);
    if (limited()) counts.dropped.assign(network.size(), {});
    if (!options.skip || options.beam) counts.points.assign(network.size(), 0);
    if (options.beam) counts.mixed.assign(network.size(), {});
    if (options.meshes) counts.meshes = count_meshes(std::vector<std::uint32_t>(grid->size()));
    return counts;
  }
  VoxelField own;
  const bool one_sided = planes && options.overlap;
  const bool kept = options.registration || options.beam || options.meshes || one_sided;
  VoxelField* field = kept && !options.field ? &own : options.field;
  const auto size = static_cast<std::uint32_t>(network.size());
  NetworkCounts counts = options.beam
                             ? count_beams(active, size, *options.beam, options.overlap, *field, progress)
                             : count_in_passes(*tracer, active, size, {.masks = options.overlap, .skip = options.skip},
                                               field, *grid, goal, progress);
  if (options.registration && !counts.cancelled)
    counts.cancelled = !register_enough(active, counts, field->stations, options, place, progress.stop);
  if (one_sided && !counts.cancelled) share_one_sided(counts, active, *planes, field->stations);
  if (options.meshes && !counts.cancelled) counts.meshes = count_meshes(field->count);
  return counts;
}

std::vector<NetworkCounts> Simulator::Impl::evaluate_each(std::span<const Network> networks,
                                                          const EveryRayOptions& options, const Progress& progress) {
  if (options.field && networks.size() != 1)
    throw Error(Errc::invalid_argument, "the points of every voxel are kept of one network at a time");
  std::vector<NetworkCounts> all(networks.size());
  for (NetworkCounts& counts : all) counts.cancelled = true;
  // Networks without active stations skip the engine; sums over the field, and passes, are made here.
  std::vector<std::vector<TraceStation>> tracing;
  std::vector<std::uint32_t> sizes;
  std::vector<std::size_t> places;
  const auto many = static_cast<double>(networks.size());
  for (std::size_t k = 0; k < networks.size() && !progress.stopped(); ++k) {
    std::vector<TraceStation> active = active_stations(networks[k]);
    if (active.empty() || options.registration || options.beam || options.field || options.meshes ||
        (planes && options.overlap) || networks[k].size() > mask_bits) {
      all[k] = evaluate(
          networks[k], options, k,
          {.report = [&](double part) { progress((static_cast<double>(k) + part) / many); }, .stop = progress.stop});
      continue;
    }
    tracing.push_back(std::move(active));
    sizes.push_back(static_cast<std::uint32_t>(networks[k].size()));
    places.push_back(k);
  }
  std::vector<NetworkCounts> counts =
      tracer->count_each(tracing, sizes, {.masks = options.overlap, .skip = options.skip}, progress);
  for (std::size_t k = 0; k < counts.size(); ++k) all[places[k]] = std::move(counts[k]);
  return all;
}

std::vector<NetworkCounts> Simulator::Impl::evaluate_one_by_one(std::span<const Network> networks,
                                                                const SampleOptions& options,
                                                                const Progress& progress) {
  std::vector<NetworkCounts> all;
  const auto share = [&](double done) {
    progress((static_cast<double>(all.size()) + done) / static_cast<double>(networks.size()));
  };
  for (std::size_t k = 0; k < networks.size(); ++k) {
    SampleOptions one = options;
    if (options.points)
      one.points = [&options, k](std::size_t, std::span<const std::uint32_t> points) { options.points(k, points); };
    NetworkCounts counts =
        evaluate_sampled(networks.subspan(k, 1), one, {.report = share, .stop = progress.stop}).front();
    all.push_back(std::move(counts));
    if (all.back().cancelled) break;
  }
  for (std::size_t k = all.size(); k < networks.size(); ++k) all.push_back(all.back());
  return all;
}

std::vector<NetworkCounts> Simulator::Impl::evaluate_sampled(std::span<const Network> networks,
                                                             const SampleOptions& options, const Progress& progress) {
  check_registration(options.registration, options.overlap);
  if (options.meshes && options.count_to == CountTo::one)
    throw Error(Errc::invalid_argument, "counts by mesh need the points of each voxel up to the goal");
  const bool large = std::ranges::any_of(networks, [](const Network& n) { return n.size() > mask_bits; });
  if (large && networks.size() > 1) return evaluate_one_by_one(networks, options, progress);
  const Sample& taken = sample_of(options.voxels, options.from);
  const std::vector<std::uint32_t>& sample = taken.voxel_indices;
  if (!options.leave_out.empty() && options.leave_out.size() != sample.size())
    throw Error(Errc::invalid_argument, "evaluate_sampled: leave_out has " + std::to_string(options.leave_out.size()) +
                                            " voxels, and the sample " + std::to_string(sample.size()));
  const std::size_t groups = options.groups ? kSampleGroups : 1;
  std::vector<NetworkCounts> all(networks.size());
  // Networks without active stations skip the engine.
  std::vector<std::vector<TraceStation>> tracing;
  std::vector<std::uint32_t> sizes;
  std::vector<std::size_t> places;
  for (std::size_t k = 0; k < networks.size(); ++k) {
    std::vector<TraceStation> active = active_stations(networks[k]);
    if (active.empty() || sample.empty()) {
      const std::uint32_t point_weight = grid->demands().least_point_weight();
      all[k] = nothing_seen(sample.size(), weight_of(sample, 0, 1), point_weight, networks[k].size(), options.overlap,
                            options.registration.has_value());
      for (std::uint32_t g = 0; options.groups && g < kSampleGroups; ++g) {
        all[k].groups.push_back(nothing_seen((sample.size() + kSampleGroups - 1 - g) / kSampleGroups,
                                             weight_of(sample, g, kSampleGroups), point_weight, networks[k].size(),
                                             options.overlap, options.registration.has_value()));
        if (options.registration) all[k].registration.groups.push_back(std::move(all[k].groups.back().registration));
      }
      const std::vector<std::uint32_t> none(sample.size());
      if (options.meshes) take_meshes(all[k], count_meshes(none, sample, taken.from, groups));
      if (options.points) options.points(k, none);
      continue;
    }
    tracing.push_back(std::move(active));
    sizes.push_back(static_cast<std::uint32_t>(networks[k].size()));
    places.push_back(k);
  }
  if (tracing.empty()) return all;
  std::vector<std::vector<std::vector<MeshVoxels>>> by_mesh(options.meshes ? tracing.size() : 0);
  const auto points = [&](std::size_t k, std::span<const std::uint32_t> counted) {
    if (options.meshes) by_mesh[k] = count_meshes(counted, sample, taken.from, groups);
    if (options.points) options.points(places[k], counted);
  };
  std::optional<RegistrationJob> registration;
  if (options.registration) {
    registration = registration_of(sample, taken.from, *options.registration, options.groups, progress.stop);
    if (!registration) {
      for (NetworkCounts& counts : all) counts.cancelled = true;
      return all;
    }
  }
  // Sharing from one side, which then goes into the counts.
  std::vector<NetworkCounts> sharing(planes && options.overlap ? tracing.size() : 0);
  const auto share = [&](std::size_t first, std::span<const std::uint64_t> masks) {
    const std::size_t words = sample.size() * (large ? mask_words(sizes.front()) : 1);
    for (std::size_t k = 0; k * words < masks.size(); ++k) {
      NetworkCounts& own = sharing[first + k];
      own.stations = sizes[first + k];
      own.groups.resize(options.groups ? kSampleGroups : 0);
      share_one_sided(own, tracing[first + k], *planes, sample, masks.subspan(k * words, words));
    }
  };
  const Tracer::SampleJob job{.sample = sample,
                              .groups = options.groups ? kSampleGroups : 0,
                              .masks = options.overlap,
                              .stop_at = stop_at(options.count_to, goal),
                              .points = options.points || options.meshes ? decltype(options.points)(points) : nullptr,
                              .station_masks = sharing.empty() ? decltype(Tracer::SampleJob::station_masks)() : share,
                              .registration = registration ? &*registration : nullptr,
                              .leave_out = options.leave_out};
  std::vector<NetworkCounts> counts;
  if (large)
    counts.push_back(count_sampled_in_passes(*tracer, tracing.front(), sizes.front(), job, *grid, goal, progress));
  else
    counts = tracer->count_sampled(tracing, sizes, job, progress);
  for (std::size_t k = 0; k < sharing.size(); ++k) {
    if (counts[k].cancelled) continue;
    counts[k].shared = std::move(sharing[k].shared);
    for (std::size_t g = 0; g < counts[k].groups.size(); ++g)
      counts[k].groups[g].shared = std::move(sharing[k].groups[g].shared);
  }
  for (std::size_t k = 0; k < by_mesh.size(); ++k)
    if (!counts[k].cancelled) take_meshes(counts[k], by_mesh[k]);
  for (std::size_t k = 0; k < counts.size(); ++k) all[places[k]] = std::move(counts[k]);
  return all;
}

}  // namespace vantage
