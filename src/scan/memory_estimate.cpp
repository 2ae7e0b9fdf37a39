// SPDX-License-Identifier: Apache-2.0
#include "scan/memory_estimate.hpp"

#include <tbb/info.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/free_memory.hpp"
#include "core/glm.hpp"
#include "core/parallel.hpp"
#include "core/text.hpp"
#include "scene/positions.hpp"
#include "trace/tracer.hpp"
#include "trace/vulkan/device_memory.hpp"
#include "vantage/error.hpp"
#include "voxel/voxel_bricks.hpp"

namespace vantage {
namespace {

// Measured on processes (docs/evidence/reliability.md). Per voxel: its count, its share of a brick, and the words of
// its mask. Per triangle: vertices and temporary data; the tree and planes of the CPU engine. Per place of a shared
// triangle: a bit.
constexpr double kMebibyte = 1048576, kProgram = 24 * kMebibyte, kThread = kMebibyte, kTriangle = 75, kTree = 90,
                 kPlaced = 1.0 / 8, kVoxel = 6, kMaskWord = 8;
constexpr double kVertex = 12;                      // the CPU engine's tree of glass has a copy of all
constexpr double kSoftwareDriver = 86 * kMebibyte;  // lavapipe with its compiler

struct SurfaceExtent {
  double cells_m2 = 0;  // an infinite plane with normal n meets |nx| + |ny| + |nz| cells per face of a cell
  double extent_m = 0;
};

// Calls body(sum, triangle) for every surveyed triangle, and adds up the sums of blocks, always in one order.
template <class Sum, class Body>
Sum sum_surveyed(const SceneData& scene, const Body& body) {
  Sum sum;
  for (const MeshRange& mesh : surveyed_ranges(scene))
    sum += parallel::reduce_in_order(
        tbb::blocked_range<std::uint32_t>(mesh.first_triangle, mesh.first_triangle + mesh.triangle_count, 4096), Sum{},
        [&](const tbb::blocked_range<std::uint32_t>& range, Sum own) {
          for (std::uint32_t t = range.begin(); t != range.end(); ++t) body(own, t);
          return own;
        },
        [](Sum a, const Sum& b) { return a += b; });
  return sum;
}

SurfaceExtent surface_of(const SceneData& scene) {
  struct Sum {
    double cells_m2 = 0;
    glm::dvec3 low{INFINITY}, high{-INFINITY};
    Sum& operator+=(const Sum& other) {
      cells_m2 += other.cells_m2, low = glm::min(low, other.low), high = glm::max(high, other.high);
      return *this;
    }
  };
  const Sum sum = sum_surveyed<Sum>(scene, [&](Sum& own, std::uint32_t t) {
    const auto [a, b, c] = corners_of(scene, t);
    const glm::dvec3 normal = cross(b - a, c - a);
    own.cells_m2 += 0.5 * (std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z));
    own.low = glm::min(own.low, glm::min(a, glm::min(b, c))),
    own.high = glm::max(own.high, glm::max(a, glm::max(b, c)));
  });
  SurfaceExtent surface{.cells_m2 = sum.cells_m2};
  const glm::dvec3 size = sum.high - sum.low;
  if (surface.cells_m2 > 0) surface.extent_m = std::max({size.x, size.y, size.z});
  return surface;
}

// Long triangles with hardly any area: each marks a row of voxels, which its area does not show.
struct Slivers {
  double cells_m2 = 0;            // their share of the surface's
  double voxels = 0, bricks = 0;  // that they pass through, each once
};

// Bytes of a brick that hardly anything but a sliver crosses: the brick, and its place in the hash table.
constexpr double kBrickBytes = 144;

struct Sliver {
  glm::dvec3 begin, along;  // its longest edge, in voxels
};

// Returns the slivers among all surveyed triangles, and their share of the surface.
std::vector<Sliver> find_slivers(const SceneData& scene, double voxel_size, double& cells_m2) {
  constexpr double kLong = 8, kThin = 0.25;  // voxels; share of those that it passes through
  const double least = kLong * voxel_size * kLong * voxel_size;
  struct Sum {
    std::vector<Sliver> found = {};
    double cells_m2 = 0;
    Sum& operator+=(const Sum& other) {
      found.insert(found.end(), other.found.begin(), other.found.end()), cells_m2 += other.cells_m2;
      return *this;
    }
  };
  Sum sum = sum_surveyed<Sum>(scene, [&](Sum& own, std::uint32_t t) {
    const std::array<glm::dvec3, 3> p = corners_of(scene, t), edges{p[1] - p[0], p[2] - p[1], p[0] - p[2]};
    const std::array<double, 3> squares{dot(edges[0], edges[0]), dot(edges[1], edges[1]), dot(edges[2], edges[2])};
    const auto longest = static_cast<std::size_t>(std::ranges::max_element(squares) - squares.begin());
    if (squares[longest] <= least) return;
    const glm::dvec3 normal = cross(edges[0], edges[1]);
    const double area = 0.5 * (std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z));
    if (area >= kThin * voxel_size * std::sqrt(squares[longest])) return;
    own.found.push_back({p[longest] / voxel_size, edges[longest] / voxel_size});
    own.cells_m2 += area;
  });
  cells_m2 = sum.cells_m2;
  return std::move(sum.found);
}

