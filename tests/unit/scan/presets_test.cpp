// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "scan/noise_model.hpp"
#include "support/temporary_folder.hpp"
#include "vantage/error.hpp"
#include "vantage/scanner.hpp"

namespace vantage {
namespace {

const std::filesystem::path presets = VANTAGE_TEST_PRESETS;

TEST(Presets, HoldTheScannersOfTheTrade) {
  std::vector<std::string> keys;
  for (const ScannerPreset& preset : list_scanners(presets)) {
    keys.push_back(preset.key);
    EXPECT_NE(preset.summary.find("settings"), std::string::npos);
    if (preset.key == "vz-400i") {
      EXPECT_EQ(preset.summary,
                "RIEGL VZ-400i: 360° around, zenith 30° to 130°, 1.5 to 800 m, one figure of noise, of 100 m, for all "
                "distances and reflectivities; settings 20mdeg, 40mdeg, 40mdeg-1200khz (default 40mdeg)");
    }
    const auto tells = [&](const char* text) { return preset.summary.find(text) != std::string::npos; };
    EXPECT_EQ(tells("no noise table: exact ranges"), preset.key == "zf5016") << preset.summary;
    const std::set<std::string> by_one_figure{"x7", "vz-400i", "mid-360", "os1", "vlp-16", "xt32"};
    EXPECT_EQ(tells("one figure of noise"), by_one_figure.contains(preset.key)) << preset.summary;
    EXPECT_EQ(tells("128 rows, zenith 67.5° to 112.5°"), preset.key == "os1") << preset.summary;
    EXPECT_EQ(tells("600000 directions, zenith 38° to 97°"), preset.key == "mid-360") << preset.summary;
    EXPECT_EQ(tells("noise of 5 distances and 3 reflectivities"), preset.key == "rtc360") << preset.summary;
    EXPECT_NO_THROW(load_scanner(preset.key, presets).check());
  }
  EXPECT_EQ(keys, (std::vector<std::string>{"focus-x330", "measured-p-class", "mid-360", "os1", "rtc360", "vlp-16",
                                            "vz-400i", "x7", "xt32", "zf5016"}));
}

// The table of the field check is its fit, and near what was measured: white at 5, 11 and 20 m, black at 5 and 20 m.
TEST(Presets, MeasuredPClassIsItsFieldCheck) {
  const NoiseTable noise = load_scanner("measured-p-class", presets).noise;
  for (std::size_t row = 0; row < noise.reflectivities.size(); ++row)
    for (std::size_t column = 0; column < noise.distances_m.size(); ++column) {
      const double square = 0.52 * 0.52 + 0.66 * 0.66 * std::pow(noise.distances_m[column] / 10, 0.86) *
                                              std::pow(noise.reflectivities[row] / 0.9, -1.18);
      EXPECT_NEAR(noise.sigma_m[row * noise.distances_m.size() + column], 1e-3 * std::sqrt(square), 5.1e-6);
    }
  const auto sigma_mm = [&](double distance, double reflectivity) {
    return 1e3 * table_sigma(noise, distance, reflectivity);
  };
  EXPECT_NEAR(sigma_mm(5, 0.9), 0.74, 0.05);
  EXPECT_NEAR(sigma_mm(11, 0.9), 0.79, 0.09);
  EXPECT_NEAR(sigma_mm(20, 0.9), 1.02, 0.05);
  EXPECT_NEAR(sigma_mm(5, 0.05), 2.7, 0.2);
  EXPECT_NEAR(sigma_mm(20, 0.04), 5.6, 0.3);
}

TEST(Presets, ASettingMayMultiplyTheNoise) {
  const Scanner usual = load_scanner("measured-p-class@6.3mm", presets),
                half = load_scanner("measured-p-class@3.1mm", presets);
  ASSERT_EQ(half.noise.sigma_m.size(), usual.noise.sigma_m.size());
  for (std::size_t k = 0; k < usual.noise.sigma_m.size(); ++k)
    EXPECT_DOUBLE_EQ(half.noise.sigma_m[k], 1.34 * usual.noise.sigma_m[k]);
  EXPECT_EQ(load_noise("measured-p-class@3.1mm").sigma_m, half.noise.sigma_m);
}

TEST(Presets, Rtc360) {
  const Scanner scanner = load_scanner("rtc360@6mm", presets);
  EXPECT_EQ(scanner.name, "Leica RTC360 @6mm");
  EXPECT_DOUBLE_EQ(scanner.azimuth_step.in_radians(), 0.0006);
  EXPECT_EQ(scanner.azimuth_step, scanner.zenith_step);
  EXPECT_EQ(scanner.columns(), 10471u);  // 2π / 0.0006
  EXPECT_EQ(scanner.rows(), 4363u);
  EXPECT_EQ(scanner.max_range_m, 130.0);
  EXPECT_EQ(scanner.min_range_m, 0.5);
  const NoiseTable paper = rtc360_noise();
  EXPECT_EQ(scanner.noise.distances_m, paper.distances_m);
  EXPECT_EQ(scanner.noise.reflectivities, paper.reflectivities);
  ASSERT_EQ(scanner.noise.sigma_m.size(), paper.sigma_m.size());
  for (std::size_t k = 0; k < paper.sigma_m.size(); ++k) EXPECT_DOUBLE_EQ(scanner.noise.sigma_m[k], paper.sigma_m[k]);
  EXPECT_DOUBLE_EQ(scanner.beam_divergence.in_radians(), 0.0005);
  EXPECT_DOUBLE_EQ(scanner.exit_diameter_m, 0.006);
  EXPECT_EQ(load_scanner("RTC360", presets).name, scanner.name);
  EXPECT_DOUBLE_EQ(load_scanner("Rtc360@3MM", presets).zenith_step.in_radians(), 0.0003);
}

TEST(Presets, ScannersThatDoNotLookUp) {
  const Scanner scanner = load_scanner("vz-400i", presets);
  EXPECT_DOUBLE_EQ(scanner.zenith_start.in_degrees(), 30.0);
  EXPECT_EQ(scanner.rows(), 2500u);
  EXPECT_EQ(scanner.columns(), 9000u);
  EXPECT_EQ(scanner.max_range_m, 800.0);
  EXPECT_EQ(load_scanner("vz-400i@40mdeg-1200khz", presets).max_range_m, 250.0);  // a setting's own range
  EXPECT_EQ(load_scanner("vz-400i@40mdeg-1200khz", presets).min_range_m, 0.5);
}

TEST(Presets, PixelsPerTurn) {
  EXPECT_EQ(load_scanner("focus-x330@1/1", presets).columns(), 40960u);
  EXPECT_EQ(load_scanner("zf5016@high", presets).columns(), 10000u);
}

// Rows are those of their makers' tables, of 360° around.
TEST(Presets, SpinningScannersHaveUnevenRows) {
  const struct {
    const char* key;
    std::uint32_t rows, columns;
    double top, bottom;  // elevations
  } cases[] = {{"vlp-16", 16, 1808, 15, -15},     {"vlp-16@5hz", 16, 3616, 15, -15}, {"vlp-16@20hz", 16, 904, 15, -15},
               {"xt32", 32, 2000, 15, -16},       {"xt32@5hz", 32, 4000, 15, -16},   {"os1", 128, 2048, 22.5, -22.5},
               {"os1@512", 128, 512, 22.5, -22.5}};
  for (const auto& c : cases) {
    SCOPED_TRACE(c.key);
    const Scanner scanner = load_scanner(c.key, presets);
    EXPECT_EQ(scanner.rows(), c.rows);
    EXPECT_EQ(scanner.columns(), c.columns);
    ASSERT_EQ(scanner.row_zeniths.size(), c.rows);
    EXPECT_NEAR(90 - scanner.row_zeniths.front().in_degrees(), c.top, 1e-9);
    EXPECT_NEAR(90 - scanner.row_zeniths.back().in_degrees(), c.bottom, 1e-9);
    EXPECT_NEAR(scanner.zenith_start.in_degrees(), 90 - c.top, 1e-9);
    EXPECT_NEAR(scanner.vertical_angle.in_degrees() / 2, c.top - c.bottom, 1e-9);
    EXPECT_DOUBLE_EQ(scanner.horizontal_angle.in_degrees(), 360);
  }
  const Scanner puck = load_scanner("vlp-16", presets);
  for (std::size_t k = 0; k < 16; ++k)
    EXPECT_NEAR(puck.row_zeniths[k].in_degrees(), 75 + 2.0 * static_cast<double>(k), 1e-9);
}

TEST(Presets, ASweepIsAListOfDirectionsWithTimes) {
  for (const double seconds : {1.0, 3.0}) {
    const Scanner scanner = load_scanner(seconds == 1 ? "mid-360@1s" : "mid-360", presets);
    const auto rays = static_cast<std::uint64_t>(2e5 * seconds);
    ASSERT_EQ(scanner.rays(), rays);
    EXPECT_EQ(scanner.columns(), 1u);
    EXPECT_NEAR(scanner.seconds(), seconds, 1e-5);
    EXPECT_DOUBLE_EQ(scanner.time_s(1000), 0.005);
    double least = 90, most = -90, even = 0;
    for (std::uint64_t ray = 0; ray < rays; ++ray) {
      const double elevation = 90 - scanner.angles(ray).zenith.in_degrees();
      least = std::min(least, elevation), most = std::max(most, elevation);
      even += elevation < 22.5 ? 1 : 0;
    }
    EXPECT_NEAR(least, -7, 0.05);
    EXPECT_NEAR(most, 52, 0.05);
    EXPECT_NEAR(even / static_cast<double>(rays), 0.5, 0.01);
    EXPECT_NEAR(scanner.horizontal_angle.in_degrees(), 360, 0.1);
  }
}

TEST(Presets, DirectionsMayBeInAFileBesideTheScanners) {
  std::ifstream in(presets);
  auto document = nlohmann::json::parse(in);
  auto mine = document["scanners"]["mid-360"];
  mine["settings"] = {{"file", {{"directions_csv", "rosette.csv"}, {"source", "assumed"}}}};
  mine["default_setting"] = "file";
  document["scanners"] = {{"mine", mine}};
  const test::TemporaryFolder folder;
  std::ofstream(folder / "scanners.json") << document;
  const auto load = [&](const std::string& table) {
    std::ofstream(folder / "rosette.csv") << table;
    return load_scanner("mine", folder / "scanners.json");
  };
  const Scanner scanner = load("# mine\r\nazimuth_deg, elevation_deg,time_s\r\n10,-5,0\n\n-30.5,45,0.25\n");
  ASSERT_EQ(scanner.rays(), 2u);
  EXPECT_DOUBLE_EQ(scanner.angles(1).zenith.in_degrees(), 45);
  EXPECT_DOUBLE_EQ(scanner.angles(1).azimuth.in_degrees(), -30.5);
  EXPECT_EQ(scanner.seconds(), 0.25);
  EXPECT_EQ(load("azimuth_deg,elevation_deg\n350,90\n").seconds(), 1 / 200'000.0);
  const std::pair<const char*, const char*> broken[] = {
      {"azimuth,elevation\n1,2\n", "line 1: the header must be azimuth_deg,elevation_deg"},
      {"azimuth_deg,elevation_deg\n", "holds no direction"},
      {"azimuth_deg,elevation_deg\n1,2\n3\n", "line 3: must have 2 cells"},
      {"azimuth_deg,elevation_deg\n1,nan\n", "line 2"},
      {"azimuth_deg,elevation_deg\n1,91\n", "line 2"},
      {"azimuth_deg,elevation_deg\n-361,1\n", "line 2"},
      {"azimuth_deg,elevation_deg,time_s\n1,2,3\n1,2,2\n", "line 3: times must not fall"}};
  for (const auto& [table, says] : broken) {
    try {
      load(table);
      ADD_FAILURE() << "passed, but should say: " << says;
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find(says), std::string::npos) << e.what();
    }
  }
}

// The beam of every preset is known, or marked as assumed.
TEST(Presets, HaveABeam) {
  for (const ScannerPreset& preset : list_scanners(presets)) {
    const Scanner scanner = load_scanner(preset.key, presets);
    EXPECT_GT(scanner.beam_divergence.in_radians(), 1e-4) << preset.key;
    const bool grid = scanner.row_zeniths.empty() && scanner.directions.empty();
    EXPECT_LT(scanner.beam_divergence.in_radians(), grid ? 1e-3 : 6e-3) << preset.key;
    EXPECT_GT(scanner.exit_diameter_m, 0.002) << preset.key;
    EXPECT_LE(scanner.exit_diameter_m, 0.01) << preset.key;
  }
}

// Each preset's detection is known, or marked as assumed. A range that the maker states for a reflectivity is reached
// on it, and on no darker surface.
TEST(Presets, HaveARangeOfDetection) {
  for (const ScannerPreset& preset : list_scanners(presets)) {
    const Scanner scanner = load_scanner(preset.key, presets);
    EXPECT_GE(scanner.detection_range_m / std::sqrt(scanner.detection_reflectivity), scanner.max_range_m) << preset.key;
  }
  for (const char* key : {"focus-x330", "vz-400i", "vz-400i@40mdeg-1200khz"}) {
    const Scanner scanner = load_scanner(key, presets);
    EXPECT_EQ(scanner.detection_range_m, scanner.max_range_m) << key;
    EXPECT_EQ(scanner.detection_reflectivity, 0.9) << key;
  }
}

TEST(Presets, NamesThatAreNotThereListWhatIs) {
  const auto message = [](const std::string& name) {
    try {
      load_scanner(name, presets);
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), Errc::invalid_argument);
      return std::string(e.what());
    }
    return std::string("no error");
  };
  EXPECT_NE(message("rtc3600").find("rtc360, vlp-16, vz-400i"), std::string::npos);
  EXPECT_NE(message("rtc360@7mm").find("12mm, 3mm, 6mm"), std::string::npos);
  EXPECT_NE(message("rtc360@").find("must follow the @"), std::string::npos);
}

