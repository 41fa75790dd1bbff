#include "tunnel/link/core/link_session.h"

#include <algorithm>

#include "core/base/assert.h"

namespace dance {
namespace {

constexpr Duration kFirstHelloWait = Duration::ms(100);
constexpr Duration kLongestHelloWait = Duration::s(1);
// A path that was cut is there again within seconds, and the dance with it: for this many hellos,
// ten seconds, a link that had its session asks more often.
constexpr Duration kLongestWaitInLapse = Duration::ms(250);
constexpr int kHellosInLapse = 40;
constexpr Duration kPingPeriod = Duration::ms(200);
// Where poses say both ways that the path lives, and none is lost, fewer pings do.
constexpr Duration kDancingPingPeriod = Duration::ms(500);
constexpr Duration kLongestCalmRoundTrip = Duration::ms(250);
// The first pings come quickly: the shortest of eight round trips maps the clock well.
constexpr Duration kQuickPingPeriod = Duration::ms(50);
constexpr int kQuickPings = 8;
constexpr Duration kSilenceLimit = Duration::ms(900);
constexpr Duration kDancesOnInLapse = Duration::s(10);
constexpr Duration kRefusedGuestWait = Duration::s(1);

}  // namespace

MonoTime LinkSession::next_deadline() const {
  MonoTime next;
  if (hello_wanted_ && is_sealed_) next = next_hello_.is_set() ? next_hello_ : MonoTime::from_ns(1);
  if (!link_.is_connected()) return next;
  next = earlier(earlier(next, next_ping_), last_heard_ + kSilenceLimit);
  for (const LocalGuest& guest : link_.locals) next = earlier(next, guest.refused_until);
  return next;
}

void LinkSession::update(MonoTime now) {
  if (link_.locals.evict_silent(now)) {
    has_untold_removal_ = true;
    schedule_update(now);
  }
  if (link_.is_connected() && now - last_heard_ >= kSilenceLimit) begin_lapse(now);
  if (!link_.is_connected()) return;
  for (LocalGuest& guest : link_.locals) {
    if (!guest.refused_until.is_set() || now < guest.refused_until) continue;
    guest.refused_until = MonoTime();
    schedule_update(now);
  }
}

void LinkSession::send_due_hello(MonoTime now) {
  if (hello_wanted_ && is_sealed_ && now >= next_hello_) send_hello(now);
}

void LinkSession::set_state(LinkState state, MonoTime now) {
  if (link_.state == state) return;
  link_.state = state;
  if (link_.handlers.on_state) link_.handlers.on_state(state, now);
}

// Asks for the guests as they are now, in the session that stands or in a new one.
void LinkSession::schedule_update(MonoTime now) {
  hello_nonce_ = 0;
  hello_wait_ = kFirstHelloWait;
  if (!hello_wanted_) ask_from(now);
  hello_wanted_ = true;
}

void LinkSession::begin_lapse(MonoTime now) {
  ++link_.counters.lapses;
  hellos_in_lapse_ = 0;
  for (LocalGuest& guest : link_.locals) guest.refused_until = MonoTime();
  schedule_update(now);
  ask_from(now);
  set_state(LinkState::kLapsed, now);
}

void LinkSession::on_sealed(MonoTime now) {
  is_sealed_ = true;
  is_welcome_ = false;
  // The server does not know yet that this sealed session is ours.
  if (link_.state == LinkState::kConnected) return begin_lapse(now);
  schedule_update(now);
  ask_from(now);
}

void LinkSession::on_moved(MonoTime now) {
  next_ping_ = now;
  if (hello_wanted_) ask_from(now);
}

// The server ends: ask at once, then more and more slowly.
void LinkSession::on_goodbye(MonoTime now) {
  has_goodbye_ = true;
  if (link_.is_connected()) begin_lapse(now);
}

void LinkSession::on_unsealed(MonoTime now) {
  is_sealed_ = is_welcome_ = false;
  if (link_.state == LinkState::kConnected) begin_lapse(now);
}

void LinkSession::send_hello(MonoTime now) {
  // One nonce for all tries of one list of guests, so that an answer on a long path still counts.
  if (hello_nonce_ == 0) {
    do {
      hello_nonce_ = random_.next_u64();
    } while (hello_nonce_ == 0);
    hello_guests_.clear();
    for (std::size_t i = 0; i < link_.locals.size(); ++i) {
      if (link_.locals[i].refused_until.is_set()) continue;
      const bool pushed = hello_guests_.try_push(static_cast<std::uint8_t>(i));
      DANCE_ASSERT(pushed);
    }
  }
  wire::Hello hello;
  hello.nonce = hello_nonce_;
  hello.token = link_.options.token;
  hello.link_time_us = now.since_zero_us();
  hello.codecs = link_.options.codecs;
  hello.room = link_.options.room;
  hello.default_divider = link_.options.interest.others;
  for (const std::uint8_t i : hello_guests_) {
    const bool pushed = hello.guests.try_push(link_.locals[i].id);
    DANCE_ASSERT(pushed);
  }
  std::array<std::uint8_t, wire::kMaxHello> out;
  link_.send({out.data(), wire::build(hello, out)});
  ++link_.counters.hellos;
  const bool is_quick = link_.state == LinkState::kLapsed && hellos_in_lapse_ < kHellosInLapse;
  // Of four quick ones the first counts: another socket before a slow path's answer would miss it.
  if (!is_quick || hellos_in_lapse_ % 4 == 0) ++unanswered_hellos_;
  if (is_quick) ++hellos_in_lapse_;
  if (hello_wait_ < kFirstHelloWait) hello_wait_ = kFirstHelloWait;
  next_hello_ = now + hello_wait_;
  hello_wait_ = std::min(hello_wait_ * 2, is_quick ? kLongestWaitInLapse : kLongestHelloWait);
}

void LinkSession::send_ping(std::uint32_t roster_version, bool is_calm, MonoTime now) {
  wire::Ping ping;
  ping.sequence = ++ping_sequence_;
  ping.link_time_us = now.since_zero_us();
  ping.roster_version = roster_version;
  ping.round_trip_us = static_cast<std::uint32_t>(
      std::clamp<std::int64_t>(link_.clock.newest_round_trip().count_us(), 0, UINT32_MAX));
  ping.datagrams_received = static_cast<std::uint32_t>(link_.counters.datagrams_in);
  ping.poses_received = static_cast<std::uint32_t>(link_.counters.poses_received);
  for (const RemoteGuest& remote : link_.remotes)
    if (remote.in_use)
      ping.poses_lost += static_cast<std::uint32_t>(remote.heard.poses.counters().lost);
  ping.epoch = static_cast<std::uint32_t>(epoch_);
  std::array<std::uint8_t, 64> out;
  link_.send({out.data(), wire::build(ping, out)});
  if (quick_pings_left_ > 0) --quick_pings_left_;
  const bool is_near = link_.clock.newest_round_trip() < kLongestCalmRoundTrip;
  next_ping_ = now + (quick_pings_left_ > 0 ? kQuickPingPeriod
                      : is_calm && is_near  ? kDancingPingPeriod
                                            : kPingPeriod);
}

void LinkSession::heard_server(MonoTime now) {
  last_heard_ = now;
  // After a goodbye only a welcome counts: other datagrams were under way before it.
  if (link_.state == LinkState::kLapsed && !has_goodbye_) {
    // The server is there, and seems still to know the session. Only its welcome makes it certain:
    // what comes may have been under way since before it forgot.
    ++link_.counters.reconnects;
    unanswered_hellos_ = 0;
    next_ping_ = now;
    set_state(LinkState::kConnected, now);
  }
}

std::optional<wire::Welcome> LinkSession::parse_answer(wire::Bytes body) const {
  auto welcome = wire::parse_welcome(body);
  const bool is_answer = welcome && hello_wanted_ && hello_nonce_ != 0 &&
                         welcome->nonce == hello_nonce_ &&
                         welcome->slots.size() == hello_guests_.size() &&
                         link_.options.codecs.contains(welcome->codec) &&
                         link_.options.make_decoder(welcome->codec) != nullptr;
  if (!is_answer) welcome.reset();
  return welcome;
}

void LinkSession::begin(const wire::Welcome& welcome, MonoTime now) {
  if (is_new(welcome)) quick_pings_left_ = kQuickPings;
  epoch_ = welcome.epoch;
  is_welcome_ = true;
  hello_wanted_ = has_untold_removal_ = false;
  hello_nonce_ = 0;
  unanswered_hellos_ = 0;
  last_heard_ = now;
  has_goodbye_ = false;
  if (link_.state == LinkState::kLapsed) ++link_.counters.reconnects;
  set_state(LinkState::kConnected, now);
}

// Another link that the user starts is refused too, for as long.
void LinkSession::stay_away(Duration for_how_long, MonoTime now) {
  removed_until_ = now + for_how_long;
  is_welcome_ = has_goodbye_ = false;
  epoch_ = 0;
  hello_wanted_ = true;
  hello_nonce_ = 0;
  ask_from(now);
  set_state(LinkState::kConnecting, now);
}

bool LinkSession::on_refusal(wire::Bytes body, MonoTime now) {
  const auto refusal = wire::parse_refusal(body);
  if (!refusal) return false;
  const bool is_removal = refusal->cause == wire::Refusal::kRemoved;
  const bool is_unasked = is_removal && refusal->nonce == 0 && is_welcome_;
  const bool is_answer = hello_wanted_ && hello_nonce_ != 0 && refusal->nonce == hello_nonce_;
  if (!is_unasked && !is_answer) return false;
  unanswered_hellos_ = 0;
  if (is_removal) {
    stay_away(Duration::s(refusal->seconds), now);
    if (link_.handlers.on_refused) link_.handlers.on_refused(*refusal, now);
    return true;
  }
  if (link_.state == LinkState::kConnected) {
    // The session stands; only who was to be added is not. Asked for again in a while.
    for (LocalGuest& guest : link_.locals)
      if (!guest.has_slot && (!refusal->guest.is_set() || refusal->guest == guest.id))
        guest.refused_until = now + kRefusedGuestWait;
    const bool others_wait =
        has_untold_removal_ ||
        std::any_of(link_.locals.begin(), link_.locals.end(),
                    [](const auto& g) { return !g.has_slot && !g.refused_until.is_set(); });
    hello_wanted_ = false;
    if (others_wait) schedule_update(now);
  } else if (refusal->guest.is_set()) {
    leave_out(refusal->guest, now);
  }
  if (link_.handlers.on_refused) link_.handlers.on_refused(*refusal, now);
  return true;
}

// One name that is taken must not keep the house's others out: the next hello is without it, at
// once. When none is left all are asked for again, at the pace of the tries.
void LinkSession::leave_out(const GuestId& refused, MonoTime now) {
  const auto named =
      std::find_if(link_.locals.begin(), link_.locals.end(), [&](const LocalGuest& guest) {
        return guest.id == refused && !guest.refused_until.is_set();
      });
  if (named == link_.locals.end()) return;
  named->refused_until = now + kRefusedGuestWait;
  hello_nonce_ = 0;
  const bool others_wait =
      std::any_of(link_.locals.begin(), link_.locals.end(),
                  [](const LocalGuest& guest) { return !guest.refused_until.is_set(); });
  if (others_wait) {
    next_hello_ = now;
    return;
  }
  for (LocalGuest& guest : link_.locals) guest.refused_until = MonoTime();
}

// True during a lapse too, until the server has surely forgotten the session: the server may
// receive although this link does not, and a pose may be the first datagram through after a cut.
// A move to another server ends the session, and with it the sending.
bool LinkSession::may_send(MonoTime now) const {
  return link_.is_connected() ||
         (link_.state == LinkState::kLapsed && is_welcome_ && now - last_heard_ < kDancesOnInLapse);
}

bool LinkSession::on_pong(wire::Bytes body, MonoTime received) {
  const auto pong = wire::parse_pong(body);
  if (!pong || sequence_ahead(pong->sequence, ping_sequence_) < 0) return false;
  constexpr std::int64_t kOldestPing_us = 60'000'000;
  const std::int64_t received_us = received.since_zero_us();
  if (pong->link_time_us < received_us - kOldestPing_us || pong->link_time_us > received_us + 1)
    return false;
  return link_.clock.add({MonoTime::from_us(pong->link_time_us), pong->server_receive_us,
                          pong->server_send_us, received});
}

void LinkSession::send_goodbye() {
  if (!is_welcome_) return;
  std::array<std::uint8_t, wire::kSessionHeader> out;
  link_.send({out.data(), wire::build_bare(wire::Type::kGoodbye, out)});
  epoch_ = 0;
  is_welcome_ = false;
  link_.state = LinkState::kConnecting;
}

}  // namespace dance
