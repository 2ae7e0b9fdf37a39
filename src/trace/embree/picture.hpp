// SPDX-License-Identifier: Apache-2.0
// The hits of all rays of a station, by drawing. The rays leave one point in a grid of azimuth and zenith, so the
// nearest triangle of each is a picture of the scene. A triangle is drawn column by column: with the ray's direction
// (sin θ cos φ, sin θ sin φ, cos θ), an edge is A sin θ + B cos θ >= 0 in a column, and the inverse of the distance is
// C sin θ + D cos θ. Drawing is certain of nearly all rays. RayCaster traces the others, so that each ray has the hit
// that RayCaster would give it.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "trace/embree/station_rays.hpp"
#include "trace/embree/tile_selection.hpp"

namespace vantage {

class Picture {
 public:
  static constexpr std::uint32_t kNone = 0x7FFFFFFFu;             // no hit, among a strip's triangles
  static constexpr std::uint32_t kStripColumns = RayTile::kSide;  // columns of a strip
  static constexpr std::uint32_t kBlockRows = RayTile::kSide;     // rows that are stored together

  // Returns true if drawing is faster than tracing.
  static bool pays(std::size_t triangles, std::uint64_t rays);
  // Returns a picture of the rays within `ends`; null if they must be traced. Borrows all.
  static std::unique_ptr<const Picture> where_it_pays(const StationRays& rays, const TraceStation& station,
                                                      const TileEnds& ends);

  // Prepares the picture of the rays within `ends`. Borrows all. REQUIRES: the scene shares no meshes.
  Picture(const StationRays& rays, const TraceStation& station, const TileEnds& ends);

  // Returns false if the head lies in a surface; nothing can be drawn then.
  bool drawable() const { return drawable_; }
  std::uint32_t strips() const { return ends_.wide; }

  template <class Value>
  struct alignas(64) Block {
    Value of[kBlockRows];
  };
  // A column of tiles: `kStripColumns` columns of rays, with all rows. Kept for reuse.
  struct Strip {
    std::uint32_t first = 0, columns = 0;  // of the pattern
    std::uint64_t rays = 0;                // drawn, within the ends
    std::uint64_t traced = 0;              // of these, rays that drawing was not certain of
    // Returns the triangles hit in a column, by rows.
    const std::uint32_t* triangles(std::uint32_t column) const { return triangle_[column * blocks_].of; }

   private:
    friend class Picture;
    std::uint32_t blocks_ = 0;
    std::vector<Block<float>> inverse_;           // [column][row] of the distance of the nearest so far
    std::vector<Block<std::uint32_t>> triangle_;  // [column][row] the nearest; `kInDoubt` beside it unless certain
    std::vector<float> farthest_;                 // [tile] at most the least of its inverse_
    std::vector<std::uint8_t> stale_;             // [tile] farthest_ may be too small
    std::vector<std::uint8_t> doubts_;            // [tile] has rays in doubt
  };

  // Returns sines and cosines of the zeniths, by row. Up to eight elements beyond the last can be read.
  const float* sines() const { return sine_.front().of; }
  const float* cosines() const { return cosine_.front().of; }

  // A range of rows of tiles, `first` to `end`.
  struct Tiles {
    std::uint32_t first = 0, end = 0;
  };
  // Finds the hits of a strip's rays; those outside `ends` have none. Draws only these rows of tiles, which can be read
  // afterwards.
  void draw(std::uint32_t index, const Tiles& tiles, Strip& strip) const;
  void draw(std::uint32_t index, Strip& strip) const { draw(index, {0, ends_.tall}, strip); }
  // Fills t and primitive of a drawn strip's tile, as RayCaster::cast() would. REQUIRES: the tile's rays.
  void fill(const Strip& strip, const RayTile& tile, RayBundle& rays) const;

 private:
  // Strip and rows in which a triangle is to be drawn.
  struct Item {
    float nearest;  // inverse distance that no hit exceeds
    std::uint32_t triangle;
    std::uint32_t row_begin, row_end, column_begin, column_end;
    bool operator<(const Item& other) const;
  };
  class StripDrawing;

  // Appends the items in which the triangle is to be drawn. Returns false if the triangle makes it impossible to draw
  // anything, as when the head lies in it.
  bool place(std::uint32_t triangle, std::vector<Item>& items) const;
  void draw_triangles(std::uint32_t index, const Tiles& tiles, Strip& strip) const;
  void trace_doubts(std::uint32_t index, const Tiles& tiles, Strip& strip) const;

  const StationRays& rays_;
  const TraceStation& station_;
  const TileEnds& ends_;
  float start_ = 0;     // inverse of the least range
  float farthest_ = 0;  // of the ends
  bool drawable_ = true;
  std::vector<Item> items_;                  // strip by strip, near ones first
  std::vector<std::size_t> begin_;           // [strip] in items_
  std::vector<Block<float>> sine_, cosine_;  // of the zeniths; 0 beyond the last
};

}  // namespace vantage
