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

#include "vantage/evaluation.hpp"
#include "vantage/missed.hpp"
#include "vantage/objective.hpp"
#include "vantage/placement.hpp"
#include "vantage/planner.hpp"
#include "vantage/scene.hpp"
#include "vantage/simulator.hpp"
#include "vantage/site.hpp"

namespace vantage {

/// Well-known text (version 1, OGC 01-009, which LAS 1.4 asks for) of the coordinate system that a scene's survey frame
/// stands in. `text`: "EPSG:25832" and the like, the name of a .prj or .wkt file, or such a text. Throws Error: io,
/// invalid_argument (a code that is not known, angles, a unit other than metres, version 2).
std::string coordinate_system(const std::string& text);

/// What a file that keeps stations apart (E57) says of one.
struct StationScan {
  std::string name;         ///< As people call it: "S1".
  Vec3 head;                ///< The scanner's head, survey frame, metres.
  Scanner scanner;          ///< Its model, and how its rays are numbered and headed.
  StationSetup setup = {};  ///< How it is turned.
};

/// Streams a point cloud to a file in constant memory. The format follows the extension: .ply (binary little endian),
/// .las (1.4) or .e57 (ASTM E2807: a scan a station, with its pose, points in the scanner's own frame). The file takes
/// its name at close(); destroyed before that, nothing is left.
class PointCloudWriter {
 public:
  /// `outputs` are the ScanOutput bits that chunks will carry; position is required. `origin` is the simulator's:
  /// chunks are in the local frame, the file is in the survey frame. `crs`: the `coordinate_system()` of that; empty:
  /// none is said. Throws Error: io, invalid_argument (unknown extension, outputs that the format cannot hold: LAS has
  /// intensity, for reflectivity, and colour).
  PointCloudWriter(const std::filesystem::path& file, const Vec3& origin, std::uint32_t outputs,
                   const std::string& crs = {});
  PointCloudWriter(PointCloudWriter&&) noexcept;
  PointCloudWriter& operator=(PointCloudWriter&&) noexcept;
  ~PointCloudWriter();
  /// The chunks that follow, until the next call, are this station's, whose first ray is ray 0. E57 wants it before the
  /// first chunk; the other formats do without.
  void begin_station(const StationScan& station);
  /// Only rays that hit become points. `station`: its number, from 1; LAS's point source id, where 0 stands for none.
  void write(const ScanChunk& chunk, std::uint16_t station);
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

/// Stations of one network as CSV: `station,name,x,y,z,ground_z,u,v,status,kept`, and where one of them is turned or
/// does not have the first scanner, `heading,tilt,scanner,step` (degrees; the scanner's name). Survey frame; x, y, z of
/// the head, ground_z of the ground. Numbers read back to the same bits. `scanners`: what `StationSetup::scanner`
/// counts; without them the last two columns are left out.
void write_stations_csv(const std::filesystem::path& file, std::span<const PlacedStation> stations,
                        std::span<const Scanner> scanners = {});

/// What `read_stations_csv` found on one line. Survey frame, metres.
struct StationRow {
  std::optional<Vec3> position;              ///< The scanner's head.
  std::optional<Vec3> ground;                ///< The point of the ground below it.
  std::optional<std::array<double, 2>> xy;   ///< East and north alone, where no height is given.
  std::optional<Uv> uv;                      ///< On the search area.
  std::string name;                          ///< As its owner calls it; empty where the file has no names.
  StationSetup setup = {};                   ///< Heading and tilt.
  std::string scanner = {};                  ///< As `load_scanner()` takes it; empty: not said.
  std::optional<Angle> step = std::nullopt;  ///< Of azimuth and zenith.
};
/// Reads a table with a header. Columns in any order, others are ignored: x, y, z (the head's), or E, N, Z, or Easting,
/// Northing, Height; ground_z for the ground's height; u, v; name; heading, tilt and step in degrees; scanner. A unit
/// may follow in brackets, and must be m, or deg for angles. Cells are parted by commas, semicolons, tabs or blanks, as
/// the header has them; but for commas, numbers may have decimal commas. Quotes, byte order marks, carriage returns,
/// empty lines and those that begin with # do no harm. Throws Error: io, malformed_file with the line (two columns for
/// one quantity, a unit that is not m, a line with more cells than the header, …).
std::vector<StationRow> read_stations_csv(const std::filesystem::path& file);

/// Everything about a run that its results must name: version, engine, device, seed, scene, every parameter. JSON text.
std::string run_parameters_json(const Simulator& simulator, const PlanResult* result = nullptr);

/// The figures of one network, as JSON text: keys coverage, coverage_se, overlap, overlap_se, overlap_matrix,
/// scan_overlap_matrix, visible, visible_se, minutes_on_site, registration{error_mm, standard_error_mm, worst_mm,
/// worst_station, stations}, dropped, voxels, goal_density, rays, sample, summary. Null: not known. Stations count from
/// 1; axes of the standard ellipsoid of each head are in millimetres, survey frame, longest first.
std::string evaluation_json(const Evaluation& evaluation);

/// `front.json`: keys problem, objectives, hypervolume, evaluations, stop_reason, front, seconds, engine, device, seed,
/// parameters, version. Every network of the front carries its values by their objectives' names. Whatever is numbered
/// (`entry`, `answer`, stations of links) counts from 1.
std::string front_json(const PlanResult& result, const Simulator& simulator);
void write_front_csv(const std::filesystem::path& file, const PlanResult& result);

/// Pictures, drawn as .png or .svg by extension.
void draw_front(const std::filesystem::path& file, const PlanResult& result);
void draw_hypervolume(const std::filesystem::path& file, const PlanResult& result);
/// The front at five moments of the search, as the search saw it (figure 9 of the method).
void draw_history_fronts(const std::filesystem::path& file, const PlanResult& result);
/// The site from above in shaded relief, the search area, the stations with the height of their ground, and the links
/// between them, as wide as their overlap is large, by one scale on all pictures; those below `link_overlap` are not
/// drawn. Where most of the ground lies under something, and where a building has several floors, it is cut 1.2 m above
/// the floor and what is cut through is filled. Several floors stand side by side, and each again on a page of its own,
/// PLAN-level-1.png and so on, from the lowest. `names`: of the stations, where they have names; "S1", "S2", … and for
/// kept ones "K1", … otherwise. `errors`: of the stations, where they are predicted: a standard
/// ellipse (one sigma, of the head in x and y) around each. `overlap_words`: what `overlap` is, in the legend. Returns
/// the files that it wrote.
std::vector<std::filesystem::path> draw_plan_view(const std::filesystem::path& file, const Scene& scene,
                                                  const SearchArea& area, std::span<const PlacedStation> stations,
                                                  const StationLinks& links, const std::string& title,
                                                  std::span<const std::string> names = {},
                                                  std::span<const StationError> errors = {});

/// Writes a whole result folder: front.csv, front.json, history.csv, fronts.csv (every iteration's front), and for the
/// `answer()` stations.csv, overlap.csv (where it is confirmed), coverage.ply (where `field`, its voxel field,
/// is given), and the pictures front.png, hypervolume.png, history.png (with several objectives), plan.png (each also
/// as .svg), of several floors also plan-level-1.png and so on; and for the crew stations.dxf, and where `crs`, the
/// `coordinate_system()` of the survey frame, is given stations.geojson and stations.kml. Where
/// the registration error is known, plan.png has its ellipses, and with `field` there are registration.ply, .png and
/// .svg. Makes the folder where there is none. Returns the index of the chosen entry.
std::size_t write_plan(const std::filesystem::path& folder, const PlanResult& result, const Simulator& simulator,
                       const SearchArea& area, const VoxelField* field = nullptr, const std::string& crs = {});
/// The same of a plan of a site.
std::size_t write_plan(const std::filesystem::path& folder, const PlanResult& result, Site& site,
                       const VoxelField* field = nullptr);

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

/// The predicted registration error on the surface in false colours: every surveyed voxel that a station sees as a
/// point with its `error_mm`, the root mean square over the stations that see it, from dark (none) to yellow (the
/// largest). `field`: with station masks, of the network that `error` is of. Binary PLY, survey frame. Throws Error.
void write_registration_ply(const std::filesystem::path& file, const Simulator& simulator, const VoxelField& field,
                            const RegistrationError& error);
/// The same from above, .png or .svg, what is not seen in grey.
void draw_registration(const std::filesystem::path& file, const Simulator& simulator, const VoxelField& field,
                       const RegistrationError& error, std::span<const PlacedStation> stations,
                       const std::string& title);

/// Writes text to a file atomically. Throws Error io.
void write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace vantage
