// SPDX-License-Identifier: Apache-2.0
// Runs the built program as a user would, on small scenes.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/temporary_folder.hpp"

namespace vantage::test {

struct Outcome {
  int exit_code = -1;  // 128 + the signal where one ended it
  std::string out, err;
};

// Starts the program with these arguments and waits for it. `meanwhile` is called with its process id once it has
// started.
Outcome run_program(const std::vector<std::string>& arguments, const std::function<void(int)>& meanwhile = {});

// A folder with the four walls in it, and options that make them quick.
class ProgramTest : public testing::Test {
 protected:
  ProgramTest();
  std::string path(const std::string& name) const { return folder_.path() / name; }
  void write(const std::string& name, const std::string& text) const;
  std::string read(const std::string& name) const;
  std::vector<std::string> files() const;  // of the folder, but for the scene

  // `command` on the four walls with coarse rays and voxels, more arguments behind.
  std::vector<std::string> coarse(const std::string& command, const std::vector<std::string>& more) const;
  nlohmann::json json_of(const std::vector<std::string>& arguments) const;

  TemporaryFolder folder_;
  std::string scene_ = path("four_walls.glb");
};

// Not 0, one error line with `words` in it, nothing on standard output.
void expect_refused(const Outcome& outcome, int exit_code, const std::string& words);

}  // namespace vantage::test
