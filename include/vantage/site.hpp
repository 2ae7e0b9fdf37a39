// SPDX-License-Identifier: Apache-2.0
/// A site: all that is fixed before a network of stations is chosen. Every call that plans or evaluates takes one.
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
#include "vantage/placement.hpp"
#include "vantage/progress.hpp"
#include "vantage/scanner.hpp"
#include "vantage/scene.hpp"
#include "vantage/settings.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

/// What is known of a site. A value that is left empty is chosen by `Site`, from the scene's own defaults where it has
/// some, and told by `Site::choices()`. Lengths in metres.
struct SiteOptions {
  SceneOptions scene = {};  ///< How the file is read.

  /// The scanners that stations choose from, complete. Empty: one, made of the members up to `points_per_second`.
  std::vector<Scanner> scanners = {};
  std::optional<std::string> scanner = {};         ///< A preset, as `load_scanner()` takes it.
  std::optional<std::array<Angle, 2>> steps = {};  ///< Azimuth and zenith.
  std::optional<Angle> heading = {}, horizontal_angle = {}, vertical_angle = {}, zenith_start = {};
  std::optional<double> height_m = {};
  std::optional<std::array<double, 2>> range_m = {};  ///< Nearest and farthest.
  std::optional<std::string> noise = {};              ///< As `load_noise()` takes it.
  std::optional<std::array<double, 2>> beam = {};     ///< Divergence in mrad, exit diameter in mm.
  std::optional<double> points_per_second = {};

  std::optional<double> user_size_m = {};  ///< Upper bound of the voxel size.
  std::optional<double> spacing_m = {};    ///< Wanted distance between points.
  bool spacing_by_detail = false;          ///< As `SimulatorConfig::spacing_by_detail`.
  std::optional<Angle> max_incidence = {};
  bool weigh_ground = true;  ///< Apply `ground_weights()` where nothing says what is surveyed. Scans can do without.

  std::optional<std::array<double, 3>> security_m = {};  ///< `SecurityVolume`: lower, upper, radius.
  std::optional<Angle> max_slope = {};
  std::optional<double> headroom_m = {}, min_area_m2 = {}, climb_m = {};
  std::optional<std::array<double, 2>> passage_m = {};  ///< Width and height.
  std::optional<Vec3> enter = {};
  std::optional<std::array<double, 2>> levels_m = {};  ///< Lowest and highest ground.
  std::vector<PlanRegion> within = {}, without = {};

  Engine engine = Engine::automatic;
  DeviceList devices = {};
  std::uint64_t seed = 1;
  bool validation = false;
  std::uint64_t memory_bytes = 0;  ///< 0: half of what is free.
  std::string crs = {};            ///< Coordinate system of the survey frame; empty: not known.

  /// Told, on the calling thread, what was found and chosen, a sentence each; and what one should be warned of.
  std::function<void(const std::string&)> log = {}, warn = {};
};

/// One row a setting, in the order in which they are told.
const SettingTable<SiteOptions>& site_settings();

/// Something that nobody gave, and `Site` chose.
struct SiteChoice {
  std::string setting;  ///< Its name in `site_settings()`.
  std::string value;    ///< As one would give it.
  std::string why;
};

/// Scene, scanners, ground, clash checks and simulator, each made once. The owner of all of them; moved, not copied. Of
/// one site, one call at a time.
class Site {
 public:
  /// Reads the scene and chooses what the options leave open. Throws Error as `Scene::load`, and invalid_argument for a
  /// setting out of its range.
  static Site open(const std::filesystem::path& file, SiteOptions options = {});
  /// The same of a scene that is there. `name`: for titles and messages.
  explicit Site(Scene scene, SiteOptions options = {}, std::string name = "site");
  /// Of parts that the caller made. `options()` holds no more than defaults then.
  Site(Simulator simulator, SearchArea area, ClashChecker clash, std::string name = "site");
  Site(Site&&) noexcept;
  Site& operator=(Site&&) noexcept;
  ~Site();

  const std::string& name() const noexcept;  ///< The file's, without folder and extension.
  const Scene& scene() const noexcept;       ///< With the weights that hold (`weigh_ground`).
  const SiteOptions& options() const noexcept;
  std::span<const SiteChoice> choices() const noexcept;
  const Scanner& scanner() const noexcept;             ///< The first.
  std::span<const Scanner> scanners() const noexcept;  ///< What `StationSetup::scanner` counts.
  /// The place of a scanner in `scanners()`, where it is added if it is not there. Throws Error invalid_argument for
  /// one that fails `Scanner::check`, or is new once the simulator is there.
  std::uint32_t place_of(const Scanner& scanner);
  /// What a scene smaller or larger than a site's has all lengths multiplied by; 1 from 2 m to 200 m.
  double length_scale() const noexcept;
  const SimulatorConfig& simulator_config() const noexcept;
  const WalkableOptions& walkable() const noexcept;
  const SecurityVolume& security() const noexcept;
  const std::string& crs() const noexcept;
  /// Everything as `Settings`, for results and configuration files.
  Settings settings() const;

  bool has_area();  ///< Whether there is ground to stand on.
  /// Throws Error invalid_argument where there is none.
  const SearchArea& area();
  const ClashChecker& clash();
  /// Spans the simulator over other processes (`SimulatorConfig::shared`). Throws Error invalid_argument once it is
  /// there.
  void share(std::shared_ptr<TracerMaker> others);
  /// Makes the simulator unless it is there; false where it was stopped meanwhile. Throws as `Simulator`.
  bool build(const Progress& progress = {});
  Simulator& simulator();     ///< Built if need be.
  Simulator& surroundings();  ///< `surroundings_of(simulator())`.

  /// Evaluates a network on this site: `evaluate_stations()` with scan overlaps if pairs are counted, and with the
  /// round on site, which begins and ends where one enters, if there is ground. Throws Error as that does.
  Evaluation evaluate(std::span<const PlacedStation> stations, const EvaluationOptions& options = {},
                      const OnSiteOptions& on_site = {}, const Progress& progress = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vantage
