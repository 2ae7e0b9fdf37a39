// SPDX-License-Identifier: Apache-2.0
#include "arrays.hpp"
#include "module.hpp"
#include "options.hpp"
#include "simulator.hpp"

namespace vantage::python {
namespace {

using Chosen = std::vector<std::size_t>;

void check_candidates(const Chosen& chosen, std::size_t candidates) {
  for (const std::size_t k : chosen)
    if (k >= candidates) throw py::index_error("candidate " + std::to_string(k) + " of " + std::to_string(candidates));
}

void add_matrix(py::module_& m) {
  py::class_<CoverageMatrix>(m, "CoverageMatrix",
                             "What each candidate adds to each element, sparse: candidates are columns. An element is\n"
                             "covered once the amounts of the chosen candidates add up to the goal.")
      .def(py::init([](std::vector<std::uint32_t> weights, double goal,
                       const std::vector<std::vector<std::uint32_t>>& amounts) {
             if (!(goal > 0))
               throw Error(Errc::invalid_argument,
                           "CoverageMatrix: the goal is " + std::to_string(goal) + ", but must be above 0");
             CoverageMatrix matrix(std::move(weights), goal);
             for (const std::vector<std::uint32_t>& column : amounts) {
               if (column.size() != matrix.elements())
                 throw Error(Errc::invalid_argument, "CoverageMatrix: a candidate has " +
                                                         std::to_string(column.size()) + " amounts for " +
                                                         std::to_string(matrix.elements()) + " elements");
               matrix.add(std::span<const std::uint32_t>(column));
             }
             return matrix;
           }),
           py::arg("weights"), py::arg("goal"), py::arg("amounts"),
           "From a weight for each element, and for each candidate its amount in each element.")
      .def("__len__", &CoverageMatrix::candidates)
      .def(
          "column",
          [](const py::object& self, std::size_t k) {
            const auto& matrix = self.cast<const CoverageMatrix&>();
            check_candidates({k}, matrix.candidates());
            return view<std::uint32_t>(matrix.column(k), self, 2);
          },
          py::arg("candidate"), "Pairs (element, amount) of what a candidate covers: (m, 2), read-only.")
      .def_property_readonly(
          "weights",
          [](const py::object& self) {
            return view<std::uint32_t>(std::span(self.cast<const CoverageMatrix&>().weights()), self);
          },
          "What each element counts in coverage: read-only.")
      .def_property_readonly("goal", &CoverageMatrix::goal, "The amount that covers an element.")
      .def(
          "coverage",
          [](const CoverageMatrix& matrix, const Chosen& chosen) {
            check_candidates(chosen, matrix.candidates());
            return matrix.coverage(chosen);
          },
          py::arg("chosen"), "The share of all weight that these candidates cover.");
  py::class_<SampledCoverage>(m, "SampledCoverage",
                              "What stations cover one by one of a sample of voxels: points add up, so that one pass\n"
                              "over single stations answers which of them to take.")
      .def("__len__", &SampledCoverage::size)
      .def_property_readonly("matrix", &SampledCoverage::matrix, py::return_value_policy::reference_internal,
                             "CoverageMatrix: candidates are the stations, elements the voxels, amounts points.")
      .def_property_readonly(
          "voxels",
          [](const py::object& self) {
            return view<std::uint32_t>(std::span(self.cast<const SampledCoverage&>().voxels()), self);
          },
          "The voxel of each element, by the order of `Simulator.voxel_centres`, ascending: read-only.")
      .def_property_readonly("cancelled", &SampledCoverage::cancelled, "The last stations are missing.")
      .def(
          "coverage",
          [](const SampledCoverage& sampled, const std::optional<Chosen>& stations) {
            check_candidates(stations.value_or(Chosen{}), sampled.size());
            return stations ? sampled.coverage(*stations) : sampled.coverage();
          },
          py::arg("stations") = py::none(),
          "(value, standard error) of equation 8 for a network of these; None: of all.");
  m.def(
      "sample_coverage",
      [](Simulators& self, const std::vector<PlacedStation>& stations, std::uint64_t sample_voxels,
         py::object progress) {
        LongCall call(std::move(progress));
        return call.run([&] { return sample_coverage(self.simulator, stations, sample_voxels, call.progress()); });
      },
      py::arg("simulator"), py::arg("stations"), py::kw_only(), py::arg("sample_voxels") = 20'000,
      py::arg("progress") = py::none(), "Traces stations one by one; those that are not 'ok' cover nothing.");
}

void add_graph(py::module_& m) {
  py::class_<StationGraph>(m, "StationGraph", "How much each two candidates overlap, and which two exclude each other.")
      .def(py::init([](const Doubles& overlaps, const std::vector<std::array<std::size_t, 2>>& excluded) {
             if (overlaps.ndim() != 2 || overlaps.shape(0) != overlaps.shape(1))
               throw Error(
                   Errc::invalid_argument,
                   "StationGraph: an array of shape (n, n) is wanted, and this one's is " + shape_text(overlaps));
             const auto* first = overlaps.data();
             StationGraph graph(static_cast<std::size_t>(overlaps.shape(0)),
                                std::vector<float>(first, first + overlaps.size()));
             for (const auto& [i, j] : excluded) {
               check_candidates({i, j}, graph.size());
               graph.exclude(i, j);
             }
             return graph;
           }),
           py::arg("overlaps"), py::arg("excluded") = std::vector<std::array<std::size_t, 2>>{},
           "From the overlap of each pair, (n, n) and symmetric, and the pairs that no network may have.")
      .def("__len__", &StationGraph::size)
      .def_property_readonly(
          "overlaps",
          [](const py::object& self) {
            const auto& graph = self.cast<const StationGraph&>();
            return view<float>(graph.overlaps(), self, std::max<std::size_t>(graph.size(), 1));
          },
          "The overlap of each pair: (n, n), read-only.");
  m.def(
      "overlap_graph",
      [](Simulators& self, const std::vector<PlacedStation>& stations, std::uint64_t sample_voxels,
         py::object progress) {
        LongCall call(std::move(progress));
        return call.run([&] { return overlap_graph(self.surroundings(), stations, sample_voxels, call.progress()); });
      },
      py::arg("simulator"), py::arg("stations"), py::kw_only(), py::arg("sample_voxels") = 10'000,
      py::arg("progress") = py::none(), "Scan overlap of each pair over all surfaces, as a share of the smaller scan.");
}

void add_finding(py::module_& m) {
  py::class_<Candidates>(m, "Candidates", "Evenly spread allowed positions, and what stations on them cover.")
      .def_property_readonly("stations", &Candidates::stations, "The positions, all 'ok'.")
      .def_property_readonly("coverage", &Candidates::coverage, py::return_value_policy::reference_internal,
                             "SampledCoverage of these stations, in that order.")
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
      [options](Simulators& self, const SearchArea& area, const ClashChecker& clash, py::object progress,
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
  py::class_<CoverSolution>(m, "CoverSolution", "A network of candidates, and what is known of others.")
      .def_readonly("chosen", &CoverSolution::chosen, "Existing candidates, then those chosen; empty: none was found.")
      .def_readonly("coverage", &CoverSolution::coverage, "Of the chosen.")
      .def_readonly("link", &CoverSolution::link, "The weakest link of the strongest spanning tree.")
      .def_readonly("violation", &CoverSolution::violation,
                    "How far it is from what is wanted: the share of the coverage that is short, and 0.2 for each\n"
                    "missing link.")
      .def_readonly("bound", &CoverSolution::bound,
                    "By `max_cover`: no network of as many candidates has more coverage. Proven.")
      .def_readonly("relaxation", &CoverSolution::relaxation, "Coverage of fractions of candidates.")
      .def_readonly("complete", &CoverSolution::complete, "The relaxation came to its tolerance in time.")
      .def_readonly("half_bound", &CoverSolution::half_bound, "The bound of the first half of the candidates.")
      .def_readonly("spacing_term", &CoverSolution::spacing_term,
                    "What positions between candidates can add, measured: how much more the bound of all is.")
      .def_property_readonly("gap", &CoverSolution::gap,
                             "How much more coverage a network may have, as a share of this one's.");
  py::class_<StationsBound>(m, "StationsBound", "How many stations a wanted coverage takes.")
      .def_readonly("possible", &StationsBound::possible, "Whether all candidates together have the coverage.")
      .def_readonly("at_least", &StationsBound::at_least, "No fewer further candidates have it. Proven.")
      .def_readonly("relaxation", &StationsBound::relaxation, "The bound before it is rounded up.")
      .def_readonly("complete", &StationsBound::complete, "The relaxation came to its tolerance in time.")
      .def_readonly("chosen", &StationsBound::chosen, "A network that has it, existing candidates first.");
  const auto of_coverage = bound_options("max_cover"), of_number = bound_options("min_cover");
  m.def(
      "max_cover",
      [of_coverage](const CoverageMatrix& matrix, std::size_t stations, const Chosen& existing,
                    const StationGraph* graph, double link, py::object progress, const py::kwargs& given) {
        const BoundConfig config = of_coverage.read(given);
        LongCall call(std::move(progress));
        const CoverProblem problem{
            .matrix = matrix, .graph = graph, .existing = existing, .most = stations, .link = link};
        return call.run([&] { return max_cover(problem, config, call.progress()); });
      },
      py::arg("matrix"), py::arg("stations"), py::arg("existing") = Chosen{}, py::kw_only(),
      py::arg("graph") = py::none(), py::arg("link") = 0.0, py::arg("progress") = py::none(),
      ("The most coverage of `stations` candidates besides the existing ones: a good network, and a bound that none\n"
       "exceeds (docs/bounds.md). `link`: least overlap in `graph` of links that connect the network; 0: it need not "
       "be\n"
       "connected." +
       of_coverage.doc())
          .c_str());
  m.def(
      "min_cover",
      [of_number](const CoverageMatrix& matrix, double coverage, const Chosen& existing, py::object progress,
                  const py::kwargs& given) {
        const BoundConfig config = of_number.read(given);
        LongCall call(std::move(progress));
        const CoverProblem problem{.matrix = matrix, .existing = existing, .coverage = coverage};
        return call.run([&] { return min_cover(problem, config, call.progress()); });
      },
      py::arg("matrix"), py::arg("coverage"), py::arg("existing") = Chosen{}, py::kw_only(),
      py::arg("progress") = py::none(),
      ("How many candidates a coverage takes at least. Raises Error invalid_argument unless 0 < coverage <= 1." +
       of_number.doc())
          .c_str());
}

void add_choices(py::module_& m) {
  m.def(
      "greedy",
      [](const CoverageMatrix& matrix, std::size_t stations, const Chosen& existing) {
        const py::gil_scoped_release released;
        return greedy({.matrix = matrix, .existing = existing, .most = stations});
      },
      py::arg("matrix"), py::arg("stations"), py::arg("existing") = Chosen{},
      "Takes the candidate that adds most coverage, again and again: existing and chosen candidates, in order. Fewer\n"
      "than `stations` where none adds anything.");
  m.def(
      "improve_by_swaps",
      [](const CoverageMatrix& matrix, const Chosen& chosen, const Chosen& existing, py::object progress) {
        check_candidates(chosen, matrix.candidates());
        if (chosen.size() < existing.size() || !std::equal(existing.begin(), existing.end(), chosen.begin()))
          throw Error(Errc::invalid_argument,
                      "improve_by_swaps: the chosen have to begin with the existing candidates");
        LongCall call(std::move(progress));
        return call.run(
            [&] { return improve_by_swaps({.matrix = matrix, .existing = existing}, chosen, call.progress().stop); });
      },
      py::arg("matrix"), py::arg("chosen"), py::arg("existing") = Chosen{}, py::kw_only(),
      py::arg("progress") = py::none(),
      "Replaces one chosen candidate by another for as long as coverage grows. Existing ones, the first, stay.");
  m.def(
      "min_connected_cover",
      [](const CoverageMatrix& matrix, double coverage, const StationGraph& graph, double link, const Chosen& existing,
         std::optional<std::size_t> most, py::object progress) {
        CoverProblem problem{
            .matrix = matrix, .graph = &graph, .existing = existing, .coverage = coverage, .link = link};
        if (most) problem.most = *most;
        LongCall call(std::move(progress));
        return call.run([&] { return min_connected_cover(problem, call.progress().stop).best; });
      },
      py::arg("matrix"), py::arg("coverage"), py::arg("graph"), py::arg("link"), py::arg("existing") = Chosen{},
      py::kw_only(), py::arg("most") = py::none(), py::arg("progress") = py::none(),
      "A network of few candidates with that coverage, connected by overlaps of `link`, by tabu search; of at most\n"
      "`most` besides the existing ones. `violation` is 0 where it has both.");
}

void add_greedy(py::module_& m) {
  py::class_<GreedyResult>(m, "GreedyResult", "What `greedy_network` chose.")
      .def_readonly("stations", &GreedyResult::stations, "In the order of choosing: the first k are the choice for k.")
      .def_readonly("coverage", &GreedyResult::coverage, "After each.")
      .def_readonly("cancelled", &GreedyResult::cancelled, "Stopped before its end.");
  const auto options =
      Options<GreedyConfig>("greedy_network")
          .add("candidates", &GreedyConfig::candidates, "Positions to choose from, spread evenly over the ground.")
          .add("sample_voxels", &GreedyConfig::sample_voxels, "0: every voxel.")
          .add("existing", &GreedyConfig::existing, "Heads of stations that are there already.")
          .add("existing_setups", &GreedyConfig::existing_setups,
               "Their StationSetups, one each; none: upright, with the first scanner.");
  m.def(
      "greedy_network",
      [options](Simulators& self, const SearchArea& area, const ClashChecker& clash, std::size_t stations,
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
      .def_readonly("stations", &ExactResult::stations, "Empty where no connected network was found.")
      .def_readonly("choice", &ExactResult::choice, "The choice among candidates, and the most coverage that any has.")
      .def_readonly("cancelled", &ExactResult::cancelled, "Stopped before its end.");
  const auto options =
      Options<ExactConfig>("exact_network")
          .add("candidates", &ExactConfig::candidates, "Positions to choose from, spread evenly over the ground.")
          .add("sample_voxels", &ExactConfig::sample_voxels, "0: every voxel.")
          .add("link", &ExactConfig::link, "Least scan overlap of links that connect it; 0: none.")
          .add("apart_m", &ExactConfig::apart_m, "Least distance between heads.")
          .add("max_seconds", &ExactConfig::max_seconds, "Of branch and bound.")
          .add("existing", &ExactConfig::existing, "Heads of stations that are there already.");
  m.def(
      "exact_network",
      [options](Simulators& self, const SearchArea& area, const ClashChecker& clash, std::size_t stations,
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
  add_matrix(m);
  add_graph(m);
  add_finding(m);
  add_bounds(m);
  add_choices(m);
  add_greedy(m);
  add_exact(m);
}

}  // namespace vantage::python