// Returns the first step after step k that lies outside the brick of step k.
double behind_brick(const std::array<std::int64_t, 3>& brick, const glm::dvec3& at, const glm::dvec3& step, double k) {
  constexpr double kSide = 8;
  double leaves = INFINITY;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = kSide * static_cast<double>(brick[static_cast<std::size_t>(axis)]);
    if (step[axis] > 0) leaves = std::min(leaves, (low + kSide - at[axis]) / step[axis]);
    if (step[axis] < 0) leaves = std::min(leaves, (low - at[axis]) / step[axis]);
  }
  return k + std::max(1.0, std::ceil(leaves));
}

// Follows every sliver, and counts the crossed voxels in a share of the bricks, chosen by their places.
Slivers slivers_of(const SceneData& scene, double voxel_size) {
  constexpr double kCounted = 0x1p20, kTooMany = 0x1p31;
  const auto steps_of = [](const Sliver& sliver) {
    return std::ceil(std::abs(sliver.along.x) + std::abs(sliver.along.y) + std::abs(sliver.along.z));
  };
  Slivers found;
  const std::vector<Sliver> slivers = find_slivers(scene, voxel_size, found.cells_m2);
  double steps = 0;
  for (const Sliver& sliver : slivers) steps += steps_of(sliver);
  if (!(steps < kTooMany)) {  // more than any site has
    found.voxels = found.bricks = steps;
    return found;
  }
  const auto one_of = static_cast<std::uint64_t>(std::max(1.0, steps / kCounted));
  std::vector<std::uint64_t> voxels;
  for (const Sliver& sliver : slivers) {
    const double count = steps_of(sliver);
    const glm::dvec3 step = sliver.along / count;
    for (double k = 0; k < count;) {
      const glm::dvec3 at = sliver.begin + step * (k + 0.5);
      std::array<std::int64_t, 3> brick{};
      std::uint64_t place = 0, inner = 0;  // 18 bits of an axis are as many as a grid has
      for (int axis = 0; axis < 3; ++axis) {
        const auto cell = static_cast<std::int64_t>(std::floor(at[axis]));
        brick[static_cast<std::size_t>(axis)] = cell >> 3;
        place = place << 18 | (static_cast<std::uint64_t>(cell >> 3) & 0x3FFFF);
        inner = inner << 3 | (static_cast<std::uint64_t>(cell) & 7);
      }
      constexpr std::uint64_t kMix = 0x9E3779B97F4A7C15u;
      if (((place * kMix) >> 32) % one_of == 0)
        voxels.push_back(place << 9 | inner), ++k;
      else
        k = behind_brick(brick, at, step, k);
    }
  }
  std::ranges::sort(voxels);
  for (std::size_t k = 0; k < voxels.size(); ++k) {
    if (k > 0 && voxels[k] == voxels[k - 1]) continue;
    ++found.voxels;
    if (k == 0 || voxels[k] >> 9 != voxels[k - 1] >> 9) ++found.bricks;
  }
  found.voxels *= static_cast<double>(one_of), found.bricks *= static_cast<double>(one_of);
  return found;
}

