// SPDX-License-Identifier: Apache-2.0
#include "import/cloud/convert.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/rounded.hpp"
#include "import/cloud/byte_file.hpp"
#include "import/cloud/cell_grid.hpp"
#include "import/cloud/density.hpp"
#include "import/cloud/flat_regions.hpp"
#include "import/cloud/free_space.hpp"
#include "import/cloud/points.hpp"
#include "import/cloud/rectangles.hpp"
#include "import/cloud/scan_settings.hpp"
#include "import/glb_bytes.hpp"
#include "import/program.hpp"

namespace vantage::importer {
namespace {

using nlohmann::json;

// Fills gaps of at most this many cells in the rows and columns of a region.
constexpr std::int32_t kClosedGap = 3;
// A person's space above ground, in metres, is known if this share of it was seen through.
constexpr double kFromGround_m = 0.3, kHeight_m = 1.8, kKnownShare = 0.5;
constexpr double kGround = 0.8;      // least z of a normal of ground
constexpr double kUpright = 0.3;     // largest z of a wall's
constexpr double kFarthest_m = 1e9;  // largest coordinate of a scene
// Follows at most this many rays of all scans to find free space; more say nothing new.
constexpr std::uint64_t kMostRays = 20'000'000;

std::string counted(std::uint64_t n, const char* what) {
  const std::string digits = std::to_string(n);
  std::string text;
  for (std::size_t k = 0; k < digits.size(); ++k) {
    if (k > 0 && (digits.size() - k) % 3 == 0) text += ' ';
    text += digits[k];
  }
  return text + " " + what;
}

std::string with_unit(double value, const char* unit) { return rounded(value) + " " + unit; }

// Returns a place with Z up in the axes of glTF, which has Y up; unchanged unless `y_up`.
std::array<double, 3> up_axis(const Eigen::Vector3d& p, bool y_up) {
  return y_up ? std::array{p.x(), p.z(), -p.y()} : std::array{p.x(), p.y(), p.z()};
}

// Triangles of one node, about the cloud's middle.
class Surface {
 public:
  explicit Surface(const char* name) : name_(name) {}

  void stand_up(bool y_up) { y_up_ = y_up; }

  void add(const FlatRegion& region, const std::vector<Square>& squares, double cell_m, bool turned) {
    const std::vector<Rectangle> all = rectangles(squares);
    const Outlines outlines(all);
    const bool forwards = (region.normal[region.axis] > 0) != turned;
    for (const Rectangle& rectangle : all) {
      const std::vector<Square> outline = outlines.of(rectangle);
      const auto first = static_cast<std::uint32_t>(positions_.size() / 3);
      const auto count = static_cast<std::uint32_t>(outline.size());
      for (const Square& corner : outline) add_corner(region, corner[0], corner[1], cell_m);
      if (count == 4) {
        add_triangle({first, first + 1, first + 2}, forwards);
        add_triangle({first, first + 2, first + 3}, forwards);
        continue;
      }
      add_corner(region, 0.5 * (rectangle.low[0] + rectangle.high[0]), 0.5 * (rectangle.low[1] + rectangle.high[1]),
                 cell_m);
      for (std::uint32_t k = 0; k < count; ++k)
        add_triangle({first + k, first + (k + 1) % count, first + count}, forwards);
    }
  }

  std::size_t triangles() const { return indices_.size() / 3; }

  void write(Buffer& buffer, json& nodes, json& meshes, const json& translation) const {
    if (indices_.empty()) return;
    const int positions = buffer.add_positions(positions_), indices = buffer.add_indices(indices_);
    meshes.push_back(
        {{"name", name_}, {"primitives", {{{"attributes", {{"POSITION", positions}}}, {"indices", indices}}}}});
    nodes.push_back({{"name", name_}, {"mesh", meshes.size() - 1}, {"translation", translation}});
  }

 private:
  void add_corner(const FlatRegion& region, double u, double v, double cell_m) {
    Eigen::Vector3d p;
    p[(region.axis + 1) % 3] = u, p[(region.axis + 2) % 3] = v, p[region.axis] = region.height(u, v);
    p *= cell_m;
    for (const double c : up_axis(p, y_up_)) positions_.push_back(static_cast<float>(c));
  }
  void add_triangle(std::array<std::uint32_t, 3> corners, bool forwards) {
    if (!forwards) std::swap(corners[1], corners[2]);
    indices_.insert(indices_.end(), corners.begin(), corners.end());
  }

