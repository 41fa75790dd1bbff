#include "tunnel/server/server_keepalive.h"

#include <algorithm>

namespace dance {
namespace {

constexpr Duration kSessionTimeout = Duration::ms(1900);  // with ServerCore's tick: within 2 s

}  // namespace

void ServerKeepalive::on_ping(std::size_t index, wire::Bytes body, MonoTime received,
                              MonoTime now) {
  const auto ping = wire::parse_ping(body);
  if (!ping) return server_.reject(ServerReject::kMalformed);
  ServerSession& session = server_.sessions[index];
  // Its welcome was lost, or is under way still.
  if (ping->epoch != static_cast<std::uint32_t>(session.epoch)) return send_goodbye(session.peer);
  session.newest_ping = *ping;
  session.knows_epoch = true;
  pace_.on_ping(index, now);
  wire::Pong pong;
  pong.sequence = ping->sequence;
  pong.link_time_us = ping->link_time_us;
  // A datagram may come in after the turn began and be of that turn all the same.
  pong.server_receive_us = received.since_zero_us();
  pong.server_send_us = std::max(now, received).since_zero_us();
  pong.datagrams_received = session.datagrams_received;
  std::array<std::uint8_t, 64> out;
  server_.send(session.peer, {out.data(), wire::build(pong, out)});
  // A newcomer is told everything at once, when the room is known.
  if (!server_.is_newcomer(index)) sync_.repeat(index, *ping, now);
}

void ServerKeepalive::sweep(MonoTime now) {
  for (std::size_t i = 0; i < server_.sessions.size(); ++i) {
    const ServerSession& session = server_.sessions[i];
    if (!session.in_use || session.is_remote()) continue;
    if (now - session.last_heard > kSessionTimeout) {
      ++server_.counters.sessions_timed_out;
      admission_.drop(i);
    } else {
      feedback_.repeat(i, now);
    }
  }
}

void ServerKeepalive::send_goodbye(PeerId peer) {
  std::array<std::uint8_t, wire::kSessionHeader> out;
  server_.send(peer, {out.data(), wire::build_bare(wire::Type::kGoodbye, out)});
}

void ServerKeepalive::send_goodbyes() {
  for (const ServerSession& session : server_.sessions)
    if (session.in_use && !session.is_remote()) send_goodbye(session.peer);
}

void ServerKeepalive::end_sessions() {
  send_goodbyes();
  for (std::size_t i = 0; i < server_.sessions.size(); ++i)
    if (server_.sessions[i].in_use && !server_.sessions[i].is_remote()) admission_.drop(i);
}

}  // namespace dance
