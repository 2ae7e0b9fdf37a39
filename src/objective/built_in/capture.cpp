// SPDX-License-Identifier: Apache-2.0
#include <limits>
#include <string>

#include "core/text.hpp"
#include "objective/built_in/built_in.hpp"
#include "vantage/error.hpp"

namespace vantage::built_in {
namespace {

// Share of the attainable coverage. It is counted during measurement, on voxels whose attainable counts are known
// (attainable.cpp).
Objective share_captured() {
  return {.name = "capture",
          .label = "Captured (share of what is attainable)",
          .noun = "share captured of what is attainable",
          .percent = true,
          .scale = maximise(1, 0),
          .needs = {.counts = false, .attainable = true},
          .advice = "allow more stations, or give more places to stand"};
}

}  // namespace

Objective capture(const ObjectiveSettings& settings) {
  if (!(settings.attainable > 0 && settings.attainable <= 1))
    throw Error(Errc::invalid_argument,
                "capture is a share of what is attainable, a coverage above 0 and at most 1, not " +
                    number(settings.attainable));
  Objective all = share_captured();
  all.value = [](const MeasuredNetwork& m) { return m.captured.value; };
  all.standard_error = [](const MeasuredNetwork& m) { return m.captured.standard_error; };
  all.kind = Objective::Kind::coverage;
  all.coverage_of_one = settings.attainable;
  all.parameters = "of an attainable coverage of " + number(settings.attainable);
  return all;
}

Objective capture_of(std::string_view meshes) {
  const std::string of(meshes);
  if (of.empty() || of == "!")
    throw Error(Errc::invalid_argument, "capture(" + of + "): name meshes, as capture(IfcWall*)");
  const auto share = [of](const MeasuredNetwork& m) {
    const auto known = m.captured_of_meshes.find(of);
    return known == m.captured_of_meshes.end() ? Estimate{std::numeric_limits<double>::quiet_NaN(), 0} : known->second;
  };
  Objective some = share_captured();
  some.name = "capture(" + of + ")";
  const std::string whose = of.starts_with('!') ? "all but " + of.substr(1) : of;
  some.label = "Captured of " + whose + " (share of what is attainable)";
  some.noun += " of " + whose;
  some.value = [share](const MeasuredNetwork& m) { return share(m).value; };
  some.standard_error = [share](const MeasuredNetwork& m) { return share(m).standard_error; };
  some.meshes = of;
  return some;
}

}  // namespace vantage::built_in
