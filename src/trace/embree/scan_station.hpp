// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "trace/embree/picture.hpp"
#include "trace/embree/station_rays.hpp"
#include "trace/embree/tile_selection.hpp"

namespace vantage {

// Whole scans, chunk by chunk. Not thread-safe.
class ChunkedScan {
 public:
  // Tracer::scan on the CPU. What is drawn of a station's last chunk serves its next; the chunk with the last ray ends
  // that.
  void scan(const StationRays& rays, const TraceStation& station, std::uint64_t first_ray, std::uint64_t ray_count,
            std::uint32_t outputs, Tracer::RawChunk& chunk);

 private:
  // Where triangles are to be drawn, as seen from a station.
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
    const std::unique_ptr<const Picture> picture;  // null: rays are to be traced
  };
  std::unique_ptr<const View> view_;
};

}  // namespace vantage