// Returns the side of a voxel by equation 2.
double voxel_size(double extent_m, double user_size_m) {
  if (!(extent_m > 0)) return user_size_m;
  return extent_m / std::exp2(std::max(0.0, std::ceil(std::log2(extent_m / user_size_m))));
}

// Number of voxels of a brick on a surface. Voxels so scattered that each has its own brick are few.
constexpr double kVoxelsOfABrick = 64;

double host_bytes(double triangles, double voxels, std::size_t stations) {
  return kProgram + kThread * tbb::info::default_concurrency() + kTriangle * triangles +
         voxels * (kVoxel + kMaskWord * static_cast<double>(mask_words(stations)));
}

std::uint64_t whole(double bytes) { return static_cast<std::uint64_t>(std::min(bytes, 1e18)); }

// Returns the devices of a configuration, each once.
std::vector<ChosenDevice> devices_of(const SimulatorConfig& config) {
  std::vector<ChosenDevice> devices;
  if (config.devices.empty()) devices.push_back(choose_device(config.engine, config.device_index));
  for (const DeviceChoice& choice : config.devices) devices.push_back(choose_device(choice.engine, choice.index));
  return devices;
}

class Estimator {
 public:
  Estimator(const Scene& scene, std::span<const Scanner> scanners, std::size_t stations, bool goals_differ = false)
      : scene_(scene.data()),
        surface_(surface_of(scene_)),
        stations_(stations),
        demands_(goals_differ ? sizeof(std::uint32_t) : 0) {
    const Scanner* const largest = &*std::ranges::max_element(scanners, {}, &Scanner::rays);
    const auto noisy = [](const Scanner& scanner) { return !scanner.noise.sigma_m.empty(); };
    const auto detects = [](const Scanner& scanner) { return scanner.detection_range_m > 0; };
    const bool limited = std::ranges::any_of(scanners, detects);
    const auto asks = [](const MeshInfo& mesh) { return mesh.detail_m || mesh.accuracy_m; };
    load_ = {.vertices = static_cast<double>(scene_.positions.size()),
             .triangles = static_cast<double>(scene_.triangles.size()),
             .runs = static_cast<double>(scene_.instances.size()),
             .rows = static_cast<std::uint32_t>(largest->rows()),
             .columns = static_cast<std::uint32_t>(largest->columns()),
             .stations = static_cast<std::uint32_t>(std::min(stations, mask_bits)),
             .shaded = limited || std::ranges::any_of(scanners, noisy) || std::ranges::any_of(scene_.meshes, asks),
             .normals = !scene_.normals.empty(),
             .glass = limited ? static_cast<double>(scene_.triangle_count() - scene_.opaque_count()) : 0};
    for (const Image& image : scene_.images) textures_ += static_cast<double>(image.rgba.size());
    follows_mirrors_ = std::ranges::any_of(scene_.meshes, &MeshInfo::mirror);
  }

  SimulatorMemory operator()(double user_size_m, const std::vector<ChosenDevice>& devices) const {
    const double side = voxel_size(surface_.extent_m, user_size_m), cell_m2 = side * side;
    const Slivers slivers = slivers_of(scene_, side);
    const double of_slivers = std::max(slivers.cells_m2 / cell_m2, slivers.voxels);
    const double voxels = (surface_.cells_m2 - slivers.cells_m2) / cell_m2 + of_slivers;
    const double bricks_bytes = kBrickBytes * std::max(0.0, slivers.bricks - of_slivers / kVoxelsOfABrick);
    double host = host_bytes(load_.triangles, voxels, stations_) + demands_ * voxels + bricks_bytes + textures_,
           device = 0;
    if (scene_.shares()) host += kPlaced * scene_.triangle_count();
    // Scans follow rays off mirrors on the CPU with every engine.
    if (follows_mirrors_) host += kTree * load_.triangles;
    const auto on_cpu = [](const ChosenDevice& each) { return each.engine == Engine::embree; };
    if (devices.empty() || std::ranges::any_of(devices, on_cpu))
      host += kTree * load_.triangles + (load_.glass > 0 ? kVertex * load_.vertices : 0);
    for (const ChosenDevice& each : devices) {
      if (each.engine == Engine::embree) continue;
      vulkan::DeviceLoad load = load_;
      load.engine = each.engine, load.software = each.software;
      load.voxels = voxels, load.bricks = voxels / kVoxelsOfABrick;
      const double own = vulkan::device_bytes(load) + demands_ * voxels;
      device = std::max(device, own);
      if (each.software) host += own + kSoftwareDriver;
    }
    return {.voxels = whole(voxels), .bytes = whole(host), .device_bytes = whole(device)};
  }