  const char* name_;
  bool y_up_ = true;
  std::vector<float> positions_;
  std::vector<std::uint32_t> indices_;
};

class Converter {
 public:
  Converter(const Files& files, const std::string& format, const CloudSettings& settings)
      : source_(open_source(files, format, settings)),
        cell_m_(settings.cell_m),
        metric_(settings.unit_m || source_->metric()) {}

  std::string run() {
    measure();
    accumulate();
    const std::uint32_t lone = drop_lone(*grid_);
    std::vector<CellPlane> planes = cell_planes(*grid_);
    std::uint32_t moving = 0;
    std::optional<FreeSpace> free;
    if (posed_ > 0) {
      free.emplace(*grid_, planes);
      follow_rays(*free);
      moving = drop_seen_through(*grid_);
      if (moving > 0) drop_lone(*grid_);
      planes = cell_planes(*grid_);
    }
    const bool whole = posed_ == source_->scans().size();
    cover(flat_regions(*grid_, planes), whole && free ? &*free : nullptr);
    tell(lone, moving);
    return write();
  }

 private:
  // Reads all points, and reports progress from `from` to `to`.
  void read(double from, double to, const PointSink& sink) {
    const auto all = static_cast<double>(std::max(source_->announced(), points_));
    double done = 0;
    source_->read([&](const PointBlock& block) {
      sink(block);
      done += static_cast<double>(block.positions.size());
      if (all > 0) tell_progress(from + (to - from) * std::min(1.0, done / all));
    });
  }

  Density density_of(double scale) {
    Density density(scale);
    read(0, 0.3, [&](const PointBlock& block) {
      for (const Eigen::Vector3d& p : block.positions) {
        density.add(p);
        floats_ = floats_ && p.array() == p.array().cast<float>().cast<double>();
      }
    });
    points_ = density.points();
    return density;
  }

  void measure() {
    Density density = density_of(1);
    if (points_ == 0) throw Refused("it holds no point; export it again");
    const bool far = density.middle().cwiseAbs().maxCoeff() > kFarthest_m;
    if (far && metric_) throw Refused("its points lie farther than 1e9 m from the origin; export it again");
    if (!metric_) refuse_degrees(density);
    if (far) {
      // Only coordinates in millimetres are that large on earth.
      source_ = moved(std::move(source_), Eigen::Matrix3d::Identity(), 0.001);
      metric_ = true;
      unit_note_ =
          "its coordinates are too large for metres, and are taken as millimetres; the setting unit tells another";
      density = density_of(1);
    }
    double cell = 0;
    if (cell_m_) {
      cell = *cell_m_;
    } else {
      // Lengths of an unknown unit count as metres unless points are too far apart for that.
      constexpr double kMostScale = 1000, kCentimetres = 100;
      while (!metric_ && density.too_thin() && scale_ < kMostScale) {
        scale_ = scale_ == 1 ? kCentimetres : kMostScale;
        density = density_of(scale_);
      }
      cell = scale_ * Density::kSizes_m[choose_cell(density, memory_for_cells(), CellGrid::kBytesEach)];
    }
    // Rounds the middle to whole metres, so that coordinates stay short.
    grid_.emplace(density.middle().array().round(), cell);
    for (const CloudScan& scan : source_->scans()) posed_ += scan.posed ? 1 : 0;
  }

  // Refuses points less than 0.02 wide and more than 50 times as high: degrees, with heights in metres.
  static void refuse_degrees(const Density& density) {
    constexpr double kWidest = 0.02, kHigher = 50, kLeastHigh = 0.3;
    const Eigen::Vector3d extent = density.extent(), middle = density.middle();
    const double wide = std::max(extent.x(), extent.y());
    if (wide < kWidest && extent.z() > kHigher * wide && extent.z() > kLeastHigh && std::abs(middle.x()) <= 180 &&
        std::abs(middle.y()) <= 180)
      throw Refused("its coordinates look like degrees of latitude and longitude; project them to metres, e.g. UTM");
  }

