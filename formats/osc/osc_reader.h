// OscReader: takes a datagram of Open Sound Control apart into its messages.
//
// Units/frames: none.
// Ownership:    keeps counts only. Allocates for damaged packets alone (the library's exceptions,
//               which end here).
// Threads:      none inside; one owner.
// Failure:      read() returns false for a damaged packet and counts it; messages before the damage
//               have been passed on. Bundles nested deeper than kMostDepth and messages beyond
//               kMostMessages count as damage.
// Source:       Open Sound Control 1.0 specification.
#pragma once

#include <cstdint>
#include <span>

#include "formats/osc/osc_message.h"

namespace dance {

class OscMessageSink {
 public:
  virtual ~OscMessageSink() = default;
  virtual void on_message(const OscMessage& message) = 0;
};

class OscReader {
 public:
  static constexpr int kMostDepth = 4;
  static constexpr int kMostMessages = 512;
  struct Counters {
    std::uint64_t packets = 0;
    std::uint64_t messages = 0;
    std::uint64_t damaged = 0;
  };

  bool read(std::span<const std::uint8_t> packet, OscMessageSink& sink);
  const Counters& counters() const { return counters_; }

 private:
  Counters counters_;
};

}  // namespace dance
