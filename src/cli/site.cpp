// SPDX-License-Identifier: Apache-2.0
#include "cli/site.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "cli/command.hpp"
#include "cli/console.hpp"
#include "cli/options.hpp"
#include "cli/parse.hpp"
#include "cli/scanners.hpp"

namespace vantage::cli {
namespace {

// Options that a preset states, and so takes out of the scene's hands.
const std::set<std::string> preset_keys{"step",  "horizontal", "vertical", "zenith-start",
                                        "range", "rate",       "noise",    "beam"};
// Options that a scene may carry defaults for: what is measured, never where files go.
const std::set<std::string> scene_keys{"scanner",  "step",  "heading",  "horizontal", "vertical",  "zenith-start",
                                       "height",   "range", "noise",    "beam",       "user-size", "spacing",
                                       "security", "slope", "headroom", "min-area",   "station",   "crs"};

template <std::size_t N>
Setter numbers_into(std::optional<std::array<double, N>>& target, std::size_t fewest, const Interval& interval) {
  return [&target, fewest, interval](const std::string& text, const std::string& what) {
    const auto values = parse_numbers(text, what, fewest, N, interval);
    std::array<double, N> all{};
    for (std::size_t k = 0; k < N; ++k) all[k] = values[std::min(k, values.size() - 1)];
    target = all;
  };
}

Scanner resolve_scanner(const SiteOptions& options, double scale) {
  Scanner scanner;
  scanner.height_m *= scale;
  scanner.min_range_m *= scale;
  scanner.max_range_m *= scale;
  if (options.scanner) {
    const double height = scanner.height_m;
    scanner = load_scanner(*options.scanner, own_presets_file());
    scanner.height_m = height;
  }
  if (options.step) {
    scanner.azimuth_step = Angle::degrees((*options.step)[0]);
    scanner.zenith_step = Angle::degrees((*options.step)[1]);
  }
  if (options.heading) scanner.heading = Angle::degrees(*options.heading);
  if (options.horizontal) scanner.horizontal_angle = Angle::degrees(*options.horizontal);
  if (options.vertical) scanner.vertical_angle = Angle::degrees(*options.vertical);
  if (options.zenith_start) scanner.zenith_start = Angle::degrees(*options.zenith_start);
  if (options.height) scanner.height_m = *options.height;
  if (options.range) {
    scanner.min_range_m = (*options.range)[0];
    scanner.max_range_m = (*options.range)[1];
    if (!(scanner.min_range_m < scanner.max_range_m))
      throw Error(Errc::invalid_argument, "--range: the nearest distance must be below the farthest, and " +
                                              std::to_string(scanner.min_range_m) + " is not below " +
                                              std::to_string(scanner.max_range_m));
  }
  if (options.rate) scanner.points_per_second = *options.rate;
  if (options.noise) scanner.noise = load_noise(*options.noise);
  if (options.beam) {
    scanner.beam_divergence = Angle::radians((*options.beam)[0] * 1e-3);
    scanner.exit_diameter_m = (*options.beam)[1] * 1e-3;
  }
  scanner.check();
  return scanner;
}

// Where the noise came from; its table says only what it holds.
std::string noise_source(const SiteOptions& options, const Scanner& scanner) {
  std::string noise = scanner.noise.empty() ? "off" : options.noise ? *options.noise : options.scanner.value_or("off");
  return noise.ends_with(".csv") ? std::filesystem::absolute(noise).string() : noise;
}

// The detail that all surveyed meshes ask for; empty where they ask for none or differ.
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

// One line on what was made up for a scene of unusual size.
void tell_scaled(const SiteOptions& options, const LoadedSite& site, double scale) {
  const bool small = scale < 1;
  std::string made_up;
  const auto add = [&](bool given, const std::string& text) {
    if (!given) made_up += (made_up.empty() ? "" : ", ") + text;
  };
  add(options.user_size.has_value(), fmt::format("user-size {:.3g}", site.config.user_size_m));
  add(options.spacing.has_value(), fmt::format("spacing {:.3g}", site.config.point_spacing_m));
  if (small) {
    add(options.height.has_value(), fmt::format("height {:.3g}", site.scanner.height_m));
    add(options.range || options.scanner,
        fmt::format("range {:.3g},{:.3g}", site.scanner.min_range_m, site.scanner.max_range_m));
    add(options.area.security.has_value(), fmt::format("security {:.3g},{:.3g},{:.3g}", site.security.lower_m,
                                                       site.security.upper_m, site.security.radius_m));
  }
  if (made_up.empty()) return;
  const Vec3 size = site.scene.bounds().size();
  spdlog::info("the scene measures {:.3g} x {:.3g} x {:.3g} m, {} than a site: {} taken as {:.2g} times the usual ({})",
               size.x, size.y, size.z, small ? "smaller" : "larger", small ? "lengths" : "what is measured by is",
               scale, made_up);
}

// Where nobody asks for a spacing: as dense as the scanner's own steps are square on at 10 m, the distance that makers
// state resolutions at, so that one station can give it. Not below the library's, whose goal a fine pattern meets with
// ease; nor so wide that a voxel would want less than a point.
double usual_spacing(const Scanner& scanner, const SimulatorConfig& config, double scale) {
  const double step = std::max(scanner.azimuth_step.in_radians(), scanner.zenith_step.in_radians());
  const double usual = config.point_spacing_m * scale;
  return std::max(usual, std::min(10 * step * scale, config.user_size_m / 2));
}

// One device is named as ever; several are listed. The processor is one by the name of its engine.
void choose_devices(SimulatorConfig& config, const SiteOptions& options) {
  const DeviceList& asked = options.devices;
  config.engine = options.engine;
  if (asked.all) config.devices = all_devices(options.engine);
  for (const std::uint32_t number : asked.numbers) config.devices.push_back({options.engine, number});
  const DeviceChoice cpu{Engine::embree, std::nullopt};
  if (asked.cpu && std::find(config.devices.begin(), config.devices.end(), cpu) == config.devices.end())
    config.devices.push_back(cpu);
  config.warn = [](const std::string& line) { spdlog::warn("{}", line); };
  if (config.devices.size() != 1) return;
  config.engine = config.devices.front().engine;
  config.device_index = config.devices.front().index;
  config.devices.clear();
}

}  // namespace

void SiteOptions::add(CLI::App& command) {
  command.add_option("scene", scene, "The site: a .glb or .gltf file")->type_name("SCENE");

  add_texts(command, "--surveyed", "PATTERN", "Nodes to survey, by name; * and ? stand for any text and any letter",
            roles.surveyed)
      ->group("Scene");
  add_texts(command, "--blocking", "PATTERN", "Nodes that only block rays and stations", roles.blocking)
      ->group("Scene");
  add_texts(command, "--search", "PATTERN", "Nodes where stations may stand", roles.search)->group("Scene");
  add_texts(command, "--ignore", "PATTERN", "Nodes to leave out", roles.ignore)->group("Scene");
  // PATTERN=VALUE of one option, its value as `parse` reads it.
  const auto add_wishes = [&](const char* name, const char* unit, const char* help, const char* example, auto& wishes,
                              auto parse) {
    add_values(command, name, unit, help,
               [&wishes, unit, example, parse](const std::string& text, const std::string& what) {
                 const std::size_t equals = text.rfind('=');
                 if (equals == std::string::npos || equals == 0)
                   throw Error(Errc::invalid_argument,
                               what + ": \"" + text + "\" is not " + unit + ", as \"" + example + "\"");
                 wishes.emplace_back(text.substr(0, equals), parse(text.substr(equals + 1), what));
               })
        ->group("Scene");
  };
  const auto length = [](const std::string& text, const std::string& what) {
    return parse_number(text, what, positive);
  };
  add_wishes("--weight", "PATTERN=W",
             "What a voxel of these nodes counts in coverage, 1 to 255, where others count 1; may be repeated",
             "facade*=5", roles.weights, [](const std::string& text, const std::string& what) {
               return static_cast<std::uint32_t>(parse_count(text, what, 1, 255));
             });
  add_wishes("--detail", "PATTERN=MM",
             "Widest footprint of the beam, in millimetres, of points that count on these nodes; may be repeated",
             "pipe*=10", roles.details_mm, length);
  add_wishes("--accuracy", "PATTERN=MM",
             "Largest range noise, in millimetres, of points that count on these nodes; may be repeated", "flange*=1",
             roles.accuracies_mm, length);
  add_value(command, "--unit", "UNIT", "What lengths in the file are: m, cm, mm, in or ft; recognised otherwise",
            [this](const std::string& text, const std::string& what) {
              try {
                roles.unit = unit_from_string(text);
              } catch (const Error& error) {
                throw Error(error.code(), what + ": " + error.what());
              }
            })
      ->group("Scene");
  add_value(command, "--up", "AXIS", "Which axis of the file points up: y or z; recognised otherwise",
            [this](const std::string& text, const std::string& what) {
              try {
                roles.up = up_axis_from_string(text);
              } catch (const Error& error) {
                throw Error(error.code(), what + ": " + error.what());
              }
            })
      ->group("Scene");
  add_text(command, "--scene-index", "N", "Which scene of the file; the file's own default otherwise", scene_index)
      ->group("Scene");
  add_number(command, "--diffuse", "R", "Diffuse reflection coefficient where the file gives none, 0 to 1", diffuse,
             {.low = 0, .high = 1})
      ->group("Scene");
  command
      .add_flag("--allow-outside", roles.allow_outside, "Let the scene name buffers and images outside its own folder")
      ->group("Scene");

  add_text(command, "--scanner", "PRESET", "A scanner that `vantage info` lists, as rtc360 or rtc360@6mm", scanner)
      ->group("Scanner");
  add_value(command, "--step", "DEG[,DEG]", "Angle between rays: both, or azimuth and zenith",
            numbers_into(step, 1, positive))
      ->group("Scanner");
  add_number(command, "--heading", "DEG", "Azimuth of the middle of the horizontal sweep, from +X towards +Y", heading,
             any_number)
      ->group("Scanner");
  add_number(command, "--horizontal", "DEG", "Horizontal wide angle", horizontal,
             {.low = 0, .high = 360, .low_included = false})
      ->group("Scanner");
  add_number(command, "--vertical", "DEG", "Vertical wide angle, over both sides of the head: 300 is zenith 0 to 150",
             vertical, {.low = 0, .high = 360, .low_included = false})
      ->group("Scanner");
  add_number(command, "--zenith-start", "DEG",
             "Zenith of the first ray; above 0 for scanners that cannot look straight up", zenith_start,
             {.low = 0, .high = 180, .high_included = false})
      ->group("Scanner");
  add_number(command, "--height", "M", "Height of the scanner's head above the ground", height, not_negative)
      ->group("Scanner");
  add_value(command, "--range", "MIN,MAX", "Nearest and farthest distance measured, in metres",
            numbers_into(range, 2, not_negative))
      ->group("Scanner");
  add_text(command, "--noise", "TABLE", "Range noise: off, a scanner's name (rtc360), or a CSV file", noise)
      ->group("Scanner");
  add_value(command, "--beam", "MRAD,MM",
            "Full angle by which the beam widens, in milliradians, and its diameter at the exit, in millimetres",
            numbers_into(beam, 2, not_negative))
      ->group("Scanner");

  add_number(command, "--rate", "N", "Points measured a second, for the time on site; the preset's, or a million", rate,
             positive)
      ->group("Scanner");

  add_number(command, "--user-size", "M", "Upper bound of the voxel size", user_size, positive)->group("Measure");
  add_number(
      command, "--incidence", "DEG",
      "Largest angle between ray and normal of points that count, 90: any; 60 with --detail or --accuracy, else 90",
      incidence, {.low = 0, .high = 90, .low_included = false})
      ->group("Measure");
  add_number(command, "--spacing", "M", "Wanted distance between points; sets the goal density", spacing, positive)
      ->group("Measure");
  command
      .add_flag("--spacing-by-detail", spacing_by_detail,
                "On nodes with a --detail that is the spacing; so without --spacing where details differ")
      ->group("Measure");

  area.add(command, roles);

  add_value(command, "--engine", "ENGINE", "auto, ray_query, compute_bvh or embree",
            [this](const std::string& text, const std::string& what) {
              try {
                engine = engine_from_string(text);
              } catch (const Error& error) {
                throw Error(error.code(), what + ": " + error.what());
              }
            })
      ->group("Run");
  add_value(command, "--device", "LIST",
            "Number of the device, as `vantage info` lists it; several that share the work: 0,1, or all, or 0,cpu",
            [this](const std::string& text, const std::string& what) { devices = parse_devices(text, what); })
      ->group("Run");
  add_value(command, "--seed", "N", "Seed of noise, samples and search; 1 otherwise",
            [this](const std::string& text, const std::string& what) { seed = parse_count(text, what); })
      ->group("Run");
  add_value(command, "--memory", "SIZE",
            "Refuse what is estimated to take more memory: 4G, 500M; half of what is free otherwise",
            [this](const std::string& text, const std::string& what) { memory = parse_bytes(text, what); })
      ->group("Run");
  command.add_flag("--validation", validation, "Check every Vulkan call with the validation layer")->group("Run");
  add_text(command, "--crs", "EPSG:N|FILE",
           "Coordinate system of the scene: EPSG:25832 and the like, or a .prj or .wkt file; point clouds carry it",
           crs)
      ->group("Run");
  add_text(command, "--config", "FILE", "JSON file of options, keyed by their long names; what is typed goes before it",
           config_file)
      ->group("Run");
}

double length_scale(const Box& bounds) {
  const Vec3 size = bounds.size();
  const double extent = std::max({size.x, size.y, size.z});
  if ((extent >= 2 && extent <= 200) || !(extent > 0)) return 1;
  const double scale = extent / 20;
  const double unit = std::pow(10, std::floor(std::log10(scale)) - 1);
  return std::round(scale / unit) * unit;
}

const SearchArea& LoadedSite::area() {
  if (!area_) {
    area_ = SearchArea::build(scene, walkable);
    tell_area(*area_, scene);
  }
  return *area_;
}

bool LoadedSite::has_area() {
  if (scene.has_search_area() || area_) return true;
  try {
    area();
    return true;
  } catch (const Error& error) {
    if (error.code() != Errc::invalid_argument) throw;
    return false;
  }
}

void weigh_ground(LoadedSite& site) {
  if (!site.has_area() || !ground_is_unmarked(site.scene, site.area())) return;
  const GroundWeights found = ground_weights(site.scene, site.area());
  if (!found.told.empty()) spdlog::info("{}", found.told);
  if (found.changes) site.scene = with_weights(site.scene, found.weights);
}

const ClashChecker& LoadedSite::clash() {
  if (!clash_) clash_.emplace(scene, security);
  return *clash_;
}

nlohmann::json LoadedSite::as_options() const {
  nlohmann::json options = options_of(settings(scanner));
  for (const Settings& list : {settings(scene.options()), settings(config), settings(security), settings(walkable)})
    options.update(options_of(list));
  options["noise"] = noise;
  if (!crs.empty()) options["crs"] = crs;
  area_options.add_files_to(options);
  return options;
}

LoadedSite open_site(CLI::App& command, SiteOptions& options) {
  if (options.config_file) apply_layer(command, read_json(*options.config_file), *options.config_file);
  if (options.scene.empty())
    throw Error(Errc::invalid_argument, command.get_name() + ": which scene? Give a .glb or .gltf file");
  if (options.scene_index)
    options.roles.scene_index = parse_count(*options.scene_index, "--scene-index", 0, 0xFFFFFFFF);
  if (options.diffuse) options.roles.default_diffuse = *options.diffuse;

  options.roles.max_memory_bytes = options.memory;
  Scene scene = Scene::load(options.scene, options.roles);
  for (const auto& note : scene.notes()) spdlog::info("{}: {}", options.scene, note);
  const bool own_preset = options.scanner.has_value(), own_noise = options.noise.has_value(),
             own_crs = options.crs.has_value();
  const CLI::Option* station_file = command.get_option_no_throw("--stations");
  const bool own_stations = station_file && station_file->count() > 0;
  apply_layer(command, nlohmann::json::parse(scene.defaults_json()), options.scene, [&](const std::string& key) {
    return scene_keys.contains(key) && !(own_preset && preset_keys.contains(key)) &&
           !(own_stations && key == "station");
  });

  if (!own_noise && options.noise && options.noise->ends_with(".csv"))
    throw Error(Errc::malformed_file, options.scene + ": its defaults name the file \"" + *options.noise +
                                          "\" for noise, and a scene may name scanners only; give it with --noise");

  if (!own_crs && options.crs && options.crs->find('[') == std::string::npos && !options.crs->starts_with("EPSG:"))
    throw Error(Errc::malformed_file, options.scene + ": its defaults name the coordinate system \"" + *options.crs +
                                          "\", and a scene may give EPSG:N or well-known text only");

  const double scale = length_scale(scene.bounds());
  const double small = std::min(scale, 1.0);  // people and tripods do not grow with a site
  LoadedSite site{.scene = std::move(scene),
                  .scanner = resolve_scanner(options, small),
                  .scanners = {},
                  .config = {},
                  .security = {},
                  .walkable = {},
                  .noise = {}};
  site.scanners = {site.scanner};
  choose_devices(site.config, options);
  site.config.seed = options.seed;
  site.config.validation = options.validation;
  site.config.max_memory_bytes = options.memory;
  site.config.user_size_m = options.user_size.value_or(site.config.user_size_m * scale);
  site.config.point_spacing_m =
      options.spacing.value_or(common_detail(site.scene).value_or(usual_spacing(site.scanner, site.config, scale)));
  const bool details_differ = asks_for_detail(site.scene) && !common_detail(site.scene);
  site.config.spacing_by_detail = options.spacing_by_detail || (details_differ && !options.spacing);
  if (details_differ && site.config.spacing_by_detail)
    spdlog::info(
        "surveyed nodes are wanted as densely as the detail that they ask for, others with a point every {:.3g} m",
        site.config.point_spacing_m);
  if (options.incidence) site.config.max_incidence = Angle::degrees(*options.incidence);
  site.config.noise = !site.scanner.noise.empty();
  site.security = options.area.volume(small);
  site.walkable = options.area.walkable(small);
  site.area_options = options.area;
  site.noise = noise_source(options, site.scanner);
  site.crs = options.crs.value_or("");
  static_cast<void>(site.crs_text());  // an error now, not behind an hour's work
  if (scale != 1) tell_scaled(options, site, scale);
  return site;
}

Simulator build_simulator(const LoadedSite& site, std::span<const Scanner> scanners, Program& program) {
  ProgressLine line(program.console, "voxels");
  // Ranks stop together, between pieces of the search.
  const std::stop_token stop = program.ranks ? std::stop_token() : program.stop;
  auto simulator = Simulator::build(site.scene, scanners, site.config,
                                    {.report = [&](double done) { line.update(done); }, .stop = stop});
  if (!simulator) throw Stopped{};
  return std::move(*simulator);
}

}  // namespace vantage::cli
