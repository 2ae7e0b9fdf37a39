// SPDX-License-Identifier: Apache-2.0
#include "cli/missed.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>

#include "cli/options.hpp"

namespace vantage::cli {
namespace {

bool known(const std::string& extension) {
  return extension == ".csv" || extension == ".ply" || extension == ".png" || extension == ".svg" ||
         extension == ".bcf";
}

void write_bcf(const std::filesystem::path& file, const MissedVoxels& judged, Site& site,
               std::span<const ElementShare> elements) {
  if (const std::size_t topics = write_missed_bcf(file, elements, judged.shares, site); topics > 0) return;
  std::filesystem::remove(file);
  spdlog::warn("{}: not written, since {}", file.string(),
               std::ranges::all_of(elements, [](const ElementShare& one) { return one.global_id.empty(); })
                   ? "no element of the model has a GlobalId, as those of IFC do"
                   : "a tenth of the goal points or more is captured of every element");
}

}  // namespace

void MissedFiles::add(CLI::App& command) {
  add_texts(command, "--missed", "FILE",
            "Write why voxels are not captured: .csv a table by node, .ply a cloud, .png or .svg a picture, .bcf "
            "the elements of an IFC model of which hardly anything is; may be repeated",
            files)
      ->group("Results");
}

void MissedFiles::check() const {
  for (const std::string& file : files)
    if (!known(std::filesystem::path(file).extension().string()))
      throw Error(Errc::invalid_argument, "--missed: " + file + " is none of .csv, .ply, .png, .svg and .bcf");
}

bool MissedFiles::with_elements() const {
  return std::ranges::any_of(files, [](const std::string& file) { return file.ends_with(".bcf"); });
}

void tell_missed(const MissedVoxels& judged) {
  const MissedShare& all = judged.shares.front();
  const auto percent = [&](WhyMissed why) { return 100 * all.share(why); };
  spdlog::info(
      "{:.1f} % of the site is captured, other stations would capture {:.1f} % more; the rest is hidden from {} "
      "positions all over the ground ({:.1f} %), out of range ({:.1f} %), or seen too flatly ({:.1f} %), from too far "
      "for so dark a surface ({:.1f} %) or too sparsely ({:.1f} %)",
      percent(WhyMissed::captured), percent(WhyMissed::not_chosen), judged.candidates, percent(WhyMissed::hidden),
      percent(WhyMissed::far), percent(WhyMissed::flat), percent(WhyMissed::dark), percent(WhyMissed::sparse));
}

std::optional<MissedVoxels> judge_missed(Site& site, const VoxelField& field, Program& program) {
  ProgressLine line(program.console, "finding why surface is missed");
  MissedVoxels judged =
      missed_voxels(site, field, {}, {.report = [&](double done) { line.update(done); }, .stop = program.abort});
  if (judged.shares.empty()) return std::nullopt;
  tell_missed(judged);
  return judged;
}

void write_missed(std::span<const std::filesystem::path> files, const MissedVoxels& judged, Site& site,
                  std::span<const PlacedStation> stations, std::span<const ElementShare> elements, PlyCoordinates ply) {
  for (const std::filesystem::path& file : files) {
    if (file.extension() == ".csv")
      write_missed_csv(file, judged.shares);
    else if (file.extension() == ".ply")
      write_missed_ply(file, site.simulator(), judged, ply);
    else if (file.extension() == ".bcf")
      write_bcf(file, judged, site, elements);
    else
      draw_missed(file, site, judged, stations, "Why surfaces are not captured");
  }
}

}  // namespace vantage::cli
