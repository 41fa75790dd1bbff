// Buses for tests, over real LCM in a private network.
//
// Ownership: plain functions.
// Threads:   one.
// Failure:   what cannot be opened fails the test that asked for it.
#pragma once

#include <gtest/gtest.h>
#include <poll.h>

#include <memory>
#include <string>

#include "core/bus/bus.h"
#include "core/net/mono_clock.h"

namespace dance {

constexpr const char* kUrl = "udpm://239.255.76.67:17667?ttl=0";

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
