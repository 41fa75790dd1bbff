#include "tunnel/link.h"

#include "core/base/assert.h"
#include "core/net/mono_clock.h"
#include "core/net/secure_random.h"

namespace dance {
namespace {

constexpr int kLinkBatches = 8;
// A socket keeps the address of the network it was made on. When the server stays silent, the house
// may have moved to another one: every so many hellos a new socket is tried.
constexpr int kHellosPerSocket = 4;

}  // namespace

Result<std::unique_ptr<Link>> Link::open(std::vector<Address> server, LinkOptions options,
                                         LinkHandlers handlers, Poller& poller) {
  DANCE_ASSERT(!server.empty());
  // One that this machine has no way to (IPv6 without IPv6, say) is left out.
  auto socket = UdpSocket::connect(server.front());
  while (!socket && server.size() > 1) {
    server.erase(server.begin());
    socket = UdpSocket::connect(server.front());
  }
  if (!socket) return tl::make_unexpected(socket.error());
  while (options.token == 0) options.token = secure_random_u64();
  if (options.clock_id == 0) options.clock_id = this_clock_id();
  options.seed = secure_random_u64();
  return std::unique_ptr<Link>(
      new Link(std::move(server), std::move(*socket), options, std::move(handlers), poller));
}

Link::Link(std::vector<Address> server, UdpSocket socket, const LinkOptions& options,
           LinkHandlers handlers, Poller& poller)
    : poller_(poller),
      server_(std::move(server)),
      on_no_answer_(handlers.on_no_answer),
      clock_id_(options.clock_id),
      begin_(mono_now()),
      socket_(std::move(socket)),
      sink_(socket_),
      core_(options, std::move(handlers), sink_) {
  watch_socket();
  core_.on_sealed(begin_);  // UNSEALED FOR NOW: what seals sessions says when there is one
  timer_ = poller_.add_timer(begin_, [this](MonoTime now) {
    // Before the next hello, so that the one before had all its time.
    if (core_.unanswered_hellos() == 0) hellos_on_socket_ = 0;
    if (core_.unanswered_hellos() - hellos_on_socket_ >= kHellosPerSocket) try_another_socket();
    return core_.tick(now);
  });
}

Link::~Link() {
  core_.say_goodbye();
  poller_.set_deadline(timer_, MonoTime());
  poller_.unwatch(socket_.fd());
}

void Link::watch_socket() {
  poller_.watch(socket_.fd(), [this](MonoTime now) { on_readable(now); });
}

void Link::on_readable(MonoTime now) {
  for (int i = 0; i < kLinkBatches; ++i) {
    const auto batch = socket_.receive();
    for (const UdpSocket::Datagram& datagram : batch)
      core_.receive(datagram.bytes, datagram.received, now);
    if (batch.size() < UdpSocket::kBatch) break;
  }
  rearm();
}

void Link::rearm() {
  const MonoTime next = core_.next_deadline();
  if (next.is_set()) poller_.set_deadline(timer_, next);
}

void Link::try_another_socket() {
  hellos_on_socket_ = core_.unanswered_hellos();
  // Where the server has once answered, there it is.
  std::size_t next = tried_;
  if (core_.counters().datagrams_in == 0) {
    if (on_no_answer_) on_no_answer_(server_[tried_]);
    next = (tried_ + 1) % server_.size();
  }
  auto socket = UdpSocket::connect(server_[next]);
  if (!socket) return;  // no network at all just now: the old one will do as well
  tried_ = next;
  poller_.unwatch(socket_.fd());
  socket_ = std::move(*socket);
  watch_socket();
}

void Link::send(const GuestId& guest, const Pose& pose, MonoTime now) {
  core_.send(guest, pose, now);
  rearm();
}

void Link::send(const GuestId& guest, const Hands& hands, MonoTime now) {
  core_.send(guest, hands, now);
  rearm();
}

void Link::send(const GuestId& guest, const Skeleton& skeleton, MonoTime now) {
  core_.send(guest, skeleton, now);
  rearm();
}

void Link::set_interest(const Interest& interest, MonoTime now) {
  core_.set_interest(interest, now);
}

Duration Link::uptime() const { return mono_now() - begin_; }

Stats Link::stats(MonoTime now) const {
  Stats stats;
  stats.time = now;
  stats.clock_id = clock_id_;
  stats.uptime = now - begin_;
  core_.fill(stats);
  return stats;
}

}  // namespace dance
