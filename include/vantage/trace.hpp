// SPDX-License-Identifier: Apache-2.0
/// Tracing's public types: engines and their devices, counts of a network, counts of each voxel.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "vantage/types.hpp"

namespace vantage {

/// Engines that trace rays. Counts do not depend on the choice, except for ray-triangle rounding at edges.
enum class Engine {
  automatic,    ///< The best hardware GPU; else `embree`.
  ray_query,    ///< Vulkan compute shaders with VK_KHR_ray_query.
  compute_bvh,  ///< Vulkan compute shaders with our own BVH.
  embree,       ///< CPU.
};
std::string to_string(Engine);  ///< "auto", "ray_query", "compute_bvh", "embree"
/// Throws Error invalid_argument and lists the engines.
Engine engine_from_string(const std::string&);

/// An engine on a device, as `list_engines` finds it.
struct EngineInfo {
  Engine engine = Engine::embree;  ///< Engine that traces.
  std::string device;              ///< "llvmpipe (LLVM 15.0.6, 256 bits)"
  std::string driver;              ///< Driver or library, with its version.
  std::uint32_t device_index = 0;  ///< Number of the device, among those of its interface.
  bool usable = false;             ///< True if a simulator can be made on it.
  bool software = false;           ///< A CPU behind a GPU interface.
  bool chosen_by_default = false;  ///< `Engine::automatic` takes it.
  std::string reason;              ///< Why it was taken or refused.
};
/// All engines on all devices of this machine, usable or not. Having no device is no error.
std::vector<EngineInfo> list_engines();

/// An engine on a device, as requested.
struct DeviceChoice {
  Engine engine = Engine::automatic;                  ///< Engine that traces.
  std::optional<std::uint32_t> index = std::nullopt;  ///< `EngineInfo::device_index`; empty: the best device that has
                                                      ///< the engine.
  friend bool operator==(const DeviceChoice&, const DeviceChoice&) = default;
};
/// Every hardware device that has the engine; for `automatic`, the engine of the best. Without such a device, the
/// single choice that `engine` stands for.
std::vector<DeviceChoice> all_devices(Engine engine = Engine::automatic);

/// Most stations of a network.
inline constexpr std::size_t max_stations = 1024;
/// Each station has a bit in the station mask of a voxel: bit i % 64 of word i / 64.
inline constexpr std::size_t mask_bits = 64;
/// Words of such a mask.
constexpr std::size_t mask_words(std::size_t stations) { return (stations + mask_bits - 1) / mask_bits; }

/// Accuracy of a surface in one scan, apart from range noise: a modelling error ρ that is constant over a patch of side
/// L. A huge wall therefore does not count as a million independent measurements.
struct RegistrationModel {
  double rho_m = 0.0015;  ///< ρ, one standard deviation along the surface's normal; above 0.
  double patch_m = 0.5;   ///< L, above 0. A plane counts if the surface is flat over half of it.
  friend bool operator==(const RegistrationModel&, const RegistrationModel&) = default;
};

/// Registration information in the station masks: sums over voxels of point-to-plane information (docs/method.md).
/// Exact, except for one rounding of each sum to double.
struct RegistrationSums {
  /// Numbers of a pair, of a station, and of a row of `instrument`.
  static constexpr std::size_t of_pair = 21, of_station = 10, instrument_errors = 14;
  std::uint64_t voxels = 0;  ///< Voxels that were summed: those counted, or a sample of them.
  Vec3 centre;               ///< Local frame; places and rotations are relative to it.
  double radius_m = 1;       ///< Unit of places; rotations are in units of 1 / it.
  std::vector<Vec3> heads;   ///< Per station, metres from the centre; empty unless sums were asked for.
  /// Per pair, in the order of `NetworkCounts::shared`: the upper triangle, row by row, of Σ w_i w_j / Σ_k w_k · J Jᵀ
  /// in 1/m², with J = [place × normal, normal].
  std::vector<double> pairs;
  /// Per station: moments 1, x, y, z, xx, xy, xz, yy, yz, zz of the places of the surface it sees, in voxel faces.
  /// Surface seen by k stations counts 1/k for each.
  std::vector<double> surface;
  /// Per station, 6 × 14 row-major: Σ w_i (b_i − b̄) · J in 1/m, where b are the distances along the normal by which a
  /// scanner's errors (`Scanner::angle_accuracy`), one standard deviation each, move the plane in a scan, and b̄ their
  /// mean over the scans that see it. Vertical index, collimation and trunnion axis, halved, for each of four draws of
  /// the directions in which scans begin; then offset and scale of ranges. Empty if no scanner states them.
  std::vector<double> instrument;
  /// The same sums for each of G interleaved groups of a sample, for standard errors; empty if all voxels were summed.
  /// Networks of more than 64 stations leave out the pairs whose sums are 0.
  std::vector<RegistrationSums> groups;
};

/// Points of one station in surveyed voxels that do not count because they miss a limit
/// (`SimulatorConfig::max_incidence`, `MeshInfo::detail_m`, `MeshInfo::accuracy_m`, `Scanner::detection_range_m`). A
/// point may miss several.
struct DroppedPoints {
  std::uint64_t points = 0;     ///< Points that miss any limit.
  std::uint64_t incidence = 0;  ///< Incidence too oblique.
  std::uint64_t footprint = 0;  ///< Beam footprint too wide.
  std::uint64_t noise = 0;      ///< Range too noisy.
  std::uint64_t echo = 0;       ///< Echo too weak to be detected, or lost at random.
  friend bool operator==(const DroppedPoints&, const DroppedPoints&) = default;
  /// Sums of both, member by member.
  friend DroppedPoints operator+(const DroppedPoints& a, const DroppedPoints& b) {
    return {a.points + b.points, a.incidence + b.incidence, a.footprint + b.footprint, a.noise + b.noise,
            a.echo + b.echo};
  }
};

/// Mixed points of one station: returns of a beam with a width (`BeamOptions`) that lie off all surfaces they were made
/// of, by more than 5 mm. Those in neither of these voxels lie in no surveyed one.
struct MixedPoints {
  std::uint64_t points = 0;       ///< All of them, wherever they lie.
  std::uint64_t counted = 0;      ///< Points that count, in a voxel that one of their echoes came from.
  std::uint64_t wrong_voxel = 0;  ///< Points in another surveyed voxel. These do not count.
  friend bool operator==(const MixedPoints&, const MixedPoints&) = default;
  /// Sums of both, member by member.
  friend MixedPoints operator+(const MixedPoints& a, const MixedPoints& b) {
    return {a.points + b.points, a.counted + b.counted, a.wrong_voxel + b.wrong_voxel};
  }
};

/// Counted voxels of one mesh. A voxel belongs to the mesh with most surface in it.
struct MeshVoxels {
  std::uint64_t voxels = 0;    ///< Counted ones.
  std::uint64_t captured = 0;  ///< Those that reached their goal density.
  friend bool operator==(const MeshVoxels&, const MeshVoxels&) = default;
};

/// A simulated network's result in the surveyed voxels, reduced to integers. Exact, so independent of engine, order and
/// chunking.
struct NetworkCounts {
  std::uint64_t voxels = 0;  ///< N_v, or the size of the sample.
  /// Sum of the voxels' weights (`MeshInfo::weight`); equals `voxels` if all surveyed meshes weigh the same.
  std::uint64_t weight = 0;
  std::uint64_t saturated = 0;  ///< Weight of the voxels that reached the goal density.
  /// Points in all other voxels together, each times its voxel's weight and its point weight.
  std::uint64_t partial_points = 0;
  /// Point weight in a voxel of the densest goal. Above 1 only if goals differ: a point weighs more in a voxel that
  /// needs fewer.
  std::uint32_t point_weight = 1;
  std::uint64_t rays = 0;             ///< Rays traced.
  std::uint32_t stations = 0;         ///< N_stations, skipped ones included.
  std::vector<std::uint64_t> points;  ///< Per station, on all meshes; empty if not counted (rays were skipped).
  std::vector<std::uint64_t> points_on_surveyed;  ///< Per station, points that count.
  std::vector<DroppedPoints> dropped;             ///< Per station; empty if points have no limits, or for a sample.
  std::vector<MixedPoints> mixed;                 ///< Per station; empty without a beam that has a width.
  std::vector<std::uint64_t> seen;                ///< Per station: voxels with a point of it. Empty without overlap.
  /// Voxels seen by both i and j, i < j, in the order (0,1), (0,2), …, (1,2), …; empty without overlap.
  std::vector<std::uint64_t> shared;
  std::vector<MeshVoxels> meshes;  ///< Per mesh of the scene, in its order; empty unless asked for.
  RegistrationSums registration;   ///< If asked for.
  /// The same counts for each of G interleaved groups of a sample, for standard errors; empty when exact.
  std::vector<NetworkCounts> groups;
  /// Sum over successive sampled voxels of the squared difference of min(count/goal, 1), for the standard error of
  /// coverage. Infinite for a sample without groups.
  double successive_difference_sum = 0;
  double trace_seconds = 0;  ///< Time of tracing; not reproducible.
  bool cancelled = false;    ///< It was stopped; the counts are then of no use.

