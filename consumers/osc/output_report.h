// OutputReport: tells the user when no program receives what a consumer sends as datagrams, and
// when one does again: lines for a program's messages, each once. The system of a receiver refuses
// datagrams to a port without a program, and connected sockets report that. Other networks lose
// them without a report.
//
// Units/frames: tick() is called about once a second.
// Ownership:    plain value.
#pragma once

#include <optional>
#include <string>

#include "core/net/udp_socket.h"

namespace dance {

class OutputReport {
 public:
  // Seconds in a row in which most datagrams were refused, or most were not.
  static constexpr int kSeconds = 3;

  explicit OutputReport(std::string name) : name_(std::move(name)) {}

  std::optional<std::string> tick(const UdpSocket::Counters& counters, const Address& to) {
    const std::uint64_t sent = counters.sent - sent_, refused = counters.refused - refused_;
    sent_ = counters.sent;
    refused_ = counters.refused;
    if (sent == 0 && refused == 0) return std::nullopt;
    // The first datagram after a restart reports the refusal of the one before.
    const bool is_refused = 2 * refused > sent;
    if (is_refused == is_refused_) {
      others_ = 0;
      return std::nullopt;
    }
    if (++others_ < kSeconds) return std::nullopt;
    others_ = 0;
    is_refused_ = is_refused;
    if (!is_refused_) return name_ + ": a program receives at " + to.to_string() + " now";
    return name_ + ": no program receives at " + to.to_string() + " (" +
           std::to_string(counters.refused) +
           " datagrams were refused): start it, or send to where it listens with --address "
           "HOST:PORT";
  }

 private:
  std::string name_;
  std::uint64_t sent_ = 0, refused_ = 0;
  int others_ = 0;  // seconds in a row that are not as is_refused_
  bool is_refused_ = false;
};

}  // namespace dance
