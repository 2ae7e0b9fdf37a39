// SPDX-License-Identifier: Apache-2.0
#include "vantage/site.hpp"

#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <nlohmann/json.hpp>

#include "core/read_json.hpp"
#include "core/rounded.hpp"
#include "core/setting_list.hpp"
#include "core/site_reach.hpp"
#include "core/utf8.hpp"
#include "placement/ground_weights.hpp"
#include "placement/nearest_place.hpp"
#include "placement/no_ground.hpp"
#include "placement/place_head.hpp"
#include "scene/scene_data.hpp"
#include "scene/told_by_name.hpp"
#include "site/room_windows.hpp"
#include "site/site_scanner.hpp"
#include "vantage/error.hpp"
#include "vantage/evaluate.hpp"

namespace vantage {
namespace {

// The common detail of all surveyed meshes; empty if they have none or differ.
std::optional<double> common_detail(const Scene& scene) {
  std::optional<double> common;
  for (const MeshInfo& mesh : scene.meshes()) {
    if (mesh.role != Role::surveyed) continue;
    if (mesh.detail_m == 0 || mesh.detail_m != common.value_or(mesh.detail_m)) return std::nullopt;
    common = mesh.detail_m;
  }
  return common;
}

bool asks_for_detail(const Scene& scene) {
  return std::ranges::any_of(scene.meshes(),
                             [](const MeshInfo& mesh) { return mesh.role == Role::surveyed && mesh.detail_m > 0; });
}

// Length scale of a scene smaller than a site: below 2 m the largest extent over 20 m, with two significant digits.
double scale_of(const Box& bounds) {
  const Vec3 size = bounds.size();
  const double extent = std::max({size.x, size.y, size.z});
  if (extent >= 2 || !(extent > 0)) return 1;
  const double scale = extent / 20;
  const double unit = std::pow(10, std::floor(std::log10(scale)) - 1);
  return std::round(scale / unit) * unit;
}

// Spacing for a scanner that is described by its steps: their distance at 10 m, square on, the distance at which
// manufacturers state resolutions, so one station can reach it. Not below the library's default, whose goal a fine
// pattern reaches easily; not so wide that a voxel would need less than a point.
double spacing_of_steps(const Scanner& scanner, const SimulatorConfig& config, double scale) {
  const double step = std::max(scanner.azimuth_step.in_radians(), scanner.zenith_step.in_radians());
  const double usual = config.point_spacing_m * scale;
  return std::max(usual, std::min(10 * step * scale, config.user_size_m / 2));
}

// Sets open settings from the scene's own defaults. Throws Error as their parser does.
void take_scene_defaults(SiteOptions& options, const Scene& scene, const std::string& source) {
  const auto defaults = nlohmann::json::parse(scene.defaults_json());
  const bool preset = options.scanner.has_value();
  const auto apply = [&](const nlohmann::json& values, const auto& again) -> void {
    for (const auto& [key, value] : values.items()) {
      if (value.is_object()) {
        again(value, again);
        continue;
      }
      std::string name = key;
      std::ranges::replace(name, '_', '-');
      const auto row = std::ranges::find(site_settings(), name, &SettingRow<SiteOptions>::name);
      if (row == site_settings().end() || !row->by_scene || (preset && row->by_preset) || row->given(options) ||
          value.is_null())
        continue;
      const std::string text = setting_text(value, source + ": " + key);
      // Names in a scene never refer to files of this machine.
      if (name == "noise" && text.ends_with(".csv"))
        throw Error(Errc::malformed_file, source + ": its defaults name the file \"" + text +
                                              "\" for noise, and a scene may name scanners only; give it as a setting");
      if (name == "crs" && text.find('[') == std::string::npos && !text.starts_with("EPSG:"))
        throw Error(Errc::malformed_file, source + ": its defaults name the coordinate system \"" + text +
                                              "\", and a scene may give EPSG:N or well-known text only");
      try {
        row->set(options, text, name);
      } catch (const Error& error) {
        throw Error(error.code(), source + ": " + error.what());
      }
    }
  };
  apply(defaults, apply);
}

// A single device keeps its usual name; several are listed. The processor is one by the name of its engine.
void choose_devices(SimulatorConfig& config, const SiteOptions& options) {
  config.engine = options.engine;
  if (options.devices.all) config.devices = all_devices(options.engine);
  for (const std::uint32_t device : options.devices.numbers) config.devices.push_back({options.engine, device});
  const DeviceChoice cpu{Engine::embree, std::nullopt};
  if (options.devices.cpu && std::find(config.devices.begin(), config.devices.end(), cpu) == config.devices.end())
    config.devices.push_back(cpu);
  if (config.devices.size() != 1) return;
  config.engine = config.devices.front().engine;
  config.device_index = config.devices.front().index;
  config.devices.clear();
}

SecurityVolume security_of(const SiteOptions& options, double scale) {
  SecurityVolume volume;
  if (options.security_m) return {(*options.security_m)[0], (*options.security_m)[1], (*options.security_m)[2]};
  volume.lower_m *= scale, volume.upper_m *= scale, volume.radius_m *= scale;
  return volume;
}

WalkableOptions walkable_of(const SiteOptions& options, double scale) {
  WalkableOptions walkable;
  if (options.max_slope) walkable.max_slope = *options.max_slope;
  walkable.headroom_m = options.headroom_m.value_or(walkable.headroom_m * scale);
  walkable.min_area_m2 = options.min_area_m2.value_or(walkable.min_area_m2 * scale * scale);
  walkable.passage_width_m = options.passage_m ? (*options.passage_m)[0] : walkable.passage_width_m * scale;
  walkable.passage_height_m = options.passage_m ? (*options.passage_m)[1] : walkable.passage_height_m * scale;
  walkable.climb_m = options.climb_m.value_or(walkable.climb_m * scale);
  walkable.enter = options.enter;
  walkable.levels = options.levels_m;
  if (walkable.levels && (*walkable.levels)[0] > (*walkable.levels)[1])
    throw Error(Errc::invalid_argument,
                "levels: " + rounded((*walkable.levels)[0], 6) + " is not below " + rounded((*walkable.levels)[1], 6));
  walkable.within = options.within, walkable.without = options.without;
  return walkable;
}

// Logs parts left out of the search area, and a hint at closed doors.
void log_area(const SearchArea& area, const Scene& scene, const std::function<void(const std::string&)>& log) {
  log("search area: " + area.description());
  std::string left_out;
  bool sealed = false;
  for (const LeftOut& out : area.left_out()) {
    left_out += (left_out.empty() ? "" : ", ") + rounded(out.area_m2) + " m² " + to_string(out.reason);
    sealed = sealed || (out.reason == LeftOutReason::sealed && out.area_m2 >= 1);
  }
  if (!left_out.empty()) log("left out of the search area: " + left_out);
  if (!sealed || !scene.options().doors.empty()) return;
  for (const MeshInfo& mesh : scene.meshes()) {
    if (!names_a_door(mesh.name)) continue;
    log("sealed parts may lie behind closed doors, such as \"" + mesh.name + "\"; the setting doors opens them");
    return;
  }
}

std::string absolute(const std::string& file) { return std::filesystem::absolute(file).string(); }

}  // namespace

struct Site::Impl {
  std::string name;
  SiteOptions options;
  Scene scene;
  std::vector<Scanner> scanners;
  std::string noise = "off";
  double scale = 1;
  SimulatorConfig config;
  SecurityVolume security;
  WalkableOptions walkable;
  std::vector<SiteChoice> choices;
  std::optional<SearchArea> area;
  bool no_ground = false;  // found out once
  std::optional<ClashChecker> clash;
  std::optional<Simulator> simulator, surroundings;
  bool surroundings_are_old = false;  // since the simulator has taken other scanners; to be made anew in place
  std::recursive_mutex making;
  // Makes a part, or waits until another thread has made it; one part may make another. The isolation keeps oneTBB from
  // giving this thread a task meanwhile that asks for the part.
  template <class Make>
  auto alone(const Make& make) {
    const std::lock_guard lock(making);
    return tbb::this_task_arena::isolate(make);
  }