  // Returns the number of a scan as cells store it.
  static std::uint16_t number_of(std::uint32_t scan) {
    return static_cast<std::uint16_t>(std::min<std::uint32_t>(scan, Cell::kSeveralScans - 1));
  }

  void accumulate() {
    read(0.3, 0.6, [&](const PointBlock& block) {
      const CloudScan scan = source_->scans()[block.scan];
      for (std::size_t k = 0; k < block.positions.size(); ++k) {
        const Eigen::Vector3d& p = block.positions[k];
        Eigen::Vector3d towards = Eigen::Vector3d::Zero();
        if (scan.posed)
          towards = (scan.position - p).stableNormalized();
        else if (!block.normals.empty())
          towards = block.normals[k].cast<double>();
        if (!grid_->add(p, number_of(block.scan), towards)) ++far_;
      }
    });
  }

  void follow_rays(FreeSpace& free) {
    const std::uint64_t stride = 1 + points_ / kMostRays;
    std::uint64_t count = 0;
    read(0.6, 0.9, [&](const PointBlock& block) {
      const CloudScan& scan = source_->scans()[block.scan];
      if (!scan.posed) return;
      const Eigen::Vector3d from = grid_->in_cells(scan.position);
      for (const Eigen::Vector3d& p : block.positions)
        if (count++ % stride == 0) free.add_ray(from, grid_->in_cells(p), number_of(block.scan));
    });
  }

  // Returns true if at least half of a person's space above this ground was seen.
  bool known_above(const FreeSpace& free, const Eigen::Vector3d& ground) const {
    int known = 0, all = 0;
    const double cells = scale_ / grid_->cell_m();  // of a metre
    for (double z = kFromGround_m * cells; z < kHeight_m * cells; z += free.coarse_cells(), ++all)
      known += free.known(ground + Eigen::Vector3d(0, 0, z)) ? 1 : 0;
    return known >= kKnownShare * all;
  }

  // `free`: null if free space is not known.
  void cover(const std::vector<FlatRegion>& regions, const FreeSpace* free) {
    const double square_m2 = grid_->cell_m() * grid_->cell_m();
    for (Surface* surface : {&floors_, &ceilings_, &walls_, &slopes_, &unknown_}) surface->stand_up(metric_);
    for (const FlatRegion& region : regions) {
      std::vector<Square> known = close_gaps(region.columns, kClosedGap), unknown;
      const bool ground = region.normal.z() >= kGround && region.axis == 2;
      if (ground && free) {
        const auto seen = [&](const Square& s) {
          return known_above(*free, {s[0] + 0.5, s[1] + 0.5, region.height(s[0] + 0.5, s[1] + 0.5)});
        };
        std::ranges::copy_if(known, std::back_inserter(unknown), [&](const Square& s) { return !seen(s); });
        std::erase_if(known, [&](const Square& s) {
          return std::ranges::binary_search(unknown, s, [](const Square& a, const Square& b) {
            return std::pair(a[1], a[0]) < std::pair(b[1], b[0]);
          });
        });
      }
      Surface& surface = ground                                    ? floors_
                         : region.normal.z() <= -kGround           ? ceilings_
                         : std::abs(region.normal.z()) <= kUpright ? walls_
                                                                   : slopes_;
      surface.add(region, known, grid_->cell_m(), false);
      // Nobody can stand on a surface that faces down.
      unknown_.add(region, unknown, grid_->cell_m(), true);
      unknown_m2_ += square_m2 * static_cast<double>(unknown.size()) / std::max(region.normal.z(), kGround);
    }
    if (triangles() > 0) return;
    const std::string coarse = coarse_note();
    throw Refused("no surface shows in its points; " + (coarse.empty() ? "export more of them" : coarse));
  }

  // Returns a note if coordinates come in steps above a twentieth of a cell, which bend flat surfaces; else empty.
  std::string coarse_note() const {
    constexpr double kCoarse = 0.05;
    double step = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const auto middle = static_cast<float>(std::abs(grid_->middle()[axis]));
      if (source_->floats() || floats_[axis])
        step = std::max(step, static_cast<double>(std::nextafter(middle, HUGE_VALF) - middle));
    }
    if (step <= kCoarse * grid_->cell_m()) return {};
    return "its coordinates have no more digits than float32, which so far from 0 are told only to " +
           with_unit(step, metric_ ? "m" : "of the file's unit") +
           " or worse; export doubles, or coordinates about a nearer origin";
  }

