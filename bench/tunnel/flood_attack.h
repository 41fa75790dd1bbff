// What a server on the internet has to stand, sent by one thread from many addresses of this
// machine: noise, hellos of nobody, recorded datagrams of a couple that dances (as they were,
// changed, and from elsewhere), old sessions played again, and handshakes with a wrong key.
//
// Units/frames: datagrams; bytes of them without headers.
// Ownership:    owns its sockets and its thread, which ends with it.
// Threads:      record() is called from the recording thread, totals() from any; the rest from its
//               owner's.
// Failure:      start() tells which socket could not be had.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string_view>
#include <thread>
#include <vector>

#include "core/base/random.h"
#include "core/base/result.h"
#include "core/net/udp_socket.h"

namespace dance {

enum class Attack : std::uint8_t {
  kNoise,
  kHello,
  kChanged,
  kReplayed,
  kOldSession,
  kWrongKey,
  kCount
};
constexpr std::size_t kAttacks = static_cast<std::size_t>(Attack::kCount);
constexpr std::array<std::string_view, kAttacks> kAttackNames{
    "noise",        "hellos of nobody", "changed recordings", "recordings from elsewhere",
    "old sessions", "wrong keys"};

class FloodAttack {
 public:
  struct Options {
    Address server;
    std::uint64_t datagrams = 1'000'000;
    double per_second = 50'000.0;
    std::size_t sources = 64;
    std::uint64_t seed = 1;
  };
  struct Totals {
    std::array<std::uint64_t, kAttacks> sent{};
    std::uint64_t bytes_sent = 0;
    std::uint64_t bytes_answered = 0;
    std::uint64_t let_in = 0;  // handshakes with a wrong key that succeeded
    std::uint64_t all_sent() const {
      std::uint64_t sum = 0;
      for (const std::uint64_t n : sent) sum += n;
      return sum;
    }
  };

  static Result<std::unique_ptr<FloodAttack>> make(const Options& options);
  ~FloodAttack();
  FloodAttack(const FloodAttack&) = delete;
  FloodAttack& operator=(const FloodAttack&) = delete;

  // A datagram that a listener on the line has seen on its way to the server.
  void record(std::span<const std::uint8_t> bytes);
  void start();
  bool is_over() const { return is_over_; }
  Totals totals() const;

 private:
  using Datagram = std::vector<std::uint8_t>;
  explicit FloodAttack(const Options& options) : options_(options), random_(options.seed) {}
  void run();
  Datagram recorded(bool is_of_begin);
  Datagram make(Attack attack);
  void make_hello();
  void take_answers();
  void try_wrong_key(MonoTime now);

  Options options_;
  Random random_;
  std::vector<UdpSocket> sockets_;
  Datagram hello_;
  mutable std::mutex mutex_;
  std::vector<Datagram> first_;   // of the recording: the couple's handshakes
  std::vector<Datagram> newest_;  // a ring
  std::size_t next_newest_ = 0;
  Totals totals_;
  std::atomic<bool> is_over_{false};
  std::atomic<bool> is_stopped_{false};
  std::thread thread_;
};

}  // namespace dance
