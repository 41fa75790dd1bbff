// ChannelFilter: a socket filter with which the kernel drops datagrams before they wake the
// program: those from other machines, unless the bus is open to the network, and those on channels
// that nothing here subscribed to. On a multicast bus every program receives every message; in a
// house with thirty dancers that is 3,600 a second for a program that only needs the beat.
//
// Ownership: keeps the beginnings of the subscribed names; the socket stays the caller's.
// Failure:   attach() returns false where the kernel refuses even the shortest filter. Where only
//            the full one has no room, the socket gets one that passes all names. Datagrams from
//            other machines are refused by either. The kernel counts what a filter drops together
//            with what a full buffer loses (`drops` in /proc/net/udp).
// Source:    Linux socket filters (Documentation/networking/filter.rst).
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace dance {

// The index of the loopback device in every Linux network namespace.
constexpr int kLoopbackIndex = 1;

class ChannelFilter {
 public:
  enum class Reach {
    kThisMachine,  // only what a program of this machine sent
    kNetwork,
  };
  // More beginnings are shortened until they are this few: the kernel bounds a filter's size.
  static constexpr std::size_t kMostBeginnings = 16;

  explicit ChannelFilter(Reach reach) : reach_(reach) {}

  // Adds names with this beginning to those that pass; "" adds all names and fragments. More than
  // that may pass.
  void want(std::string_view beginning);
  // Replaces the socket's filter by this one. The socket is never without a filter.
  bool attach(int socket_fd) const;

  // The list is sorted by length; no entry is a prefix of another.
  const std::vector<std::string>& beginnings() const { return beginnings_; }
  bool wants_everything() const { return beginnings_.size() == 1 && beginnings_[0].empty(); }

 private:
  void insert(std::string beginning);

  Reach reach_;
  std::vector<std::string> beginnings_;
};

// A filter for a socket that only sends: everything that arrives is dropped.
bool drop_everything(int socket_fd);

}  // namespace dance
