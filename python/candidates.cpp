// SPDX-License-Identifier: Apache-2.0
#include "arrays.hpp"
#include "module.hpp"
#include "options.hpp"
#include "simulator.hpp"

namespace vantage::python {
namespace {

using Rows = std::vector<std::size_t>;

void add_rows(py::module_& m) {
  py::class_<CaptureRows>(
      m, "CaptureRows",
      "What stations capture one by one of a sample of voxels: points add up, so that one pass over\n"
      "single stations answers which of them to take.")
      .def("__len__", &CaptureRows::size)
      .def(
          "row",
          [](const py::object& self, std::size_t k) {
            const auto& rows = self.cast<const CaptureRows&>();
            if (k >= rows.size())
              throw py::index_error("row " + std::to_string(k) + " of " + std::to_string(rows.size()));
            return view<std::uint32_t>(rows.row(k), self, 2);
          },
          py::arg("k"), "Pairs (place in the sample, points) of the voxels that station k sees: (m, 2), read-only.")
      .def_property_readonly(
          "voxels",
          [](const py::object& self) {
            return view<std::uint32_t>(std::span(self.cast<const CaptureRows&>().voxels()), self);
          },
          "The sample, by the order of `Simulator.voxel_centres`, ascending: read-only.")
      .def_property_readonly(
          "weights",
          [](const py::object& self) {
            return view<std::uint32_t>(std::span(self.cast<const CaptureRows&>().weights()), self);
          },
          "What each of them counts in coverage: read-only.")
      .def_property_readonly("goal_density", &CaptureRows::goal_density, "Points wanted in a voxel.")
      .def_property_readonly("cancelled", &CaptureRows::cancelled, "The last stations have no rows.")
      .def(
          "coverage",
          [](const CaptureRows& rows, const std::optional<Rows>& chosen) {
            for (const std::size_t row : chosen.value_or(Rows{}))
              if (row >= rows.size())
                throw py::index_error("row " + std::to_string(row) + " of " + std::to_string(rows.size()));
            return chosen ? rows.coverage(*chosen) : rows.coverage();
          },
          py::arg("rows") = py::none(), "(value, standard error) of equation 8 for a network of these; None: of all.");
  m.def(
      "capture_rows",
      [](GuardedSimulator& self, const std::vector<PlacedStation>& stations, std::uint64_t sample_voxels,
         py::object progress) {
        LongCall call(std::move(progress));
        return call.run([&] { return capture_rows(self.simulator, stations, sample_voxels, call.progress()); });
      },
      py::arg("simulator"), py::arg("stations"), py::kw_only(), py::arg("sample_voxels") = 20'000,
      py::arg("progress") = py::none(), "A row for each station; those that are not 'ok' have empty ones.");
}

void add_finding(py::module_& m) {
  py::class_<Candidates>(m, "Candidates", "Evenly spread allowed positions, and what they capture.")
      .def_property_readonly("stations", &Candidates::stations, "The positions, all 'ok'.")
      .def_property_readonly("rows", &Candidates::rows, "What each captures, in that order.")
      .def_property_readonly("visible", &Candidates::visible,
                             "What can be seen: (coverage, standard error) with a station on every candidate.")
      .def_property_readonly("change", &Candidates::change, "By what share the last doubling changed that.")
      .def_property_readonly("ended", &Candidates::ended,
                             "Why there are no more: 'enough', 'all', 'most', 'time' or 'cancelled'.")
      .def_property_readonly("spacing_m", &Candidates::spacing_m, "Typical distance between neighbours.")
      .def("__len__", [](const Candidates& found) { return found.stations().size(); });
  const auto options =
      Options<CandidateConfig>("find_candidates")
          .add("first", &CandidateConfig::first, "How many to begin with; then twice as many, and so on.")
          .add("most", &CandidateConfig::most, "And no more than this.")
          .add("change", &CandidateConfig::change, "Enough once doubling changes what all capture by less, as a share.")
          .add("sample_voxels", &CandidateConfig::sample_voxels, "0: every voxel.")
          .add("scanner", &CandidateConfig::scanner, "Which of the simulator's scanners stands on each.")
          .add("max_seconds", &CandidateConfig::max_seconds, "Stop growing after so long; 0: no limit.");
  m.def(
      "find_candidates",
      [options](GuardedSimulator& self, const SearchArea& area, const ClashChecker& clash, py::object progress,
                const py::kwargs& given) {
        const CandidateConfig config = options.read(given);
        LongCall call(std::move(progress));
        return call.run([&] { return find_candidates(self.simulator, area, clash, config, call.progress()); });
      },
      py::arg("simulator"), py::arg("area"), py::arg("clash"), py::kw_only(), py::arg("progress") = py::none(),
      ("Allowed positions at the scanner's height, spread evenly, doubled in number until what all of them capture\n"
       "together hardly changes. Raises Error invalid_argument where none is allowed." +
       options.doc())
          .c_str());
}

Options<BoundConfig> bound_options(const char* name) {
  return Options<BoundConfig>(name)
      .add("tolerance", &BoundConfig::tolerance, "How exactly the relaxation is solved, in coverage.")
      .add("max_seconds", &BoundConfig::max_seconds, "For each relaxation; 0: no limit.")
      .add("exact_seconds", &BoundConfig::exact_seconds, "For branch and bound; 0: greedy and swaps only.");
}

void add_bounds(py::module_& m) {
  py::class_<CaptureBound>(m, "CaptureBound", "What any number of stations captures at most.")
      .def_readonly("stations", &CaptureBound::stations, "Without those that are fixed.")
      .def_readonly("bound", &CaptureBound::bound, "No so many candidates have more coverage on the sample: proven.")
      .def_readonly("relaxation", &CaptureBound::relaxation, "What fractions of candidates reach.")
      .def_readonly("complete", &CaptureBound::complete, "The relaxation came to its tolerance in time.")
      .def_readonly("spacing_term", &CaptureBound::spacing_term,
                    "What a position between candidates can add, measured.")
      .def_readonly("half_bound", &CaptureBound::half_bound, "The bound of the first half of the candidates.")
      .def_readonly("chosen", &CaptureBound::chosen, "The best rows found, the fixed ones first.")
      .def_readonly("reached", &CaptureBound::reached, "Their coverage: (value, standard error).")
      .def_property_readonly("gap", &CaptureBound::gap, "How much better any choice can be, as a share of `reached`.");
  py::class_<StationsBound>(m, "StationsBound", "How many stations a wanted coverage takes.")
      .def_readonly("possible", &StationsBound::possible, "Whether all candidates together capture as much.")
      .def_readonly("at_least", &StationsBound::at_least, "No fewer candidates have it: proven.")
      .def_readonly("relaxation", &StationsBound::relaxation, "The bound before it is rounded up.")
      .def_readonly("complete", &StationsBound::complete, "The relaxation came to its tolerance in time.")
      .def_readonly("chosen", &StationsBound::chosen, "A choice that has it: the fixed rows first.");
  const auto capture = bound_options("bound_capture"), wanted = bound_options("bound_stations");
  m.def(
      "bound_capture",
      [capture](const CaptureRows& rows, std::size_t count, const Rows& fixed, py::object progress,
                const py::kwargs& given) {
        const BoundConfig config = capture.read(given);
        LongCall call(std::move(progress));
        return call.run([&] { return bound_capture(rows, count, fixed, config, call.progress()); });
      },
      py::arg("rows"), py::arg("stations"), py::arg("fixed") = Rows{}, py::kw_only(), py::arg("progress") = py::none(),
      ("What any `stations` rows besides the fixed ones capture at most, and a good choice of them (docs/bounds.md)." +
       capture.doc())
          .c_str());
  m.def(
      "bound_stations",
      [wanted](const CaptureRows& rows, double share, const Rows& fixed, py::object progress, const py::kwargs& given) {
        const BoundConfig config = wanted.read(given);
        LongCall call(std::move(progress));
        return call.run([&] { return bound_stations(rows, share, fixed, config, call.progress()); });
      },
      py::arg("rows"), py::arg("capture"), py::arg("fixed") = Rows{}, py::kw_only(), py::arg("progress") = py::none(),
      ("How many rows a coverage of `capture` takes at least. Raises Error invalid_argument unless 0 < capture <= 1." +
       wanted.doc())
          .c_str());
  const auto linked = bound_options("bound_linked_capture");
  m.def(
      "bound_linked_capture",
      [linked](const CaptureRows& rows, std::size_t count, const std::vector<RowLink>& links, const Rows& fixed,
               py::object progress, const py::kwargs& given) {
        const BoundConfig config = linked.read(given);
        LongCall call(std::move(progress));
        return call.run([&] { return bound_linked_capture(rows, count, links, fixed, config, call.progress()); });
      },
      py::arg("rows"), py::arg("stations"), py::arg("links"), py::arg("fixed") = Rows{}, py::kw_only(),
      py::arg("progress") = py::none(),
      ("The same of networks that hang together along some of `links`, pairs of rows; `chosen` is empty where none "
       "was\n"
       "found." +
       linked.doc())
          .c_str());
  m.def(
      "links_between",
      [](GuardedSimulator& self, const std::vector<PlacedStation>& stations, double least, std::uint64_t sample_voxels,
         py::object progress) {
        LongCall call(std::move(progress));
        return call.run(
            [&] { return links_between(self.surroundings(), stations, least, sample_voxels, call.progress()); });
      },
      py::arg("simulator"), py::arg("stations"), py::arg("least"), py::kw_only(), py::arg("sample_voxels") = 10'000,
      py::arg("progress") = py::none(),
      "Pairs of stations whose scans overlap by at least `least` over all surfaces, as a share of the smaller scan.");
  m.def(
      "choose_rows",
      [](const CaptureRows& rows, std::size_t count, const Rows& fixed, py::object progress) {
        LongCall call(std::move(progress));
        return call.run([&] { return choose_rows(rows, count, fixed, call.progress()); });
      },
      py::arg("rows"), py::arg("stations"), py::arg("fixed") = Rows{}, py::kw_only(), py::arg("progress") = py::none(),
      "The best choice found of `stations` rows besides the fixed ones: fixed and chosen rows.");
}

void add_greedy(py::module_& m) {
  py::class_<GreedyResult>(m, "GreedyResult", "What `greedy_network` chose.")
      .def_readonly("stations", &GreedyResult::stations, "In the order of choosing: the first k are the choice for k.")
      .def_readonly("coverage", &GreedyResult::coverage, "After each.")
      .def_readonly("evaluations", &GreedyResult::evaluations, "Networks that were evaluated.")
      .def_readonly("cancelled", &GreedyResult::cancelled, "Stopped before its end.");
  const auto options = Options<GreedyConfig>("greedy_network")
                           .add("candidates", &GreedyConfig::candidates, "Positions to choose from, even in (u, v).")
                           .add("sample_voxels", &GreedyConfig::sample_voxels, "0: with every ray.")
                           .add("fixed", &GreedyConfig::fixed, "Heads of stations that are there already.")
                           .add("fixed_setups", &GreedyConfig::fixed_setups,
                                "Their StationSetups, one each; none: upright, with the first scanner.");
  m.def(
      "greedy_network",
      [options](GuardedSimulator& self, const SearchArea& area, const ClashChecker& clash, std::size_t stations,
                py::object progress, const py::kwargs& given) {
        GreedyConfig config = options.read(given);
        config.stations = stations;
        LongCall call(std::move(progress));
        return call.run([&] { return greedy_network(self.simulator, area, clash, config, call.progress()); });
      },
      py::arg("simulator"), py::arg("area"), py::arg("clash"), py::arg("stations"), py::kw_only(),
      py::arg("progress") = py::none(),
      ("Takes the candidate that adds most coverage, again and again: a baseline, and a first network for\n"
       "`plan(start=...)`." +
       options.doc())
          .c_str());
}

void add_exact(py::module_& m) {
  py::class_<ExactResult>(m, "ExactResult", "What `exact_network` chose.")
      .def_readonly("stations", &ExactResult::stations, "Empty where none that hangs together was found.")
      .def_readonly("choice", &ExactResult::choice, "Its coverage, and the most that any choice of candidates has.")
      .def_readonly("cancelled", &ExactResult::cancelled, "Stopped before its end.");
  const auto options =
      Options<ExactConfig>("exact_network")
          .add("candidates", &ExactConfig::candidates, "Positions to choose from, spread evenly over the ground.")
          .add("sample_voxels", &ExactConfig::sample_voxels, "0: every voxel.")
          .add("link", &ExactConfig::link, "Least scan overlap along some spanning tree; 0: any.")
          .add("apart_m", &ExactConfig::apart_m, "Least distance between heads.")
          .add("max_seconds", &ExactConfig::max_seconds, "Of branch and bound.")
          .add("fixed", &ExactConfig::fixed, "Heads of stations that are there already.");
  m.def(
      "exact_network",
      [options](GuardedSimulator& self, const SearchArea& area, const ClashChecker& clash, std::size_t stations,
                py::object progress, const py::kwargs& given) {
        ExactConfig config = options.read(given);
        config.stations = stations;
        LongCall call(std::move(progress));
        return call.run([&] { return exact_network(self.simulator, area, clash, config, call.progress()); });
      },
      py::arg("simulator"), py::arg("area"), py::arg("clash"), py::arg("stations"), py::kw_only(),
      py::arg("progress") = py::none(),
      ("The best network among candidates, as an integer program: without a gap the best there is among them." +
       options.doc())
          .c_str());
}

}  // namespace

void add_candidates(py::module_& m) {
  add_rows(m);
  add_finding(m);
  add_bounds(m);
  add_greedy(m);
  add_exact(m);
}

}  // namespace vantage::python
