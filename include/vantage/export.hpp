// SPDX-License-Identifier: Apache-2.0
/// Files that vantage writes: point clouds, coverage cartography and tables; pictures are in pictures.hpp. Every file
/// appears whole or not at all.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "vantage/evaluation.hpp"
#include "vantage/missed.hpp"
#include "vantage/objective.hpp"
#include "vantage/pictures.hpp"
#include "vantage/placement.hpp"
#include "vantage/planner.hpp"
#include "vantage/scene.hpp"
#include "vantage/simulator.hpp"
#include "vantage/site.hpp"

namespace vantage {

/// Returns the well-known text (version 1, OGC 01-009, as LAS 1.4 requires) of a coordinate system. `text`:
/// "EPSG:25832" and the like, "EPSG:26918+5703" with heights, the name of a .prj or .wkt file, or well-known text of
/// either version. Throws Error: io, invalid_argument (an unknown code, angles, a unit other than metres, heights
/// included, axes other than east and north).
std::string coordinate_system(const std::string& text);

/// Description of one station in a file that keeps stations apart (E57).
struct StationScan {
  std::string name;         ///< Name as shown to people: "S1".
  Vec3 head;                ///< The scanner's head, survey frame, metres.
  Scanner scanner;          ///< Its model, and how its rays are numbered and headed.
  StationSetup setup = {};  ///< Heading, tilt and scanner.
};

/// Returns `outputs` and what such a file always has: the reflectivity, as intensity, in .las and .e57.
std::uint32_t point_cloud_outputs(const std::filesystem::path& file, std::uint32_t outputs);

/// The kind of coordinates of a PLY. Floats, which all viewers read, are about an origin of whole kilometres near the
/// site that the header's comment `origin X Y Z` tells: 0 0 0 where coordinates are small. Doubles are in the survey
/// frame.
enum class PlyCoordinates : std::uint8_t {
  floats,   ///< Coordinates take 12 bytes a point.
  doubles,  ///< Coordinates take 24 bytes a point.
};

/// Streams a point cloud to a file in constant memory. The extension decides the format: .ply (binary little endian),
/// .las (1.4) or .e57 (ASTM E2807: a scan for each station, with its pose, points in the scanner's own frame). The file
/// gets its name at close(); if the writer is destroyed before, no file remains.
class PointCloudWriter {
 public:
  /// `outputs` are the ScanOutput bits of the chunks; position is required. `origin` is the simulator's: chunks are in
  /// the local frame, the file is in the survey frame. `crs`: its `coordinate_system()`; empty: none is written. `ply`:
  /// of a .ply. Throws Error: io, invalid_argument (unknown extension, outputs that the format cannot hold: LAS has
  /// only intensity, for reflectivity, and colour).
  PointCloudWriter(const std::filesystem::path& file, const Vec3& origin, std::uint32_t outputs,
                   const std::string& crs = {}, PlyCoordinates ply = PlyCoordinates::floats);
  PointCloudWriter(PointCloudWriter&&) noexcept;
  PointCloudWriter& operator=(PointCloudWriter&&) noexcept;
  ~PointCloudWriter();
  /// Chunks until the next call belong to this station; its first ray is ray 0. E57 needs this call before the first
  /// chunk, other formats ignore it.
  void begin_station(const StationScan& station);
  /// Writes a point for each ray that hit. `station`: its number, from 1; LAS's point source id, where 0 means none.
  void write(const ScanChunk& chunk, std::uint16_t station);
  /// Completes the file and gives it its name. Throws Error io.
  void close();
  std::uint64_t points() const noexcept;  ///< Points written so far.

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The coverage cartography (figures 7b, 11, 17 of the method): every surveyed voxel as a coloured point, from red (no
/// point) through yellow to green (goal reached), with its ratio, count and station mask; of more than 64 stations the
/// number of those that have a point in it. Binary PLY.
void write_coverage_ply(const std::filesystem::path& file, const Simulator& simulator, const VoxelField& field,
                        PlyCoordinates coordinates = PlyCoordinates::floats);

/// Square matrix with a header line; row and column i are station i.
void write_overlap_csv(const std::filesystem::path& file, const OverlapMatrix& overlap);

/// Stations of one network as CSV: `station,name,x,y,z,ground_z,u,v,status,existing`. If a station is turned or does
/// not have the first scanner, also `heading,tilt,scanner,step` (degrees; the scanner's name). Survey frame; x, y, z of
/// the head, ground_z of the ground. Numbers read back to the same bits. `scanners` are indexed by
/// `StationSetup::scanner`; without them the last two columns are left out. `names`: as `station_names()` takes them.
void write_stations_csv(const std::filesystem::path& file, std::span<const PlacedStation> stations,
                        std::span<const Scanner> scanners = {}, std::span<const std::string> names = {});

/// Sessions of an evaluated network as CSV, a line for each station in the order of its session:
/// `session,day,crew,order,station,name,walk_m,arrive_min,stay_min,leave_min,wait_min,begin,end`, and `batteries` if
/// scanners have a known life of one. Minutes count from the session's start; `begin` and `end` are times of day;
/// `walk_m` is the way to the station; `station` is its line in stations.csv. REQUIRES: the evaluation has a visit.
void write_sessions_csv(const std::filesystem::path& file, const Evaluation& evaluation);

/// Writes the round of an evaluated network for a robot, or each of its sessions; the extension decides the format:
/// - .csv: `day,crew,order,name,x,y,z,head_height,heading,first_column,dwell_s`, a line for each station;
/// - .json: keys crs and rounds[{day, crew, minutes, start, waypoints[{order, name, position, orientation{x, y, z, w},
///   heading, first_column, head_height, dwell_s, path}], back}].
/// Positions are of the ground, survey frame, with every digit. `heading` is the direction in which a station is
/// reached and `first_column` that of the scanner's first column, both in degrees from +X towards +Y. Throws Error: io;
/// invalid_argument (another extension, an evaluation without a round).
void write_waypoints(const std::filesystem::path& file, const Evaluation& evaluation, std::span<const Scanner> scanners,
                     const std::string& crs = {});

/// Writes stations for maps and drawings; the extension decides the format:
/// - .geojson (RFC 7946): a Point for each station below its tripod, [longitude, latitude, z] with ten and four digits.
///   Properties: kind ("station"), name, status, existing, head_height_m, and in the survey frame x, y, z of the head
///   and ground_z. A station without ground has no geometry. A Point for each target's centre: kind ("target" or
///   "control point"), name, proposed, sigma_m (null unless known), stations (names), x, y, z.
/// - .kml (2.2, OGC 07-147r2): a Placemark for each station with ground, with the same position and figures. Existing
///   stations, those left out and targets have icons of another colour.
/// - .dxf (release 12, ASCII), metres, survey frame. Layers: STATIONS, STATIONS_EXISTING and STATIONS_LEFT_OUT (a point
///   and a circle below the tripod), STATION_NAMES, LINKS (between the grounds of linked stations), SEARCH_AREA (closed
///   polylines), TARGETS and CONTROL_POINTS (a point and a circle at the centre), TARGET_NAMES.
///
/// `names`: from `station_names()`, one each. `links`: of these stations, or without values. Throws Error: io;
/// invalid_argument (another extension, sizes that do not match, for .geojson and .kml a site without a coordinate
/// system or stations outside of it).
void write_stations(const std::filesystem::path& file, std::span<const PlacedStation> stations,
                    std::span<const std::string> names, const StationLinks& links, Site& site,
                    std::span<const Target> targets = {});

/// One line of a table, as `read_stations_csv` returns it. Survey frame, metres.
struct StationRow {
  std::optional<Vec3> position;              ///< The scanner's head.
  std::optional<Vec3> ground;                ///< The point of the ground below it.
  std::optional<std::array<double, 2>> xy;   ///< East and north alone, if no height is given.
  std::optional<Uv> uv;                      ///< On the search area.
  std::string name;                          ///< The user's name; empty if the file has none.
  StationSetup setup = {};                   ///< Heading and tilt.
  std::string scanner = {};                  ///< In the form of `load_scanner()`; empty: not given.
  std::optional<Angle> step = std::nullopt;  ///< Azimuth and zenith step.
  /// Standard deviation of a control point's coordinates, in metres (`read_targets_csv()`).
  std::optional<double> sigma_m = std::nullopt;
  bool check = false;  ///< A place of a check (`Target::check`), which `read_targets_csv()` leaves out.
};
/// Reads a table with a header. Columns may have any order, and others are ignored: x, y, z (of the head), or E, N, Z,
/// or Easting, Northing, Height; ground_z for the ground's height; u, v; name; heading, tilt and step in degrees;
/// scanner. A unit may follow in brackets, and must be m, or deg for angles. The header decides whether commas,
/// semicolons, tabs or blanks separate cells; unless commas do, numbers may have decimal commas. Quotes, byte order
/// marks, carriage returns, empty lines and lines that begin with # are accepted. Throws Error: io, malformed_file with
/// the line (two columns for one quantity, a unit that is not m, a line with more cells than the header, …).
std::vector<StationRow> read_stations_csv(const std::filesystem::path& file);

/// Returns everything that results must state about a run, as JSON text: version, engine, device, seed, scene, every
/// parameter.
std::string run_parameters_json(const Simulator& simulator, const PlanResult* result = nullptr);

/// The figures of one network, as JSON text; docs/command_line.md lists its keys (`evaluate --json`). Null: not known.
/// Stations count from 1. Axes of the standard ellipsoid of each head are in millimetres, survey frame, longest first.
std::string evaluation_json(const Evaluation& evaluation);

/// Returns the text of `front.json`; docs/command_line.md lists its keys. Every network of the front has its values by
/// their objectives' names. All numbers (`entry`, `answer`, stations of links) count from 1.
std::string front_json(const PlanResult& result, const Simulator& simulator);
/// A line for each network of the front: its values by the search and by every ray, violation, and stations. Throws
/// Error io.
void write_front_csv(const std::filesystem::path& file, const PlanResult& result);

/// CSV: `node,voxels,captured,hidden,out_of_range,too_flat,too_dark,too_sparse,not_chosen`, the node's `MissedShare`.
void write_missed_csv(const std::filesystem::path& file, std::span<const MissedShare> shares);
/// CSV, a line for each of the scene's rooms: `storey,room,floor_m2,ground_m2,stations,why_no_station,voxels` and the
/// reasons as above. `ground_m2` is the search area in it; stations are listed by their `names`. REQUIRES: one of
/// `shares` for each of `rooms`.
void write_rooms_csv(const std::filesystem::path& file, std::span<const Room> rooms, std::span<const RoomShare> shares,
                     std::span<const PlacedStation> stations, std::span<const std::string> names);
/// An element of the model, the surveyed meshes of one name, as a network captures it.
struct ElementShare {
  std::string name = {};                ///< `MeshInfo::name`.
  std::string ifc_class = {};           ///< "IfcWall", as the importer of IFC puts it into the name; empty: none.
  std::string global_id = {};           ///< Its GlobalId, likewise.
  double area_m2 = 0;                   ///< Area of all its triangles.
  std::uint64_t voxels = 0;             ///< Voxels with most surface of it.
  std::optional<double> captured = {};  ///< Share of the goal points of these.
  std::optional<Angle> incidence = {};  ///< Median over its seen voxels, each from the station that sees it best.
  std::optional<double> point_distance_m = {};  ///< Median over its seen voxels: the root of area over points.
  /// Predicted registration error, root mean square over its seen voxels; empty unless it was predicted.
  std::optional<double> deviation_m = {};
};
/// Elements in the order of their first meshes. Looks at 50 000 voxels at most, those of `missed_voxels`. `field`: of
/// the evaluated stations; with station masks, or incidence and deviation are empty. Throws Error invalid_argument for
/// a field without the points of every voxel.
std::vector<ElementShare> element_shares(const Simulator& simulator, const Evaluation& evaluation,
                                         const VoxelField& field);
/// CSV: `name,class,global_id,area_m2,voxels,captured,incidence,point_distance_mm,deviation_mm`; degrees, millimetres.
/// Empty cells: not known.
void write_elements_csv(const std::filesystem::path& file, std::span<const ElementShare> elements);
/// BCF 2.1, which programs for building models read: a topic for each of `elements` with a GlobalId of which less than
/// `most_captured` of the goal points are captured, the largest first, `most_topics` at most. Each tells the captured
/// share and the reasons in `shares`, of the nodes by name, for the rest; its viewpoint selects the element, and looks
/// at it from where most of it is in free sight. A camera is left out if the importer moved the model, since it would
/// look at another place there: several files with map conversions of their own. Returns how many topics there are; no
/// file is written if there is none. The same bytes for the same elements: all dates are 1980-01-01. Throws Error io.
std::size_t write_missed_bcf(const std::filesystem::path& file, std::span<const ElementShare> elements,
                             std::span<const MissedShare> shares, Site& site, double most_captured = 0.1,
                             std::size_t most_topics = 1000);
/// Every voxel of `missed` as a point in the colour of its reason, with the number of the reason (`WhyMissed`) and its
/// count. Binary PLY.
void write_missed_ply(const std::filesystem::path& file, const Simulator& simulator, const MissedVoxels& missed,
                      PlyCoordinates coordinates = PlyCoordinates::floats);

/// The predicted registration error on the surface in false colours. Every surveyed voxel that a station sees is a
/// point with its `error_mm`, the root mean square over the stations that see it, from dark (none) to yellow (the
/// largest). `field`: with station masks, of the network of `error`. Binary PLY. Throws Error.
void write_registration_ply(const std::filesystem::path& file, const Simulator& simulator, const VoxelField& field,
                            const RegistrationError& error, PlyCoordinates coordinates = PlyCoordinates::floats);

/// Writes text to a file atomically. Throws Error io.
void write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace vantage
