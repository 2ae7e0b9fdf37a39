// SPDX-License-Identifier: Apache-2.0
/// A site: all that is fixed before a network of stations is chosen. Every call that plans, evaluates or writes results
/// takes one.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vantage/evaluation.hpp"
#include "vantage/on_site.hpp"
#include "vantage/placement.hpp"
#include "vantage/progress.hpp"
#include "vantage/scanner.hpp"
#include "vantage/scene.hpp"
#include "vantage/settings.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

/// Settings of a site. `Site` chooses values that are left empty, from the scene's own defaults if it has some;
/// `Site::choices()` lists them. Lengths in metres.
struct SiteOptions {
  SceneOptions scene = {};  ///< Settings for reading the file.

  /// The scanners that stations choose from, complete. Empty: one, made of the members up to `battery`.
  std::vector<Scanner> scanners = {};
  /// A preset, in the form of `load_scanner()`. Empty: `usual_scanner`, unless `steps` describe another.
  std::optional<std::string> scanner = {};
  std::optional<std::array<Angle, 2>> steps = {};  ///< Angles between rays in azimuth and zenith.
  /// As in `Scanner`.
  std::optional<Angle> heading = {}, horizontal_angle = {}, vertical_angle = {}, zenith_start = {};
  std::optional<double> height_m = {};                ///< Height of the head above the ground.
  std::optional<std::array<double, 2>> range_m = {};  ///< Nearest and farthest distance measured.
  std::optional<std::string> noise = {};              ///< Range noise, in the form of `load_noise()`.
  std::optional<std::array<double, 2>> beam = {};     ///< Divergence of the beam in mrad, exit diameter in mm.
  /// `Scanner::detection_range_m` and `detection_reflectivity`; {0, 1}: every echo is detected.
  std::optional<std::array<double, 2>> detection = {};
  std::optional<double> dropout = {};  ///< As in `Scanner`.
  /// A calibration's: `Scanner::angle_accuracy` in arc seconds, `range_accuracy_m` in mm, `range_accuracy_ppm`.
  std::optional<std::array<double, 3>> calibration = {};
  std::optional<double> points_per_second = {};  ///< As in `Scanner`.
  /// `Scanner::battery_min` and `battery_scans`; {0, 0}: not known.
  std::optional<std::array<double, 2>> battery = {};

  std::optional<double> user_size_m = {};  ///< Upper bound of the voxel size.
  std::optional<double> spacing_m = {};    ///< Wanted distance between points.
  /// The spacing follows from this purpose of the scans, in the form of `spacing_for()`, unless it is given.
  std::optional<std::string> deliverable = {};
  bool spacing_by_detail = false;           ///< As `SimulatorConfig::spacing_by_detail`.
  std::optional<Angle> max_incidence = {};  ///< As `SimulatorConfig::max_incidence`; 90°: any.
  /// If nothing marks the surveyed surface, weigh all but ground to stand on so that ground has a third of coverage at
  /// most. Scans do not need it.
  bool weigh_ground = true;

  std::optional<std::array<double, 3>> security_m = {};  ///< Lower and upper height and radius of the `SecurityVolume`.
  std::optional<Angle> max_slope = {};                   ///< As in `WalkableOptions`.
  std::optional<double> headroom_m = {}, min_area_m2 = {}, climb_m = {};  ///< As in `WalkableOptions`.
  /// Width and height of the narrowest opening that a person passes.
  std::optional<std::array<double, 2>> passage_m = {};
  std::vector<Vec3> enter = {};                        ///< Entrances, survey frame; empty: found.
  std::optional<std::array<double, 2>> levels_m = {};  ///< Lowest and highest ground, survey frame.
  std::vector<PlanRegion> within = {}, without = {};   ///< Regions that all stations stand in, and none.

  Engine engine = Engine::automatic;  ///< Engine that traces rays.
  DeviceList devices = {};            ///< Devices that share the work; none named: the best.
  std::uint64_t seed = 1;             ///< Seed of noise, samples and search.
  bool validation = false;            ///< Checks every Vulkan call with the validation layer.
  std::uint64_t memory_bytes = 0;     ///< Larger estimates are refused; 0: half of the free memory.
  std::string crs = {};               ///< Coordinate system of the survey frame; empty: unknown.

  /// Called on the calling thread with each fact and choice, a sentence each, and with each warning.
  std::function<void(const std::string&)> log = {}, warn = {};
};

/// The scanner of sites whose options and scene describe none.
inline constexpr const char* usual_scanner = "rtc360@6mm";
/// Wanted distance between points, in metres, where nothing tells what the scans are for.
inline constexpr double usual_spacing_m = 0.02;
/// Returns the distance between points, in metres, that a deliverable takes: of a drawing "1:N", 0.1 mm of paper, half
/// the line that is drawn; of an accuracy class of the USIBD, "LOA20" to "LOA50", its bound at 95 %: 50, 15, 5 or 1 mm.
/// Throws Error invalid_argument.
double spacing_for(const std::string& deliverable);
/// `target` with the accuracy class that the site's scans are for, unless it has one or they are for none.
TargetOptions with_class_of(const SiteOptions& site, TargetOptions target);