  std::size_t triangles() const {
    std::size_t n = 0;
    for (const Surface* surface : {&floors_, &ceilings_, &walls_, &slopes_, &unknown_}) n += surface->triangles();
    return n;
  }

  void tell(std::uint32_t lone, std::uint32_t moving) {
    notes_ = source_->notes();
    const std::size_t scans = source_->scans().size();
    notes_.push_back(
        "a point cloud, " + counted(points_, "points") +
        (scans > 1 ? " of " + counted(scans, "scans") : std::string()) + ": surfaces are fitted in cells of " +
        (metric_ ? with_unit(100 * grid_->cell_m(), "cm") : with_unit(grid_->cell_m(), "in the file's unit")) + ", " +
        counted(triangles(), "triangles"));
    if (lone > 0) notes_.push_back(counted(lone, "cells of lone points are left out"));
    if (far_ > 0) notes_.push_back(counted(far_, "points far from all others are left out"));
    if (moving > 0)
      notes_.push_back(
          counted(moving, "cells are left out, as other scans saw through them: people, cars and the like"));
    if (posed_ < scans)
      notes_.push_back(posed_ == 0
                           ? "the file does not say where its scans were taken: what lies between points counts as free"
                           : counted(scans - posed_, "scans have no pose: what lies between points counts as free"));
    if (!unit_note_.empty()) notes_.push_back(unit_note_);
    if (const std::string coarse = coarse_note(); !coarse.empty()) notes_.push_back(coarse);
    if (metric_ && unknown_m2_ >= 0.1)
      notes_.push_back(
          with_unit(unknown_m2_, "m² of ground lie below space that no scan saw; no station stands there"));
  }

  std::string write() const {
    Buffer buffer;
    json nodes = json::array(), meshes = json::array();
    const Eigen::Vector3d& middle = grid_->middle();
    const json translation = up_axis(middle, metric_);
    for (const Surface* surface : {&floors_, &ceilings_, &walls_, &slopes_, &unknown_})
      surface->write(buffer, nodes, meshes, translation);
    json roots = json::array();
    for (std::size_t k = 0; k < nodes.size(); ++k) roots.push_back(k);
    // The axes stay those that the user knows if there is no unit; the scene's reader recognises it or asks.
    json vantage{{"up", metric_ ? "y" : "z"}, {"scanned", true}};
    if (metric_) vantage["unit"] = "m";
    const std::string& crs = source_->crs();
    if (crs.starts_with("PROJCS[") || crs.starts_with("COMPD_CS[") || crs.starts_with("EPSG:")) vantage["crs"] = crs;
    return buffer.finish({{"asset",
                           {{"version", "2.0"},
                            {"generator", "vantage-import-cloud"},
                            {"extras", {{"vantage", vantage}, {"notes", notes_}}}}},
                          {"scene", 0},
                          {"scenes", {{{"nodes", roots}}}},
                          {"nodes", nodes},
                          {"meshes", meshes}});
  }

  std::unique_ptr<PointSource> source_;
  std::optional<double> cell_m_;  // the user's; empty: chosen
  bool metric_ = false;           // true: lengths are metres; false: the file's own unit
  double scale_ = 1;              // the file's units in a metre, as far as recognised
  std::string unit_note_;
  std::optional<CellGrid> grid_;
  std::uint64_t points_ = 0, far_ = 0;
  // True for each axis along which all coordinates are numbers of float32.
  Eigen::Array<bool, 3, 1> floats_ = Eigen::Array<bool, 3, 1>::Constant(true);
  std::size_t posed_ = 0;  // scans with a pose
  double unknown_m2_ = 0;
  Surface floors_{"floors"}, ceilings_{"ceilings"}, walls_{"walls"}, slopes_{"slopes"},
      unknown_{"floors-below-unknown-space"};
  std::vector<std::string> notes_;
};

}  // namespace

