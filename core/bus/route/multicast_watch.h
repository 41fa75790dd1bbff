// MulticastWatch: over which network device this machine sends a multicast group, and a descriptor
// that becomes readable when that may have changed: a cable, Wi-Fi, a VPN, a route.
//
// Ownership: owns its sockets, so that it looks at the network namespace that it was opened in.
// Failure:   open() returns nullptr where the kernel refuses the socket.
// Source:    rtnetlink(7).
#pragma once

#include <cstdint>
#include <memory>
#include <string>

namespace dance {

class MulticastWatch {
 public:
  struct State {
    int device = 0;  // index; 0 = there is no route, or one that prohibits it
    std::string name;
    bool is_loopback_up = false;
    bool operator==(const State&) const = default;
  };

  // The group's first byte is the highest.
  static std::unique_ptr<MulticastWatch> open(std::uint32_t group);
  ~MulticastWatch();
  MulticastWatch(const MulticastWatch&) = delete;
  MulticastWatch& operator=(const MulticastWatch&) = delete;

  int fd() const { return fd_; }
  // Reads all pending reports. True if there was one.
  bool drain();
  // Asks the kernel.
  State state() const;

 private:
  explicit MulticastWatch(std::uint32_t group) : group_(group) {}

  std::uint32_t group_;
  int fd_ = -1;          // reports
  int request_fd_ = -1;  // route requests
  int device_fd_ = -1;   // names and flags of devices
};

// `socket_fd`: any IPv4 socket.
bool loopback_is_up(int socket_fd);

}  // namespace dance