 private:
  const SceneData& scene_;
  SurfaceExtent surface_;
  std::size_t stations_;
  double demands_;       // bytes per voxel, for point weights
  double textures_ = 0;  // bytes
  bool follows_mirrors_ = false;
  vulkan::DeviceLoad load_;
};

}  // namespace

SimulatorMemory simulator_memory(const Scene& scene, std::span<const Scanner> scanners, const SimulatorConfig& config,
                                 std::size_t stations) {
  return Estimator(scene, scanners, stations, config.spacing_by_detail)(config.user_size_m, devices_of(config));
}

MemoryEstimate estimate_memory(const Scene& scene, double user_size_m, std::size_t stations) {
  if (!(user_size_m > 0 && std::isfinite(user_size_m))) return {};
  const Scanner any;
  const SimulatorMemory memory = Estimator(scene, {&any, 1}, stations)(user_size_m, {});
  return {.voxels = memory.voxels, .bytes = memory.bytes};
}

std::uint64_t bytes_of_meshes(const SceneData& scene, std::span<const MeshRange> meshes, double voxel_size_m) {
  double triangles = 0, voxels = 0;
  for (const MeshRange& mesh : meshes) {
    triangles += mesh.triangle_count;
    for (std::uint32_t t = mesh.first_triangle; t < mesh.first_triangle + mesh.triangle_count; ++t) {
      const auto [a, b, c] = corners_of(scene, t);
      const glm::dvec3 normal = cross(b - a, c - a), edge = abs(b - a) + abs(c - a);  // a sliver is as long as it is
      voxels += 0.5 * (std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z)) / (voxel_size_m * voxel_size_m) +
                (edge.x + edge.y + edge.z) / voxel_size_m + 1;
    }
  }
  return whole(triangles * (kTriangle + kTree) +
               voxels * (kVoxel + kMaskWord * static_cast<double>(mask_words(mask_bits)) + kBrickBytes));
}

SimulatorMemory require_memory(const Scene& scene, std::span<const Scanner> scanners, const SimulatorConfig& config) {
  if (!(config.user_size_m > 0 && std::isfinite(config.user_size_m))) return {};  // the grid's builder rejects it
  const std::vector<ChosenDevice> devices = devices_of(config);
  const std::uint64_t given = config.max_memory_bytes;
  const std::uint64_t unlimited = std::numeric_limits<std::uint64_t>::max();
  const std::uint64_t host = memory_limit(given);
  std::uint64_t device = given > 0 ? given : unlimited;
  for (const ChosenDevice& each : devices) device = std::min(device, each.free_bytes.value_or(unlimited));
  const Estimator estimate(scene, scanners, mask_bits, config.spacing_by_detail);
  const auto fits = [&](const SimulatorMemory& wanted) {
    return wanted.bytes <= host && wanted.device_bytes <= device;
  };
  const SimulatorMemory wanted = estimate(config.user_size_m, devices);
  if (fits(wanted)) return wanted;
  const bool of_host = wanted.bytes > host;
  std::string what = "this takes about " + bytes_text(of_host ? wanted.bytes : wanted.device_bytes) + " of " +
                     (of_host ? "" : "the device's ") + "memory, for " + number(scene.data().triangle_count()) +
                     " triangles and some " + number(wanted.voxels) + " surveyed voxels; ";
  if (given > 0)
    what += "it may take " + bytes_text(given);
  else if (of_host)
    what += "half of what is free is " + bytes_text(host) + " (max_memory_bytes)";
  else
    what += bytes_text(device) + " of that is free";
  for (double size = config.user_size_m; size < 1e9; size *= 2)
    if (fits(estimate(size, devices))) {
      what += "; a user size of " + number(size) + " m would fit";
      break;
    }
  throw Error(Errc::out_of_memory, what);
}

}  // namespace vantage
