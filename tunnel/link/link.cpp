#include "tunnel/link/link.h"

#include <algorithm>

#include "core/base/assert.h"
#include "core/net/mono_clock.h"
#include "core/net/secure_random.h"

namespace dance {
namespace {

constexpr int kLinkBatches = 8;
// A socket keeps the address of the network it was made on. When the server stays silent, the house
// may have moved to another one: every so many hellos a new socket is tried.
constexpr int kHellosPerSocket = 4;
constexpr Duration kTroubleIsSaidEach = Duration::s(30);
constexpr Duration kLookUpEach = Duration::s(5);

// Leaves out addresses to which this machine has no route (IPv6 on a machine without it, say).
// Without any address the socket leads nowhere.
Result<UdpSocket> socket_to(std::vector<Address>& server) {
  if (server.empty()) return UdpSocket::bind(Address::loopback(0));
  auto socket = UdpSocket::connect(server.front());
  while (!socket && server.size() > 1) {
    server.erase(server.begin());
    socket = UdpSocket::connect(server.front());
  }
  return socket;
}

}  // namespace

Result<std::unique_ptr<Link>> Link::open(std::vector<Address> server, const LinkKey& key,
                                         LinkOptions options, LinkHandlers handlers,
                                         Poller& poller) {
  DANCE_ASSERT(!server.empty() || options.look_up);
  DANCE_TRY(auto context, key.context());
  std::unique_ptr<NameLookup> lookup;
  if (options.look_up) {
    DANCE_TRY(lookup, NameLookup::create(options.look_up));
  }
  auto socket = socket_to(server);
  // No network at the moment: the addresses are resolved again when there is one.
  if (!socket && lookup) {
    server.clear();
    socket = socket_to(server);
  }
  if (!socket) return tl::make_unexpected(socket.error());
  while (options.token == 0) options.token = secure_random_u64();
  if (options.clock_id == 0) options.clock_id = this_clock_id();
  options.seed = secure_random_u64();
  return std::unique_ptr<Link>(new Link(std::move(server), std::move(*socket), std::move(context),
                                        std::move(lookup), options, std::move(handlers), poller));
}

Link::Link(std::vector<Address> server, UdpSocket socket, std::unique_ptr<SealContext> context,
           std::unique_ptr<NameLookup> lookup, const LinkOptions& options, LinkHandlers handlers,
           Poller& poller)
    : poller_(poller),
      server_(std::move(server)),
      probe_(poller, [this](const Address& from) { candidates_.note_answer(from); }),
      on_other_server_(handlers.on_other_server),
      on_no_answer_(handlers.on_no_answer),
      on_no_entry_(handlers.on_no_entry),
      clock_id_(options.clock_id),
      begin_(mono_now()),
      lookup_(std::move(lookup)),
      on_new_address_(handlers.on_new_address),
      on_unknown_name_(handlers.on_unknown_name),
      socket_(std::move(socket)),
      sink_(socket_),
      seal_(std::move(context), secure_random_u64, seal_handlers(), sink_),
      core_(options, with_servers(std::move(handlers), *this), seal_) {
  watch_socket();
  addresses_ = AddressWatch::open();
  if (addresses_)
    poller_.watch(addresses_->fd(), [this](MonoTime now) {
      if (addresses_->drain()) on_addresses_changed(now);
    });
  if (lookup_) poller_.watch(lookup_->fd(), [this](MonoTime now) { on_looked_up(now); });
  timer_ = poller_.add_timer(begin_, [this](MonoTime now) { return tick(now); });
}

LinkHandlers Link::with_servers(LinkHandlers handlers, Link& link) {
  handlers.on_servers = [&link](const wire::ServerList& servers, MonoTime now) {
    link.on_servers(servers, now);
  };
  return handlers;
}

void Link::on_servers(const wire::ServerList& servers, MonoTime now) {
  choice_.set_current(server());
  if (choice_.set_others(candidates_.accept(server(), servers, now))) plan_probe(now);
}

void Link::plan_probe(MonoTime now) {
  probe_due_ = candidates_.probe_due(choice_.all(), now);
  probe_rounds_ = 0;
}

bool Link::have_answered(const std::vector<Address>& servers) const {
  return std::ranges::all_of(
      servers, [this](const Address& server) { return candidates_.has_answered(server); });
}

// Moves to the nearest server after connecting, and to the next one while the server is silent or
// has ended.
void Link::choose_server(MonoTime now) {
  if (core_.is_connected()) {
    if (choice_.is_in_lapse()) candidates_.note_welcome(server());
    if (choice_.end_lapse()) plan_probe(now);
  } else if (core_.state() == LinkState::kLapsed && choice_.has_others() &&
             !choice_.is_in_lapse() && !have_answered(choice_.all())) {
    plan_probe(now);
  }
  probe_servers(now);
  if (core_.state() != LinkState::kLapsed) return;
  const auto other = choice_.next(core_.has_goodbye(), candidates_, now);
  if (other) move_to(*other, now);
}

void Link::probe_servers(MonoTime now) {
  const bool was_done = probe_.is_done();
  probe_.tick(now);
  if (probe_due_.is_set() && now >= probe_due_) {
    probe_due_ = MonoTime();
    const std::vector<Address> servers = choice_.all();
    candidates_.note_probes(servers, now);
    probe_.begin(servers, now);
  } else if (!was_done && probe_.is_done()) {
    on_probed(now);
  }
}

void Link::on_probed(MonoTime now) {
  constexpr int kMostRounds = 3;
  const std::vector<Address> servers = choice_.all();
  std::vector<ServerChoice::Distance> distances;
  for (const Address& server : servers) distances.push_back({server, probe_.round_trip(server)});
  choice_.set_distances(distances);
  // A datagram may have been lost, and only servers that have answered are used.
  const bool is_measured = probe_.round_trip(choice_.current()).has_value();
  if ((!is_measured || !have_answered(servers)) && ++probe_rounds_ < kMostRounds)
    probe_due_ = candidates_.probe_due(servers, now);
  if (!is_measured || core_.state() == LinkState::kLapsed) return;
  const auto other = choice_.choose();
  if (!other || !candidates_.take_try(*other, now)) return;
  choice_.begin_try(*other, now);
  move_to(*other, now);
}

void Link::move_to(const Address& server, MonoTime now) {
  auto socket = UdpSocket::connect(server);
  if (!socket) return;
  server_ = {server};
  tried_ = 0;
  poller_.unwatch(socket_.fd());
  socket_ = std::move(*socket);
  watch_socket();
  seal_.connect_to_other_server(now);
  if (on_other_server_) on_other_server_(server);
}

SealClient::Handlers Link::seal_handlers() {
  SealClient::Handlers handlers;
  handlers.on_sealed = [this](MonoTime now) { core_.on_sealed(now); };
  handlers.on_unsealed = [this](MonoTime now) { core_.on_unsealed(now); };
  handlers.on_datagram = [this](wire::Bytes plain, MonoTime received, MonoTime now) {
    core_.receive(plain, received, now);
  };
  handlers.on_trouble = [this](SealTrouble trouble, MonoTime now) { on_trouble(trouble, now); };
  return handlers;
}

void Link::on_trouble(SealTrouble trouble, MonoTime now) {
  if (trouble == SealTrouble::kNoAnswer) return try_another_socket();
  // Tried again every few seconds: said when it is news, and now and then.
  const bool is_news = !told_at_.is_set() || trouble != told_trouble_;
  if (!on_no_entry_ || (!is_news && now - told_at_ < kTroubleIsSaidEach)) return;
  told_trouble_ = trouble;
  told_at_ = now;
  on_no_entry_(trouble);
}

MonoTime Link::tick(MonoTime now) {
  if (core_.is_removed(now)) return next_deadline();
  if (server_.empty()) {
    look_up_server(now);
    return next_deadline();
  }
  choose_server(now);
  // Before the next hello, so that the one before had all its time.
  if (core_.unanswered_hellos() == 0) hellos_on_socket_ = 0;
  if (core_.unanswered_hellos() - hellos_on_socket_ >= kHellosPerSocket) {
    try_another_socket();
    if (seal_.is_trying()) seal_.begin_anew(now);
  }
  if (now >= seal_.next_deadline()) seal_.tick(now);
  core_.tick(now);
  return next_deadline();
}

MonoTime Link::next_deadline() const {
  // A host has removed this house: neither this server nor another is asked until then.
  if (core_.removed_until() > mono_now()) return core_.removed_until();
  if (server_.empty()) return std::max(next_lookup_, MonoTime::from_ns(1));
  const MonoTime core = core_.next_deadline();
  // Before its first turn the seal has no deadline: that is now, not never.
  const MonoTime seal = std::max(seal_.next_deadline(), MonoTime::from_ns(1));
  MonoTime next = core.is_set() ? std::min(core, seal) : seal;
  for (const MonoTime due : {probe_.next_deadline(), choice_.next_deadline(), probe_due_})
    if (due.is_set()) next = std::min(next, due);
  return next;
}

Link::~Link() {
  core_.send_goodbye();
  seal_.close();
  poller_.remove_timer(timer_);
  poller_.unwatch(socket_.fd());
  if (addresses_) poller_.unwatch(addresses_->fd());
  if (lookup_) poller_.unwatch(lookup_->fd());
}

// Another network: the session goes on from there, as soon as the server hears from there.
void Link::on_addresses_changed(MonoTime now) {
  if (server_.empty()) {
    next_lookup_ = now;
    return look_up_server(now);
  }
  const Address before = socket_.local_address();
  const auto probe = UdpSocket::connect(server_[tried_]);
  if (!probe || probe->local_address().with_port(0) == before.with_port(0)) return;
  if (!use_socket_to(tried_)) return;
  // A handshake is bound to where it began.
  if (seal_.is_trying()) seal_.begin_anew(now);
  core_.on_moved(now);
  rearm();
}

void Link::watch_socket() {
  poller_.watch(socket_.fd(), [this](MonoTime now) { on_readable(now); });
}

void Link::on_readable(MonoTime now) {
  for (int i = 0; i < kLinkBatches; ++i) {
    const auto batch = socket_.receive();
    for (const UdpSocket::Datagram& datagram : batch)
      seal_.receive(datagram.bytes, datagram.received, now);
    if (batch.size() < UdpSocket::kBatch) break;
  }
  rearm();
}

void Link::rearm() { poller_.set_deadline(timer_, next_deadline()); }

void Link::try_another_socket() {
  hellos_on_socket_ = core_.unanswered_hellos();
  if (server_.empty()) return;
  look_up_server(mono_now());
  // An address that has answered once is kept.
  std::size_t next = tried_;
  if (!has_server_answered()) {
    if (on_no_answer_) on_no_answer_(server_[tried_]);
    next = (tried_ + 1) % server_.size();
  }
  use_socket_to(next);
}

void Link::look_up_server(MonoTime now) {
  // The other servers of a cluster are known by their addresses.
  if (!lookup_ || choice_.has_others() || (next_lookup_.is_set() && now < next_lookup_)) return;
  next_lookup_ = now + kLookUpEach;
  lookup_->begin();
}

void Link::on_looked_up(MonoTime now) {
  auto found = lookup_->take();
  if (!found) return;
  next_lookup_ = now + kLookUpEach;
  // Meanwhile it may have answered.
  if (!core_.is_connected()) {
    if (*found && !(*found)->empty())
      use_addresses(std::move(**found), now);
    else if (on_unknown_name_ && !*found)
      on_unknown_name_(found->error().what);
  }
  rearm();
}

// The link sends nothing to the new address before its server has proved its key: otherwise the
// owner of a name could aim poses at a third host.
void Link::use_addresses(std::vector<Address> addresses, MonoTime now) {
  const Address before = server();
  const auto same = std::ranges::find(addresses, before);
  if (same != addresses.end()) {
    tried_ = static_cast<std::size_t>(same - addresses.begin());
    server_ = std::move(addresses);
    return;
  }
  auto socket = socket_to(addresses);
  if (!socket) return;
  server_ = std::move(addresses);
  tried_ = 0;
  sessions_elsewhere_ = seal_.counters().sessions;
  poller_.unwatch(socket_.fd());
  socket_ = std::move(*socket);
  watch_socket();
  seal_.connect_to_other_server(now);
  if (before.is_set()) core_.on_moved(now);
  if (on_new_address_) on_new_address_(server());
}

bool Link::use_socket_to(std::size_t which) {
  auto socket = UdpSocket::connect(server_[which]);
  if (!socket) return false;  // no network at all just now: the old one will do as well
  tried_ = which;
  poller_.unwatch(socket_.fd());
  socket_ = std::move(*socket);
  watch_socket();
  return true;
}

void Link::send_channel(std::string_view name, wire::Bytes message, MonoTime now,
                        const GuestId& guest) {
  core_.send_channel(name, message, now, guest);
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
  // What the seal keeps out is a stranger's or damaged; copies of what came may be the network's
  // own.
  stats.rejected_datagrams += static_cast<std::int64_t>(seal_.counters().forged);
  return stats;
}

}  // namespace dance
