// SPDX-License-Identifier: Apache-2.0
#include "ranks/server.hpp"

#include <chrono>
#include <exception>
#include <new>
#include <utility>

namespace vantage::ranks {
namespace {

// Results beside the counts of a sample, kept until all are sent.
struct Delivered {
  std::size_t many = 0;
  Writer writer;

  template <class T>
  void add(std::size_t network, std::span<const T> values) {
    ++many;
    writer.whole(network);
    writer.array(std::vector<T>(values.begin(), values.end()));
  }
  void into(Message& message) {
    Writer head;
    head.whole(many);
    message += head.take() + writer.take();
  }
};

Message count(Tracer& tracer, Reader& reader, const Progress& progress) {
  const Networks networks = read_networks(reader);
  Tracer::CountOptions options;
  reader.raw(options.masks), reader.raw(options.skip);
  PassField field;
  const bool with_field = reader.raw<bool>();
  if (with_field) options.field = &field;
  const NetworkCounts counts = tracer.count(networks.stations.at(0), networks.sizes.at(0), options, progress);
  Writer writer;
  pass(writer, counts);
  if (with_field) pass(writer, field);
  return writer.take();
}

Message count_each(Tracer& tracer, Reader& reader, const Progress& progress) {
  const Networks networks = read_networks(reader);
  Tracer::CountOptions options;
  reader.raw(options.masks), reader.raw(options.skip);
  Writer writer;
  write_counts(writer, tracer.count_each(networks.stations, networks.sizes, options, progress));
  return writer.take();
}

Message count_sampled(Tracer& tracer, std::span<const std::uint32_t> sample, RegistrationJob& registration,
                      Reader& reader, const Progress& progress) {
  const Networks networks = read_networks(reader);
  Tracer::SampleJob job{.sample = sample};
  reader.whole(job.groups), reader.raw(job.masks), reader.whole(job.stop_at);
  Delivered points, masks;
  const bool with_points = reader.raw<bool>(), with_masks = reader.raw<bool>();
  if (with_points) job.points = [&](std::size_t k, std::span<const std::uint32_t> told) { points.add(k, told); };
  if (with_masks) job.station_masks = [&](std::size_t k, std::span<const std::uint64_t> told) { masks.add(k, told); };
  if (reader.raw<bool>()) job.registration = &registration;
  reader.raw(registration.groups);
  Writer writer;
  write_counts(writer, tracer.count_sampled(networks.stations, networks.sizes, job, progress));
  Message message = writer.take();
  if (with_points) points.into(message);
  if (with_masks) masks.into(message);
  return message;
}

Message scan(Tracer& tracer, Reader& reader) {
  TraceStation station;
  pass(reader, station);
  const auto first = reader.raw<std::uint64_t>(), rays = reader.raw<std::uint64_t>();
  Tracer::RawChunk chunk;
  tracer.scan(station, first, rays, reader.raw<std::uint32_t>(), chunk);
  Writer writer;
  pass(writer, chunk);
  return writer.take();
}

}  // namespace

Server::Server(Transport& transport, std::string host, std::function<void()> on_end)
    : transport_(transport), host_(std::move(host)), on_end_(std::move(on_end)) {
  transport.deliver_to([this](int, Message message) { receive(std::move(message)); });
}

void Server::offer(Tracer& tracer, const Identity& identity) { offered_.push_back({&tracer, identity}); }

void Server::receive(Message message) {
  // This is the transport's thread, which has nobody to throw at: serve() does.
  Head head;
  try {
    Reader reader(message);
    head = read_head(reader);
  } catch (const Error&) {
    const std::lock_guard lock(mutex_);
    broken_ = std::current_exception();
    wake_.notify_all();
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    if (head.kind == Kind::end) {
      ended_ = true;
      stop_.request_stop();
    } else if (head.kind == Kind::stop) {
      given_up_ = head.serial;
      if (current_ <= given_up_) stop_.request_stop();
    } else {
      messages_.push_back(std::move(message));
    }
  }
  wake_.notify_all();
  if (head.kind == Kind::end && on_end_) on_end_();
}

// Takes the next message that somebody waits for; returns false at the end.
bool Server::next(Message& message, Head& head) {
  for (;;) {
    std::unique_lock lock(mutex_);
    wake_.wait(lock, [&] { return ended_ || broken_ || !messages_.empty(); });
    if (broken_) std::rethrow_exception(broken_);
    if (ended_) return false;
    message = std::move(messages_.front());
    messages_.pop_front();
    Reader reader(message);
    head = read_head(reader);
    if (head.serial > 0 && head.serial <= given_up_) continue;
    current_ = head.serial;
    stop_ = std::stop_source();
    return true;
  }
}

void Server::serve(const More& more) {
  Message message;
  Head head;
  while (next(message, head)) {
    Reader reader(message);
    read_head(reader);
    const auto refuse = [&](Errc code, const std::string& why) {
      send(Kind::error, head.serial, [&](Writer& writer) { writer.raw(code), writer.text(why); });
    };
    try {
      handle(head, reader, more);
    } catch (const Error& error) {
      refuse(error.code(), "on " + host_ + ": " + error.what());
    } catch (const std::bad_alloc&) {
      refuse(Errc::out_of_memory, "on " + host_ + ": not enough memory");
    } catch (const std::exception& error) {
      refuse(Errc::device_failure, "on " + host_ + ": " + error.what());
    }
  }
}

void Server::fail(Errc code, const std::string& why) {
  send(Kind::failed, 0, [&](Writer& writer) { writer.raw(code), writer.text("on " + host_ + ": " + why); });
  std::unique_lock lock(mutex_);
  wake_.wait(lock, [&] { return ended_; });
}

void Server::handle(const Head& head, Reader& reader, const More& more) {
  Writer body;
  if (head.kind == Kind::open) {
    Identity asked;
    pass(reader, asked);
    pass(body, open(asked, more));
    send(Kind::answer, head.serial, [&](Writer& writer) { writer.text(body.take()); });
    return;
  }
  Offered& offered = offered_.at(reader.raw<std::uint32_t>());
  switch (head.kind) {
    case Kind::goal: return offered.tracer->set_goal_density(reader.raw<double>());
    case Kind::sample: return reader.array(offered.sample);
    case Kind::patches: return pass(reader, offered.registration);
    default: break;
  }
  using Clock = std::chrono::steady_clock;
  Clock::time_point told = Clock::now();
  const Progress progress{.report =
                              [&](double share) {
                                constexpr std::chrono::milliseconds kOften{100};
                                if (Clock::now() - told < kOften) return;
                                told = Clock::now();
                                send(Kind::progress, head.serial, [&](Writer& writer) { writer.raw(share); });
                              },
                          .stop = stop_.get_token()};
  const Message answered = answer(head.kind, offered, reader, progress);
  send(Kind::answer, head.serial, [&](Writer& writer) { writer.text(answered); });
}

Opened Server::open(const Identity& asked, const More& more) {
  const auto find = [&] {
    std::size_t k = 0;
    while (k < offered_.size() && !(offered_[k].identity == asked)) ++k;
    return k;
  };
  std::size_t k = find();
  if (k == offered_.size() && offered_.front().identity.version == asked.version) more(), k = find();
  const EngineInfo& info = offered_.front().tracer->info();
  return {.known = k < offered_.size(),
          .tracer = static_cast<std::uint32_t>(k),
          .own = offered_.front().identity,
          .host = host_,
          .device = info.device,
          .engine = info.engine};
}

Message Server::answer(Kind kind, Offered& offered, Reader& reader, const Progress& progress) {
  switch (kind) {
    case Kind::scan: return scan(*offered.tracer, reader);
    case Kind::count: return count(*offered.tracer, reader, progress);
    case Kind::count_each: return count_each(*offered.tracer, reader, progress);
    case Kind::count_sampled:
      return count_sampled(*offered.tracer, offered.sample, offered.registration, reader, progress);
    default: throw Error(Errc::device_failure, "asked in no known way");
  }
}

void Server::send(Kind kind, std::uint64_t serial, const std::function<void(Writer&)>& write) {
  Writer writer = begin(kind, serial);
  write(writer);
  transport_.send(0, writer.take());
}

}  // namespace vantage::ranks
