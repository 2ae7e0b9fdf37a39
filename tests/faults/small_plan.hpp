// SPDX-License-Identifier: Apache-2.0
// A plan of a few milliseconds that covers all stages of planning, to be made to fail anywhere.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "support/temporary_folder.hpp"
#include "vantage/vantage.hpp"

namespace vantage::test {

class SmallPlan {
 public:
  SmallPlan(Engine engine, bool validation);

  // Runs from scene to front; returns the front as text, with every bit of it.
  std::string run(const std::filesystem::path& checkpoint, bool resume);
  const std::vector<std::string>& warned() const { return warned_; }  // since the last run() began
  bool searching() const { return searching_; }                       // whether it reached a first evaluation

 private:
  TemporaryFolder folder_;
  Engine engine_;
  bool validation_;
  std::vector<std::string> warned_;
  bool searching_ = false;
};

// Outcome of a plan that met a fault.
struct Outcome {
  enum class Kind {
    same,     // continued to the front of an undisturbed plan
    refused,  // one clear error, before there was anything to lose
    saved,    // one clear error; from the checkpoint it continues to that front
    wrong
  } kind;
  std::string text;  // the error, or what is wrong
};

// Calls `arm` just before the plan, and `disarm` just after it, before testing the checkpoint.
Outcome attempt(SmallPlan& plan, const std::string& front, const std::function<void()>& arm,
                const std::function<void()>& disarm);

}  // namespace vantage::test