bool take_setting(CloudSettings& settings, const std::string& word) {
  constexpr double kFinest_m = 1e-4, kCoarsest_m = 10;
  const std::size_t equals = word.find('=');
  if (equals == std::string::npos) return false;
  const std::string name = word.substr(0, equals), value = word.substr(equals + 1);
  if (name == "cell") {
    const auto cell_m = number_of(value);
    if (!cell_m || !(*cell_m >= kFinest_m && *cell_m <= kCoarsest_m))
      throw Refused("the setting " + word + " is not cell=METRES, from 0.0001 to 10");
    settings.cell_m = cell_m;
  } else if (name == "unit") {
    constexpr std::array<std::pair<const char*, double>, 5> kUnits{
        {{"m", 1}, {"cm", 0.01}, {"mm", 0.001}, {"in", 0.0254}, {"ft", 0.3048}}};
    const auto* unit = std::ranges::find(kUnits, value, &std::pair<const char*, double>::first);
    if (unit == kUnits.end()) throw Refused("the setting " + word + " is not unit=m, cm, mm, in or ft");
    settings.unit_m = unit->second;
  } else if (name == "up") {
    if (value != "x" && value != "y" && value != "z") throw Refused("the setting " + word + " is not up=x, y or z");
    settings.up = value.front();
  } else if (name == "columns") {
    settings.columns = value;
  } else {
    return false;
  }
  return true;
}

std::unique_ptr<PointSource> open_source(const Files& files, const std::string& format, const CloudSettings& settings) {
  const Reading reading{.own_unit = !settings.unit_m, .columns = settings.columns};
  std::vector<std::unique_ptr<PointSource>> sources;
  for (const std::filesystem::path& file : files) try {
      sources.push_back(format == "e57"   ? open_e57(file)
                        : format == "las" ? open_las(file, reading)
                        : format == "ply" ? open_ply(file)
                        : format == "pcd" ? open_pcd(file)
                                          : open_text(file, reading));
    } catch (const Refused& why) {
      throw files.size() == 1 ? why : Refused(file.filename().string() + ": " + why.what());
    }
  auto all = joined(std::move(sources));
  if (!settings.unit_m && settings.up == 'z') return all;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  if (settings.up == 'y') turn << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  if (settings.up == 'x') turn << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  return moved(std::move(all), turn, settings.unit_m.value_or(1));
}

double memory_for_cells() {
  constexpr double kShare = 0.6, kWithoutLimit = 2e9;
  rlimit limit{};
  if (getrlimit(RLIMIT_DATA, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kShare * kWithoutLimit;
  return kShare * static_cast<double>(limit.rlim_cur);
}

std::string convert_cloud(const Files& files, const std::string& format, const CloudSettings& settings) {
  return Converter(files, format, settings).run();
}

json scan_json(const CloudScan& scan) {
  return {{"name", scan.name},
          {"position", {scan.position.x(), scan.position.y(), scan.position.z()}},
          {"rotation", {scan.rotation.w(), scan.rotation.x(), scan.rotation.y(), scan.rotation.z()}},
          {"sensor", scan.sensor}};
}

std::string list_scans(const std::filesystem::path& file) {
  json scans = json::array();
  const auto source = open_e57(file);
  if (std::ranges::none_of(source->scans(), &CloudScan::posed))
    throw Refused("it does not say from where its scans were taken; export it with their poses");
  std::vector<ScanSettings> settings(source->scans().size());
  const auto all = static_cast<double>(source->announced());
  double done = 0;
  source->want_cells();
  source->read([&](const PointBlock& block) {
    const CloudScan& scan = source->scans()[block.scan];
    const Eigen::Matrix3d into_scanner = scan.rotation.conjugate().toRotationMatrix();
    for (std::size_t k = 0; k < block.positions.size(); ++k)
      settings[block.scan].add(into_scanner * (block.positions[k] - scan.position),
                               block.cells.empty() ? std::nullopt : std::optional(block.cells[k]));
    done += static_cast<double>(block.positions.size());
    if (all > 0) tell_progress(done / all);
  });
  for (std::size_t k = 0; k < settings.size(); ++k) {
    if (!source->scans()[k].posed) continue;
    json scan = scan_json(source->scans()[k]);
    scan["settings"] = settings[k].as_json();
    scans.push_back(std::move(scan));
  }
  return glb_bytes(
      {{"asset", {{"version", "2.0"}, {"generator", "vantage-import-cloud"}, {"extras", {{"scans", scans}}}}}}, "");
}

}  // namespace vantage::importer
