// SPDX-License-Identifier: Apache-2.0
// Makes Vulkan calls of a small plan fail, one by one, and reports the outcome:
//     vantage-device-faults ENGINE [EVERY [FIRST]]
// Tries each call, or one of EVERY, from number FIRST (default 0) on; docs/evidence/reliability.md has the table. If
// VANTAGE_FAULTS_UNWATCHED is set, runs without the validation layer.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <string>

#include "faults/open_layer.hpp"
#include "faults/small_plan.hpp"
#include "vantage/built_in_scenes.hpp"

namespace vantage::test {
namespace {

constexpr unsigned hang_seconds = 300;  // longer than any attempt; the alarm ends the program

struct Kind {
  Fault fault;
  const char* name;
};
constexpr std::array kinds{Kind{Fault::lost, "device lost"},
                           Kind{Fault::gone, "device lost for good"},
                           Kind{Fault::device_memory, "out of device memory"},
                           Kind{Fault::host_memory, "out of host memory"},
                           Kind{Fault::timeout, "wait timed out"},
                           Kind{Fault::late, "answers late"}};

class Trial {
 public:
  Trial(Engine engine, const FaultControl& faults)
      : engine_(engine), faults_(faults), plan_(engine, watched()), quiet_plan_(engine, false) {
    front_ = reference();
    // Later plans share an instance while it lives.
    befall(plan_, "cannot make an instance", 1, [&](std::uint64_t) { faults_.arm(Fault::host_memory, 0); });
    keeper_.emplace(kept(engine));
  }

  int all(std::uint64_t every, std::uint64_t first) {
    for (const Kind& kind : kinds) {
      reference();
      const std::uint64_t calls = faults_.calls(kind.fault);
      if (calls == 0) complain("nothing that a fault can befall");
      befall(plan_, kind.name, (calls - std::min(calls, first) + every - 1) / every,
             [&](std::uint64_t k) { faults_.arm(kind.fault, first + k * every); });
    }
    if (first > 0) return failed_ ? 1 : 0;  // the rest runs only with FIRST 0
    too_little_memory();
    slow_device();
    hangs();
    return failed_ ? 1 : 0;
  }

 private:
  static bool watched() { return !std::getenv("VANTAGE_FAULTS_UNWATCHED"); }
  static Simulator kept(Engine engine) {
    const TemporaryFolder folder;
    write_built_in_scene("three-walls", 0, folder / "scene.glb");
    const Scanner scanner{.azimuth_step = Angle::degrees(30), .zenith_step = Angle::degrees(30)};
    return {Scene::load(folder / "scene.glb"),
            scanner,
            {.engine = engine, .user_size_m = 1, .point_spacing_m = 0.5, .validation = watched()}};
  }

  void complain(const std::string& what) {
    failed_ = true;
    std::fprintf(stderr, "WRONG: %s\n", what.c_str());
  }

  // Front of a plan without a fault; its counts remain in the layer.
  std::string reference() {
    const TemporaryFolder folder;
    faults_.arm(Fault::none, 0);
    const std::string front = plan_.run(folder / "checkpoint", false);
    if (front.empty() || (!front_.empty() && front != front_)) complain("plans without a fault differ");
    return front;
  }

