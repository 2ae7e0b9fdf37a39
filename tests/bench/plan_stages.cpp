// SPDX-License-Identifier: Apache-2.0
#include "plan_stages.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "bench_site.hpp"
#include "vantage/error.hpp"
#include "vantage/planner.hpp"
#include "vantage/question.hpp"
#include "vantage/site.hpp"

extern char** environ;

namespace vantage::bench {
namespace {

// Wall time and the processor time of all threads, since the object was made or since the last lap.
class Laps {
 public:
  struct Lap {
    double seconds = 0, processor_s = 0;
  };
  Lap lap() {
    const Lap here{watch_.seconds(), processor()};
    const Lap since{here.seconds - last_.seconds, here.processor_s - last_.processor_s};
    last_ = here;
    return since;
  }

 private:
  static double processor() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  }
  Stopwatch watch_;
  Lap last_{0, processor()};
};

struct Stage {
  double seconds = 0, processor_s = 0;
  Work work;
};

void print(const std::string& site, const std::string& name, const Stage& stage) {
  std::printf("%s,%s,%.2f,%.2f", site.c_str(), name.c_str(), stage.seconds, stage.processor_s);
  Work::for_each(
      [&](const char*, auto member) { std::printf(",%llu", static_cast<unsigned long long>(stage.work.*member)); });
  std::printf("\n");
}

// One plan in this process, stage by stage, in the order in which they first began.
void tell_stages(const std::string& file, const PlanStagesOptions& options) {
  std::vector<std::string> order;
  std::map<std::string, Stage> stages;
  Laps laps;
  Work known;
  const auto end_stage = [&](const std::string& name, const Work& now) {
    const Laps::Lap lap = laps.lap();
    if (std::ranges::find(order, name) == order.end()) order.push_back(name);
    Stage& stage = stages[name];
    stage.seconds += lap.seconds, stage.processor_s += lap.processor_s;
    stage.work = stage.work + (now - known);
    known = now;
  };
  vantage::SiteOptions given;
  given.engine = engine_from_string(options.engine);
  Site site = Site::open(file, given);
  end_stage("load", site.work());
  site.area();
  end_stage("ground", site.work());
  site.simulator();
  end_stage("voxels", site.work());
  std::string phase = "look";
  const PlanResult result =
      plan(site, SurveyQuestion{.capture = 0.9}, PlanConfig{}, {.report = [&](const PlanProgress& now) {
             end_stage(phase, site.work());
             phase = now.phase;
           }});
  end_stage(phase, site.work());
  Stage whole;
  for (const std::string& name : order) {
    const Stage& stage = stages[name];
    print(file, name, stage);
    whole.seconds += stage.seconds, whole.processor_s += stage.processor_s, whole.work = whole.work + stage.work;
  }
  whole.work.choice_steps = result.work.choice_steps;
  print(file, "whole", whole);
  std::printf("%s: %zu stations, %.1f %% captured, engine %.2f s\n", file.c_str(), result.front.front().stations.size(),
              100 * result.front.front().value("capture"), result.trace_seconds);
}

struct Run {
  double seconds = 0, processor_s = 0, captured = 0;
  std::size_t stations = 0;
  int status = 0;
};

// One plan by a program, without its report.
Run run_program(const std::string& program, const std::string& site, const PlanStagesOptions& options,
                const std::filesystem::path& folder) {
  std::vector<std::string> words{program, "plan", site,       "--no-report", "--force",
                                 "-o",    folder, "--engine", options.engine};
  words.insert(words.end(), options.site_options.begin(), options.site_options.end());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const Stopwatch watch;
  pid_t child = 0;
  posix_spawn_file_actions_t quiet;
  posix_spawn_file_actions_init(&quiet);
  for (const int stream : {1, 2}) posix_spawn_file_actions_addopen(&quiet, stream, "/dev/null", O_WRONLY, 0);
  const int failed = posix_spawn(&child, program.c_str(), &quiet, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&quiet);
  if (failed != 0) throw Error(Errc::invalid_argument, program + " cannot be started");
  rusage used{};
  Run run;
  wait4(child, &run.status, 0, &used);
  run.seconds = watch.seconds();
  const auto of = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  run.processor_s = of(used.ru_utime) + of(used.ru_stime);
  std::ifstream file(folder / "front.json");
  const nlohmann::json front = nlohmann::json::parse(file, nullptr, false);
  if (front.is_discarded()) throw Error(Errc::invalid_argument, program + " wrote no plan of " + site);
  const auto& entry = front.at("front").at(front.value("answer", std::size_t{1}) - 1);
  run.stations = entry.at("station_count");
  if (entry.at("values").contains("capture")) run.captured = entry.at("values").at("capture").at("exact");
  return run;
}

void compare(const std::string& site, const PlanStagesOptions& options) {
  const auto folder = std::filesystem::temp_directory_path() / "vantage-bench-plan";
  double seconds = 1e300, other_seconds = 1e300, processor_s = 1e300, other_processor_s = 1e300;
  for (std::size_t k = 0; k < options.repeats; ++k)
    for (const bool other : {true, false}) {
      const std::string& program = other ? options.against : options.program;
      const Run run = run_program(program, site, options, folder);
      std::printf("%s,%s,%.1f,%.1f,%zu,%.4f\n", site.c_str(), other ? "against" : "program", run.seconds,
                  run.processor_s, run.stations, run.captured);
      std::fflush(stdout);
      double &least = other ? other_seconds : seconds, &least_processor = other ? other_processor_s : processor_s;
      least = std::min(least, run.seconds), least_processor = std::min(least_processor, run.processor_s);
    }
  std::printf("%s: %.2f times as fast, %.2f times less processor time (shortest of %zu each)\n", site.c_str(),
              other_seconds / seconds, other_processor_s / processor_s, options.repeats);
  std::filesystem::remove_all(folder);
}

}  // namespace

void PlanStagesOptions::add(CLI::App& command) {
  command.add_option("site", sites, "Models")->required();
  command.add_option("--engine", engine, "As of vantage plan")->capture_default_str();
  command.add_option("--against", against, "Program of another build: both plan in turn, and ratios are printed");
  command.add_option("--program", program, "Program of this build, for --against");
  command.add_option("--with", site_options, "Options that both programs get, each a word: --with=--step --with=0.2");
  command.add_option("--repeats", repeats, "Runs of each program")->check(CLI::PositiveNumber)->capture_default_str();
}

void run_plan_stages(const PlanStagesOptions& options) {
  if (options.against.empty()) {
    std::printf("site,stage,seconds,processor seconds");
    Work::for_each([](const char* name, auto) { std::printf(",%s", name); });
    std::printf("\n");
    for (const std::string& site : options.sites) tell_stages(site, options);
    return;
  }
  if (options.program.empty()) throw Error(Errc::invalid_argument, "--against: --program names this build's program");
  std::printf("site,build,seconds,processor seconds,stations,captured\n");
  for (const std::string& site : options.sites) compare(site, options);
}

}  // namespace vantage::bench
