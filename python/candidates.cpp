// SPDX-License-Identifier: Apache-2.0
#include "vantage/candidates.hpp"

#include "arrays.hpp"
#include "module.hpp"
#include "options.hpp"
#include "site.hpp"

namespace vantage::python {
namespace {

using Chosen = std::vector<std::size_t>;
using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

void check_candidates(const Chosen& chosen, std::size_t candidates) {
  for (const std::size_t k : chosen)
    if (k >= candidates) throw py::index_error("candidate " + std::to_string(k) + " of " + std::to_string(candidates));
}

void add_matrix(py::module_& m) {
  py::class_<CoverageMatrix>(
      m, "CoverageMatrix",
      "Sparse matrix of the amount that each candidate adds to each element: candidates are columns. An element "
      "is\ncovered once the amounts of the chosen candidates add up to the goal.")
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
           "weights: one for each element. amounts: for each candidate its amount in each element.")
      .def("__len__", &CoverageMatrix::candidates)
      .def(
          "column",
          [](const py::object& self, std::size_t k) {
            const auto& matrix = self.cast<const CoverageMatrix&>();
            check_candidates({k}, matrix.candidates());
            return view<std::uint32_t>(matrix.column(k), self, 2);
          },
          py::arg("candidate"), "Pairs (element, amount) of a candidate: (m, 2), read-only.")
      .def_property_readonly(
          "weights",
          [](const py::object& self) {
            return view<std::uint32_t>(std::span(self.cast<const CoverageMatrix&>().weights()), self);
          },
          "Weight of each element in coverage: read-only.")
      .def_property_readonly(
          "goal", [](const CoverageMatrix& matrix) { return matrix.goal(); }, "The amount that covers an element.")
      .def(
          "coverage",
          [](const CoverageMatrix& matrix, const Chosen& chosen) {
            check_candidates(chosen, matrix.candidates());
            return matrix.coverage(chosen);
          },
          py::arg("chosen"), "Share of all weight that these candidates cover.");
  py::class_<SampledCoverage>(m, "SampledCoverage",
                              "Points of single stations in a sample of the voxels. Points add up, so one pass over "
                              "single stations answers\nwhich of them to take.")
      .def("__len__", &SampledCoverage::size)
      .def_property_readonly("matrix", &SampledCoverage::matrix, py::return_value_policy::reference_internal,
                             "CoverageMatrix: candidates are the stations, elements the voxels, amounts points.")
      .def_property_readonly(
          "voxels",
          [](const py::object& self) {
            return view<std::uint32_t>(std::span(self.cast<const SampledCoverage&>().voxels()), self);
          },
          "Voxel of each element, in the order of `Simulator.voxel_centres`, ascending: read-only.")
      .def_property_readonly("cancelled", &SampledCoverage::cancelled, "Whether the last stations are missing.")
      .def(
          "coverage",
          [](const SampledCoverage& sampled, const std::optional<Chosen>& stations) {
            check_candidates(stations.value_or(Chosen{}), sampled.size());
            return stations ? sampled.coverage(*stations) : sampled.coverage();
          },
          py::arg("stations") = py::none(),
          "(value, standard error) of equation 8 for a network of these stations; None: of all.");
  m.def(
      "sample_coverage",
      [](Simulators& self, const std::vector<PlacedStation>& stations, std::uint64_t sample_voxels, Listener progress) {
        LongCall call(std::move(progress));
        return call.run([&] { return sample_coverage(self.simulator, stations, sample_voxels, call.progress()); });
      },
      py::arg("simulator"), py::arg("stations"), py::kw_only(), py::arg("sample_voxels") = 20'000,
      py::arg("progress") = py::none(), "Traces stations one by one. Those that are not 'ok' cover nothing.");
}

void add_graph(py::module_& m) {
  py::class_<StationGraph>(m, "StationGraph",
                           "Overlap of each pair of candidates, and the pairs that exclude each other.")
      .def(py::init([](const Doubles& overlaps, const Pairs& excluded) {
             if (overlaps.ndim() != 2 || overlaps.shape(0) != overlaps.shape(1))
               throw Error(
                   Errc::invalid_argument,
                   "StationGraph: an array of shape (n, n) is wanted, and this one's is " + shape_text(overlaps));
             const auto* first = overlaps.data();
             const std::vector<float> values(first, first + overlaps.size());
             StationGraph graph(static_cast<std::size_t>(overlaps.shape(0)), values);
             for (const auto& [i, j] : excluded) {
               check_candidates({i, j}, graph.size());
               graph.exclude(i, j);
             }
             return graph;
           }),
           py::arg("overlaps"), py::arg("excluded") = Pairs{},
           "overlaps: of each pair, (n, n) and symmetric. excluded: pairs that no network may have.")
      .def("__len__", &StationGraph::size)
      .def_property_readonly(
          "overlaps",
          [](const StationGraph& graph) {
            const std::size_t size = graph.size();
            std::vector<float> all(size * size, 0);
            for (std::size_t i = 0; i < size; ++i)
              for (const StationGraph::Overlap& other : graph.overlaps(i))
                all[i * size + other.candidate] = other.share;
            const auto n = static_cast<py::ssize_t>(size);
            return adopt<float>(std::move(all), {n, n});
          },
          "Overlap of each pair: (n, n), a copy.");
  m.def(
      "overlap_graph",
      [](Simulators& self, const std::vector<PlacedStation>& stations, std::uint64_t sample_voxels, Listener progress) {
        LongCall call(std::move(progress));
        return call.run([&] { return overlap_graph(self.surroundings(), stations, sample_voxels, call.progress()); });
      },
      py::arg("simulator"), py::arg("stations"), py::kw_only(), py::arg("sample_voxels") = 10'000,
      py::arg("progress") = py::none(), "Scan overlap of each pair over all surfaces, as a share of the smaller scan.");
}

template <class Config>
std::optional<std::uint64_t> sample_of(const Config& config) {
  return config.sample_voxels == every_voxel ? std::nullopt : std::optional(config.sample_voxels);
}

void add_finding(py::module_& m) {
  py::class_<Candidates>(m, "Candidates", "Evenly spread allowed positions, and the coverage of stations on them.")
      .def_property_readonly("stations", &Candidates::stations, "The positions, all 'ok'.")
      .def_property_readonly("coverage", &Candidates::coverage, py::return_value_policy::reference_internal,
                             "SampledCoverage of these stations, in that order.")
      .def_property_readonly("attainable", &Candidates::attainable,
                             "Attainable coverage, with its standard error: by the best candidate for each voxel.")
      .def_property_readonly("captured_matrix", &Candidates::captured_matrix,
                             "Coverage matrix of the share of what is attainable.")
      .def_property_readonly("change", &Candidates::change, "By what share the last doubling raised that.")
      .def_property_readonly(
          "ended",
          [](const Candidates& found) {
            return Typed<"Literal['enough', 'all', 'most', 'time', 'cancelled']", py::str>(found.ended());
          },
          "Why growth ended: 'enough', 'all', 'most', 'time' or 'cancelled'.")
      .def_property_readonly("spacing_m", &Candidates::spacing_m, "Typical distance between neighbours.")
      .def("__len__", [](const Candidates& found) { return found.stations().size(); });
  const auto options =
      Options<CandidateConfig>("find_candidates")
          .add("first", &CandidateConfig::first, "Initial number; it is doubled until a limit holds.")
          .add("most", &CandidateConfig::most, "Largest number.")
          .add("change", &CandidateConfig::change,
               "Stops once doubling changes their common coverage by less than this share.")
          .add<std::optional<std::uint64_t>>(
              "sample_voxels", [](const CandidateConfig& c) { return sample_of(c); },
              [](CandidateConfig& c, std::optional<std::uint64_t> voxels) {
                c.sample_voxels = voxels.value_or(every_voxel);
              },
              "Size of the sample of voxels; None: every voxel.")
          .add("scanner", &CandidateConfig::scanner, "Scanner on each, an index into `Simulator.scanners`.")
          .add("max_seconds", &CandidateConfig::max_seconds, "Time limit for growing; 0: none.");
  m.def(
      "find_candidates",
      [options](GuardedSite& self, Listener progress, const py::kwargs& given) {
        const CandidateConfig config = options.read(given);
        const auto lock = self.taken();
        LongCall call(std::move(progress));
        return call.run([&] { return find_candidates(self.site, config, call.progress()); });
      },
      py::arg("site"), py::kw_only(), py::arg("progress") = py::none(),
      ("Allowed positions at the scanner's height, spread evenly. Their number doubles until their common "
       "coverage\nhardly changes. Raises Error invalid_argument if none is allowed." +
       options.doc())
          .c_str());
}

Options<BoundConfig> bound_options(const char* name) {
  return Options<BoundConfig>(name)
      .add("tolerance", &BoundConfig::tolerance, "Accuracy of the relaxation, in coverage.")
      .add("max_seconds", &BoundConfig::max_seconds, "Time limit of each relaxation; 0: none.")
      .add("exact_seconds", &BoundConfig::exact_seconds, "Time for branch and bound; 0: greedy and swaps only.");
}

void add_bounds(py::module_& m) {
  py::class_<CoverSolution>(m, "CoverSolution", "A network of candidates, and bounds on others.")
      .def_readonly("chosen", &CoverSolution::chosen, "Existing candidates, then the others; empty: none was found.")
      .def_readonly("coverage", &CoverSolution::coverage, "Coverage of `chosen`.")
      .def_readonly("link", &CoverSolution::link, "Weakest link of the maximum spanning tree.")
      .def_readonly("violation", &CoverSolution::violation,
                    "Missing share of the wanted coverage, and 0.2 for each missing link; 0: feasible.")
      .def_readonly("bound", &CoverSolution::bound,
                    "From `max_cover`: a proven upper bound on the coverage of as many candidates.")
      .def_readonly("relaxation", &CoverSolution::relaxation, "Coverage of a fractional choice.")
      .def_readonly("complete", &CoverSolution::complete, "Whether the relaxation reached its tolerance in time.")
      .def_readonly("half_bound", &CoverSolution::half_bound, "Bound for the first half of the candidates.")
      .def_readonly("spacing_term", &CoverSolution::spacing_term,
                    "Growth of the bound from that half to all: measures what positions between candidates can add.")
      .def_property_readonly("gap", &CoverSolution::gap, "Possible gain in coverage, as a share of this network's.");
  py::class_<StationsBound>(m, "StationsBound", "Bound on the number of stations for a wanted coverage.")
      .def_readonly("possible", &StationsBound::possible, "Whether all candidates together reach the coverage.")
      .def_readonly("at_least", &StationsBound::at_least, "Proven lower bound on the number of further candidates.")
      .def_readonly("relaxation", &StationsBound::relaxation, "The bound before it is rounded up.")
      .def_readonly("complete", &StationsBound::complete, "Whether the relaxation reached its tolerance in time.")
      .def_readonly("chosen", &StationsBound::chosen, "A network that reaches it, existing candidates first.");
  const auto of_coverage = bound_options("max_cover"), of_number = bound_options("min_cover");
  m.def(
      "max_cover",
      [of_coverage](const CoverageMatrix& matrix, std::size_t stations, const Chosen& existing,
                    std::optional<std::reference_wrapper<const StationGraph>> graph, double link, Listener progress,
                    const py::kwargs& given) {
        const BoundConfig config = of_coverage.read(given);
        LongCall call(std::move(progress));
        const CoverProblem problem{.matrix = matrix,
                                   .graph = graph ? &graph->get() : nullptr,
                                   .existing = existing,
                                   .most = stations,
                                   .link = link};
        return call.run([&] { return max_cover(problem, config, call.progress()); });
      },
      py::arg("matrix"), py::arg("stations"), py::arg("existing") = Chosen{}, py::kw_only(),
      py::arg("graph") = py::none(), py::arg("link") = 0.0, py::arg("progress") = py::none(),
      ("The most coverage of `stations` candidates besides the existing ones: a good network, and a bound for "
       "all\nothers (docs/bounds.md). `link`: least overlap in `graph` of the links that connect the network; 0: it "
       "need not\nbe connected. Raises Error invalid_argument: no candidates, or 0 stations." +
       of_coverage.doc())
          .c_str());
  m.def(
      "min_cover",
      [of_number](const CoverageMatrix& matrix, double coverage, const Chosen& existing, Listener progress,
                  const py::kwargs& given) {
        const BoundConfig config = of_number.read(given);
        LongCall call(std::move(progress));
        const CoverProblem problem{.matrix = matrix, .existing = existing, .coverage = coverage};
        return call.run([&] { return min_cover(problem, config, call.progress()); });
      },
      py::arg("matrix"), py::arg("coverage"), py::arg("existing") = Chosen{}, py::kw_only(),
      py::arg("progress") = py::none(),
      ("Least number of candidates for a coverage. Raises Error invalid_argument unless 0 < coverage <= 1." +
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
      "Adds the candidate with the largest gain in coverage, again and again. Returns existing, then "
      "chosen\ncandidates in order; fewer than `stations` if none adds anything.");
  m.def(
      "improve_by_swaps",
      [](const CoverageMatrix& matrix, const Chosen& chosen, const Chosen& existing, Listener progress) {
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
      "Replaces one chosen candidate by another while coverage grows. Existing ones, the first, stay.");
  m.def(
      "min_connected_cover",
      [](const CoverageMatrix& matrix, double coverage, const StationGraph& graph, double link, const Chosen& existing,
         std::optional<std::size_t> most, Listener progress) {
        CoverProblem problem{
            .matrix = matrix, .graph = &graph, .existing = existing, .coverage = coverage, .link = link};
        if (most) problem.most = *most;
        LongCall call(std::move(progress));
        return call.run([&] { return min_connected_cover(problem, call.progress().stop).best; });
      },
      py::arg("matrix"), py::arg("coverage"), py::arg("graph"), py::arg("link"), py::arg("existing") = Chosen{},
      py::kw_only(), py::arg("most") = py::none(), py::arg("progress") = py::none(),
      "A network of few candidates with that coverage, connected by overlaps of `link`, by tabu search; of at "
      "most\n`most` besides the existing ones. `violation` is 0 if it has both.");
}

void add_greedy(py::module_& m) {
  py::class_<GreedyResult>(m, "GreedyResult", "Result of `greedy_network`.")
      .def_readonly("stations", &GreedyResult::stations, "In the order of choice: the first k are the choice for k.")
      .def_readonly("coverage", &GreedyResult::coverage, "Coverage after each.")
      .def_readonly("cancelled", &GreedyResult::cancelled, "Whether it was stopped before its end.");
  const auto options =
      Options<GreedyConfig>("greedy_network")
          .add("candidates", &GreedyConfig::candidates, "Positions to choose from, spread evenly over the ground.")
          .add<std::optional<std::uint64_t>>(
              "sample_voxels", [](const GreedyConfig& c) { return sample_of(c); },
              [](GreedyConfig& c, std::optional<std::uint64_t> voxels) {
                c.sample_voxels = voxels.value_or(every_voxel);
              },
              "Size of the sample of voxels; None: every voxel.")
          .add("existing", &GreedyConfig::existing, "Heads of existing stations.")
          .add("existing_setups", &GreedyConfig::existing_setups,
               "Their StationSetups, one each; none: upright, with the first scanner.");
  m.def(
      "greedy_network",
      [options](GuardedSite& self, std::size_t stations, Listener progress, const py::kwargs& given) {
        GreedyConfig config = options.read(given);
        config.stations = stations;
        const auto lock = self.taken();
        LongCall call(std::move(progress));
        return call.run([&] { return greedy_network(self.site, config, call.progress()); });
      },
      py::arg("site"), py::arg("stations"), py::kw_only(), py::arg("progress") = py::none(),
      ("Adds the candidate with the largest gain in coverage, again and again: a baseline, and a first network "
       "for\n`Site.plan(start=...)`. Raises Error invalid_argument: more stations than candidates, or no allowed "
       "position." +
       options.doc())
          .c_str());
}

void add_exact(py::module_& m) {
  py::class_<ExactResult>(m, "ExactResult", "Result of `exact_network`.")
      .def_readonly("stations", &ExactResult::stations, "Empty if no connected network was found.")
      .def_readonly("choice", &ExactResult::choice, "The choice among candidates, and a bound on the coverage of any.")
      .def_readonly("cancelled", &ExactResult::cancelled, "Whether it was stopped before its end.");
  const auto options =
      Options<ExactConfig>("exact_network")
          .add("candidates", &ExactConfig::candidates, "Positions to choose from, spread evenly over the ground.")
          .add<std::optional<std::uint64_t>>(
              "sample_voxels", [](const ExactConfig& c) { return sample_of(c); },
              [](ExactConfig& c, std::optional<std::uint64_t> voxels) {
                c.sample_voxels = voxels.value_or(every_voxel);
              },
              "Size of the sample of voxels; None: every voxel.")
          .add("link", &ExactConfig::link, "Least scan overlap of the links that connect it; 0: none.")
          .add("apart_m", &ExactConfig::apart_m, "Least distance between heads.")
          .add("max_seconds", &ExactConfig::max_seconds, "Time for branch and bound.")
          .add("existing", &ExactConfig::existing, "Heads of existing stations.")
          .add("existing_setups", &ExactConfig::existing_setups,
               "Their StationSetups, one each; none: upright, with the first scanner.");
  m.def(
      "exact_network",
      [options](GuardedSite& self, std::size_t stations, Listener progress, const py::kwargs& given) {
        ExactConfig config = options.read(given);
        config.stations = stations;
        const auto lock = self.taken();
        LongCall call(std::move(progress));
        return call.run([&] { return exact_network(self.site, config, call.progress()); });
      },
      py::arg("site"), py::arg("stations"), py::kw_only(), py::arg("progress") = py::none(),
      ("The best network among candidates, as an integer program; proven best among them if its gap is 0.\nRaises "
       "Error invalid_argument if no position is allowed." +
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