  // Runs `many` plans, each with the fault that `arm` makes, and returns the outcomes.
  template <class Arm>
  std::map<Outcome::Kind, int> befall(SmallPlan& plan, const char* name, std::uint64_t many, const Arm& arm) {
    const auto disarm = [&] {
      struck_ = faults_.struck() ? faults_.struck() : "nothing";
      dispatches_ = faults_.dispatches();
      faults_.limit(0), faults_.slow_down(1), faults_.arm(Fault::none, 0);
    };
    std::map<Outcome::Kind, int> outcomes;
    std::map<std::string, int> calls, errors;
    int warned = 0;
    for (std::uint64_t k = 0; k < many; ++k) {
      const std::int64_t before = faults_.alive();
      alarm(hang_seconds);
      const Outcome outcome = attempt(
          plan, front_, [&] { arm(k); }, disarm);
      alarm(0);
      ++outcomes[outcome.kind], ++calls[struck_];
      warned += outcome.kind == Outcome::Kind::same && !plan.warned().empty();
      split_ |= mentions(plan.warned(), "networks at once");
      const std::string where = std::string(name) + ", number " + std::to_string(k) + ", " + struck_ + ": ";
      if (outcome.kind == Outcome::Kind::wrong) complain(where + outcome.text);
      if (faults_.alive() != before && &plan == &plan_ && keeper_)
        complain(where + std::to_string(faults_.alive() - before) + " objects left undestroyed");
      if (outcome.kind != Outcome::Kind::same) ++errors[outcome.text.substr(0, outcome.text.find("; "))];
    }
    std::printf("| %s | %s | %llu | %d (%d set up anew) | %d | %d | %d |\n", to_string(engine_).c_str(), name,
                static_cast<unsigned long long>(many), outcomes[Outcome::Kind::same], warned,
                outcomes[Outcome::Kind::saved], outcomes[Outcome::Kind::refused], outcomes[Outcome::Kind::wrong]);
    std::fflush(stdout);
    for (const auto& [call, times] : calls) std::fprintf(stderr, "  %s: %d\n", call.c_str(), times);
    for (const auto& [error, times] : errors) std::fprintf(stderr, "  \"%s\": %d\n", error.c_str(), times);
    return outcomes;
  }

  // From the memory for all networks at once down to none.
  void too_little_memory() {
    reference();
    const std::uint64_t peak = faults_.peak_bytes();
    constexpr std::uint64_t steps = 16;
    split_ = false;
    befall(plan_, "too little memory", steps, [&](std::uint64_t k) {
      faults_.arm(Fault::none, 0);
      faults_.limit(peak * (steps - 1 - k) / steps + 1);
    });
    if (!split_) complain("no population was split where memory was short");
  }

  void slow_device() {
    reference();
    const std::uint64_t quick = faults_.dispatches();
    const auto outcomes = befall(plan_, "a million times slower", 1, [&](std::uint64_t) {
      faults_.arm(Fault::none, 0);
      faults_.slow_down(1e6);
    });
    if (outcomes.at(Outcome::Kind::same) == 0) complain("a slow device was not waited for");
    if (dispatches_ <= quick) complain("the work of a slow device was not split");
  }

  // Abandons its objects for good, so it runs without the validation layer, which would report them.
  void hangs() {
    front_ = [&] {
      const TemporaryFolder folder;
      faults_.arm(Fault::none, 0);
      return quiet_plan_.run(folder / "checkpoint", false);
    }();
    const std::uint64_t calls = faults_.calls(Fault::hang);
    constexpr std::uint64_t tries = 4;
    const auto outcomes = befall(quiet_plan_, "hangs", tries,
                                 [&](std::uint64_t k) { faults_.arm(Fault::hang, k * (calls - 1) / (tries - 1)); });
    if (outcomes.at(Outcome::Kind::same) > 0) complain("a device that hung was waited for");
  }

  static bool mentions(const std::vector<std::string>& lines, const char* what) {
    return std::ranges::any_of(lines, [&](const std::string& line) { return line.find(what) != std::string::npos; });
  }

  Engine engine_;
  const FaultControl& faults_;
  SmallPlan plan_, quiet_plan_;
  std::optional<Simulator> keeper_;
  std::string front_, struck_;
  std::uint64_t dispatches_ = 0;
  bool split_ = false, failed_ = false;
};

}  // namespace
}  // namespace vantage::test

int main(int argc, char** argv) {
  using namespace vantage;
  if (argc < 2) return std::fprintf(stderr, "usage: vantage-device-faults ENGINE [EVERY [FIRST]]\n"), 2;
  const auto& faults = test::open_layer();
  const auto every = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  const auto first = argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 0;
  return test::Trial(engine_from_string(argv[1]), faults).all(std::max(every, 1ull), first);
}