TEST(Presets, EveryFigureHasASource) {
  std::ifstream in(presets);
  const auto document = nlohmann::json::parse(in);
  const auto sourced = [](const nlohmann::json& scanner, const nlohmann::json& figure) {
    return figure.at("source") == "assumed" || scanner["sources"].contains(figure.at("source"));
  };
  for (const auto& [key, scanner] : document["scanners"].items()) {
    for (const auto& [name, figure] : scanner.items()) {
      if (name == "name" || name == "sources" || name == "default_setting") continue;
      if (name == "settings") {
        for (const auto& [setting, entry] : figure.items()) EXPECT_TRUE(sourced(scanner, entry)) << key << setting;
      } else {
        EXPECT_TRUE(sourced(scanner, figure)) << key << name;
      }
    }
  }
}

TEST(Presets, TellHowLongABatteryLastsIfTheFileStatesIt) {
  std::ifstream in(presets);
  auto document = nlohmann::json::parse(in);
  auto& mine = document["scanners"]["mine"] = document["scanners"]["rtc360"];
  mine.erase("battery");
  const test::TemporaryFolder folder;
  const auto load = [&] {
    std::ofstream(folder / "scanners.json") << document;
    return load_scanner("mine", folder / "scanners.json");
  };
  EXPECT_EQ(load().battery_min, 0);
  EXPECT_EQ(load().battery_scans, 0);
  mine["battery"] = {{"minutes", 90}, {"source", "assumed"}, {"note", "an old one"}};
  EXPECT_EQ(load().battery_min, 90);
  EXPECT_EQ(load().battery_scans, 0);
  mine["battery"]["scans"] = 40;
  EXPECT_EQ(load().battery_min, 90);
  EXPECT_EQ(load().battery_scans, 40);
  EXPECT_EQ(load().dropout, 0);
  mine["dropout"] = {{"value", 0.03}, {"source", "assumed"}};
  EXPECT_EQ(load().dropout, 0.03);
}

