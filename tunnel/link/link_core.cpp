#include "tunnel/link/link_core.h"

#include <algorithm>

#include "core/base/assert.h"

namespace dance {
namespace {

constexpr Duration kHeardOfLate = Duration::ms(100);

}  // namespace

LinkCore::LinkCore(const LinkOptions& options, LinkHandlers handlers, DatagramSink& sink)
    : link_(options, std::move(handlers), sink) {
  DANCE_ASSERT(options.token != 0);
  DANCE_ASSERT(options.room.is_set());
  DANCE_ASSERT(!options.listen_only || options.guests.empty());
  if (options.codecs.empty())
    for (const CodecName& name : known_codecs()) {
      const bool pushed = link_.options.codecs.try_push(name);
      DANCE_ASSERT(pushed);
    }
  for (const GuestId& id : options.guests)
    link_.locals.add(id, QualityByRate(options.quality_m, options.pose_bytes_per_second));
}

MonoTime LinkCore::next_deadline() const {
  return earlier(earlier(session_.next_deadline(), sender_.next_deadline()),
                 earlier(files_.next_deadline(), voice_.next_deadline()));
}

MonoTime LinkCore::tick(MonoTime now) {
  session_.update(now);
  if (is_connected()) {
    sender_.flush_acks(now);
    if (session_.is_ping_due(now)) send_ping(now);
  }
  if (!session_.may_send(now)) {
    link_.stream.bundle.clear();
    voice_.clear();
  }
  sender_.flush_due(now);
  voice_.flush_due(now);
  files_.send_due(now);  // after whatever dances
  session_.send_due_hello(now);
  return next_deadline();
}

// From this house.

LocalGuest* LinkCore::find_or_add(const GuestId& id, MonoTime now) {
  LocalGuest* guest = link_.locals.find(id);
  if (guest == nullptr) {
    if (link_.options.listen_only || link_.locals.is_full()) {
      ++(link_.options.listen_only ? link_.counters.unrouted : link_.counters.overflow);
      return nullptr;
    }
    const LinkOptions& options = link_.options;
    guest = &link_.locals.add(id, QualityByRate(options.quality_m, options.pose_bytes_per_second));
    guest->came_with_pose = true;
    session_.schedule_update(now);
  }
  return guest;
}
LocalGuest* LinkCore::find_or_add_dancer(const GuestId& id, MonoTime now) {
  LocalGuest* guest = find_or_add(id, now);
  if (guest != nullptr) guest->last_pose = now;
  return guest;
}

void LinkCore::send(const GuestId& id, const Pose& pose, MonoTime now) {
  ++link_.counters.poses_offered;
  LocalGuest* guest = find_or_add_dancer(id, now);
  if (guest == nullptr) return;
  if (session_.may_send(now) && guest->has_slot)
    sender_.send(*guest, pose, now);
  else
    ++link_.counters.unrouted;
}
void LinkCore::send(const GuestId& id, const Hands& hands, MonoTime now) {
  LocalGuest* guest = find_or_add_dancer(id, now);
  if (guest != nullptr && session_.may_send(now) && guest->has_slot)
    sender_.send(*guest, hands, now);
}
void LinkCore::send(const GuestId& id, const Skeleton& skeleton, MonoTime now) {
  if (LocalGuest* guest = find_or_add_dancer(id, now)) states_.send(*guest, skeleton, now);
}
// Speaking keeps a guest in the room as dancing does, but does not count as dancing.
void LinkCore::send(const GuestId& id, const Voice& voice, MonoTime now) {
  LocalGuest* guest = find_or_add(id, now);
  if (guest == nullptr) return;
  guest->last_voice = now;
  if (session_.may_send(now) && guest->has_slot)
    voice_.send(*guest, voice, now);
  else
    ++link_.counters.voices_unrouted;
}
void LinkCore::send(const GuestId& id, const Avatar& avatar, MonoTime now) {
  states_.send(id, wire::StateKind::kAvatar, avatar, now);
}
void LinkCore::send(const GuestId& id, const AvatarFile& file, MonoTime now) {
  states_.send(id, wire::StateKind::kAvatarFile, file, now);
}
void LinkCore::send(const GuestId& id, const Style& style, MonoTime now) {
  states_.send(id, wire::StateKind::kStyle, style, now);
}
void LinkCore::send(const GuestId& id, const Placement& placement, MonoTime now) {
  states_.send(id, wire::StateKind::kPlacement, placement, now);
}
void LinkCore::send(const GuestId& id, const Chat& chat, MonoTime now) {
  states_.send(id, chat, now);
}
void LinkCore::send(const GuestId& id, const Music& music, MonoTime now) {
  room_.send(id, music, now);
}
void LinkCore::send(const GuestId& id, const RoomSong& song, MonoTime now) {
  room_.send(id, song, now);
}
void LinkCore::send(const GuestId& id, const Scene& scene, MonoTime now) {
  room_.send(id, scene, now);
}
void LinkCore::send_channel(std::string_view name, wire::Bytes message, MonoTime now,
                            const GuestId& guest) {
  channels_.send(name, message, now, guest);
}

// From the server.

void LinkCore::receive(wire::Bytes datagram, MonoTime received, MonoTime now) {
  ++link_.counters.datagrams_in;
  link_.counters.bytes_in += datagram.size() + wire::kSealOverhead;
  const auto opening = wire::parse_opening(datagram);
  bool is_good = false;
  if (opening && opening->type == wire::Type::kWelcome)
    is_good = on_welcome(opening->body, received, now);
  else if (opening && opening->type == wire::Type::kRefusal)
    is_good = on_refusal(opening->body, now);
  // Anything else that comes before the welcome is of the sealed session before.
  else if (opening && session_.is_welcome())
    is_good = on_session_datagram(*opening, received, now);
  if (!is_good) ++link_.counters.rejected_datagrams;
}

bool LinkCore::on_session_datagram(const wire::Opening& opening, MonoTime received, MonoTime now) {
  bool is_good = false;
  switch (opening.type) {
    case wire::Type::kPong:
      is_good = session_.on_pong(opening.body, received);
      if (is_good) files_.see_round_trip(link_.clock.newest_round_trip(), now);
      break;
    case wire::Type::kRecords:
      is_good = receiver_.on_records(opening.body, received, now);
      break;
    case wire::Type::kVoices:
      is_good = voice_.on_voices(opening.body, now);
      break;
    case wire::Type::kRoster:
      is_good = roster_.on_roster(opening.body, now);
      interest_.update();
      break;
    case wire::Type::kState:
      is_good = states_.on_states(opening.body, now);
      break;
    case wire::Type::kStateAck:
      is_good = states_.on_acks(opening.body);
      break;
    case wire::Type::kInterestAck:
      is_good = interest_.on_ack(opening.body);
      break;
    case wire::Type::kFileTerms:
    case wire::Type::kFileWant:
    case wire::Type::kFileChunk:
    case wire::Type::kFileRefusal:
      is_good = files_.receive(opening, now);
      break;
    case wire::Type::kRemovalAnswer:
      is_good = removals_.on_answer(opening.body);
      break;
    case wire::Type::kRights:
      is_good = removals_.on_rights(opening.body);
      break;
    case wire::Type::kServers:
      is_good = on_servers(opening.body, now);
      break;
    case wire::Type::kGoodbye:
      if (!opening.body.empty()) return false;
      session_.on_goodbye(now);
      return true;
    default:
      return false;
  }
  if (is_good) session_.heard_server(now);
  return is_good;
}

// The order matters: guests are settled against the previous epoch, which session_.begin()
// replaces, and the room's music is mapped by the clock's new sample.
bool LinkCore::on_welcome(wire::Bytes body, MonoTime received, MonoTime now) {
  const auto welcome = session_.parse_answer(body);
  if (!welcome) return false;
  const bool is_new = session_.is_new(*welcome);
  link_.codec = welcome->codec;
  if (is_new) begin_session();
  session_.settle_guests(*welcome, [this](LocalGuest& guest) { sender_.begin_encoder(guest); });
  link_.clock.add({MonoTime::from_us(welcome->link_time_us), welcome->server_receive_us,
                   welcome->server_send_us, received});
  if (is_new) {
    room_.map_times();
    chat_.map_times();
  }
  session_.begin(*welcome, now);
  send_ping(now);  // brings what was lost of the roster and the states
  return true;
}

void LinkCore::begin_session() {
  sender_.begin_session();
  voice_.clear();
  files_.begin_session();
  room_.begin_session();
  interest_.begin_session();
  link_.clock.reset();
  link_.may_remove = false;
  roster_.begin_session();
}

bool LinkCore::on_servers(wire::Bytes body, MonoTime now) {
  const auto servers = wire::parse_servers(body);
  if (servers && link_.handlers.on_servers) link_.handlers.on_servers(*servers, now);
  return servers.has_value();
}

bool LinkCore::on_refusal(wire::Bytes body, MonoTime now) {
  // The name of a guest that is to be added is taken: the roster is asked for again, to see by
  // whom.
  const bool is_of_session = is_connected();
  if (!session_.on_refusal(body, now)) return false;
  if (is_of_session) roster_.forget();
  return true;
}

// Each ping is the occasion to repeat what the server has not acknowledged.
void LinkCore::send_ping(MonoTime now) {
  // Where poses say both ways that the path lives, and none is lost, pings come less often.
  const MonoTime heard = receiver_.heard_records();
  const bool is_calm = link_.locals.count_dancing(now) > 0 && heard.is_set() &&
                       now - heard < kHeardOfLate && link_.is_path_clean() && interest_.is_acked();
  session_.send_ping(roster_.whole_version(), is_calm, now);
  files_.say_terms();
  states_.repeat(now);
  interest_.repeat();
  removals_.repeat();
}

void LinkCore::set_interest(const Interest& interest, MonoTime) {
  link_.options.interest = interest;
  if (session_.is_welcome()) interest_.update();
}

void LinkCore::set_hearing(const Hearing& hearing, MonoTime) {
  link_.options.hearing = hearing;
  if (session_.is_welcome()) interest_.update();
}

void LinkCore::fill(Stats& stats) const {
  const LinkCounters& c = link_.counters;
  const auto as_signed = [](std::uint64_t n) { return static_cast<std::int64_t>(n); };
  stats.received = as_signed(c.poses_offered + c.poses_received);
  stats.forwarded = as_signed(c.poses_sent + c.poses_delivered);
  stats.dropped_late = as_signed(c.late);
  stats.dropped_invalid = as_signed(c.invalid + c.reference_missing + c.skeleton_missing);
  stats.dropped_unrouted = as_signed(c.unrouted);
  stats.dropped_overflow = as_signed(c.overflow);
  stats.lost = 0;
  stats.guests = 0;
  for (const RemoteGuestStats& guest : remote_stats()) {
    if (guest.is_here) ++stats.guests;
    stats.lost += as_signed(guest.lost);
  }
  stats.bytes_in = as_signed(c.bytes_in);
  stats.bytes_out = as_signed(c.bytes_out);
  stats.datagrams_in = as_signed(c.datagrams_in);
  stats.datagrams_out = as_signed(c.datagrams_out);
  stats.rejected_datagrams = as_signed(c.rejected_datagrams);
  stats.sessions = is_connected() ? 1 : 0;
  stats.reconnects = as_signed(c.reconnects);
  stats.round_trip = link_.clock.newest_round_trip();
  stats.clock_offset = link_.clock.offset();
}

}  // namespace dance
