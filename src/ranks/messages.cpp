// SPDX-License-Identifier: Apache-2.0
#include "ranks/messages.hpp"

#include <cstdio>
#include <memory>
#include <utility>

#include "core/hash.hpp"
#include "vantage/version.hpp"

namespace vantage::ranks {
namespace {

// Bytes that each takes at least in a message, so that a short one cannot ask for much memory.
constexpr std::size_t kLeastCounts = 31, kLeastStation = sizeof(TraceStation::origin) + 3,
                      kLeastScanner = 1 + sizeof(NoiseModel::min_range) + sizeof(NoiseModel::inverse_span) +
                                      sizeof(NoiseModel::seed) + sizeof(NoiseModel::reach) +
                                      sizeof(PatchScanner::density) + sizeof(PatchScanner::angle) +
                                      sizeof(PatchScanner::offset_m) + sizeof(PatchScanner::scale) +
                                      sizeof(PatchScanner::range_m);

// Members of each struct, in the order in which they are sent. `Archive` is a Writer or a Reader.

template <class Archive, class T>
void pass_identity(Archive& archive, T& identity) {
  archive.text(identity.version);
  archive.raw(identity.fingerprint), archive.raw(identity.voxels), archive.raw(identity.scanners);
}

template <class Archive, class T>
void pass_opened(Archive& archive, T& opened) {
  archive.raw(opened.known), archive.raw(opened.tracer);
  pass_identity(archive, opened.own);
  archive.text(opened.host), archive.text(opened.device);
  archive.raw(opened.engine);
}

template <class Archive, class T>
void pass_sums(Archive& archive, T& sums) {
  archive.array(sums.heads);
  if (sums.heads.empty()) return;
  archive.raw(sums.voxels), archive.raw(sums.centre), archive.raw(sums.radius_m);
  archive.array(sums.pairs), archive.array(sums.surface), archive.array(sums.instrument);
}

template <class Archive, class T>
void pass_counts(Archive& archive, T& counts) {
  archive.whole(counts.voxels), archive.whole(counts.weight), archive.whole(counts.saturated);
  archive.whole(counts.partial_points), archive.whole(counts.point_weight), archive.whole(counts.rays),
      archive.whole(counts.stations);
  archive.wholes(counts.points), archive.wholes(counts.points_on_surveyed);
  archive.array(counts.dropped);
  archive.wholes(counts.seen), archive.wholes(counts.shared);
  pass_sums(archive, counts.registration);
  archive.raw(counts.successive_difference_sum), archive.raw(counts.trace_seconds);
  archive.raw(counts.cancelled);
}

template <class Archive, class T>
void pass_field(Archive& archive, T& field) {
  archive.array(field.count), archive.array(field.stations);
}

template <class Archive, class T>
void pass_chunk(Archive& archive, T& chunk) {
  archive.array(chunk.range), archive.array(chunk.position), archive.array(chunk.normal);
  archive.array(chunk.reflectivity), archive.array(chunk.primitive), archive.array(chunk.barycentric);
  archive.array(chunk.voxel);
}

template <class Archive, class T>
void pass_noise(Archive& archive, T& noise) {
  archive.array(noise.sigma);
  archive.raw(noise.min_range), archive.raw(noise.inverse_span), archive.raw(noise.seed), archive.raw(noise.reach);
}

template <class Archive, class T>
void pass_patches(Archive& archive, T& patches) {
  archive.array(patches.patches);
  archive.raw(patches.centre), archive.raw(patches.radius), archive.raw(patches.largest);
  archive.raw(patches.model.rho_m), archive.raw(patches.model.patch_m);
}

void add(Hash& hash, const NoiseModel& noise) {
  hash.add_all(noise.sigma);
  hash.add(noise.min_range), hash.add(noise.inverse_span), hash.add(noise.seed), hash.add(noise.reach);
}

void add(Hash& hash, const TraceScanner& scanner) {
  const RayPattern& pattern = *scanner.pattern;
  for (const auto* table : {&pattern.sin_zenith, &pattern.cos_zenith, &pattern.sin_azimuth, &pattern.cos_azimuth})
    hash.add_all(*table);
  if (pattern.list) hash.add_all(pattern.list->sin_azimuth), hash.add_all(pattern.list->cos_azimuth);
  hash.add(pattern.min_range), hash.add(pattern.max_range);
  hash.add(pattern.zenith_step), hash.add(pattern.azimuth_step);
  hash.add(pattern.first_zenith), hash.add(pattern.first_azimuth);
  if (scanner.noise) add(hash, *scanner.noise);
  if (!scanner.limits) return;
  const LimitModel& limits = *scanner.limits;
  for (const LimitModel::Limits& limit : limits.meshes)
    hash.add(limit.least_cosine_square), hash.add(limit.largest_footprint_square), hash.add(limit.largest_sigma),
        hash.add(limit.largest_reach_square);
  hash.add(limits.exit_diameter), hash.add(limits.divergence), hash.add(limits.lost_below), hash.add(limits.seed);
  if (limits.noise) add(hash, *limits.noise);
}

std::string hex(std::uint64_t value) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
  return text;
}

}  // namespace

Writer begin(Kind kind, std::uint64_t serial) {
  Writer writer;
  writer.raw(kind);
  writer.whole(serial);
  return writer;
}

Head read_head(Reader& reader) {
  Head head;
  reader.raw(head.kind);
  reader.whole(head.serial);
  return head;
}

