// SPDX-License-Identifier: Apache-2.0
#include "arrays.hpp"
#include "long_call.hpp"
#include "module.hpp"
#include "options.hpp"
#include "pickle.hpp"
#include "simulator.hpp"

namespace vantage::python {
namespace {

Options<MissedOptions> missed_options() {
  return Options<MissedOptions>("why_missed")
      .add("candidates", &MissedOptions::candidates, "Positions, spread over the ground, that lines are drawn from.")
      .add("flat_deg", &MissedOptions::flat, "Incidence from which on a surface counts as seen too flatly.");
}

std::vector<std::string> reasons() {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < why_missed_count; ++k) names.push_back(to_string(static_cast<WhyMissed>(k)));
  return names;
}

std::map<std::string, std::map<std::string, double>> shares_of(const MissedVoxels& missed) {
  std::map<std::string, std::map<std::string, double>> shares;
  for (const MissedShare& node : missed.shares)
    for (std::size_t k = 0; k < why_missed_count; ++k) {
      const auto why = static_cast<WhyMissed>(k);
      shares[node.node][to_string(why)] = node.share(why);
    }
  return shares;
}

}  // namespace

void add_missed(py::module_& m) {
  py::class_<MissedVoxels> type(m, "MissedVoxels", "What became of surveyed voxels, or of a sample of many.");
  type.def_property_readonly(
          "voxels",
          [](const py::object& self) {
            return view<std::uint32_t>(std::span(self.cast<const MissedVoxels&>().ranks), self);
          },
          "Which voxels, in the order of `Simulator.voxel_centres`: (k,), ascending, read-only.")
      .def_property_readonly(
          "points",
          [](const py::object& self) {
            return view<std::uint32_t>(std::span(self.cast<const MissedVoxels&>().points), self);
          },
          "Points that the network left in each: (k,), read-only.")
      .def_property_readonly(
          "why",
          [](const py::object& self) {
            return view<std::uint8_t>(std::span(self.cast<const MissedVoxels&>().why), self);
          },
          "What became of each, as an index into `reasons`: (k,), read-only.")
      .def_property_readonly(
          "reasons", [](const MissedVoxels&) { return reasons(); },
          "'captured', 'hidden', 'far', 'flat', 'sparse' and 'not_chosen', in the order of the numbers of `why`.")
      .def_property_readonly("shares", &shares_of,
                             "The share of its voxels by reason, for each node by its name; '': the whole site.")
      .def_readonly("candidates", &MissedVoxels::candidates, "Positions that lines were drawn from.");
  add_pickle(type);
  const auto options = missed_options();
  m.def(
      "why_missed",
      [options](GuardedSimulator& self, const SearchArea& area, const ClashChecker& clash, const Evaluation& evaluation,
                py::object progress, const py::kwargs& given) {
        const MissedOptions how = options.read(given);
        if (evaluation.field.count.size() != self.simulator.voxel_count())
          throw Error(Errc::invalid_argument,
                      "why_missed: the evaluation has no points of each voxel; evaluate with field=True");
        LongCall call(std::move(progress));
        return call.run(
            [&] { return missed_voxels(self.simulator, area, clash, evaluation.field, how, call.progress()); });
      },
      py::arg("simulator"), py::arg("area"), py::arg("clash"), py::arg("evaluation"), py::kw_only(),
      py::arg("progress") = py::none(),
      ("Why voxels are not captured: what no allowed position can help, and what other stations would have captured.\n"
       "Looks at 50 000 voxels, or at all if there are fewer. evaluation: with field=True. Empty if it was stopped.\n"
       "Raises Error invalid_argument." +
       options.doc())
          .c_str());
}

}  // namespace vantage::python
