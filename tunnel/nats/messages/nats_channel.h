// The bytes to and from one NATS server, in TLS where it asks for that. start_tls() waits; from
// then on nothing does.
//
// Units/frames: bytes.
// Ownership:    owns socket and session.
// Threads:      one at a time.
// Failure:      start_tls() says what is wrong with certificates or names; later nullopt is the end
//               of the connection. In TLS the program must ignore SIGPIPE, or the write that finds
//               the end is the program's too.
#pragma once

#include <openssl/ssl.h>

#include <memory>
#include <string>

#include "core/net/tcp_socket.h"
#include "tunnel/nats/nats_deadline.h"
#include "tunnel/nats/nats_options.h"

namespace dance {

class NatsChannel {
 public:
  explicit NatsChannel(TcpSocket socket) : socket_(std::move(socket)) {}

  // `host` is what its certificate must bear.
  Result<void> start_tls(const NatsOptions& options, const std::string& host,
                         const NatsDeadline& deadline);

  int fd() const { return socket_.fd(); }
  // As TcpSocket. A poller misses none of what is there where one reads until less than asked for
  // came, or until has_pending() is false.
  std::optional<std::size_t> read(std::span<std::uint8_t> into);
  // In TLS bytes have been taken from the socket that were not read.
  bool has_pending() const { return tls_ && SSL_has_pending(tls_.get()) == 1; }
  // After 0 the same bytes must come first again.
  std::optional<std::size_t> write(std::span<const std::uint8_t> from);
  bool wait_for_bytes(Duration longest) const { return socket_.wait_for_bytes(longest); }

 private:
  struct TlsDeleter {
    void operator()(SSL* it) const { SSL_free(it); }
  };
  TcpSocket socket_;
  std::unique_ptr<SSL, TlsDeleter> tls_;
};

}  // namespace dance
