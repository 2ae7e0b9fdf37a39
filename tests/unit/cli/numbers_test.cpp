// SPDX-License-Identifier: Apache-2.0
// Numbers as nobody should write them, in every option of every command and in every file that is read: each is one
// clear error, or a run with finite results. Options are taken from the program itself, so a new one is tried too.
//
// VANTAGE_NUMBERS=all runs every command with every number that it takes, not only one for each option.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <set>
#include <thread>

#include "cli/command.hpp"
#include "cli/options.hpp"
#include "cli/stations.hpp"
#include "placement/area_limits.hpp"
#include "program.hpp"
#include "vantage/export.hpp"
#include "vantage/scene_builder.hpp"
#include "vantage/simulator.hpp"

namespace vantage::test {
namespace {

const std::vector<std::string> kNumbers{"nan",
                                        "-nan",
                                        "NaN(7)",
                                        "inf",
                                        "-inf",
                                        "infinity",
                                        "1e308",
                                        "-1e308",
                                        "1e309",
                                        "1e30",
                                        "-1e30",
                                        "1e-310",
                                        "-5e-324",
                                        "5e-324",
                                        "1e-400",
                                        "0",
                                        "-0",
                                        "-0.0",
                                        "0x10",
                                        "0x1p4",
                                        "1,5",
                                        "1.234,5",
                                        "1,234.5",
                                        "1'000",
                                        "1 000",
                                        "1_000",
                                        "1\u00a0000",
                                        "9007199254740993",
                                        "2147483648",
                                        "4294967296",
                                        "9223372036854775808",
                                        "18446744073709551615",
                                        "18446744073709551616",
                                        "-1",
                                        "1e",
                                        ".",
                                        "+",
                                        "--",
                                        "\u0663",
                                        ""};

// The program's commands, nothing read yet.
struct Commands {
  Commands() { cli::add_commands(app, program); }
  static cli::Console& console() {
    static cli::Console one;
    return one;
  }
  CLI::App app{"vantage", "vantage"};
  cli::Program program{.console = console(), .stop = {}, .abort = {}};
};

std::string name_of(const CLI::Option& option) {
  return option.get_lnames().empty() ? option.get_name() : option.get_lnames().front();
}

// command -> its options that take a value
std::map<std::string, std::vector<std::string>> all_options() {
  std::map<std::string, std::vector<std::string>> all;
  Commands commands;
  for (const CLI::App* command : commands.app.get_subcommands([](const CLI::App*) { return true; }))
    for (const CLI::Option* option : command->get_options())
      if (option->get_items_expected_max() > 0 && !option->get_lnames().empty() && name_of(*option) != "help")
        all[command->get_name()].push_back(name_of(*option));
  return all;
}

// The message where it is refused as it is read. Commands forget what they read before.
std::optional<std::string> refused(Commands& commands, const std::string& command, const std::string& option,
                                   const std::string& value) {
  std::vector<std::string> words{"--" + option + "=" + value, command};  // last first, for CLI11
  try {
    commands.app.parse(words);
  } catch (const CLI::Error& error) {
    return error.what();
  } catch (const Error& error) {
    EXPECT_TRUE(error.code() == Errc::invalid_argument || error.code() == Errc::io) << error.what();
    return error.what();
  }
  return std::nullopt;
}

// Options that name a file or a view: their messages say what was not found.
bool names_something(const std::string& option) { return option == "panorama" || option == "views"; }

// Values that every numeric option refuses.
bool wants_numbers(Commands& commands, const std::string& command, const std::string& option) {
  return refused(commands, command, option, "frobnicate").has_value();
}

TEST(Numbers, EveryOptionReadsOrRefusesThemAsTheyAre) {
  const std::set<std::string> never{"nan",   "-nan",  "NaN(7)", "inf",        "-inf",   "infinity",
                                    "1e309", "0x10",  "0x1p4",  "1e",         ".",      "+",
                                    "--",    "1'000", "1_000",  "1\u00a0000", "\u0663", ""};
  std::size_t tried = 0, numeric = 0;
  for (const auto& [command, options] : all_options())
    for (const std::string& option : options) {
      Commands commands;
      const bool number = wants_numbers(commands, command, option);
      numeric += number;
      for (const std::string& value : kNumbers) {
        SCOPED_TRACE(command + " --" + option + "='" + value + "'");
        const auto message = refused(commands, command, option, value);
        ++tried;
        EXPECT_TRUE(!message || names_something(option) || message->find(option) != std::string::npos) << *message;
        EXPECT_TRUE(message || !number || !never.contains(value)) << "was taken";
      }
    }
  EXPECT_GT(numeric, 100u) << "of all commands together";
  EXPECT_GT(tried, 5000u);
}

// As JSON numbers and as texts.
TEST(Numbers, EveryOptionOfAConfigurationReadsOrRefusesThem) {
  const std::vector<nlohmann::json> values{1e308,
                                           -1e308,
                                           5e-324,
                                           -0.0,
                                           -1,
                                           18446744073709551615u,
                                           std::numeric_limits<std::int64_t>::min(),
                                           std::numeric_limits<double>::quiet_NaN(),
                                           std::numeric_limits<double>::infinity(),
                                           "nan",
                                           "1e309",
                                           "0x10",
                                           "18446744073709551616",
                                           nlohmann::json::array({1e308, -1}),
                                           nlohmann::json::array({nullptr, nlohmann::json::array()}),
                                           nlohmann::json::array()};
  for (const auto& [command, options] : all_options())
    for (const std::string& option : options) {
      if (option == "config") continue;
      Commands commands;
      const bool number = wants_numbers(commands, command, option);
      for (const auto& value : values) {
        SCOPED_TRACE(command + " " + option + ": " + value.dump());
        commands.app.clear();
        try {
          cli::apply_layer(*commands.app.get_subcommand(command), {{option, value}}, "config.json");
          EXPECT_TRUE(!number || !value.is_number_float() || std::isfinite(value.get<double>())) << "was taken";
        } catch (const Error& error) {
          EXPECT_EQ(std::string(error.what()).find("config.json: "), 0u) << error.what();
          EXPECT_TRUE(names_something(option) || std::string(error.what()).find(option) != std::string::npos)
              << error.what();
        }
      }
    }
}

class NumbersInFiles : public ProgramTest {
 protected:
  // Reads the file with each number in place of @; values that it accepts must be finite.
  void try_all(const std::string& name, const std::string& text,
               const std::function<std::vector<double>(const std::string&)>& read) {
    std::size_t taken = 0, refused = 0;
    for (const std::string& number : kNumbers) {
      SCOPED_TRACE(name + " with '" + number + "' in " + text);
      std::string with = text;
      with.replace(with.find('@'), 1, number);
      write(name, with);
      try {
        for (const double value : read(path(name))) EXPECT_TRUE(std::isfinite(value)) << value;
        ++taken;
      } catch (const Error& error) {
        ++refused;
        EXPECT_TRUE(error.code() == Errc::malformed_file || error.code() == Errc::invalid_argument) << error.what();
        EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
      }
    }
    EXPECT_GT(refused, kNumbers.size() / 3) << text;
    EXPECT_GT(taken, 0u) << text;
  }
};

TEST_F(NumbersInFiles, OfStations) {
  const auto read = [](const std::string& file) {
    std::vector<double> values;
    for (const StationRow& row : read_stations_csv(file)) {
      for (const auto& p : {row.position, row.ground})
        if (p) values.insert(values.end(), {p->x, p->y, p->z});
      if (row.xy) values.insert(values.end(), row.xy->begin(), row.xy->end());
      if (row.uv) values.insert(values.end(), {row.uv->u, row.uv->v});
      values.insert(values.end(), {row.setup.heading.in_degrees(), row.setup.tilt.in_degrees()});
      if (row.step) values.push_back(row.step->in_degrees());
    }
    return values;
  };
  for (const char* row : {"@;1;2;0.5;0.5;10;0;1", "0;@;2;0.5;0.5;10;0;1", "0;1;@;0.5;0.5;10;0;1", "0;1;2;@;0.5;10;0;1",
                          "0;1;2;0.5;@;10;0;1", "0;1;2;0.5;0.5;@;0;1", "0;1;2;0.5;0.5;10;@;1", "0;1;2;0.5;0.5;10;0;@"})
    try_all("stations.csv", std::string("x;y;z;u;v;heading;tilt;step\n") + row + "\n", read);
}

TEST_F(NumbersInFiles, OfNoise) {
  const auto read = [](const std::string& file) {
    const NoiseTable table = load_noise(file);
    std::vector<double> values = table.sigma_m;
    values.insert(values.end(), table.distances_m.begin(), table.distances_m.end());
    values.insert(values.end(), table.reflectivities.begin(), table.reflectivities.end());
    return values;
  };
  try_all("noise.csv", "reflectivity,@,1e309000\n0.1,0.001\n", [&](const std::string& file) {
    write("noise.csv", this->read("noise.csv").substr(0, this->read("noise.csv").find(",1e309000")) + "\n0.1,0.001\n");
    return read(file);
  });
  try_all("noise.csv", "reflectivity,10\n@,0.001\n", read);
  try_all("noise.csv", "reflectivity,10\n0.1,@\n", read);
}

TEST_F(NumbersInFiles, OfRegions) {
  const auto read = [](const std::string& file) {
    std::vector<double> values;
    for (const auto& ring : read_region(file).rings)
      for (const auto& corner : ring) values.insert(values.end(), corner.begin(), corner.end());
    return values;
  };
  try_all("region.csv", "x,y\n0,0\n4,@\n4,4\n", read);
  try_all("region.geojson", R"({"type":"Polygon","coordinates":[[[0,0],[4,@],[4,4]]]})", read);
}

TEST_F(NumbersInFiles, OfResults) {
  const auto read = [](const std::string& file) {
    std::vector<double> values;
    cli::StationOptions options;
    options.file = file;
    for (const cli::StationText& station : options.read(1024)) {
      if (station.position)
        values.insert(values.end(), {station.position->x, station.position->y, station.position->z});
      if (station.uv) values.insert(values.end(), {station.uv->u, station.uv->v});
      values.insert(values.end(), {station.setup.heading.in_degrees(), station.setup.tilt.in_degrees()});
      if (station.step) values.push_back(station.step->in_degrees());
    }
    return values;
  };
  for (const char* station : {R"("position":[@,1,2])", R"("uv":[0.5,@])", R"("position":[0,1,2],"heading":@)",
                              R"("position":[0,1,2],"tilt":@)", R"("position":[0,1,2],"step":@)"})
    try_all("front.json", std::string(R"({"front":[{"stations":[{)") + station + "}]}]}", read);
}

// glTF is JSON, which has no NaN; but numbers of any size.
TEST(NumbersOfScenes, AreFiniteOrRefused) {
  const auto scene_with = [](const std::string& member, const std::string& number) {
    std::string text = R"({"asset":{"version":"2.0","extras":{"vantage":{"user_size":1}}},"scene":0,
      "scenes":[{"nodes":[0]}],"nodes":[{"name":"wall","mesh":0,"translation":[0,0,0],"scale":[1,1,1],
      "extras":{"vantage":{"diffuse":0.5,"weight":2,"detail_mm":10,"accuracy_mm":1}}}],
      "meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],
      "materials":[{"pbrMetallicRoughness":{"baseColorFactor":[0.5,0.5,0.5,1]}}],
      "accessors":[{"bufferView":0,"byteOffset":0,"componentType":5126,"count":3,"type":"VEC3"}],
      "bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36}],
      "buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";
    const std::size_t at = text.find("\"" + member + "\":") + member.size() + 3;
    std::size_t from = at + (text[at] == '[' ? 1 : 0);
    const std::size_t end = text.find_first_of(",]}", from);
    return text.replace(from, end - from, number);
  };
  std::size_t taken = 0, refused = 0;
  for (const char* member : {"translation", "scale", "diffuse", "weight", "detail_mm", "accuracy_mm", "baseColorFactor",
                             "byteOffset", "byteLength", "count", "user_size", "componentType", "mesh"})
    for (const std::string& number : kNumbers) {
      SCOPED_TRACE(std::string(member) + ": " + number);
      const std::string text = scene_with(member, number);
      try {
        const Scene scene = load_gltf({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, {}, "hostile");
        ++taken;
        const Vec3 size = scene.bounds().size();
        EXPECT_TRUE(std::isfinite(size.x + size.y + size.z));
        for (const MeshInfo& mesh : scene.meshes()) {
          EXPECT_TRUE(mesh.diffuse >= 0 && mesh.diffuse <= 1) << mesh.diffuse;
          EXPECT_TRUE(std::isfinite(mesh.detail_m) && std::isfinite(mesh.accuracy_m));
          EXPECT_TRUE(mesh.weight >= 1 && mesh.weight <= 255) << mesh.weight;
        }
      } catch (const Error& error) {
        ++refused;
        EXPECT_EQ(error.code(), Errc::malformed_file) << error.what();
      }
    }
  EXPECT_GT(taken, 20u);
  EXPECT_GT(refused, 200u);
}

class NumbersThatAreTaken : public ProgramTest {
 protected:
  // The quickest run of each command.
  std::vector<std::string> quick(const std::string& command) const {
    if (command == "info") return {"info", scene_};
    if (command == "generate") return {"generate", "four-walls", "-o", path("made.glb")};
    if (command == "plan")
      return coarse("plan", {"--problem", "coverage-fix", "--stations", "1", "--population", "4", "--iterations", "1",
                             "--sample", "100", "--no-report", "--force", "-o", path("plan")});
    if (command == "bound") return coarse("bound", {"--stations", "1", "--candidates", "8", "--sample", "50"});
    if (command == "panorama")
      return coarse("panorama", {"--station", "8,0,1.5", "--width", "16", "-o", path("pictures")});
    return coarse(command, {"--station", "8,0,1.5"});
  }
};

// Kills processes that have not ended after a minute.
void at_most_a_minute(int process) {
  for (int tries = 0; tries < 6000; ++tries) {
    siginfo_t ended{};
    if (waitid(P_PID, static_cast<id_t>(process), &ended, WEXITED | WNOHANG | WNOWAIT) == 0 && ended.si_pid == process)
      return;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  kill(process, SIGKILL);
}

TEST_F(NumbersThatAreTaken, EndInFiniteResultsOrOneError) {
  const char* asked = std::getenv("VANTAGE_NUMBERS");
  const bool all = asked && std::string(asked) == "all";
  std::set<std::string> seen;  // options that several commands share are read by the same code
  std::size_t runs = 0;
  for (const auto& [command, options] : all_options()) {
    if (command == "edit") continue;  // waits for a browser
    for (const std::string& option : options) {
      if (option == "output" || (!seen.insert(option).second && !all)) continue;
      std::vector<std::string> taken;
      Commands commands;
      for (const std::string& value : kNumbers)
        if (!refused(commands, command, option, value)) taken.push_back(value);
      if (!all && taken.size() > 1) taken = {taken[std::hash<std::string>()(command + option) % taken.size()]};
      for (const std::string& value : taken) {
        auto words = quick(command);
        const auto same = std::find(words.begin(), words.end(), "--" + option);
        if (same != words.end()) words.erase(same, same + 2);
        words.push_back("--" + option + "=" + value);
        SCOPED_TRACE(command + " --" + option + "='" + value + "'");
        const Outcome outcome = run_program(words, at_most_a_minute);
        ++runs;
        EXPECT_TRUE(outcome.exit_code >= 0 && outcome.exit_code <= 3) << outcome.exit_code << "\n" << outcome.err;
        if (outcome.exit_code == 1 || outcome.exit_code == 2) expect_refused(outcome, outcome.exit_code, "");
        // One station stands infinitely far from the next.
        for (const char* odd : {"nan", option == "apart" ? "nan" : " inf", "-inf"})
          EXPECT_EQ(outcome.out.find(odd), std::string::npos) << outcome.out;
      }
    }
  }
  EXPECT_GT(runs, 60u);
}

class PositionsThatAreTaken : public NumbersThatAreTaken {
 protected:
  void expect_ended(const std::vector<std::string>& words) {
    std::string all;
    for (const std::string& word : words) all += word + " ";
    SCOPED_TRACE(all);
    const Outcome outcome = run_program(words, at_most_a_minute);
    expect_refused(outcome, 2, "");
    EXPECT_NE(outcome.err.find("within 1000 km of the scene"), std::string::npos) << outcome.err;
  }
  std::vector<std::string> with(std::vector<std::string> words, const std::vector<std::string>& more) const {
    const auto station = std::find(words.begin(), words.end(), "--station");
    if (station != words.end()) words.erase(station, station + 2);
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  static inline const std::vector<std::string> kFar{"2e6", "-1e18", "1e30", "1e308", "9223372036854775808"};
};

TEST_F(PositionsThatAreTaken, EndInOneErrorThatSaysWhere) {
  for (const std::string& far : kFar) {
    write("far.csv", "x,y,z\n0," + far + ",1.5\n");
    write("front.json", R"({"front":[{"stations":[{"position":[)" + far + R"(,0,1.5]}]}]})");
    for (const char* command : {"evaluate", "scan", "panorama"}) {
      expect_ended(with(quick(command), {"--station", "0,0," + far}));
      expect_ended(with(quick(command), {"--stations", path("far.csv")}));
      expect_ended(with(quick(command), {"--stations", path("front.json")}));
    }
    expect_ended(with(quick("plan"), {"--keep=" + far + ",0,1.5"}));
    expect_ended(with(quick("plan"), {"--start=" + far + ",0,1.5"}));
    expect_ended(with(quick("evaluate"), {"--enter=" + far + ",1,1", "--station", "8,0,1.5", "--station", "0,8,1.5"}));
  }
  expect_ended(with(quick("evaluate"), {"--enter=1e160,1,1", "--station", "8,0,1.5", "--station", "0,8,1.5"}));
}

}  // namespace
}  // namespace vantage::test
