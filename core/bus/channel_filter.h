// ChannelFilter: a socket filter by which the kernel drops the messages of a bus that this program
// has not subscribed to. On a multicast bus every program receives every message, and LCM looks at
// a name only when its thread has been woken and the message copied: in a house that shows thirty
// dancers that would be 3,600 times a second for a program that only needs the beat.
//
// Ownership: keeps the beginnings of the subscribed names; the socket is LCM's.
// Threads:   none inside; one owner.
// Failure:   where the kernel takes no filter, or none as long as this, there is none, and LCM
//            chooses, as it does anyway: the same messages, with more work. The kernel counts what
//            it keeps back with what a full buffer loses (`drops` in /proc/net/udp).
// Source:    BSD packet filter as Linux takes it for any socket
//            (Documentation/networking/filter.rst); LCM's UDP multicast protocol: "LC02", sequence,
//            name, NUL, message.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace dance {

// How every name begins that a regular expression matches, as far as plain characters tell:
// "POSE/guest/" of "POSE/guest/[a-z0-9-]+", and nothing of ".*".
std::string_view plain_beginning(std::string_view regex);

// The UDP sockets of this process that are bound to a port.
std::vector<int> udp_sockets_on(int port);

class ChannelFilter {
 public:
  // More are cut shorter until they are so few: a program for the kernel has a bound.
  static constexpr std::size_t kMostBeginnings = 16;

  // From now on names that `regex` matches are wanted too. What is let through may be more than
  // what is wanted.
  void want(std::string_view regex);
  // In place of the one before. False where the kernel does not take it; then the socket has none.
  bool attach(int socket_fd) const;

  // None contains another; "" alone: everything; empty: nothing is wanted yet.
  const std::vector<std::string>& beginnings() const { return beginnings_; }

 private:
  void insert(std::string beginning);

  std::vector<std::string> beginnings_;
};

}  // namespace dance
