// SPDX-License-Identifier: Apache-2.0
// Messages between ranks: stations and jobs one way, integer counts the other.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "ranks/wire.hpp"
#include "trace/registration_sums.hpp"
#include "trace/tracer.hpp"

namespace vantage::ranks {

// First byte of a message. A serial number follows; an answer has its request's.
enum class Kind : std::uint8_t {
  // rank 0 to others
  open,  // Identity: does the rank have a tracer for it?
  goal,  // goal density; no answer
  scan,
  count,
  count_each,
  sample,   // new sample for sampled counts; no answer
  patches,  // new registration job, except `groups`; no answer
  count_sampled,
  stop,  // abandons the request of this number, which is no longer answered
  end,   // ends the worker
  // others to rank 0
  answer,
  error,     // replaces an answer: Errc, text
  progress,  // share done
  failed,    // nothing could be served: text
};
struct Head {
  Kind kind = Kind::end;
  std::uint64_t serial = 0;
};
Writer begin(Kind kind, std::uint64_t serial);
Head read_head(Reader& reader);

// Properties that ranks compare to know that they trace the same; every part must be equal.
struct Identity {
  std::string version;
  std::uint64_t fingerprint = 0;  // of the scene
  std::uint64_t voxels = 0;       // of the grid
  std::uint64_t scanners = 0;     // their patterns, noise and limits
  friend bool operator==(const Identity&, const Identity&) = default;
};
Identity identity_of(const TraceScene& scene, std::uint64_t fingerprint);
// Describes the differences; empty if there are none.
std::string difference(const Identity& here, const Identity& there);

// A rank's answer to `open`.
struct Opened {
  bool known = false;
  std::uint32_t tracer = 0;  // number used in requests
  Identity own;              // of the scene that the rank loaded
  std::string host, device;
  Engine engine = Engine::embree;
};

// Networks with their sizes.
struct Networks {
  std::vector<std::vector<TraceStation>> stations;
  std::vector<std::uint32_t> sizes;
};

void pass(Writer& writer, const Identity& identity);
void pass(Reader& reader, Identity& identity);
void pass(Writer& writer, const Opened& opened);
void pass(Reader& reader, Opened& opened);
void pass(Writer& writer, const TraceStation& station);
void pass(Reader& reader, TraceStation& station);
void pass(Writer& writer, const NetworkCounts& counts);
void pass(Reader& reader, NetworkCounts& counts);
void pass(Writer& writer, const PassField& field);
void pass(Reader& reader, PassField& field);
void pass(Writer& writer, const Tracer::RawChunk& chunk);
void pass(Reader& reader, Tracer::RawChunk& chunk);
void pass(Writer& writer, const RegistrationJob& job);
void pass(Reader& reader, RegistrationJob& job);
void write_networks(Writer& writer, std::span<const std::vector<TraceStation>> stations,
                    std::span<const std::uint32_t> sizes);
Networks read_networks(Reader& reader);
void write_counts(Writer& writer, std::span<const NetworkCounts> counts);
std::vector<NetworkCounts> read_counts(Reader& reader);

}  // namespace vantage::ranks
