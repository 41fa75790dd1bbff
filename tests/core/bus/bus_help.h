// Buses for tests, in a private network.
//
// Ownership: plain functions.
// Threads:   one.
// Failure:   what cannot be opened fails the test that asked for it.
#pragma once

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>

#include <fstream>
#include <memory>
#include <string>

#include "core/bus/bus.h"
#include "core/net/mono_clock.h"

namespace dance {

constexpr const char* kUrl = "udpm://239.255.76.67:17667?ttl=0";

// The socket that receives, for its options: one of those that the bus's descriptor waits for.
inline int receive_socket_of(const Bus& bus) {
  std::ifstream waits_for("/proc/self/fdinfo/" + std::to_string(bus.fd()));
  for (std::string word; waits_for >> word;) {
    int fd = -1, domain = 0;
    socklen_t size = sizeof domain;
    if (word == "tfd:" && waits_for >> fd &&
        getsockopt(fd, SOL_SOCKET, SO_DOMAIN, &domain, &size) == 0 && domain == AF_INET)
      return fd;
  }
  return -1;
}

inline GuestId guest(const std::string& name) { return *GuestId::parse(name); }
inline Channel capture_of(const std::string& name) {
  return Channel::of(Signal::kPose, Where::kCapture, guest(name));
}

inline std::unique_ptr<Bus> open_bus() {
  auto bus = Bus::open(kUrl);
  EXPECT_TRUE(bus) << bus.error().what;
  return bus ? std::move(*bus) : nullptr;
}

// Drains the bus until `is_done`, or until nothing has come for so long that nothing more will.
template <class IsDone>
void drain_until(Bus& bus, IsDone is_done) {
  while (!is_done()) {
    pollfd readable{bus.fd(), POLLIN, 0};
    if (poll(&readable, 1, 2000) <= 0) return;
    bus.drain(mono_now());
  }
}

inline Pose numbered(std::uint32_t sequence) {
  Pose pose;
  pose.sequence = sequence;
  return pose;
}

}  // namespace dance