  explicit Impl(Scene s) : scene(std::move(s)) {}

  void log(const std::string& line) const {
    if (options.log) options.log(line);
  }
  void require(const Vec3& position, const char* what) const { require_in_reach(position, scene.data().origin, what); }
  void choose(const char* setting, std::string value, std::string why) {
    choices.push_back({setting, std::move(value), std::move(why)});
  }

  void resolve() {
    scale = scale_of(scene.bounds());
    scanners = options.scanners;
    if (scanners.empty()) resolve_scanner();
    for (const Scanner& one : scanners) one.check();
    noise = noise_source(options, scanners.front());
    choose_devices(config, options);
    config.warn = options.warn;
    config.seed = options.seed;
    config.validation = options.validation;
    config.max_memory_bytes = options.memory_bytes;
    config.max_incidence = options.max_incidence;
    config.noise = std::ranges::any_of(scanners, [](const Scanner& scanner) { return !scanner.noise.empty(); });
    resolve_density();
    security = security_of(options, scale);
    walkable = walkable_of(options, scale);
    if (scale != 1) log_scaled();
    if (!options.noise) log_noise();
  }

  void resolve_scanner() {
    const bool open = !options.scanner && !options.steps && scale == 1;
    if (open) options.scanner = usual_scanner;
    scanners = {site_scanner(options, scale)};
    if (!open) return;
    choose("scanner", usual_scanner, "no scanner was named");
    log("scanner: none was named, so a " + scanners[0].name + " is assumed, " + rounded(scanners[0].seconds(), 2) +
        " s a scan");
  }

