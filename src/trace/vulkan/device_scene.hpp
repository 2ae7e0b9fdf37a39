// SPDX-License-Identifier: Apache-2.0
// A scene on the device: voxels at once, triangles and their attributes when a kernel first needs them. Writes the
// parameters that all scanners share into each scanner's block.
#pragma once

#include <span>

#include "scene/scene_difference.hpp"
#include "shared/trace_types.h"
#include "trace/tracer.hpp"
#include "trace/vulkan/device_demands.hpp"
#include "trace/vulkan/device_scanner.hpp"
#include "trace/vulkan/traversal.hpp"

namespace vantage::vulkan {

class DeviceScene {
 public:
  // All arguments must outlive it.
  DeviceScene(Device& device, Commands& commands, const TraceScene& scene, const Traversal& traversal,
              std::span<const DeviceScanner> scanners);

  const DeviceDemands& demands() const { return demands_; }  // of all voxels
  // Each of these does nothing the second time.
  void upload_triangles();
  void upload_neighbours();  // only if the structure is watertight
  void upload_shading();     // normals and diffuse coefficients, with the triangles

  // Follows its scene after the triangles of some runs have moved and the grid may have changed.
  void take(const SceneDifference& difference, std::span<const KeptRun> moved);

 private:
  void upload_grid();
  void write_parameters();
  void upload_glass();
  void upload_places();

  Device& device_;
  Commands& commands_;
  const TraceScene& scene_;
  std::span<const DeviceScanner> scanners_;
  bool watertight_;
  TraceParameters parameters_{};  // except for each scanner's own part
  DeviceDemands demands_;
  Buffer bricks_, slots_, normal_table_, glass_nodes_, glass_corners_, runs_, run_at_, places_;
  Buffer positions_, triangles_, neighbours_, diffuse_, normals_;  // filled on first use
};

}  // namespace vantage::vulkan
