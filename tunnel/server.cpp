#include "tunnel/server.h"

#include "core/net/secure_random.h"

namespace dance {
namespace {

// A flood gets this many batches a turn; then timers have their say.
constexpr int kBatchesPerTurn = 8;

}  // namespace

Result<std::unique_ptr<Server>> Server::open(const Address& local, const ServerLimits& limits,
                                             Poller& poller) {
  DANCE_TRY(UdpSocket socket, UdpSocket::bind(local));
  return std::unique_ptr<Server>(new Server(std::move(socket), limits, poller));
}

Server::Server(UdpSocket socket, const ServerLimits& limits, Poller& poller)
    : poller_(poller),
      socket_(std::move(socket)),
      unsealed_(socket_),
      core_(limits, secure_random_u64, unsealed_) {
  poller_.watch(socket_.fd(), [this](MonoTime now) { on_readable(now); });
  timer_ = poller_.add_timer(MonoTime(), [this](MonoTime now) {
    const MonoTime next = core_.tick(now);
    socket_.flush();
    return next;
  });
}

Server::~Server() {
  poller_.set_deadline(timer_, MonoTime());
  poller_.unwatch(socket_.fd());
}

void Server::on_readable(MonoTime now) {
  for (int i = 0; i < kBatchesPerTurn; ++i) {
    const auto batch = socket_.receive();
    for (const UdpSocket::Datagram& datagram : batch)
      core_.receive(unsealed_.peer_at(datagram.from), Access{.any_name = true}, datagram.bytes,
                    datagram.received, now);
    core_.end_turn(now);
    socket_.flush();
    if (batch.size() < UdpSocket::kBatch) break;
  }
  poller_.set_deadline(timer_, core_.next_deadline());
}

void Server::say_goodbye() {
  core_.say_goodbye();
  socket_.flush();
}

}  // namespace dance
