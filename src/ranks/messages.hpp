// SPDX-License-Identifier: Apache-2.0
// What ranks tell each other: stations and jobs one way, whole-number counts the other.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "ranks/wire.hpp"
#include "trace/registration_sums.hpp"
#include "trace/tracer.hpp"

namespace vantage::ranks {

// The first byte of a letter. Behind it, a serial number: an answer has its question's.
enum class Kind : std::uint8_t {
  // rank 0 to others
  open,  // Identity: have you the tracer of it?
  goal,  // goal density; not answered
  scan,
  count,
  count_each,
  sample,   // new sample for sampled counts; not answered
  patches,  // new registration job, but for `groups`; not answered
  count_sampled,
  stop,  // the question of this number is given up, and is not answered any more
  end,   // go home
  // others to rank 0
  answer,
  error,     // in place of an answer: Errc, text
  progress,  // share done
  failed,    // before there was anything to serve: text
};
struct Head {
  Kind kind = Kind::end;
  std::uint64_t serial = 0;
};
Writer begin(Kind kind, std::uint64_t serial);
Head read_head(Reader& reader);

// By which ranks know that they trace the same: a part each that is to be equal.
struct Identity {
  std::string version;
  std::uint64_t fingerprint = 0;  // of the scene
  std::uint64_t voxels = 0;       // of the grid
  std::uint64_t scanners = 0;     // their patterns, noise and limits
  friend bool operator==(const Identity&, const Identity&) = default;
};
Identity identity_of(const TraceScene& scene, std::uint64_t fingerprint);
// What is not the same, in words; empty where all is.
std::string difference(const Identity& here, const Identity& there);

// A rank's answer to `open`.
struct Opened {
  bool known = false;
  std::uint32_t tracer = 0;  // to be named in what is asked of it
  Identity own;              // of the rank's scene as it was loaded
  std::string host, device;
  Engine engine = Engine::embree;
};

// Networks with the sizes that go with them.
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
void pass(Writer& writer, const VoxelField& field);
void pass(Reader& reader, VoxelField& field);
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
