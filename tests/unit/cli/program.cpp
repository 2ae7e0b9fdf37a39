// SPDX-License-Identifier: Apache-2.0
#include "program.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "vantage/built_in_scenes.hpp"
#include "vantage/scene.hpp"

extern char** environ;

namespace vantage::test {
namespace {

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

}  // namespace

Outcome run_program(const std::vector<std::string>& arguments, const std::function<void(int)>& meanwhile) {
  const TemporaryFolder folder;
  const std::string out = folder / "out", err = folder / "err";
  std::vector<std::string> words{VANTAGE_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (auto& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_addopen(&actions, 2, err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  pid_t process = 0;
  const int failure = posix_spawn(&process, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  EXPECT_EQ(failure, 0) << VANTAGE_PROGRAM;
  if (failure != 0) return {};
  if (meanwhile) meanwhile(process);
  int status = 0;
  waitpid(process, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), text_of(out), text_of(err)};
}

ProgramTest::ProgramTest() { write_built_in_scene("four-walls", 0, scene_); }

void ProgramTest::write(const std::string& name, const std::string& text) const { std::ofstream(path(name)) << text; }

std::string ProgramTest::read(const std::string& name) const { return text_of(path(name)); }

std::vector<std::string> ProgramTest::files() const {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_.path()))
    if (entry.is_regular_file() && entry.path() != scene_)
      names.push_back(std::filesystem::relative(entry.path(), folder_.path()));
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> ProgramTest::coarse(const std::string& command, const std::vector<std::string>& more) const {
  std::vector<std::string> all{command, scene_,        "--engine", "embree",    "--step",
                               "1",     "--user-size", "0.5",      "--spacing", "0.2"};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

nlohmann::json ProgramTest::json_of(const std::vector<std::string>& arguments) const {
  auto with_json = arguments;
  with_json.push_back("--json");
  const Outcome outcome = run_program(with_json);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  auto object = nlohmann::json::parse(outcome.out, nullptr, false);
  EXPECT_TRUE(object.is_object()) << outcome.out;
  return object;
}

void expect_refused(const Outcome& outcome, int exit_code, const std::string& words) {
  EXPECT_EQ(outcome.exit_code, exit_code) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  std::istringstream lines(outcome.err);
  std::string line, last;
  std::size_t errors = 0;
  while (std::getline(lines, line)) {
    errors += line.starts_with("vantage: error: ");
    if (line.starts_with("vantage: error: ")) last = line;
  }
  EXPECT_EQ(errors, 1u) << outcome.err;
  EXPECT_NE(last.find(words), std::string::npos) << "'" << words << "' is not in: " << outcome.err;
}

}  // namespace vantage::test
