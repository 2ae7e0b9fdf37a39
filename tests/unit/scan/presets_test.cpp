// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
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
    EXPECT_EQ(tells("one figure of noise"), preset.key == "x7" || preset.key == "vz-400i") << preset.summary;
    EXPECT_EQ(tells("noise of 5 distances and 3 reflectivities"), preset.key == "rtc360") << preset.summary;
    EXPECT_NO_THROW(load_scanner(preset.key, presets).check());
  }
  EXPECT_EQ(keys, (std::vector<std::string>{"focus-x330", "measured-p-class", "rtc360", "vz-400i", "x7", "zf5016"}));
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

// The beam of every preset is known, or marked as assumed.
TEST(Presets, HaveABeam) {
  for (const ScannerPreset& preset : list_scanners(presets)) {
    const Scanner scanner = load_scanner(preset.key, presets);
    EXPECT_GT(scanner.beam_divergence.in_radians(), 1e-4) << preset.key;
    EXPECT_LT(scanner.beam_divergence.in_radians(), 1e-3) << preset.key;
    EXPECT_GT(scanner.exit_diameter_m, 0.002) << preset.key;
    EXPECT_LT(scanner.exit_diameter_m, 0.01) << preset.key;
  }
}

// What every preset detects is known, or marked as assumed. A range that the maker states for a reflectivity is reached
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
  EXPECT_NE(message("rtc3600").find("rtc360, vz-400i"), std::string::npos);
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

TEST(Presets, BrokenFilesSayWhere) {
  std::ifstream in(presets);
  const auto good = nlohmann::json::parse(in);
  const test::TemporaryFolder folder;
  const auto file = folder / "scanners.json";
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