  std::uint64_t shared_by(std::size_t i, std::size_t j) const;  ///< REQUIRES: i != j, both < stations.
};

/// Which stations have a point in which voxel. Hundreds of stations see a small part of a site each, so 64 of them take
/// memory only for those blocks of voxels in which one has a point; up to 64 in all have a word for each voxel.
class StationMasks {
 public:
  static constexpr std::size_t block_voxels = 4096;  ///< Voxels of a block.

  StationMasks() = default;
  /// No station has a point yet.
  StationMasks(std::size_t voxels, std::size_t stations);
  /// The masks of up to 64 stations: a word for each voxel.
  explicit StationMasks(std::vector<std::uint64_t> words)
      : voxels_(words.size()), words_(1), only_word_(std::move(words)) {}

  bool empty() const { return words_ == 0; }      ///< No masks were asked for.
  std::size_t voxels() const { return voxels_; }  ///< Number of voxels.
  std::size_t words() const { return words_; }    ///< Number of words, for 64 stations each.
  /// Bit b means that station 64 w + b has a point in the voxel. REQUIRES: w < words(), voxel < voxels().
  std::uint64_t word(std::size_t w, std::size_t voxel) const {
    if (words_ == 1) return only_word_[voxel];
    const std::span<const std::uint64_t> own = block(w, voxel / block_voxels);
    return own.empty() ? 0 : own[voxel % block_voxels];
  }
  /// Word w of all voxels. REQUIRES: masks.size() == voxels(). Parallel.
  void set_words(std::size_t w, std::span<const std::uint64_t> masks);
  /// Word w of the voxels from block_voxels · k on; empty if it takes no memory, being 0 for all of them.
  std::span<const std::uint64_t> block(std::size_t w, std::size_t k) const {
    if (words_ != 1) return blocks_[w * blocks() + k];
    const std::size_t first = k * block_voxels, left = voxels_ - first;
    return std::span(only_word_).subspan(first, left < block_voxels ? left : block_voxels);
  }
  /// Calls visit(station) for each station with a point in the voxel, ascending.
  template <class Visit>
  void for_each_station(std::size_t voxel, const Visit& visit) const {
    for (std::size_t w = 0; w < words_; ++w)
      for (std::uint64_t mask = word(w, voxel); mask != 0; mask &= mask - 1)
        visit(w * mask_bits + static_cast<std::size_t>(std::countr_zero(mask)));
  }
  /// Every word: word w of voxel k is at w · voxels() + k.
  std::vector<std::uint64_t> all_words() const;

  friend bool operator==(const StationMasks&, const StationMasks&) = default;

 private:
  std::size_t blocks() const { return (voxels_ + block_voxels - 1) / block_voxels; }

  std::size_t voxels_ = 0, words_ = 0;
  std::vector<std::uint64_t> only_word_;            // of a single word
  std::vector<std::vector<std::uint64_t>> blocks_;  // of more
};

/// Voxel field: the map of coverage. Element k belongs to the k-th surveyed voxel in Morton order.
struct VoxelField {
  std::vector<std::uint32_t> count;  ///< Points, saturating.
  StationMasks stations;             ///< Empty without overlap.
};

}  // namespace vantage
