// SPDX-License-Identifier: Apache-2.0
#include "ranks/remote_tracer.hpp"

#include <algorithm>
#include <utility>

namespace vantage::ranks {
namespace {

std::vector<NetworkCounts> none_of(std::size_t networks) {
  std::vector<NetworkCounts> all(networks);
  for (NetworkCounts& counts : all) counts.cancelled = true;
  return all;
}

// The comparer keeps the models alive, so that no address is reused.
bool same_scanners(const std::vector<PatchScanner>& a, const std::vector<PatchScanner>& b) {
  return std::ranges::equal(a, b, [](const PatchScanner& x, const PatchScanner& y) {
    return x.noise == y.noise && x.density == y.density && x.angle == y.angle && x.offset_m == y.offset_m &&
           x.scale == y.scale && x.range_m == y.range_m;
  });
}

}  // namespace

RemoteTracer::RemoteTracer(std::shared_ptr<Session> session, int rank, std::uint32_t tracer, EngineInfo info,
                           std::vector<std::uint64_t> scan_rays)
    : session_(std::move(session)),
      rank_(rank),
      tracer_(tracer),
      info_(std::move(info)),
      scan_rays_(std::move(scan_rays)) {}

Writer RemoteTracer::message() const {
  Writer writer;
  writer.raw(tracer_);
  return writer;
}

std::optional<Message> RemoteTracer::asked(Kind kind, Message body, const Progress& progress) {
  return session_->answer(rank_, session_->request(rank_, kind, body), progress);
}

void RemoteTracer::set_goal_density(double goal) {
  Tracer::set_goal_density(goal);
  Writer writer = message();
  writer.raw(goal);
  session_->send(rank_, Kind::goal, writer.take());
}

void RemoteTracer::scan(const TraceStation& station, std::uint64_t first_ray, std::uint64_t ray_count,
                        std::uint32_t outputs, RawChunk& chunk) {
  Writer writer = message();
  pass(writer, station);
  writer.raw(first_ray), writer.raw(ray_count), writer.raw(outputs);
  const auto answer = asked(Kind::scan, writer.take(), {});
  Reader reader(*answer);
  pass(reader, chunk);
}

NetworkCounts RemoteTracer::count(std::span<const TraceStation> stations, std::uint32_t station_count,
                                  const CountOptions& options, const Progress& progress) {
  Writer writer = message();
  const std::vector<TraceStation> network(stations.begin(), stations.end());
  write_networks(writer, {&network, 1}, {&station_count, 1});
  writer.raw(options.masks), writer.raw(options.skip), writer.raw(options.field != nullptr);
  const auto answer = asked(Kind::count, writer.take(), progress);
  if (!answer) return none_of(1).front();
  Reader reader(*answer);
  NetworkCounts counts;
  pass(reader, counts);
  if (options.field) pass(reader, *options.field);
  return counts;
}

std::vector<NetworkCounts> RemoteTracer::count_each(std::span<const std::vector<TraceStation>> networks,
                                                    std::span<const std::uint32_t> station_counts,
                                                    const CountOptions& options, const Progress& progress) {
  Writer writer = message();
  write_networks(writer, networks, station_counts);
  writer.raw(options.masks), writer.raw(options.skip);
  const auto answer = asked(Kind::count_each, writer.take(), progress);
  if (!answer) return none_of(networks.size());
  Reader reader(*answer);
  return read_counts(reader);
}

void RemoteTracer::send_sample(std::span<const std::uint32_t> sample) {
  if (sample_ && std::ranges::equal(*sample_, sample)) return;
  sample_ = session_->kept(sample);
  Writer writer = message();
  writer.array(*sample_);
  session_->send(rank_, Kind::sample, writer.take());
}

void RemoteTracer::send_patches(const RegistrationJob& job) {
  if (patches_.patches == job.patches && same_scanners(patches_.scanners, job.scanners)) return;
  patches_ = job;
  Writer writer = message();
  pass(writer, job);
  session_->send(rank_, Kind::patches, writer.take());
}

std::vector<NetworkCounts> RemoteTracer::count_sampled(std::span<const std::vector<TraceStation>> networks,
                                                       std::span<const std::uint32_t> station_counts,
                                                       const SampleJob& job, const Progress& progress) {
  send_sample(job.sample);
  if (job.registration) send_patches(*job.registration);
  Writer writer = message();
  write_networks(writer, networks, station_counts);
  writer.whole(job.groups), writer.raw(job.masks), writer.whole(job.stop_at);
  writer.raw(static_cast<bool>(job.points)), writer.raw(static_cast<bool>(job.station_masks));
  writer.raw(job.registration != nullptr), writer.raw(job.registration && job.registration->groups);
  const auto answer = asked(Kind::count_sampled, writer.take(), progress);
  if (!answer) return none_of(networks.size());
  Reader reader(*answer);
  std::vector<NetworkCounts> counts = read_counts(reader);
  if (job.points) {
    std::vector<std::uint32_t> points;
    for (std::size_t left = reader.size(1); left > 0; --left) {
      const std::size_t network = reader.whole();
      reader.array(points);
      job.points(network, points);
    }
  }
  if (job.station_masks) {
    std::vector<std::uint64_t> masks;
    for (std::size_t left = reader.size(1); left > 0; --left) {
      const std::size_t first = reader.whole();
      reader.array(masks);
      job.station_masks(first, masks);
    }
  }
  return counts;
}

}  // namespace vantage::ranks
