// SPDX-License-Identifier: Apache-2.0
/// Files that vantage writes: point clouds, coverage cartography, tables and pictures. Every file appears whole or not
/// at all.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vantage/missed.hpp"
#include "vantage/objective.hpp"
#include "vantage/placement.hpp"
#include "vantage/planner.hpp"
#include "vantage/scene.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

/// What a file that keeps stations apart (E57) says of one.
struct StationScan {
  std::string name;  ///< As people call it: "S1".
  Vec3 head;         ///< The scanner's head, survey frame, metres; upright, as always.
  Scanner scanner;   ///< Its model, and how its rays are numbered and headed.
};

/// Streams a point cloud to a file in constant memory. The format follows the extension: .ply (binary little endian),
/// .las (1.4) or .e57 (ASTM E2807: a scan a station, with its pose, points in the scanner's own frame). The file takes
/// its name at close(); destroyed before that, nothing is left.
class PointCloudWriter {
 public:
  /// `outputs` are the ScanOutput bits that chunks will carry; position is required. `origin` is the simulator's:
  /// chunks are in the local frame, the file is in the survey frame. Throws Error: io, invalid_argument (unknown
  /// extension).
  PointCloudWriter(const std::filesystem::path& file, const Vec3& origin, std::uint32_t outputs);
  PointCloudWriter(PointCloudWriter&&) noexcept;
  PointCloudWriter& operator=(PointCloudWriter&&) noexcept;
  ~PointCloudWriter();
  /// The chunks that follow, until the next call, are this station's, whose first ray is ray 0. E57 wants it before the
  /// first chunk; the other formats do without.
  void begin_station(const StationScan& station);
  void write(const ScanChunk& chunk, std::uint16_t station);  ///< Only rays that hit become points.
  void close();
  std::uint64_t points() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The coverage cartography (figures 7b, 11, 17 of the method): every surveyed voxel as a coloured point, from red (no
/// point) over yellow to green (goal reached), with its ratio, count and station mask. Binary PLY, survey frame.
void write_coverage_ply(const std::filesystem::path& file, const Simulator& simulator, const VoxelField& field);

/// Square matrix with a header line; row and column i are station i.
void write_overlap_csv(const std::filesystem::path& file, const OverlapMatrix& overlap);

/// Stations of one network as CSV: `station,x,y,z,u,v,status`. Survey frame, head positions.
void write_stations_csv(const std::filesystem::path& file, std::span<const PlacedStation> stations);

/// What `read_stations_csv` found on one line: x,y,z or u,v or both.
struct StationRow {
  std::optional<Vec3> position;
  std::optional<Uv> uv;
};
/// Reads a CSV with a header naming x,y,z and/or u,v (any order, other columns ignored). Throws Error: io,
/// malformed_file with the line.
std::vector<StationRow> read_stations_csv(const std::filesystem::path& file);

/// Everything about a run that its results must name: version, engine, device, seed, scene, every parameter. JSON text.
std::string run_parameters_json(const Simulator& simulator, const PlanResult* result = nullptr);

/// `front.json`: keys problem, objectives, hypervolume, evaluations, stop_reason, front, seconds, engine, device, seed,
/// parameters, version. Every network of the front carries its values by their objectives' names.
std::string front_json(const PlanResult& result, const Simulator& simulator);
void write_front_csv(const std::filesystem::path& file, const PlanResult& result);

/// Pictures, drawn as .png or .svg by extension.
void draw_front(const std::filesystem::path& file, const PlanResult& result);
void draw_hypervolume(const std::filesystem::path& file, const PlanResult& result);
/// The front at five moments of the search, as the search saw it (figure 9 of the method).
void draw_history_fronts(const std::filesystem::path& file, const PlanResult& result);
/// The site from above in shaded relief, the search area, the stations and the links between them, as wide as their
/// overlap is large; those below `link_overlap` are not drawn.
void draw_plan_view(const std::filesystem::path& file, const Scene& scene, const SearchArea& area,
                    std::span<const PlacedStation> stations, const OverlapMatrix& overlap, const std::string& title,
                    double link_overlap = default_link_overlap);

/// Writes a whole result folder: front.csv, front.json, history.csv, fronts.csv (every iteration's front), and for the
/// chosen compromise stations.csv, overlap.csv (where it is confirmed), coverage.ply (where `field`, its voxel field,
/// is given), and the pictures front.png, hypervolume.png, history.png (with several objectives), plan.png (each also
/// as .svg). Makes the folder where there is none. Returns the index of the chosen entry.
std::size_t write_plan(const std::filesystem::path& folder, const PlanResult& result, const Simulator& simulator,
                       const SearchArea& area, const VoxelField* field = nullptr);

/// The compromise shown where one must be chosen: of the entries that miss the requirements least the one with the
/// largest product of its objectives' gains (1 less the scaled value). Where an objective looks at pairs, of those
/// whose stations all hang together by the problem's `link_overlap`, as far as there are any confirmed: parts of a
/// network cannot be registered with each other, however well each overlaps in itself.
std::size_t compromise(const PlanResult& result);

/// CSV: `node,voxels,captured,hidden,out_of_range,too_flat,too_sparse,not_chosen`, shares of the node's voxels.
void write_missed_csv(const std::filesystem::path& file, std::span<const MissedShare> shares);
/// Every voxel of `ranks` as a point in the colour of its reason, with the reason as a number (`WhyMissed`) and its
/// count. Binary PLY, survey frame.
void write_missed_ply(const std::filesystem::path& file, const Simulator& simulator,
                      std::span<const std::uint32_t> ranks, std::span<const WhyMissed> why,
                      std::span<const std::uint32_t> points);
/// The same from above, .png or .svg: where voxels lie over each other the one that is missed for want of a station
/// shows before those that nothing helps, and these before what is captured.
void draw_missed(const std::filesystem::path& file, const Simulator& simulator, std::span<const std::uint32_t> ranks,
                 std::span<const WhyMissed> why, std::span<const PlacedStation> stations, const std::string& title);

/// Writes text to a file atomically. Throws Error io.
void write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace vantage