  // A figure that a maker does not state makes its scans look better than they are. The built-in scanner claims
  // nothing.
  void log_noise() const {
    for (const Scanner& one : scanners) {
      if (one.name == Scanner().name || one.noise.sigma_m.size() > 1) continue;
      log(one.name + ": " + describe(one.noise) +
          (one.noise.empty() ? "; its scans and their registration look better than they are"
                             : "; near and bright surfaces look worse than they are, far and dark ones better"));
    }
  }

  void resolve_density() {
    const std::optional<double> detail = common_detail(scene);
    config.user_size_m = options.user_size_m.value_or(config.user_size_m * scale);
    const bool by_steps = !options.scanner && options.scanners.empty();
    const double usual = options.deliverable ? spacing_for(*options.deliverable)
                         : by_steps          ? spacing_of_steps(scanners.front(), config, scale)
                                             : usual_spacing_m * scale;
    config.point_spacing_m = options.spacing_m.value_or(options.deliverable ? usual : detail.value_or(usual));
    const bool details_differ = asks_for_detail(scene) && !detail;
    config.spacing_by_detail = options.spacing_by_detail || (details_differ && !options.spacing_m);
    if (!options.user_size_m)
      choose("user-size", rounded(config.user_size_m), scale == 1 ? "the usual size" : "by the size of the scene");
    if (!options.spacing_m)
      choose("spacing", rounded(config.point_spacing_m),
             options.deliverable ? "what " + *options.deliverable + " takes"
             : detail            ? "the detail that all surveyed nodes ask for"
             : by_steps          ? "the scanner's own steps at 10 m"
                                 : "the usual distance between points");
    if (!details_differ || !config.spacing_by_detail) return;
    choose("spacing-by-detail", "true", "nodes ask for details that differ");
    log("surveyed nodes are wanted as densely as the detail that they ask for, others with a point every " +
        rounded(config.point_spacing_m) + " m");
  }

  // Logs the values scaled for a scene smaller than a site in one line.
  void log_scaled() const {
    std::string made_up;
    const auto add = [&](bool given, const std::string& text) {
      if (!given) made_up += (made_up.empty() ? "" : ", ") + text;
    };
    const Scanner& scanner = scanners.front();
    add(options.user_size_m.has_value(), "user-size " + rounded(config.user_size_m));
    add(options.spacing_m.has_value(), "spacing " + rounded(config.point_spacing_m));
    add(options.height_m.has_value(), "height " + rounded(scanner.height_m));
    add(options.range_m || options.scanner,
        "range " + rounded(scanner.min_range_m) + "," + rounded(scanner.max_range_m));
    add(options.security_m.has_value(),
        "security " + rounded(security.lower_m) + "," + rounded(security.upper_m) + "," + rounded(security.radius_m));
    if (made_up.empty()) return;
    const Vec3 size = scene.bounds().size();
    log("the scene measures " + rounded(size.x) + " x " + rounded(size.y) + " x " + rounded(size.z) +
        " m, smaller than a site: lengths are taken as " + rounded(scale, 2) + " times the usual (" + made_up + ")");
  }

