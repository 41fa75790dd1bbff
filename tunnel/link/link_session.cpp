// How a link comes to its session, keeps it, and gets it back.
#include <algorithm>

#include "core/base/assert.h"
#include "tunnel/link/link_core.h"

namespace dance {
namespace {

constexpr Duration kFirstHelloWait = Duration::ms(100);
constexpr Duration kLongestHelloWait = Duration::s(1);
// A way that was cut is there again within seconds, and the dance with it: for this many hellos,
// ten seconds, a link that had its session asks more often.
constexpr Duration kLongestWaitInLapse = Duration::ms(250);
constexpr int kHellosInLapse = 40;
constexpr Duration kPingPeriod = Duration::ms(200);
// Where poses say both ways that the line lives, and none is lost, they need less company.
constexpr Duration kDancingPingPeriod = Duration::ms(500);
constexpr Duration kHeardOfLate = Duration::ms(100);
constexpr Duration kLongestCalmRoundTrip = Duration::ms(250);
// The first pings come quickly: the shortest of eight round trips maps the clock well.
constexpr Duration kQuickPingPeriod = Duration::ms(50);
constexpr int kQuickPings = 8;
constexpr Duration kSilenceLimit = Duration::ms(900);
constexpr Duration kRefusedGuestWait = Duration::s(1);
constexpr Duration kSilentGuestStays = Duration::s(10);

MonoTime earlier(MonoTime a, MonoTime b) {
  if (!a.is_set()) return b;
  return b.is_set() ? std::min(a, b) : a;
}

}  // namespace

MonoTime LinkCore::next_deadline() const {
  MonoTime next;
  if (hello_wanted_ && is_sealed_) next = next_hello_.is_set() ? next_hello_ : MonoTime::from_ns(1);
  if (state_ == LinkState::kConnected) {
    next = earlier(next, next_ping_);
    next = earlier(next, last_heard_ + kSilenceLimit);
    next = earlier(next, stream_.received.due());
    for (const LocalGuest& guest : locals_) next = earlier(next, guest.refused_until);
  }
  if (!stream_.bundle.is_empty()) next = earlier(next, stream_.bundle.due());
  return next;
}

MonoTime LinkCore::tick(MonoTime now) {
  let_silent_go(now);
  if (state_ == LinkState::kConnected && now - last_heard_ >= kSilenceLimit) begin_lapse(now);
  if (state_ == LinkState::kConnected) {
    for (LocalGuest& guest : locals_) {
      if (!guest.refused_until.is_set() || now < guest.refused_until) continue;
      guest.refused_until = MonoTime();
      schedule_update(now);
    }
    if (stream_.received.owes() && now >= stream_.received.due()) flush_records(now);
    if (now >= next_ping_) send_ping(now);
  }
  if (!may_send(now)) stream_.bundle.clear();
  if (!stream_.bundle.is_empty() && now >= stream_.bundle.due()) flush_records(now);
  if (hello_wanted_ && is_sealed_ && now >= next_hello_) send_hello(now);
  return next_deadline();
}

// Asks for the guests as they are now, in the session that stands or in a new one.
void LinkCore::schedule_update(MonoTime now) {
  hello_nonce_ = 0;
  hello_wait_ = kFirstHelloWait;
  if (!hello_wanted_) next_hello_ = now;
  hello_wanted_ = true;
}

void LinkCore::begin_lapse(MonoTime now) {
  ++counters_.lapses;
  hellos_in_lapse_ = 0;
  for (LocalGuest& guest : locals_) guest.refused_until = MonoTime();
  schedule_update(now);
  next_hello_ = now;
  deliver_state(LinkState::kLapsed, now);
}

void LinkCore::on_sealed(MonoTime now) {
  is_sealed_ = true;
  is_welcome_ = false;
  // The server does not know yet that this sealed session is ours.
  if (state_ == LinkState::kConnected) return begin_lapse(now);
  schedule_update(now);
  next_hello_ = now;
}

void LinkCore::on_moved(MonoTime now) {
  next_ping_ = now;
  if (hello_wanted_) next_hello_ = now;
}

void LinkCore::on_unsealed(MonoTime now) {
  is_sealed_ = is_welcome_ = false;
  if (state_ == LinkState::kConnected) begin_lapse(now);
}

void LinkCore::send_hello(MonoTime now) {
  // One nonce for all tries of one list of guests, so that an answer on a long line still counts.
  if (hello_nonce_ == 0) {
    do {
      hello_nonce_ = random_.next_u64();
    } while (hello_nonce_ == 0);
    hello_guests_.clear();
    for (std::size_t i = 0; i < locals_.size(); ++i) {
      if (locals_[i].refused_until.is_set()) continue;
      const bool pushed = hello_guests_.try_push(static_cast<std::uint8_t>(i));
      DANCE_ASSERT(pushed);
    }
  }
  wire::Hello hello;
  hello.nonce = hello_nonce_;
  hello.token = options_.token;
  hello.link_time_us = now.since_zero_us();
  hello.codecs = options_.codecs;
  hello.room = options_.room;
  hello.default_divider = options_.interest.others;
  for (const std::uint8_t i : hello_guests_) {
    const bool pushed = hello.guests.try_push(locals_[i].id);
    DANCE_ASSERT(pushed);
  }
  std::array<std::uint8_t, wire::kMaxHello> out;
  send_datagram({out.data(), wire::build(hello, out)});
  ++counters_.hellos;
  const bool is_quick = state_ == LinkState::kLapsed && hellos_in_lapse_ < kHellosInLapse;
  // Of four quick ones the first counts: another socket before a slow way's answer would miss it.
  if (!is_quick || hellos_in_lapse_ % 4 == 0) ++unanswered_hellos_;
  if (is_quick) ++hellos_in_lapse_;
  if (hello_wait_ < kFirstHelloWait) hello_wait_ = kFirstHelloWait;
  next_hello_ = now + hello_wait_;
  hello_wait_ = std::min(hello_wait_ * 2, is_quick ? kLongestWaitInLapse : kLongestHelloWait);
}

Duration LinkCore::ping_period(MonoTime now) const {
  if (quick_pings_left_ > 0) return kQuickPingPeriod;
  const bool is_dancing = count_dancing(now) > 0 && heard_records_.is_set() &&
                          now - heard_records_ < kHeardOfLate && is_way_clean();
  const bool is_calm = interest_.is_acked() && clock_.newest_round_trip() < kLongestCalmRoundTrip;
  return is_dancing && is_calm ? kDancingPingPeriod : kPingPeriod;
}

void LinkCore::send_ping(MonoTime now) {
  wire::Ping ping;
  ping.sequence = ++ping_sequence_;
  ping.link_time_us = now.since_zero_us();
  ping.roster_version = roster_.whole_version();
  ping.round_trip_us = static_cast<std::uint32_t>(
      std::clamp<std::int64_t>(clock_.newest_round_trip().count_us(), 0, UINT32_MAX));
  ping.datagrams_received = static_cast<std::uint32_t>(counters_.datagrams_in);
  ping.poses_received = static_cast<std::uint32_t>(counters_.poses_received);
  for (const RemoteGuest& remote : remotes_)
    if (remote.in_use) ping.poses_lost += static_cast<std::uint32_t>(remote.poses.counters().lost);
  ping.epoch = static_cast<std::uint32_t>(epoch_);
  std::array<std::uint8_t, 64> out;
  send_datagram({out.data(), wire::build(ping, out)});
  if (quick_pings_left_ > 0) --quick_pings_left_;
  next_ping_ = now + ping_period(now);
  repeat_states(now);
  if (!interest_.is_acked()) tell_interest();
}

void LinkCore::heard_server(MonoTime now) {
  last_heard_ = now;
  if (state_ == LinkState::kLapsed) {
    // The server is there, and seems still to know the session. Only its welcome makes it certain:
    // what comes may have been under way since before it forgot.
    ++counters_.reconnects;
    unanswered_hellos_ = 0;
    next_ping_ = now;
    deliver_state(LinkState::kConnected, now);
  }
}

void LinkCore::on_welcome(wire::Bytes body, MonoTime received, MonoTime now) {
  const auto welcome = wire::parse_welcome(body);
  const bool is_answer =
      welcome && hello_wanted_ && hello_nonce_ != 0 && welcome->nonce == hello_nonce_ &&
      welcome->slots.size() == hello_guests_.size() && options_.codecs.contains(welcome->codec) &&
      options_.make_decoder(welcome->codec) != nullptr;
  if (!is_answer) {
    ++counters_.rejected_datagrams;
    return;
  }
  const bool is_new = welcome->epoch != epoch_;
  codec_ = welcome->codec;
  if (is_new) {
    begin_session_records();
    forget_room();
    interest_.begin(options_.interest.others);
    clock_.reset();
    roster_.reset();
    for (RemoteGuest& remote : remotes_) {
      keep_counts(remote);
      remote.poses = StreamGate();
      remote.hands = StreamGate();
      remote.has_decoded = false;
      remote.state_versions = {};
      remote.channels = {};
      if (remote.decoder) renew_decoder(remote);
    }
  }
  epoch_ = welcome->epoch;
  is_welcome_ = true;
  for (LocalGuest& guest : locals_) guest.has_slot = false;
  for (std::size_t i = 0; i < hello_guests_.size(); ++i) {
    LocalGuest& guest = locals_[hello_guests_[i]];
    const wire::Slot& slot = welcome->slots[i];
    const bool is_same =
        !is_new && guest.slot.slot == slot.slot && guest.slot.generation == slot.generation;
    if (!is_same) stream_.states.forget(slot.slot);
    guest.has_slot = true;
    guest.slot = slot;
    // A new session's hearers know nothing of what was encoded before.
    if (!guest.encoder || guest.encoder->name() != codec_ || !is_same) settle_encoder(guest);
  }
  clock_.add({MonoTime::from_us(welcome->link_time_us), welcome->server_receive_us,
              welcome->server_send_us, received});
  if (is_new) map_wished_music();
  hello_wanted_ = false;
  removal_untold_ = false;
  hello_nonce_ = 0;
  unanswered_hellos_ = 0;
  last_heard_ = now;
  if (state_ == LinkState::kLapsed) ++counters_.reconnects;
  if (is_new) quick_pings_left_ = kQuickPings;
  deliver_state(LinkState::kConnected, now);
  send_ping(now);  // brings what was lost of the roster and the states
}

void LinkCore::on_refusal(wire::Bytes body, MonoTime now) {
  const auto refusal = wire::parse_refusal(body);
  if (!refusal || !hello_wanted_ || hello_nonce_ == 0 || refusal->nonce != hello_nonce_) {
    ++counters_.rejected_datagrams;
    return;
  }
  unanswered_hellos_ = 0;
  if (state_ == LinkState::kConnected) {
    // The session stands; only who was to be added is not. Asked for again in a while.
    for (LocalGuest& guest : locals_)
      if (!guest.has_slot && (!refusal->guest.is_set() || refusal->guest == guest.id))
        guest.refused_until = now + kRefusedGuestWait;
    const bool others_wait =
        removal_untold_ || std::any_of(locals_.begin(), locals_.end(), [](const auto& g) {
          return !g.has_slot && !g.refused_until.is_set();
        });
    hello_wanted_ = false;
    roster_.reset();  // who bears the name is somebody else: the roster must be read again
    if (others_wait) schedule_update(now);
  } else if (refusal->guest.is_set()) {
    leave_out(refusal->guest, now);
  }
  if (handlers_.on_refused) handlers_.on_refused(*refusal, now);
}

// One name that is taken must not keep the house's others out: the next hello is without it, at
// once. When none is left all are asked for again, at the pace of the tries.
void LinkCore::leave_out(const GuestId& refused, MonoTime now) {
  const auto named = std::find_if(locals_.begin(), locals_.end(), [&](const LocalGuest& guest) {
    return guest.id == refused && !guest.refused_until.is_set();
  });
  if (named == locals_.end()) return;
  named->refused_until = now + kRefusedGuestWait;
  hello_nonce_ = 0;
  const bool others_wait = std::any_of(locals_.begin(), locals_.end(), [](const LocalGuest& guest) {
    return !guest.refused_until.is_set();
  });
  if (others_wait) {
    next_hello_ = now;
    return;
  }
  for (LocalGuest& guest : locals_) guest.refused_until = MonoTime();
}

// A guest who came with a pose and whose producer has ended gives the name back to the room.
void LinkCore::let_silent_go(MonoTime now) {
  const auto is_gone = [&](const LocalGuest& guest) {
    return guest.came_with_pose && now - guest.last_pose > kSilentGuestStays;
  };
  if (std::erase_if(locals_, is_gone) == 0) return;
  removal_untold_ = true;
  schedule_update(now);
}

bool LinkCore::on_session_datagram(const wire::Opening& opening, MonoTime received, MonoTime now) {
  bool is_good = false;
  switch (opening.type) {
    case wire::Type::kPong:
      is_good = on_pong(opening.body, received);
      break;
    case wire::Type::kRecords:
      is_good = on_records(opening.body, received, now);
      break;
    case wire::Type::kRoster:
      is_good = on_roster(opening.body, now);
      break;
    case wire::Type::kState:
      is_good = on_states(opening.body, now);
      break;
    case wire::Type::kStateAck:
      is_good = on_state_acks(opening.body);
      break;
    case wire::Type::kInterestAck:
      is_good = on_interest_ack(opening.body);
      break;
    case wire::Type::kGoodbye:
      if (!opening.body.empty()) return false;
      // The server ends: ask at once, then more and more slowly.
      if (state_ == LinkState::kConnected) begin_lapse(now);
      return true;
    default:
      return false;
  }
  if (is_good) heard_server(now);
  return is_good;
}

bool LinkCore::on_pong(wire::Bytes body, MonoTime received) {
  const auto pong = wire::parse_pong(body);
  if (!pong || sequence_ahead(pong->sequence, ping_sequence_) < 0) return false;
  constexpr std::int64_t kOldestPing_us = 60'000'000;
  const std::int64_t received_us = received.since_zero_us();
  if (pong->link_time_us < received_us - kOldestPing_us || pong->link_time_us > received_us + 1)
    return false;
  return clock_.add({MonoTime::from_us(pong->link_time_us), pong->server_receive_us,
                     pong->server_send_us, received});
}

void LinkCore::say_goodbye() {
  if (!is_welcome_) return;
  std::array<std::uint8_t, wire::kSessionHeader> out;
  send_datagram({out.data(), wire::build_bare(wire::Type::kGoodbye, out)});
  epoch_ = 0;
  is_welcome_ = false;
  state_ = LinkState::kConnecting;
}

}  // namespace dance
