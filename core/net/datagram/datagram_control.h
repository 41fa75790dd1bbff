// Control messages of a datagram: the kernel reports when it arrived and to which address of this
// machine; the sender sets the address that it leaves from.
//
// Units/frames: times are MonoTime of this process's clock.
// Threads:      plain functions; they allocate nothing.
// Failure:      what the kernel does not report stays as it is.
// Source:       ip(7), ipv6(7): IP_PKTINFO, IPV6_PKTINFO; SO_TIMESTAMPNS.
#pragma once

#include <sys/socket.h>

#include <cstddef>
#include <cstdint>

#include "core/base/time.h"
#include "core/net/address.h"

namespace dance {

// Room for the control messages of one datagram.
constexpr std::size_t kControlBytes = 96;

// The wall clock and this process's clock, read together.
struct ClockReadings {
  std::int64_t wall_ns;
  MonoTime mono;
};

// Fills in the time from the kernel's stamp, and the address that the sender asked for.
void read_control(msghdr& header, const ClockReadings& read, Address& from, MonoTime& received);

// Makes the datagram leave from the address that `to` has asked, if that is known; the route
// chooses the device. `control` has kControlBytes bytes and is aligned for a cmsghdr.
void set_source(const Address& to, Address::Family socket_family, char* control, msghdr& header);

}  // namespace dance
