// SPDX-License-Identifier: Apache-2.0
#include "evaluation.hpp"
#include "module.hpp"
#include "options.hpp"
#include "pickle.hpp"

namespace vantage::python {
namespace {

/// Input of an objective in Python: a copy, so that it may be kept.
struct Measured {
  Evaluation evaluation;
  std::vector<PlacedStation> stations = {};
  std::size_t existing = 0, visible_parts = 0;
  double minutes_on_site = 0;
  std::optional<Evaluation> surroundings = std::nullopt;
  std::optional<Scene> scene = std::nullopt;
};

// Figures from a network's counts, with pairs if there are any.
Evaluation figures_of(const MeasuredNetwork& network, const std::optional<RegistrationOptions>& registration) {
  static const std::vector<Objective> figures{make_objective("coverage"), make_objective("overlap")};
  const std::size_t known = network.counts.seen.empty() ? 1 : 2;
  return evaluation_of(network, std::span(figures).first(known), registration);
}

Measured copy_of(const MeasuredNetwork& network, const std::optional<RegistrationOptions>& registration) {
  MeasuredNetwork seen{.counts = network.counts,
                       .stations = network.stations,
                       .existing = network.existing,
                       .goal_density = network.goal_density,
                       .voxels = network.voxels,
                       .overlap = overlap_matrix(network.counts),
                       .surroundings = network.surroundings,
                       .surroundings_voxels = network.surroundings_voxels};
  Measured copy{.evaluation = figures_of(seen, registration),
                .stations = {network.stations.begin(), network.stations.end()},
                .existing = network.existing,
                .visible_parts = network.visible_parts,
                .minutes_on_site = network.minutes_on_site};
  if (network.scene) copy.scene = *network.scene;
  if (network.surroundings)
    copy.surroundings = figures_of({.counts = *network.surroundings,
                                    .stations = network.stations,
                                    .goal_density = network.goal_density,
                                    .voxels = network.surroundings_voxels,
                                    .overlap = overlap_matrix(*network.surroundings)},
                                   std::nullopt);
  return copy;
}

using GivenMeasure = Typed<"Callable[[vantage.MeasuredNetwork], float]", py::function>;
using Measure = std::function<double(const MeasuredNetwork&)>;

// Searches copy and call objectives without holding the interpreter's lock.
Measure measure_of(const py::function& function, const std::optional<RegistrationOptions>& registration) {
  std::shared_ptr<py::function> held(new py::function(function), [](py::function* kept) {
    const py::gil_scoped_acquire lock;
    delete kept;
  });
  return [held, registration](const MeasuredNetwork& network) {
    const py::gil_scoped_acquire lock;
    const py::object value = (*held)(copy_of(network, registration));
    const double number = PyFloat_AsDouble(value.ptr());
    if (number == -1 && PyErr_Occurred()) throw py::error_already_set();
    return number;
  };
}

Objective objective_of(std::string name, const GivenMeasure& value, const Scale& scale, std::string label,
                       std::string unit, bool counts, bool pairs, bool visibility, bool surroundings, bool time,
                       bool meshes, const std::optional<RegistrationOptions>& registration,
                       const std::optional<GivenMeasure>& standard_error, std::string parameters) {
  Objective made{.name = std::move(name),
                 .label = std::move(label),
                 .unit = std::move(unit),
                 .scale = scale,
                 .needs = {.counts = counts,
                           .pairs = pairs,
                           .visibility = visibility,
                           .surroundings = surroundings,
                           .time = time,
                           .meshes = meshes},
                 .value = measure_of(value, registration),
                 .parameters = std::move(parameters)};
  if (registration) {
    const bool by_all = registration->surfaces == RegistrationSurfaces::all;
    made.needs.pairs = true;
    made.needs.registration = registration->model;
    made.needs.surroundings_registration = by_all;
    made.needs.surroundings = surroundings || by_all;
  }
  if (standard_error) made.standard_error = measure_of(*standard_error, registration);
  return made;
}

void add_objectives(py::module_& m) {
  py::class_<Measured>(m, "MeasuredNetwork", "Input of an objective. A copy: it may be kept.")
      .def_readonly("evaluation", &Measured::evaluation,
                    "Its counts, by every ray or of a sample; with pairs if the objective needs them.")
      .def_readonly("stations", &Measured::stations, "Its stations, existing ones first, skipped ones included.")
      .def_property_readonly(
          "heads", [](const Measured& network) { return heads_of(network.stations); },
          "Their heads, survey frame: (n, 3), metres.")
      .def_readonly("existing", &Measured::existing, "Number of existing stations.")
      .def_readonly("visible_parts", &Measured::visible_parts,
                    "Connected components of the stations that see each other; 0 unless needed.")
      .def_readonly("minutes_on_site", &Measured::minutes_on_site, "Time without existing stations; 0 unless needed.")
      .def_readonly("surroundings", &Measured::surroundings,
                    "Counts on all surfaces, surveyed or not; None unless needed.")
      .def(
          "captured",
          [](const Measured& network, const std::string& meshes) {
            return captured({.counts = network.evaluation.counts,
                             .stations = network.stations,
                             .scene = network.scene ? &*network.scene : nullptr},
                            meshes);
          },
          py::arg("meshes"),
          "Share of voxels that reached their goal density, of surveyed meshes whose name matches a shell glob: "
          "'facade*'. The\nobjective is made with meshes=True. 0 if a sample holds none of their voxels.\nRaises Error "
          "invalid_argument if no surveyed mesh has such a name.");
  py::class_<Scale> scale(m, "Scale", "The relevant range of an objective's values; made by `minimise` or `maximise`.");
  scale.def_readonly("best", &Scale::best, "Value scaled to 0.")
      .def_readonly("worst", &Scale::worst, "Value scaled to 1: the reference point of the hypervolume.")
      .def("__repr__", [](const Scale& scale) {
        return std::string(scale.best > scale.worst ? "vantage.maximise(" : "vantage.minimise(") +
               py::str(py::float_(scale.best)).cast<std::string>() + ", " +
               py::str(py::float_(scale.worst)).cast<std::string>() + ")";
      });
  add_pickle(scale);
  m.def("minimise", &minimise, py::arg("best"), py::arg("worst"),
        "A scale on which less is better, in the objective's unit. Raises Error unless best <= worst, both finite.");
  m.def("maximise", &maximise, py::arg("best"), py::arg("worst"),
        "A scale on which more is better, in the objective's unit. Raises Error unless best >= worst, both finite.");
  py::class_<Objective>(m, "Objective", "One measure of a network, to be searched for, required or reported.")
      .def(py::init(&objective_of), py::arg("name"), py::arg("value"), py::arg("scale"), py::kw_only(),
           py::arg("label") = "", py::arg("unit") = "", py::arg("counts") = true, py::arg("pairs") = false,
           py::arg("visibility") = false, py::arg("surroundings") = false, py::arg("time") = false,
           py::arg("meshes") = false, py::arg("registration") = py::none(), py::arg("standard_error") = py::none(),
           py::arg("parameters") = "",
           "name: lower-case letters, digits, `_`. value: a pure function of a MeasuredNetwork. scale: `minimise(best, "
           "worst)`\nor `maximise(best, worst)`, for search and hypervolume. counts, pairs, visibility, surroundings, "
           "time, meshes, registration\n(RegistrationOptions): inputs that it needs; others are not computed. "
           "standard_error: "
           "a function like value; None:\nby the jackknife. parameters: its own parameters; runs resume only under the "
           "same ones.")
      .def_readonly("name", &Objective::name, "Its key in tables and results.")
      .def_readonly("label", &Objective::label, "Text for axes.")
      .def_readonly("unit", &Objective::unit, "'mm'; empty: a plain number.")
      .def_readonly("scale", &Objective::scale, "From best to worst, in its unit.")
      .def("__repr__", [](const Objective& o) { return "<vantage.Objective '" + o.name + "'>"; });
  py::class_<Requirement>(m, "Requirement", "A bound on an objective.")
      .def(py::init([](Objective objective, const Typed<"Literal['>=', '<=']", py::str>& given, double limit) {
             const std::string bound = given;
             if (bound != ">=" && bound != "<=")
               throw Error(Errc::invalid_argument, "bound: '" + bound + "' is neither '>=' nor '<='");
             return Requirement{std::move(objective),
                                bound == ">=" ? Requirement::Bound::at_least : Requirement::Bound::at_most, limit};
           }),
           py::arg("objective"), py::arg("bound"), py::arg("limit"), "bound: '>=' or '<='.")
      .def_readonly("objective", &Requirement::objective, "The objective.")
      .def_readonly("limit", &Requirement::limit, "The bound.")
      .def("__str__", [](const Requirement& r) { return to_string(r); })
      .def("__repr__", [](const Requirement& r) { return "<vantage.Requirement " + to_string(r) + ">"; });
  m.def(
      "objective_names",
      [] {
        const auto names = objective_names();
        return std::vector<std::string>(names.begin(), names.end());
      },
      "The built-in objectives.");
}

// Objectives or requirements, or texts of which `make` makes them with the problem's settings.
template <class Made>
using MadeOrText = Tuple<std::variant<std::string, Made>>;
template <class Made, class Make>
std::vector<Made> made_of(MadeOrText<Made> given, const SurveyProblem& problem, const Make& make) {
  std::vector<Made> all;
  for (auto& each : given.values) {
    const auto* text = std::get_if<std::string>(&each);
    all.push_back(text ? make(*text, problem.settings()) : std::get<Made>(std::move(each)));
  }
  return all;
}

template <class Value>
auto tuple_of(std::vector<Value> SurveyProblem::*member) {
  return [member](const SurveyProblem& p) { return Tuple<Value>{p.*member}; };
}
template <class Value>
auto from_tuple(std::vector<Value> SurveyProblem::*member) {
  return [member](SurveyProblem& p, Tuple<Value> given) { p.*member = std::move(given.values); };
}

Options<SurveyProblem> problem_options() {
  return Options<SurveyProblem>("SurveyProblem")
      .add("name", &SurveyProblem::name, "For tables and pictures.")
      .add("stations_min", &SurveyProblem::stations_min, "Fewest stations to place.")
      .add("stations_max", &SurveyProblem::stations_max, "Most; if it differs from the fewest, the number is searched.")
      .add<Tuple<Vec3>>("existing", tuple_of(&SurveyProblem::existing), from_tuple(&SurveyProblem::existing),
                        "Heads (x, y, z) of existing stations, survey frame, metres.")
      .add<Tuple<StationSetup>>("existing_setups", tuple_of(&SurveyProblem::existing_setups),
                                from_tuple(&SurveyProblem::existing_setups),
                                "Their StationSetups, one each; none: upright, with the first scanner.")
      .add<Tuple<std::string>>("existing_names", tuple_of(&SurveyProblem::existing_names),
                               from_tuple(&SurveyProblem::existing_names), "Their names, one each, or none.")
      .add<Tuple<Scanner>>("scanners", tuple_of(&SurveyProblem::scanners), from_tuple(&SurveyProblem::scanners),
                           "Scanners that each station chooses from, in their order; none: the site's first.")
      .add("every_echo", &SurveyProblem::every_echo,
           "Whether it is posed for scanners that detect every echo. The site's then do, unless `detection` says what "
           "they\ndetect.")
      .add("heights_m", &SurveyProblem::heights_m, "Lowest and highest head above ground; None: the scanner's.")
      .add("link_overlap", &SurveyProblem::link_overlap, "Least overlap of a link.")
      .add("registration", &SurveyProblem::registration, "Prior of registration.")
      .add("on_site", &SurveyProblem::on_site, "OnSiteOptions: times of a round.")
      .add("targets", &SurveyProblem::targets,
           "Targets to propose; 0: none, None: as few as the registration takes, if `fewest`.")
      .add<Tuple<Target>>("existing_targets", tuple_of(&SurveyProblem::existing_targets),
                          from_tuple(&SurveyProblem::existing_targets), "Targets and control points that are there.")
      .add("fewest", &SurveyProblem::fewest, "First the fewest stations that meet the requirements, then the best.")
      .add("pays_m2", &SurveyProblem::pays_m2,
           "With `fewest`: what each station has to capture besides the others, m². The required `capture` is the "
           "least.")
      .add("pays_share", &SurveyProblem::pays_share,
           "The same as a share of what the stations before it capture on average, of fewer than ten as if they were "
           "ten; "
           "the larger of both counts.")
      .add("attainable", &SurveyProblem::attainable,
           "Attainable coverage, the denominator of `capture`; a plan finds it.")
      .add<MadeOrText<Objective>>(
          "objectives", tuple_of(&SurveyProblem::objectives),
          [](SurveyProblem& p, MadeOrText<Objective> given) {
            p.objectives = made_of(std::move(given), p, &make_objective);
          },
          "Objectives of the search, or names of built-in ones.")
      .add<MadeOrText<Requirement>>(
          "requirements", tuple_of(&SurveyProblem::requirements),
          [](SurveyProblem& p, MadeOrText<Requirement> given) {
            p.requirements = made_of(std::move(given), p, &make_requirement);
          },
          "Requirements, or texts like 'coverage >= 0.9'.");
}

// Name of a built-in objective. Throws TypeError for any other.
std::string name_to_pickle(const Objective& objective, const SurveyProblem& problem) {
  const auto names = objective_names();
  if (std::ranges::find(names, objective.name) != names.end()) {
    const Objective same = make_objective(objective.name, problem.settings());
    if (same.parameters == objective.parameters && same.label == objective.label &&
        same.scale.best == objective.scale.best && same.scale.worst == objective.scale.worst)
      return objective.name;
  }
  throw py::type_error("SurveyProblem: the objective '" + objective.name +
                       "' is one of your own, or was made with other settings, and is not pickled");
}

// Members by their names; objectives and requirements by their makers.
py::tuple problem_state(const Options<SurveyProblem>& options, const SurveyProblem& problem) {
  py::dict members = options.values(problem);
  members.attr("pop")("objectives"), members.attr("pop")("requirements");
  py::list objectives, requirements;
  for (const Objective& objective : problem.objectives) objectives.append(name_to_pickle(objective, problem));
  for (const Requirement& r : problem.requirements)
    requirements.append(
        py::make_tuple(name_to_pickle(r.objective, problem), r.bound == Requirement::Bound::at_least, r.limit));
  return py::make_tuple(members, objectives, requirements);
}

SurveyProblem problem_from(const Options<SurveyProblem>& options, const py::tuple& state) {
  SurveyProblem problem = options.read(py::reinterpret_borrow<py::kwargs>(state[0].cast<py::dict>()));
  for (const auto& name : state[1])
    problem.objectives.push_back(make_objective(name.cast<std::string>(), problem.settings()));
  for (const auto& each : state[2]) {
    const auto [name, at_least, limit] = each.cast<std::tuple<std::string, bool, double>>();
    problem.requirements.push_back({make_objective(name, problem.settings()),
                                    at_least ? Requirement::Bound::at_least : Requirement::Bound::at_most, limit});
  }
  return problem;
}

}  // namespace

void add_problems(py::module_& m) {
  add_objectives(m);
  const auto options = problem_options();
  py::class_<SurveyProblem> type(
      m, "SurveyProblem",
      ("A planning problem: number of stations, allowed heights, objectives and requirements. With one objective "
       "the\nbest network is searched, with several a front. Names of built-in objectives are resolved when they are "
       "given:\nset the numbers of stations before." +
       options.doc())
          .c_str());
  type.def(py::init([options](const py::kwargs& given) { return options.read(given); }))
      .def(
          "to_dict", [](const SurveyProblem& problem) { return to_dict(settings(problem)); },
          "Its members by their names.")
      .def("__repr__", [options](const SurveyProblem& problem) { return options.repr(problem); });
  options.attributes(type);
  type.def(py::pickle([options](const SurveyProblem& problem) { return problem_state(options, problem); },
                      [options](const py::tuple& state) { return problem_from(options, state); }));
  const auto stations = py::arg("stations");
  const auto low = py::arg("stations_min"), high = py::arg("stations_max");
  m.def("coverage_fix", &coverage_fix, stations, "Table 2 of the paper: coverage of a number of stations.");
  m.def("coverage_overlap_fix", &coverage_overlap_fix, stations, "Coverage against overlap of a number of stations.");
  m.def("coverage_min", &coverage_min, low, high, "Coverage against the number of stations.");
  m.def("coverage_overlap_min", &coverage_overlap_min, low, high, "Coverage, overlap and number of stations.");
  m.def(
      "fitness_min",
      [](std::size_t least, std::size_t most, double coverage, double station_count, double visibility) {
        return fitness_min(least, most, {coverage, station_count, visibility});
      },
      low, high, py::arg("coverage") = FitnessWeights{}.coverage,
      py::arg("station_count") = FitnessWeights{}.station_count, py::arg("visibility") = FitnessWeights{}.visibility,
      "The weighted fitness of equation 1 of the paper, a baseline.");
  m.def(
      "fewest_stations", &fewest_stations, py::arg("capture") = 0.9, py::arg("link") = 0.3, py::arg("stations_min") = 1,
      py::arg("stations_max") = max_stations, py::arg("apart_m") = 1.0,
      "The surveyor's question: the fewest stations that capture that share of attainable coverage, connected by "
      "scan\noverlaps of at least `link`, at least apart_m metres from each other; then the least registration error.");
}

}  // namespace vantage::python
