// A TCP connection to a server. Making it may wait for seconds; from then on nothing waits.
//
// Units/frames: bytes.
// Ownership:    owns the descriptor; never allocates.
// Threads:      one at a time.
// Failure:      begin() and finish() name the address and the reason; later an end of the
//               connection, from whatever cause, is nullopt, and stays so.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "core/base/result.h"
#include "core/base/time.h"
#include "core/net/address.h"

namespace dance {

// Whether a TCP server could use the address now: binds a socket to it for a moment. The error
// names the cause and the cure.
Result<void> try_tcp_port(const Address& local);

class TcpSocket {
 public:
  // A connection in steps: begin(), wait_for_room() until it says true, finish().
  static Result<TcpSocket> begin(const Address& to);
  Result<void> finish(const Address& to);
  TcpSocket(TcpSocket&& other) noexcept : fd_(other.fd_) { other.fd_ = -1; }
  TcpSocket& operator=(TcpSocket&& other) noexcept;
  ~TcpSocket();

  int fd() const { return fd_; }
  // How many bytes came, or went; 0 where none can now.
  std::optional<std::size_t> read(std::span<std::uint8_t> into);
  std::optional<std::size_t> write(std::span<const std::uint8_t> from);
  // Before the connection is watched by a poller: false when it took too long.
  bool wait_for_bytes(Duration longest) const;
  bool wait_for_room(Duration longest) const;

 private:
  explicit TcpSocket(int fd) : fd_(fd) {}
  int fd_ = -1;
};

}  // namespace dance
