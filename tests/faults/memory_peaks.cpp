// SPDX-License-Identifier: Apache-2.0
// Compares a simulation's memory with its estimate:
//     vantage-memory-peaks ENGINE TRIANGLES USER_SIZE [STEP]
// The process's memory is the kernel's peak; the device's is what the layer saw allocated. Fails if an estimate is off
// by more than a fifth.
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "faults/open_layer.hpp"
#include "scan/memory_estimate.hpp"
#include "support/temporary_folder.hpp"
#include "vantage/built_in_scenes.hpp"
#include "vantage/vantage.hpp"

namespace vantage::test {
namespace {

constexpr double mib = 1048576;

double process_peak() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) * 1024;
  return 0;
}

// Heads all over the site, stacked if there are many.
Network stations(const Scene& scene, std::size_t many) {
  const Box bounds = scene.bounds();
  const Vec3 size = bounds.size();
  Network network;
  for (std::size_t k = 0; k < many; ++k) {
    const double share = (static_cast<double>(k) + 0.5) / static_cast<double>(many);
    network.push_back(
        {.position = bounds.min + Vec3{size.x * share, size.y * std::fmod(7 * share, 1.0), 0.5 * size.z}});
  }
  return network;
}

// Runs in a process of its own, whose memory does not count.
void make_scene(std::size_t triangles, const std::filesystem::path& file) {
  const pid_t child = fork();
  if (child == 0) {
    write_built_in_scene("industrial", triangles, file);
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
}

bool close(double measured, double estimated) { return std::abs(estimated / measured - 1) <= 0.2; }

int run(Engine engine, std::size_t triangles, double user_size_m, double step) {
  const FaultControl& layer = open_layer();
  const TemporaryFolder folder;
  make_scene(triangles, folder / "scene.glb");
  const Scene scene = Scene::load(folder / "scene.glb");
  const Scanner scanner{.azimuth_step = Angle::degrees(step), .zenith_step = Angle::degrees(step), .height_m = 1.5};
  const SimulatorConfig config{
      .engine = engine, .user_size_m = user_size_m, .point_spacing_m = 0.1 * user_size_m, .max_memory_bytes = ~0ull};
  constexpr std::size_t many = 64;
  const SimulatorMemory estimate = simulator_memory(scene, {&scanner, 1}, config, many);
  Simulator simulator(scene, scanner, config);
  const Network network = stations(scene, many);
  VoxelField field;  // as in a plan that writes the covered surface
  simulator.evaluate(network, {.field = &field});
  const std::vector<Network> population(8, network);
  simulator.evaluate_sampled(population, {.voxels = 20'000});
  const double process = process_peak(), device = static_cast<double>(layer.peak_bytes());
  const auto of_device = static_cast<double>(estimate.device_bytes);
  std::printf("| %s | %zu | %llu, estimated %llu | %.0f | %.0f | %.0f | %.0f |\n", to_string(engine).c_str(),
              scene.triangle_count(), static_cast<unsigned long long>(simulator.voxel_count()),
              static_cast<unsigned long long>(estimate.voxels), process / mib,
              static_cast<double>(estimate.bytes) / mib, device / mib, of_device / mib);
  const bool good = close(process, static_cast<double>(estimate.bytes)) && (device == 0 || close(device, of_device));
  if (!good) std::printf("WRONG: an estimate is off by more than a fifth\n");
  return good ? 0 : 1;
}

}  // namespace
}  // namespace vantage::test

int main(int argc, char** argv) {
  using namespace vantage;
  if (argc < 4) return std::fprintf(stderr, "usage: vantage-memory-peaks ENGINE TRIANGLES USER_SIZE [STEP]\n"), 2;
  return test::run(engine_from_string(argv[1]), std::strtoul(argv[2], nullptr, 10), std::strtod(argv[3], nullptr),
                   argc > 4 ? std::strtod(argv[4], nullptr) : 0.25);
}
