// SPDX-License-Identifier: Apache-2.0
// Messages between ranks.
#include "ranks/messages.hpp"

#include <array>
#include <memory>

#include "fuzz/target.hpp"

namespace vantage::fuzz {
namespace {

using namespace ranks;

// A message's content: a value that was read can be written, and reads back as the same.
struct Content {
  const char* name;
  std::string (*rewritten)(std::string_view bytes);
  std::string (*seed)();
};

template <class T>
std::string written(const T& value) {
  Writer writer;
  pass(writer, value);
  return writer.take();
}

template <class T>
std::string rewritten(std::string_view bytes) {
  T value;
  Reader reader(bytes);
  pass(reader, value);
  return written(value);
}

std::string written_networks(const Networks& networks) {
  Writer writer;
  write_networks(writer, networks.stations, networks.sizes);
  return writer.take();
}

Identity an_identity() { return {"0.1.0", 1, 2, 3}; }

NetworkCounts some_counts() {
  NetworkCounts counts;
  counts.voxels = 1000, counts.stations = 2, counts.points = {5, 600, 70'000}, counts.seen = {1, 2};
  counts.registration.heads = {{1, 2, 3}};
  counts.groups.resize(2);
  return counts;
}

constexpr std::array kContents{
    Content{"identity", rewritten<Identity>, [] { return written(an_identity()); }},
    Content{"opened", rewritten<Opened>,
            [] { return written(Opened{.known = true, .own = an_identity(), .host = "a", .device = "b"}); }},
    Content{"station", rewritten<TraceStation>, [] { return written(TraceStation{.origin = {}, .turn = Turn{}}); }},
    Content{"counts", rewritten<NetworkCounts>, [] { return written(some_counts()); }},
    Content{"field", rewritten<PassField>,
            [] {
              PassField field;
              field.count = {1, 2, 3}, field.stations = {1, 3, 2};
              return written(field);
            }},
    Content{"chunk", rewritten<Tracer::RawChunk>,
            [] {
              Tracer::RawChunk chunk;
              chunk.range = {1.5F, 2.5F}, chunk.primitive = {7, 8};
              return written(chunk);
            }},
    Content{"registration", rewritten<RegistrationJob>,
            [] {
              RegistrationJob job{.patches = std::make_shared<const Patches>(), .scanners = {}};
              job.scanners.resize(2, {.noise = std::make_shared<const NoiseModel>()});
              return written(job);
            }},
    Content{"networks",
            [](std::string_view bytes) {
              Reader reader(bytes);
              return written_networks(read_networks(reader));
            },
            [] {
              return written_networks({.stations = {{TraceStation{}, TraceStation{}}, {}}, .sizes = {2, 0}});
            }}};

}  // namespace

std::vector<std::pair<std::string, std::string>> message_seeds() {
  std::vector<std::pair<std::string, std::string>> seeds;
  for (std::size_t kind = 0; kind < kContents.size(); ++kind)
    seeds.emplace_back(std::string("message/") + kContents[kind].name,
                       static_cast<char>(kind) + kContents[kind].seed());
  return seeds;
}

// The first byte tells the type of the message.
void message(Bytes bytes) {
  if (bytes.empty()) return;
  const Content& content = kContents[bytes[0] % kContents.size()];
  const std::string text = text_of(bytes.subspan(1));
  accepts([&] {
    const std::string once = content.rewritten(text);
    require(content.rewritten(once) == once, "what is written is read as the same");
  });
}

}  // namespace vantage::fuzz