Identity identity_of(const TraceScene& scene, std::uint64_t fingerprint) {
  const VoxelGrid& grid = *scene.grid;
  Hash voxels, scanners;
  voxels.add(grid.size()), voxels.add(grid.voxel_size());
  for (const float coordinate : grid.min()) voxels.add(coordinate);
  for (std::uint64_t rank = 0; rank < grid.size(); ++rank) voxels.add(grid.key(rank));
  voxels.add_all(grid.demands().weights), voxels.add_all(grid.demands().point_weights);
  for (const TraceScanner& scanner : scene.scanners) add(scanners, scanner);
  return {version(), fingerprint, voxels.value(), scanners.value()};
}

std::string difference(const Identity& here, const Identity& there) {
  if (here.version != there.version)
    return "it is vantage " + there.version + " and rank 0 is " + here.version + ": start the same program everywhere";
  if (here.fingerprint != there.fingerprint)
    return "its scene is not rank 0's (fingerprint " + hex(there.fingerprint) + ", of rank 0 " + hex(here.fingerprint) +
           "): give every rank the same file and options";
  if (here.voxels != there.voxels)
    return "its voxels are not rank 0's, though the scene is: give every rank the same options";
  if (here.scanners != there.scanners)
    return "its scanner or noise is not rank 0's: give every rank the same options and configuration files";
  return "";
}

void pass(Writer& writer, const Identity& identity) { pass_identity(writer, identity); }
void pass(Reader& reader, Identity& identity) { pass_identity(reader, identity); }
void pass(Writer& writer, const Opened& opened) { pass_opened(writer, opened); }
void pass(Reader& reader, Opened& opened) { pass_opened(reader, opened); }
void pass(Writer& writer, const PassField& field) { pass_field(writer, field); }
void pass(Reader& reader, PassField& field) { pass_field(reader, field); }
void pass(Writer& writer, const Tracer::RawChunk& chunk) { pass_chunk(writer, chunk); }
void pass(Reader& reader, Tracer::RawChunk& chunk) { pass_chunk(reader, chunk); }

void pass(Writer& writer, const TraceStation& station) {
  writer.raw(station.origin);
  writer.whole(station.place), writer.whole(station.scanner);
  writer.raw(station.turn.has_value());
  if (station.turn) writer.raw(*station.turn);
}

void pass(Reader& reader, TraceStation& station) {
  reader.raw(station.origin);
  reader.whole(station.place), reader.whole(station.scanner);
  station.turn.reset();
  if (reader.raw<bool>()) station.turn = reader.raw<Turn>();
}

void pass(Writer& writer, const NetworkCounts& counts) {
  pass_counts(writer, counts);
  write_counts(writer, counts.groups);
  writer.whole(counts.registration.groups.size());
  for (const RegistrationSums& group : counts.registration.groups) pass_sums(writer, group);
}

void pass(Reader& reader, NetworkCounts& counts) {
  pass_counts(reader, counts);
  counts.groups.resize(reader.size(kLeastCounts));
  for (NetworkCounts& group : counts.groups) {
    pass_counts(reader, group);
    // A reader that followed groups of groups would recurse as deeply as a message asks.
    if (reader.whole() != 0 || reader.whole() != 0)
      throw Error(Errc::device_failure, "a message from another rank has groups within groups");
  }
  counts.registration.groups.resize(reader.size(1));
  for (RegistrationSums& group : counts.registration.groups) pass_sums(reader, group);
}

void pass(Writer& writer, const RegistrationJob& job) {
  pass_patches(writer, *job.patches);
  writer.whole(job.scanners.size());
  for (const PatchScanner& scanner : job.scanners) {
    pass_noise(writer, *scanner.noise);
    writer.raw(scanner.density), writer.raw(scanner.angle), writer.raw(scanner.offset_m), writer.raw(scanner.scale);
    writer.raw(scanner.range_m);
  }
}

void pass(Reader& reader, RegistrationJob& job) {
  auto patches = std::make_shared<Patches>();
  pass_patches(reader, *patches);
  job.patches = std::move(patches);
  job.scanners.resize(reader.size(kLeastScanner));
  for (PatchScanner& scanner : job.scanners) {
    auto noise = std::make_shared<NoiseModel>();
    pass_noise(reader, *noise);
    scanner.noise = std::move(noise);
    reader.raw(scanner.density), reader.raw(scanner.angle), reader.raw(scanner.offset_m), reader.raw(scanner.scale);
    reader.raw(scanner.range_m);
  }
}

void write_networks(Writer& writer, std::span<const std::vector<TraceStation>> stations,
                    std::span<const std::uint32_t> sizes) {
  writer.whole(stations.size());
  for (std::size_t k = 0; k < stations.size(); ++k) {
    writer.whole(sizes[k]);
    writer.whole(stations[k].size());
    for (const TraceStation& station : stations[k]) pass(writer, station);
  }
}

Networks read_networks(Reader& reader) {
  Networks networks;
  networks.stations.resize(reader.size(2));
  for (auto& stations : networks.stations) {
    reader.whole(networks.sizes.emplace_back());
    stations.resize(reader.size(kLeastStation));
    for (TraceStation& station : stations) pass(reader, station);
  }
  return networks;
}

void write_counts(Writer& writer, std::span<const NetworkCounts> counts) {
  writer.whole(counts.size());
  for (const NetworkCounts& each : counts) pass(writer, each);
}

std::vector<NetworkCounts> read_counts(Reader& reader) {
  std::vector<NetworkCounts> counts(reader.size(kLeastCounts));
  for (NetworkCounts& each : counts) pass(reader, each);
  return counts;
}

}  // namespace vantage::ranks
