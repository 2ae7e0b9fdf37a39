// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <utility>

#include "trace/vulkan/vulkan_tracer.hpp"

namespace vantage::vulkan {

void VulkanTracer::scan(const TraceStation& station, std::uint64_t first_ray, std::uint64_t ray_count,
                        std::uint32_t outputs, RawChunk& chunk) {
  const DeviceScanner& scanner = scanners_[station.scanner];
  const std::uint32_t columns = scanner.pattern().columns();
  if (outputs & (normal | reflectivity | barycentric)) device_scene_.upload_shading();
  const auto rows = static_cast<std::uint32_t>(ray_count / columns);

  ScanPush push{};
  push.origin = {station.origin.x, station.origin.y, station.origin.z};
  push.place = station.place;
  set_turn(push.turn, station);
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

  // The arrays begin at first_ray. A part counts its rows from its own start, so its outputs are offset.
  const BoundPipeline pipeline = kernels_.get(
      scanner.set(), {Kernel::scan, {scanner.noise(), scanner.limits()}, station.turn.has_value(), scanner.listed()});
  const std::uint32_t at_once = rows_per_dispatch(scanner.pattern());
  const auto first_row = static_cast<std::uint32_t>(first_ray / columns);
  for (std::uint32_t row = 0; row < rows; row += at_once) {
    ScanPush part = push;
    part.first_row = first_row + row;
    part.row_count = std::min(at_once, rows - row);
    const std::uint64_t skip = std::uint64_t{row} * columns;
    for (auto [address, size] : {std::pair{&part.range, sizeof(float)},
                                 {&part.position, sizeof(Float3)},
                                 {&part.normal, sizeof(Float3)},
                                 {&part.reflectivity, sizeof(float)},
                                 {&part.primitive, sizeof(std::uint32_t)},
                                 {&part.barycentric, sizeof(Float2)},
                                 {&part.voxel, sizeof(std::uint32_t)}})
      if (*address) *address += skip * size;
    commands_.run([&](const Recorder& r) {
      r.dispatch(pipeline, part, groups_of(columns, block_columns), groups_of(part.row_count, scanner.rows_of_group()));
    });
  }
  for (const Copy& copy : copies) commands_.download(*copy.from, copy.to, copy.bytes);
}

}  // namespace vantage::vulkan
