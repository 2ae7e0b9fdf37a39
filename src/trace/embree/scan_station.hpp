// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "trace/embree/picture.hpp"
#include "trace/embree/station_rays.hpp"
#include "trace/embree/tile_selection.hpp"

namespace vantage {

// Scans whole stations, chunk by chunk. Not thread-safe.
class ChunkedScan {
 public:
  // Tracer::scan on the CPU. A picture prepared for one chunk of a station serves its next chunks; the chunk with the
  // last ray frees it.
  void scan(const StationRays& rays, const TraceStation& station, std::uint64_t first_ray, std::uint64_t ray_count,
            std::uint32_t outputs, Tracer::RawChunk& chunk);

 private:
  // A picture prepared for a station.
  struct View {
    View(const StationRays& own_rays, const TraceStation& from)
        : rays(own_rays),
          station(from),
          ends(all_tiles(rays.pattern())),
          picture(Picture::where_it_pays(rays, station, ends)) {}
    View(const View&) = delete;
    View& operator=(const View&) = delete;
    bool is_of(const StationRays& other, const TraceStation& from) const;

    const StationRays& rays;
    const TraceStation station;
    const TileEnds ends;
    const std::unique_ptr<const Picture> picture;  // null: rays are traced
  };
  std::unique_ptr<const View> view_;
};

}  // namespace vantage
