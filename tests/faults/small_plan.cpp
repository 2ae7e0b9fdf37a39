// SPDX-License-Identifier: Apache-2.0
#include "faults/small_plan.hpp"

#include <cstdio>
#include <new>

#include "support/site_of.hpp"
#include "vantage/built_in_scenes.hpp"

namespace vantage::test {
namespace {

std::string text_of(const PlanResult& result) {
  std::string text;
  const auto add = [&](double value) {
    char hex[40];
    std::snprintf(hex, sizeof hex, "%a ", value);
    text += hex;
  };
  for (const PlanEntry& entry : result.front) {
    for (const double x : entry.x) add(x);
    for (const auto& [name, seen] : entry.searched) {
      text += name + " ";
      add(seen.value), add(seen.standard_error), add(entry.value(name));
    }
    for (const std::uint64_t points : entry.counts.points_on_surveyed) add(static_cast<double>(points));
    text += "\n";
  }
  return text;
}

}  // namespace

SmallPlan::SmallPlan(Engine engine, bool validation) : engine_(engine), validation_(validation) {
  write_built_in_scene("three-walls", 0, folder_ / "scene.glb");
}

std::string SmallPlan::run(const std::filesystem::path& checkpoint, bool resume) {
  warned_.clear();
  searching_ = false;
  const Scene scene = Scene::load(folder_ / "scene.glb");
  const Scanner scanner{
      .azimuth_step = Angle::degrees(12), .zenith_step = Angle::degrees(12), .height_m = 1.5, .noise = rtc360_noise()};
  Site site = site_of(Simulator(scene, scanner,
                                {.engine = engine_,
                                 .warn = [this](const std::string& line) { warned_.push_back(line); },
                                 .user_size_m = 0.5,
                                 .point_spacing_m = 0.25,
                                 .validation = validation_,
                                 .max_rays_per_dispatch = 8192}));
  const std::vector<std::string> objectives{"coverage", "overlap", "registration"};
  const PlanConfig config{.population = 8,
                          .iterations = 1,
                          .scheme = MoScheme::generational,
                          .sample_voxels = 400,
                          .seed = 5,
                          .checkpoint = checkpoint,
                          .checkpoint_seconds = 1e-9,
                          .resume = resume};
  const auto report = [this](const PlanProgress& now) { searching_ |= now.evaluations > 0; };
  return text_of(plan(site, survey_problem(objectives, 2, 2), config, {.report = report}));
}

Outcome attempt(SmallPlan& plan, const std::string& front, const std::function<void()>& arm,
                const std::function<void()>& disarm) {
  using Kind = Outcome::Kind;
  const TemporaryFolder folder;
  const std::filesystem::path checkpoint = folder / "checkpoint";
  std::string error;
  try {
    arm();
    const std::string found = plan.run(checkpoint, false);
    disarm();
    if (found != front) return {Kind::wrong, "another front"};
    return {Kind::same, ""};
  } catch (const Error& thrown) {
    disarm();
    error = thrown.what();
    const bool clear = thrown.code() == Errc::out_of_memory || thrown.code() == Errc::device_failure ||
                       thrown.code() == Errc::no_suitable_device;
    if (!clear || error.empty() || error.find("validation layer reports") != std::string::npos)
      return {Kind::wrong, "an error of another kind: " + error};
  } catch (const std::bad_alloc&) {
    disarm();
    error = "out of memory";
  } catch (const std::exception& thrown) {
    disarm();
    return {Kind::wrong, std::string("an exception of another kind: ") + thrown.what()};
  }
  const bool kept = std::filesystem::exists(checkpoint);
  if (!kept) return {plan.searching() ? Kind::wrong : Kind::refused, error};
  try {
    if (plan.run(checkpoint, true) != front) return {Kind::wrong, error + "; and another front when it goes on"};
  } catch (const std::exception& thrown) {
    return {Kind::wrong, error + "; and it cannot go on: " + thrown.what()};
  }
  return {Kind::saved, error};
}

}  // namespace vantage::test