TEST(Presets, BrokenFilesSayWhere) {
  std::ifstream in(presets);
  const auto good = nlohmann::json::parse(in);
  const test::TemporaryFolder folder;
  const auto file = folder / "scanners.json";
  const auto give_rows = [](nlohmann::json& d, const nlohmann::json& elevations) {
    d["scanners"]["rtc360"].erase("vertical_angle_deg");
    d["scanners"]["rtc360"]["elevations_deg"] = {{"value", elevations}, {"source", "assumed"}};
  };
  const struct {
    const char* says;
    std::function<void(nlohmann::json&)> spoil;
  } cases[] = {
      {"\"format\" must be", [](auto& d) { d.erase("format"); }},
      {"at least one scanner", [](auto& d) { d["scanners"] = nlohmann::json::object(); }},
      {"rtc360: \"hight\" is not known", [](auto& d) { d["scanners"]["rtc360"]["hight"] = 3; }},
      {"rtc360: \"max_range_m\" is missing", [](auto& d) { d["scanners"]["rtc360"].erase("max_range_m"); }},
      {"max_range_m: \"source\" is missing", [](auto& d) { d["scanners"]["rtc360"]["max_range_m"].erase("source"); }},
      {"source: \"hearsay\" is not among", [](auto& d) { d["scanners"]["rtc360"]["noise"]["source"] = "hearsay"; }},
      {"value: must be a number", [](auto& d) { d["scanners"]["rtc360"]["max_range_m"]["value"] = "far"; }},
      {"row 2 must have a value", [](auto& d) { d["scanners"]["rtc360"]["noise"]["sigma_mm"][1].erase(0); }},
      {"must have a row", [](auto& d) { d["scanners"]["rtc360"]["noise"]["sigma_mm"].erase(0); }},
      {"6mm: needs one of", [](auto& d) { d["scanners"]["rtc360"]["settings"]["6mm"].erase("spacing_mm"); }},
      {"noise_factor: \"source\" is missing",
       [](auto& d) { d["scanners"]["rtc360"]["settings"]["6mm"]["noise_factor"]["value"] = 2; }},
      {"noise_factor / value: must be above 0",
       [](auto& d) {
         d["scanners"]["rtc360"]["settings"]["6mm"]["noise_factor"] = {{"value", 0}, {"source", "assumed"}};
       }},
      {"battery: needs minutes or scans",
       [](auto& d) {
         d["scanners"]["rtc360"]["battery"] = {{"source", "assumed"}};
       }},
      {"battery: \"source\" is missing",
       [](auto& d) {
         d["scanners"]["rtc360"]["battery"] = {{"minutes", 90}};
       }},
      {"battery_min is 0.5, but must be 0",
       [](auto& d) {
         d["scanners"]["rtc360"]["battery"] = {{"minutes", 0.5}, {"source", "assumed"}};
       }},
      {"leave out \"vertical_angle_deg\"",
       [](auto& d) {
         d["scanners"]["rtc360"]["elevations_deg"] = {{"value", {1, 2}}, {"source", "assumed"}};
       }},
      {"must all rise or all fall",
       [&](auto& d) {
         give_rows(d, {1, 3, 2});
       }},
      {"must all rise or all fall",
       [&](auto& d) {
         give_rows(d, {3, 3});
       }},
      {"must be from -90 to 90",
       [&](auto& d) {
         give_rows(d, {3, 95});
       }},
      {"must have an elevation for each row", [&](auto& d) { give_rows(d, nlohmann::json::array()); }},
      {"must be an array of numbers", [&](auto& d) { give_rows(d, {"high"}); }},
      {"directions tell the field",
       [](auto& d) {
         d["scanners"]["rtc360"]["settings"]["6mm"] = {{"directions_csv", "any.csv"}, {"source", "sheet"}};
       }},
      {"vertical_angle in degrees is 720",
       [](auto& d) { d["scanners"]["rtc360"]["vertical_angle_deg"]["value"] = 720; }},
  };
  for (const auto& c : cases) {
    auto document = good;
    c.spoil(document);
    std::ofstream(file) << document;
    try {
      load_scanner("rtc360@6mm", file);
      ADD_FAILURE() << "passed, but should say: " << c.says;
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), Errc::malformed_file) << e.what();
      EXPECT_NE(std::string(e.what()).find(c.says), std::string::npos) << e.what();
    }
  }
  std::ofstream(file) << "{ \"format\": ";
  EXPECT_THROW(list_scanners(file), Error);
  EXPECT_THROW(list_scanners(folder / "none.json"), Error);
}