/// One row for each setting, in the order in which they are listed.
const SettingTable<SiteOptions>& site_settings();

/// A setting that the user left open and `Site` chose.
struct SiteChoice {
  std::string setting;  ///< Its name in `site_settings()`.
  std::string value;    ///< In the form in which users give it.
  std::string why;      ///< Reason, a phrase.
};

/// Owns scene, scanners, ground, clash checks and simulator, each made once. Moved, not copied. Several threads may
/// call it at once, while a plan of it runs too: calls that trace take turns, each waiting for what the other traces at
/// the moment. `place_of`, `detect_every_echo`, `share`, moving and destroying must run alone, and so must `equip`, and
/// a plan until it has called that.
class Site {
 public:
  /// Reads a model, a floor plan or points, in the formats of `Scene::load`, and chooses what the options leave open.
  /// Throws Error as `Scene::load`, and invalid_argument for a setting out of its range.
  static Site open(const std::filesystem::path& file, SiteOptions options = {});
  /// Makes a site of an existing scene. `name`: for titles and messages.
  explicit Site(Scene scene, SiteOptions options = {}, std::string name = "site");
  /// Makes a site of parts made by the caller. `options()` then holds only defaults.
  Site(Simulator simulator, SearchArea area, ClashChecker clash, std::string name = "site");
  Site(Site&&) noexcept;
  Site& operator=(Site&&) noexcept;
  ~Site();

  const std::string& name() const noexcept;              ///< The file's name, without folder and extension.
  const Scene& scene() const noexcept;                   ///< The scene, with the weights in force (`weigh_ground`).
  const SiteOptions& options() const noexcept;           ///< As they were given.
  std::span<const SiteChoice> choices() const noexcept;  ///< Settings that were left open, and what they are taken as.
  const Scanner& scanner() const noexcept;               ///< The first scanner.
  std::span<const Scanner> scanners() const noexcept;    ///< Indexed by `StationSetup::scanner`.
  /// Index of a scanner in `scanners()`, which it joins if it is new; the simulator then takes it, if it is made.
  /// Throws Error invalid_argument if it fails `Scanner::check`, and as `Simulator::set_scanners`.
  std::uint32_t place_of(const Scanner& scanner);
  /// Lets the scanners detect every echo, unless the options say what they detect. The paper's problems are posed for
  /// such scanners. Throws Error as `Simulator::set_scanners`.
  void detect_every_echo();
  /// Factor of default lengths for scenes smaller than a site; 1 from 2 m.
  double length_scale() const noexcept;
  const SimulatorConfig& simulator_config() const noexcept;  ///< Settings of `simulator()`.
  const WalkableOptions& walkable() const noexcept;          ///< Settings of `area()`.
  const SecurityVolume& security() const noexcept;           ///< Volume that `clash()` keeps free.
  const std::string& crs() const noexcept;                   ///< Coordinate system of the survey frame; empty: unknown.
  /// All settings, for results and configuration files.
  Settings settings() const;

  bool has_area();  ///< True if there is ground to stand on.
  /// Throws Error invalid_argument if there is none.
  const SearchArea& area();
  const ClashChecker& clash();  ///< Made if needed.
  /// Spans the simulator over other processes (`SimulatorConfig::shared`). Throws Error invalid_argument once it
  /// exists.
  void share(std::shared_ptr<TracerMaker> others);
  /// Makes the simulator unless it exists; false if stopped meanwhile. Throws as `Simulator`.
  bool build(const Progress& progress = {});
  Simulator& simulator();     ///< Made if needed.
  Simulator& surroundings();  ///< `surroundings_of(simulator())`.
  Work work() const;          ///< Work of the simulators that were made so far.

  /// Places a station by its head (survey frame), at `uv` if that is given, and checks it as a search does.
  PlacedHead place_head(const Vec3& head, std::optional<Uv> uv = {});
  /// The place nearest to a head (survey frame, metres) that may hold a station: on the search area, at the first
  /// scanner's height above the ground, free of clashes, `StationStatus::ok`. Distances are between heads, in space;
  /// the result is the nearest to within a fiftieth of the security volume's radius (1 cm by default). Empty if no such
  /// place lies within `reach_m`. Throws Error invalid_argument (no ground, a reach below 0, a value not finite).
  std::optional<PlacedStation> nearest_place(const Vec3& head, double reach_m = nearest_place_reach_m);
  /// Paths over the ground and times of rounds; rounds begin and end at the site's entrance if `options` name none.
  /// Throws Error invalid_argument (an option out of its range, no ground).
  OnSite on_site(OnSiteOptions options = {});

  /// Evaluates a network on this site: `evaluate_stations()` with scan overlaps if pairs are counted, and with the
  /// round on site, from and to the entrance, if there is ground. Throws Error as that does.
  Evaluation evaluate(std::span<const PlacedStation> stations, const EvaluationOptions& options = {},
                      const OnSiteOptions& on_site = {}, const Progress& progress = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Turns pairs u1, v1, u2, v2, … into stations: finds the ground, raises heads by the scanner's height, checks for
/// clashes.
std::vector<PlacedStation> place_stations(Site& site, std::span<const double> uvs);

}  // namespace vantage
