// An attack on a tunnel server's newcomers: one owner of many IPv6 networks begins
// handshakes at a given rate, each from a random /64 of the prefix. It answers the server's
// cookie, which proves that the addresses are real, and then goes silent.
//
// Needs a local route to the prefix: `ip -6 route add local PREFIX dev lo`. For benchmarks and flow
// tests in a network namespace of their own.
//
// Threads:   sends and receives in a thread of its own, from start() to the end of its life.
// Failure:   make() names what the kernel refused and the cure.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "core/base/random.h"
#include "core/base/result.h"
#include "core/net/address.h"
#include "core/net/mono_clock.h"

namespace dance {

class NewcomerFlood {
 public:
  struct Options {
    Address server;  // IPv6
    double per_second = 3000.0;
    // The /64s are 2001:db8:0:0 … of this many low bits: 8 = all of a /56, 16 = all of a /48.
    int network_bits = 16;
    std::uint64_t seed = 1;
  };
  struct Totals {
    std::uint64_t hellos = 0;      // first datagrams, without a cookie
    std::uint64_t cookies = 0;     // that the server answered with
    std::uint64_t begun = 0;       // hellos that returned a cookie
    std::uint64_t handshakes = 0;  // datagrams of handshakes that the server began
  };

  // The networks that the flood comes from.
  static constexpr const char* kPrefix = "2001:db8::/48";

  static Result<std::unique_ptr<NewcomerFlood>> make(const Options& options);
  ~NewcomerFlood();
  NewcomerFlood(const NewcomerFlood&) = delete;
  NewcomerFlood& operator=(const NewcomerFlood&) = delete;

  void start();
  Totals totals() const { return {hellos_, cookies_, begun_, handshakes_}; }

 private:
  NewcomerFlood(const Options& options, int fd)
      : options_(options), random_(options.seed), fd_(fd) {}
  Result<void> make_hello();
  void run();
  void send_hello();
  bool receive();
  void send(const std::array<std::uint8_t, 16>& from, const std::vector<std::uint8_t>& bytes);

  Options options_;
  Random random_;
  int fd_;
  std::vector<std::uint8_t> hello_;  // without a cookie, of a real link
  std::atomic<std::uint64_t> hellos_{0}, cookies_{0}, begun_{0}, handshakes_{0};
  std::atomic<bool> is_stopped_{false};
  std::thread thread_;
};

}  // namespace dance