// The built-in presets are the file in data/, and a user's file adds to them.
TEST(Presets, AFileAddsToWhatIsBuiltIn) {
  std::ifstream in(presets);
  auto document = nlohmann::json::parse(in);
  const test::TemporaryFolder folder;
  const std::size_t built_in = list_scanners().size();
  EXPECT_EQ(built_in, document["scanners"].size());
  document["scanners"] = {{"mine", document["scanners"]["rtc360"]}, {"x7", document["scanners"]["x7"]}};
  document["scanners"]["mine"]["max_range_m"]["value"] = 42;
  document["scanners"]["x7"]["max_range_m"]["value"] = 43;
  std::ofstream(folder / "scanners.json") << document;
  const auto file = folder / "scanners.json";
  EXPECT_EQ(load_scanner("mine", file).max_range_m, 42);
  EXPECT_EQ(load_scanner("x7", file).max_range_m, 43);  // takes precedence over the built-in one
  EXPECT_EQ(load_scanner("rtc360", file).max_range_m, load_scanner("rtc360").max_range_m);
  EXPECT_NE(load_scanner("x7").max_range_m, 43);
  EXPECT_EQ(list_scanners(file).size(), built_in + 1);
}

TEST(Presets, OwnFileFollowsTheEnvironment) {
  setenv("VANTAGE_DATA", "/some/where", 1);
  EXPECT_EQ(own_presets_file(), "/some/where/scanners.json");
  unsetenv("VANTAGE_DATA");
  EXPECT_TRUE(own_presets_file().empty());
}

}  // namespace
}  // namespace vantage
