// SPDX-License-Identifier: Apache-2.0
// Run time against error, and rates, on one machine in one run. Times of different machines do not compare; ratios
// within a run do.
#include <cstdio>

#include "bare_embree.hpp"
#include "choose.hpp"
#include "day.hpp"
#include "devices.hpp"
#ifdef VANTAGE_HAS_EDITOR
#include "drag.hpp"
#endif
#include "error.hpp"
#include "front.hpp"
#include "gap.hpp"
#include "growth.hpp"
#include "intervals.hpp"
#include "own_rays.hpp"
#include "plan_stages.hpp"
#include "population.hpp"
#include "ranks.hpp"
#include "rates.hpp"
#include "sweep.hpp"
#include "vantage/error.hpp"

int main(int argc, char** argv) {
  CLI::App app("Benchmarks of vantage");
  app.require_subcommand(1);
  vantage::bench::RatesOptions rates;
  rates.add(
      *app.add_subcommand("rates", "Rays a second of every engine, with and without skipping, counting included"));
  vantage::bench::OwnRaysOptions own_rays;
  own_rays.add(*app.add_subcommand(
      "own-rays", "Rays of a caller's own, on devices alone and in whole calls, beside counting every ray"));
  vantage::bench::PopulationOptions population;
  population.add(
      *app.add_subcommand("population", "Sampled evaluation of many networks: time and error at several sample sizes"));
  vantage::bench::BareEmbreeOptions bare_embree;
  bare_embree.add(*app.add_subcommand("embree", "The embree engine, counting, beside a bare loop over the same rays"));
  vantage::bench::ErrorOptions error;
  error.add(*app.add_subcommand("error", "Time against error: exact, sampled, and with coarser steps and voxels"));
  vantage::bench::GrowthOptions growth;
  growth.add(
      *app.add_subcommand("growth", "Time and memory over triangles, stations, voxels and the size of the sample"));
  vantage::bench::IntervalsOptions intervals;
  intervals.add(*app.add_subcommand("intervals", "How often a sample's 95 % intervals hold the value of every ray"));
  vantage::bench::DevicesOptions devices;
  devices.add(*app.add_subcommand("devices", "How the rate grows with the devices that share the work"));
  vantage::bench::FrontOptions front;
  front.add(
      *app.add_subcommand("front", "What searched fronts are worth by every ray, over the seconds of the search"));
  vantage::bench::RanksOptions ranks;
  ranks.add(
      *app.add_subcommand("ranks", "How the rate grows with the ranks of a job, simulated from what is measured here"));
  vantage::bench::GapOptions gap;
  gap.add(*app.add_subcommand("gap", "What stations capture at most, and at best as found, over the candidates"));
  vantage::bench::ChooseOptions choose;
  choose.add(*app.add_subcommand("choose", "Choosing many stations on a made-up large site: greedy, swaps and drops"));
  vantage::bench::DayOptions day;
  day.add(*app.add_subcommand("day", "A simulated day: the plan that is made anew after each scan, and the kept one"));
  vantage::bench::PlanStagesOptions plan;
  plan.add(*app.add_subcommand("plan", "Default plans of sites: what each stage takes, or how two builds compare"));
  vantage::bench::SweepOptions sweep;
  sweep.add(*app.add_subcommand("sweep", "Plans of many sites by the default question, against the truth"));
#ifdef VANTAGE_HAS_EDITOR
  vantage::bench::DragOptions drag;
  drag.add(*app.add_subcommand("drag", "The editor: from a station that moves to new numbers and colours"));
#endif
  CLI11_PARSE(app, argc, argv);
  try {
    if (app.got_subcommand("rates")) vantage::bench::run_rates(rates);
    if (app.got_subcommand("own-rays")) vantage::bench::run_own_rays(own_rays);
    if (app.got_subcommand("embree")) vantage::bench::run_bare_embree(bare_embree);
    if (app.got_subcommand("population")) vantage::bench::run_population(population);
    if (app.got_subcommand("error")) vantage::bench::run_error(error);
    if (app.got_subcommand("intervals")) vantage::bench::run_intervals(intervals);
    if (app.got_subcommand("devices")) vantage::bench::run_devices(devices);
    if (app.got_subcommand("front")) vantage::bench::run_front(front);
    if (app.got_subcommand("ranks")) vantage::bench::run_ranks(ranks);
#ifdef VANTAGE_HAS_EDITOR
    if (app.got_subcommand("drag")) vantage::bench::run_drag(drag);
#endif
    if (app.got_subcommand("gap")) vantage::bench::run_gap(gap);
    if (app.got_subcommand("choose")) vantage::bench::run_choose(choose);
    if (app.got_subcommand("plan")) vantage::bench::run_plan_stages(plan);
    if (app.got_subcommand("day")) vantage::bench::run_day(day);
    if (app.got_subcommand("sweep") && !vantage::bench::run_sweep(sweep)) return 1;
    if (app.got_subcommand("growth")) vantage::bench::run_growth(growth);
  } catch (const vantage::Error& failure) {
    std::fprintf(stderr, "%s\n", failure.what());
    return 1;
  }
  return 0;
}