  const SearchArea& search_area() {
    return *alone([&] {
      if (!area) {
        area = SearchArea::build(scene, walkable);
        if (options.log) log_area(*area, scene, options.log);
      }
      return &*area;
    });
  }

  bool has_area() {
    return alone([&] {
      if (scene.has_search_area() || area) return true;
      try {
        if (!no_ground) search_area();
      } catch (const NoGround&) {
        no_ground = true;
      }
      return !no_ground;
    });
  }

  // The site is unchanged after an error.
  void take_scanners(std::vector<Scanner> all) {
    if (simulator) simulator->set_scanners(all);
    surroundings_are_old = true;
    scanners = std::move(all);
  }

  // Raises the weight of everything except the ground, so that ground has a third of coverage at most.
  void weigh_ground() {
    if (!options.weigh_ground || !has_area() || !ground_is_unmarked(scene, search_area())) return;
    const GroundWeights found = ground_weights(scene, search_area());
    if (!found.told.empty()) log(found.told);
    if (!found.changes) return;
    choose("weigh-ground", "true", found.told);
    scene = with_weights(scene, found.weights);
  }
};

Site Site::open(const std::filesystem::path& file, SiteOptions options) {
  check_settings(site_settings(), options);
  if (options.memory_bytes > 0) options.scene.max_memory_bytes = options.memory_bytes;
  Scene scene = Scene::load(file, options.scene);
  if (options.log)
    for (const std::string& note : scene.notes()) options.log(file.string() + ": " + note);
  take_scene_defaults(options, scene, file.string());
  return Site(std::move(scene), std::move(options), to_utf8(file.stem().string()));
}

Site::Site(Scene scene, SiteOptions options, std::string name) : impl_(std::make_unique<Impl>(std::move(scene))) {
  impl_->name = std::move(name);
  check_settings(site_settings(), options);
  for (const Vec3& place : options.enter) impl_->require(place, "enter: the entrance is");
  impl_->options = std::move(options);
  impl_->resolve();
  impl_->weigh_ground();
}

Site::Site(Simulator simulator, SearchArea area, ClashChecker clash, std::string name)
    : impl_(std::make_unique<Impl>(simulator.scene())) {
  impl_->name = std::move(name);
  impl_->scanners.assign(simulator.scanners().begin(), simulator.scanners().end());
  impl_->config = simulator.config();
  impl_->options.seed = simulator.config().seed;
  // The simulator's scanners state what they detect.
  impl_->options.detection = {impl_->scanners.front().detection_range_m,
                              impl_->scanners.front().detection_reflectivity};
  impl_->security = clash.volume();
  impl_->walkable = area.options();
  impl_->area = std::move(area);
  impl_->clash = std::move(clash);
  impl_->simulator = std::move(simulator);
}

Site::Site(Site&&) noexcept = default;
Site& Site::operator=(Site&&) noexcept = default;
Site::~Site() = default;

const std::string& Site::name() const noexcept { return impl_->name; }
const Scene& Site::scene() const noexcept { return impl_->scene; }
const SiteOptions& Site::options() const noexcept { return impl_->options; }
std::span<const SiteChoice> Site::choices() const noexcept { return impl_->choices; }
const Scanner& Site::scanner() const noexcept { return impl_->scanners.front(); }
std::span<const Scanner> Site::scanners() const noexcept { return impl_->scanners; }
double Site::length_scale() const noexcept { return impl_->scale; }
const SimulatorConfig& Site::simulator_config() const noexcept { return impl_->config; }
const WalkableOptions& Site::walkable() const noexcept { return impl_->walkable; }
const SecurityVolume& Site::security() const noexcept { return impl_->security; }
const std::string& Site::crs() const noexcept { return impl_->options.crs; }

std::uint32_t Site::place_of(const Scanner& scanner) {
  const std::uint32_t place = place_in(impl_->scanners, scanner);
  if (place == impl_->scanners.size()) {
    std::vector<Scanner> all = impl_->scanners;
    all.push_back(scanner);
    impl_->take_scanners(std::move(all));
  }
  return place;
}

void Site::detect_every_echo() {
  const auto limited = [](const Scanner& scanner) { return scanner.detection_range_m > 0; };
  if (impl_->options.detection || std::ranges::none_of(impl_->scanners, limited)) return;
  std::vector<Scanner> all = impl_->scanners;
  for (Scanner& scanner : all) vantage::detect_every_echo(scanner);
  impl_->take_scanners(std::move(all));
}

Settings Site::settings() const {
  Settings all = vantage::settings(scanner());
  const auto append = [&](const Settings& more) { all.insert(all.end(), more.begin(), more.end()); };
  append(vantage::settings(scene().options()));
  append(vantage::settings(impl_->config));
  append(vantage::settings(impl_->security));
  append(vantage::settings(impl_->walkable));
  SettingList more;
  more.add("noise_source", impl_->noise, {"noise"});
  if (!crs().empty()) more.add("crs", crs(), {"crs", false});
  const auto files = [&](const char* name, const std::vector<PlanRegion>& regions) {
    std::vector<std::string> list;
    for (const PlanRegion& region : regions)
      if (!region.file.empty()) list.push_back(absolute(region.file));
    if (!list.empty()) more.add(std::string(name) + "_files", list, {name, false});
  };
  files("within", impl_->walkable.within);
  files("without", impl_->walkable.without);
  append(more.take());
  return all;
}

bool Site::has_area() { return impl_->has_area(); }
const SearchArea& Site::area() { return impl_->search_area(); }
const ClashChecker& Site::clash() {
  return *impl_->alone([&] {
    if (!impl_->clash) impl_->clash.emplace(impl_->scene, impl_->security);
    return &*impl_->clash;
  });
}

void Site::share(std::shared_ptr<TracerMaker> others) {
  if (impl_->simulator)
    throw Error(Errc::invalid_argument, "the site's simulator is made, and can no longer span other processes");
  impl_->config.shared = std::move(others);
}
bool Site::build(const Progress& progress) {
  return impl_->alone([&] {
    if (!impl_->simulator) impl_->simulator = Simulator::build(impl_->scene, impl_->scanners, impl_->config, progress);
    return impl_->simulator.has_value();
  });
}
Simulator& Site::simulator() {
  build();
  return *impl_->simulator;
}
Work Site::work() const {
  const std::lock_guard lock(impl_->making);
  Work sum;
  if (impl_->simulator) sum = sum + impl_->simulator->work();
  if (impl_->surroundings && !impl_->surroundings_are_old) sum = sum + impl_->surroundings->work();
  return sum;
}
Simulator& Site::surroundings() {
  return *impl_->alone([&] {
    if (!impl_->surroundings || impl_->surroundings_are_old) impl_->surroundings = surroundings_of(simulator());
    impl_->surroundings_are_old = false;
    return &*impl_->surroundings;
  });
}

PlacedHead Site::place_head(const Vec3& head, std::optional<Uv> uv) {
  impl_->require(head, "the scanner's head is");
  return vantage::place_head(has_area() ? &area() : nullptr, clash(), scanner().height_m, head, uv);
}

std::optional<PlacedStation> Site::nearest_place(const Vec3& head, double reach_m) {
  impl_->require(head, "the scanner's head is");
  return vantage::nearest_place(area(), clash(), scanner().height_m, head, reach_m);
}

OnSite Site::on_site(OnSiteOptions options) {
  if (!options.entrance && !walkable().enter.empty()) options.entrance = walkable().enter.front();
  check_rooms(options.windows, scene().rooms());
  return {area(),
          clash(),
          scanners(),
          options,
          impl_->scene.data().origin,
          windows_by_room(options.windows, scene().rooms())};
}

Evaluation Site::evaluate(std::span<const PlacedStation> stations, const EvaluationOptions& options,
                          const OnSiteOptions& options_on_site, const Progress& progress) {
  std::optional<OnSite> walk;
  if (has_area()) walk = on_site(options_on_site);
  if (!walk && options_on_site.day_min)
    throw Error(Errc::invalid_argument, "day: there is no ground in the model for a round that sessions are made of");
  EvaluationOptions chosen = options;
  chosen.target = with_class_of(this->options(), options.target);
  return evaluate_stations({.simulator = simulator(),
                            .surroundings = options.overlap ? &surroundings() : nullptr,
                            .on_site = walk ? &*walk : nullptr,
                            .clash = &clash(),
                            .area = has_area() ? &area() : nullptr},
                           stations, chosen, progress);
}

}  // namespace vantage
