// SPDX-License-Identifier: Apache-2.0
#include "arrays.hpp"
#include "long_call.hpp"
#include "module.hpp"
#include "options.hpp"
#include "pickle.hpp"
#include "site.hpp"

namespace vantage::python {
namespace {

Options<MissedOptions> missed_options() {
  return Options<MissedOptions>("why_missed")
      .add("candidates", &MissedOptions::candidates,
           "Number of positions, spread over the ground, from which lines are drawn.")
      .add("flat_deg", &MissedOptions::flat, "Largest incidence of a surface that is not seen too flatly.");
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

Typed<"List[Dict[str, Any]]", py::list> rooms_of(const MissedVoxels& missed) {
  py::list rooms;
  for (const RoomShare& room : missed.rooms) {
    py::dict shares;
    for (std::size_t k = 0; k < why_missed_count; ++k)
      shares[py::str(to_string(static_cast<WhyMissed>(k)))] = room.share.share(static_cast<WhyMissed>(k));
    py::dict out;
    out["name"] = room.share.node, out["voxels"] = room.share.voxels, out["shares"] = shares;
    out["ground_m2"] = room.ground_m2, out["why_no_station"] = why_no_station(room);
    rooms.append(out);
  }
  return rooms;
}

}  // namespace

void add_missed(py::module_& m) {
  py::class_<MissedVoxels> type(m, "MissedVoxels", "Status of surveyed voxels, or of a sample of them.");
  type.def_property_readonly(
          "voxels",
          [](const py::object& self) {
            return view<std::uint32_t>(std::span(self.cast<const MissedVoxels&>().voxels), self);
          },
          "Voxel indices, in the order of `Simulator.voxel_centres`: (k,), ascending, read-only.")
      .def_property_readonly(
          "points",
          [](const py::object& self) {
            return view<std::uint32_t>(std::span(self.cast<const MissedVoxels&>().points), self);
          },
          "Points of the network in each: (k,), read-only.")
      .def_property_readonly(
          "why",
          [](const MissedVoxels& self) {
            py::array_t<std::uint8_t> why(static_cast<py::ssize_t>(self.status.size()));
            for (std::size_t k = 0; k < self.status.size(); ++k)
              why.mutable_data()[k] = static_cast<std::uint8_t>(self.status[k].why);
            return why;
          },
          "Status of each, an index into `reasons`: (k,).")
      .def_property_readonly(
          "reasons", [](const MissedVoxels&) { return reasons(); },
          "'captured', 'hidden', 'out_of_range', 'too_flat', 'too_dark', 'too_sparse' and 'not_chosen', in the order "
          "of the numbers of `why`.")
      .def_property_readonly(
          "shares", &shares_of,
          "Shares of the goal points by reason, which add up to 1, for each node by its name; '': the whole site.")
      .def_property_readonly("rooms", &rooms_of,
                             "For each of the scene's rooms: 'name', 'voxels' and 'shares' of those in it, 'ground_m2' "
                             "of the search area, and\n'why_no_station' if no station stands in it.")
      .def_readonly("candidates", &MissedVoxels::candidates, "Number of positions from which lines were drawn.");
  add_pickle(type);
  const auto options = missed_options();
  m.def(
      "why_missed",
      [options](GuardedSite& self, const Evaluation& evaluation, Listener progress, const py::kwargs& given) {
        const MissedOptions how = options.read(given);
        const auto lock = self.taken();
        if (evaluation.field.count.empty() || evaluation.field.count.size() != self.site.simulator().voxel_count())
          throw Error(Errc::invalid_argument,
                      "why_missed: the evaluation has no points of each voxel; evaluate with field=True");
        LongCall call(std::move(progress));
        return call.run([&] { return missed_voxels(self.site, evaluation.field, how, call.progress()); });
      },
      py::arg("site"), py::arg("evaluation"), py::kw_only(), py::arg("progress") = py::none(),
      ("Why voxels are not captured: those beyond any allowed position, and those that other stations would "
       "have\ncaptured. Judges at most 50 000 voxels. evaluation: with field=True. Empty if it was stopped.\nRaises "
       "Error invalid_argument." +
       options.doc())
          .c_str());
}

}  // namespace vantage::python
