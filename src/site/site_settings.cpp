// SPDX-License-Identifier: Apache-2.0
#include "core/setting_table.hpp"
#include "vantage/site.hpp"

namespace vantage {
namespace {

using Rows = SettingRows<SiteOptions>;

// PATTERN=VALUE, with the value read by `parse`.
template <class Parse>
auto wish(std::string unit, std::string example, Parse parse) {
  return
      [unit = std::move(unit), example = std::move(example), parse](const std::string& text, const std::string& what) {
        const std::size_t equals = text.rfind('=');
        if (equals == std::string::npos || equals == 0)
          throw Error(Errc::invalid_argument, what + ": \"" + text + "\" is not " + unit + ", as \"" + example + "\"");
        return std::pair(text.substr(0, equals), parse(text.substr(equals + 1), what));
      };
}

double length(const std::string& text, const std::string& what) { return parse_number(text, what, kMeasurable); }

// A check of the values of wishes.
template <class Values>
auto each_in(Values values, Interval interval) {
  return [values, interval](const SiteOptions& options, const std::string& what) {
    for (const auto& [pattern, value] : values(options))
      check_number(static_cast<double>(value), what + " of \"" + pattern + "\"", interval);
  };
}

// A check of an optional number.
template <class Value>
auto if_given(Value value, Interval interval) {
  return [value, interval](const SiteOptions& options, const std::string& what) {
    if (const auto& number = value(options)) check_number(*number, what, interval);
  };
}

void add_scene(Rows& rows) {
  rows.group("Scene")
      .texts(
          "beside", "FILE", "Further files of the same site: IFC models, scans or floor plans, as the first one is",
          [](SiteOptions & o) -> auto& { return o.scene.beside; })
      .texts(
          "surveyed", "PATTERN", "Nodes to survey, by name; * is any text, ? any letter",
          [](SiteOptions & o) -> auto& { return o.scene.surveyed; })
      .texts(
          "blocking", "PATTERN", "Nodes that only block rays and stations",
          [](SiteOptions & o) -> auto& { return o.scene.blocking; })
      .texts(
          "search", "PATTERN", "Nodes where stations may stand",
          [](SiteOptions & o) -> auto& { return o.scene.search; })
      .texts(
          "ignore", "PATTERN", "Nodes to leave out", [](SiteOptions & o) -> auto& { return o.scene.ignore; })
      .texts(
          "glass", "PATTERN",
          "Nodes of glass, besides those whose material is: rays pass it, people do not; opaque: none is",
          [](SiteOptions & o) -> auto& { return o.scene.glass; })
      .texts(
          "mirror", "PATTERN",
          "Nodes that mirror rays, besides those whose material does: their points are ghosts; none: none does",
          [](SiteOptions & o) -> auto& { return o.scene.mirror; })
      .repeated(
          "weight", "PATTERN=W",
          "Weight of a voxel of these nodes in coverage, 1 to 255; others have 1; may be repeated",
          [](SiteOptions & o) -> auto& { return o.scene.weights; },
          wish("PATTERN=W", "facade*=5",
               [](const std::string& text, const std::string& what) {
                 return static_cast<std::uint32_t>(parse_count(text, what, 1, 255));
               }))
      .advanced()
      .checked(each_in([](const SiteOptions& o) -> auto& { return o.scene.weights; }, {.low = 1, .high = 255}))
      .repeated(
          "detail", "PATTERN=MM",
          "Widest beam footprint, in millimetres, of points that count on these nodes; may be repeated",
          [](SiteOptions & o) -> auto& { return o.scene.details_mm; }, wish("PATTERN=MM", "pipe*=10", length))
      .checked(each_in(
          [](const SiteOptions& o) -> auto& { return o.scene.details_mm; }, kMeasurable))
      .repeated(
          "accuracy", "PATTERN=MM",
          "Largest range noise, in millimetres, of points that count on these nodes; may be repeated",
          [](SiteOptions & o) -> auto& { return o.scene.accuracies_mm; }, wish("PATTERN=MM", "flange*=1", length))
      .checked(each_in(
          [](const SiteOptions& o) -> auto& { return o.scene.accuracies_mm; }, kMeasurable))
      .custom(
          "unit", "UNIT", "Unit of lengths in the file: m, cm, mm, in or ft; recognised by default",
          [](SiteOptions& o, const std::string& text, const std::string& what) {
            o.scene.unit = named(what, [&] { return unit_from_string(text); });
          },
          [](const SiteOptions& o) { return o.scene.unit.has_value(); })
      .custom(
          "up", "AXIS", "Axis of the file that points up: x, y or z; recognised by default",
          [](SiteOptions& o, const std::string& text, const std::string& what) {
            o.scene.up = named(what, [&] { return up_axis_from_string(text); });
          },
          [](const SiteOptions& o) { return o.scene.up.has_value(); })
      .texts(
          "wall-layer", "PATTERN", "Layers of a floor plan's walls; recognised by default",
          [](SiteOptions & o) -> auto& { return o.scene.wall_layers; })
      .custom(
          "wall-height", "M", "Height of a floor plan's walls; 2.7",
          [](SiteOptions& o, const std::string& text, const std::string& what) {
            o.scene.wall_height_m = parse_number(text, what, kMeasurable);
          },
          [](const SiteOptions& o) { return o.scene.wall_height_m.has_value(); })
      .checked(if_given(
          [](const SiteOptions& o) -> auto& { return o.scene.wall_height_m; }, kMeasurable))
      .custom(
          "scene-index", "N", "Scene of the file; its own default otherwise",
          [](SiteOptions& o, const std::string& text, const std::string& what) {
            o.scene.scene_index = parse_count(text, what, 0, 0xFFFFFFFF);
          },
          [](const SiteOptions& o) { return o.scene.scene_index.has_value(); })
      .advanced()
      .number_in(
          "diffuse", "R", "Diffuse reflection coefficient if the file gives none, 0 to 1",
          [](SiteOptions & o) -> auto& { return o.scene.default_diffuse; }, kAnyShare)
      .advanced()
      .custom(
          "shared-meshes", "WHEN",
          "Store a mesh that several nodes place once: auto, in scenes of more than 8 million triangles; always; never",
          [](SiteOptions& o, const std::string& text, const std::string& what) {
            o.scene.shared_meshes = named(what, [&] { return shared_meshes_from_string(text); });
          })
      .advanced()
      .custom("allow-outside", "", "Let the scene name buffers and images outside its own folder",
              [](SiteOptions& o, const std::string& text, const std::string& what) {
                o.scene.allow_outside = parse_flag(text, what);
              })
      .advanced();
}

void check_battery(const std::array<double, 2>& battery, const std::string& what) {
  for (const double lasts : battery)
    if (lasts != 0) check_number(lasts, what, {.low = 1, .high = 1e6});
}

void add_scanner(Rows& rows) {
  rows.group("Scanner")
      .text("scanner", "PRESET", "A scanner that `vantage info` lists, such as rtc360 or rtc360@6mm",
            &SiteOptions::scanner)
      .by_scene()
      .optional("step", "DEG[,DEG]", "Angle between rays: one for both, or azimuth and zenith", &SiteOptions::steps,
                [](const std::string& text, const std::string& what) {
                  const auto values = parse_numbers(text, what, 1, 2, kMeasurable);
                  return std::array{Angle::degrees(values.front()), Angle::degrees(values.back())};
                })
      .checked([](const SiteOptions& o, const std::string& what) {
        if (o.steps)
          for (const Angle step : *o.steps) check_number(whole_degrees(step), what, kMeasurable);
      })
      .by_scene()
      .by_preset()
      .degrees("heading", "Azimuth of the middle of the horizontal sweep, from +X towards +Y", &SiteOptions::heading,
               kAnyNumber)
      .by_scene()
      .degrees("horizontal", "Horizontal wide angle", &SiteOptions::horizontal_angle, {.low = 1e-6, .high = 360})
      .by_scene()
      .by_preset()
      .degrees("vertical", "Vertical wide angle, over both sides of the head: 300 is zenith 0 to 150",
               &SiteOptions::vertical_angle, {.low = 1e-6, .high = 360})
      .by_scene()
      .by_preset()
      .degrees("zenith-start", "Zenith of the first ray; above 0 for scanners that cannot look straight up",
               &SiteOptions::zenith_start, {.low = 0, .high = 180, .high_included = false})
      .advanced()
      .by_scene()
      .by_preset()
      .number("height", "M", "Height of the scanner's head above the ground", &SiteOptions::height_m, kNotNegative)
      .by_scene()
      .numbers("range", "MIN,MAX", "Nearest and farthest distance measured, in metres", &SiteOptions::range_m, 2,
               kNotNegative)
      .by_scene()
      .by_preset()
      .text("noise", "TABLE", "Range noise: off, a scanner's name (rtc360), or a CSV file", &SiteOptions::noise)
      .by_scene()
      .by_preset()
      .numbers("beam", "MRAD,MM",
               "Full angle of the beam's divergence, in milliradians, and its diameter at the exit, in millimetres",
               &SiteOptions::beam, 2, kNotNegative)
      .advanced()
      .by_scene()
      .by_preset()
      .numbers("calibration", "ARCSEC,MM,PPM",
               "Errors that a calibration leaves, which all scans share: of angles in arc seconds, and of the offset "
               "and the scale of ranges, one standard deviation each",
               &SiteOptions::calibration, 3, kNotNegative)
      .advanced()
      .by_scene()
      .by_preset()
      .optional("detection", "M,R",
                "Longest distance, in metres, from which the scanner detects a surface of reflectivity R, 0 to 1; off: "
                "every echo",
                &SiteOptions::detection,
                [](const std::string& text, const std::string& what) {
                  if (text == "off") return std::array{0.0, 1.0};
                  const auto values = parse_numbers(text, what, 2, 2, kPositive);
                  if (values[1] > 1)
                    throw Error(Errc::invalid_argument, what + ": a reflectivity is at most 1, and " + text +
                                                            " ends with " + std::to_string(values[1]));
                  return std::array{values[0], values[1]};
                })
      .advanced()
      .checked([](const SiteOptions& o, const std::string& what) {
        if (!o.detection) return;
        check_number((*o.detection)[0], what, kNotNegative);
        check_number((*o.detection)[1], what, kAnyShare);
      })
      .by_scene()
      .by_preset()
      .number("dropout", "P", "Share of the rays, 0 to below 1, whose echo is lost at random; that of the preset, or 0",
              &SiteOptions::dropout, kShareBelow1)
      .advanced()
      .by_scene()
      .by_preset()
      .number("rate", "N", "Points measured per second, for the time on site; that of the preset, or a million",
              &SiteOptions::points_per_second, kMeasurable)
      .advanced()
      .by_preset()
      .optional("battery", "MIN[,SCANS]",
                "How long a charged battery lasts: minutes with the scanner on, and scans; 0: not stated. That of the "
                "preset otherwise",
                &SiteOptions::battery,
                [](const std::string& text, const std::string& what) {
                  const auto values = parse_numbers(text, what, 1, 2, kNotNegative);
                  const std::array battery{values.front(), values.size() > 1 ? values.back() : 0};
                  check_battery(battery, what);
                  return battery;
                })
      .checked([](const SiteOptions& o, const std::string& what) {
        if (o.battery) check_battery(*o.battery, what);
      })
      .advanced()
      .by_preset();
}

void add_measure(Rows& rows) {
  rows.group("Measure")
      .number("user-size", "M", "Upper bound of the voxel size", &SiteOptions::user_size_m, kMeasurable)
      .advanced()
      .by_scene()
      .degrees("incidence",
               "Largest angle between ray and normal of points that count, 90: any; 60 if a detail or an accuracy "
               "is set, else 90",
               &SiteOptions::max_incidence, {.low = 1e-6, .high = 90})
      .number("spacing", "M", "Wanted distance between points; sets the goal density", &SiteOptions::spacing_m,
              kMeasurable)
      .by_scene()
      .optional("for", "1:N|LOA20..LOA50",
                "What the scans are for, which sets the spacing: a drawing at this scale (1:50: 5 mm), or an accuracy "
                "class (LOA30: 15 mm); 20 mm otherwise",
                &SiteOptions::deliverable,
                [](const std::string& text, const std::string& what) {
                  named(what, [&] { return spacing_for(text); });
                  return text;
                })
      .flag("spacing-by-detail",
            "Use the detail of nodes as their spacing; the default if details differ and no spacing is given",
            &SiteOptions::spacing_by_detail)
      .advanced();
}

void add_placement(Rows& rows) {
  rows.group("Placement")
      .numbers("security", "H1,H2,R",
               "Clear space of a station: two spheres of radius R at heights H1 and H2 above the ground; R 0: none",
               &SiteOptions::security_m, 3, kNotNegative)
      .by_scene()
      .degrees("slope", "Steepest walkable ground, if the scene marks no search area", &SiteOptions::max_slope,
               {.low = 0, .high = 90, .high_included = false})
      .by_scene()
      .number("headroom", "M", "Clear height above walkable ground", &SiteOptions::headroom_m, kNotNegative)
      .by_scene()
      .number("min-area", "M2", "Smallest connected piece of walkable ground", &SiteOptions::min_area_m2, kNotNegative)
      .advanced()
      .by_scene()
      .numbers("passage", "W,H", "Width and height of the narrowest opening that a person passes; 0.6,1.9",
               &SiteOptions::passage_m, 2, kMeasurable)
      .number("climb", "M", "Highest step that a person takes; 0.25", &SiteOptions::climb_m, kNotNegative)
      .repeated(
          "enter", "X,Y,Z", "Entrance of the site; found automatically by default; may be repeated",
          [](SiteOptions & o) -> auto& { return o.enter; },
          [](const std::string& text, const std::string& what) {
            const auto values = parse_numbers(text, what, 3, 3);
            return Vec3{values[0], values[1], values[2]};
          })
      .checked([](const SiteOptions& o, const std::string& what) {
        for (const Vec3& place : o.enter)
          for (const double value : {place.x, place.y, place.z}) check_number(value, what);
      })
      .texts(
          "doors", "PATTERN",
          "Nodes that are closed doors: open for people, closed for rays; closed: keep all doors closed",
          [](SiteOptions & o) -> auto& { return o.scene.doors; })
      .texts(
          "station-area", "PATTERN", "Nodes to stand on that keep their role, such as surveyed",
          [](SiteOptions & o) -> auto& { return o.scene.station_area; })
      .advanced()
      .numbers("levels", "LOW,HIGH", "Heights of ground between which stations may stand", &SiteOptions::levels_m, 2,
               kAnyNumber)
      .repeated(
          "within", "FILE", "Polygon that all stations stand in: GeoJSON, or a CSV file with x,y on each line",
          [](SiteOptions & o) -> auto& { return o.within; },
          [](const std::string& text, const std::string& what) {
            return named(what, [&] { return read_region(text); });
          })
      .repeated(
          "without", "FILE", "Polygon that no station stands in", [](SiteOptions & o) -> auto& { return o.without; },
          [](const std::string& text, const std::string& what) {
            return named(what, [&] { return read_region(text); });
          });
}

void add_run(Rows& rows) {
  rows.group("Run")
      .custom("engine", "ENGINE", "Tracing engine: auto, ray_query, compute_bvh or embree",
              [](SiteOptions& o, const std::string& text, const std::string& what) {
                o.engine = named(what, [&] { return engine_from_string(text); });
              })
      .custom("device", "LIST",
              "Number of the device in the list of `vantage info`; several share the work: 0,1, or all, or 0,cpu",
              [](SiteOptions& o, const std::string& text, const std::string& what) {
                o.devices = parse_devices(text, what);
              })
      .count("seed", "N", "Seed of noise, samples and search; 1 otherwise", &SiteOptions::seed, 0,
             std::numeric_limits<std::uint64_t>::max())
      .custom("memory", "SIZE",
              "Memory limit: 4G, 500M; tasks with a larger estimate are refused; half of the free memory by default",
              [](SiteOptions& o, const std::string& text, const std::string& what) {
                o.memory_bytes = parse_bytes(text, what);
              })
      .flag("validation", "Check every Vulkan call with the validation layer", &SiteOptions::validation)
      .advanced()
      .custom(
          "crs", "EPSG:N|FILE",
          "Coordinate system of the scene: EPSG:25832 or the like, or a .prj or .wkt file; point clouds carry it",
          [](SiteOptions& o, const std::string& text, const std::string&) { o.crs = text; },
          [](const SiteOptions& o) { return !o.crs.empty(); })
      .by_scene();
}

}  // namespace

const SettingTable<SiteOptions>& site_settings() {
  static const SettingTable<SiteOptions> table = [] {
    Rows rows;
    add_scene(rows);
    add_scanner(rows);
    add_measure(rows);
    add_placement(rows);
    add_run(rows);
    return rows.take();
  }();
  return table;
}

}  // namespace vantage
