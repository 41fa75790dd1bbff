// The snapshot as JSON, written in one go: a full server has four thousand guests, and poses wait
// meanwhile.
#include "tunnel/server/program/cluster/cluster_status_json.h"
#include "tunnel/server/program/json_text.h"
#include "tunnel/server/program/server_status.h"

namespace dance {
namespace {

void add_json(const ServerLinkStatus& link, StatusJsonText& json) {
  json.next();
  json.open('{');
  json.member("peer", link.peer);
  json.member("key", link.key);
  if (link.key_until_utc_s)
    json.member("key_until_utc_s", static_cast<std::uint64_t>(*link.key_until_utc_s));
  json.member("age_s", link.age.as_seconds());
  json.member("last_heard_s", link.last_heard.as_seconds());
  json.member("round_trip_ms", ms_of(link.round_trip));
  json.member("loss_up", link.loss_up);
  json.member("loss_down", link.loss_down);
  json.member("jitter_ms", ms_of(link.jitter));
  json.member("datagrams_in_per_s", link.datagrams_in_per_s);
  json.member("datagrams_out_per_s", link.datagrams_out_per_s);
  json.member("bytes_in_per_s", link.bytes_in_per_s);
  json.member("bytes_out_per_s", link.bytes_out_per_s);
  json.member("budget_bytes_per_s", link.budget_bytes_per_s);
  json.member("share_window_ms", link.share_window.as_ms());
  json.member("thinned", std::uint64_t{link.thinned});
  json.member("bytes_in", link.bytes_in);
  json.member("bytes_out", link.bytes_out);
  json.member("voices_in_per_s", link.voices_in_per_s);
  json.member("voices_out_per_s", link.voices_out_per_s);
  json.member("voice_bytes_out", link.voice_bytes_out);
  json.member("poses_lost", std::uint64_t{link.poses_lost});
  json.key("guests");
  json.open('[');
  for (const ServerGuestStatus& guest : link.guests) {
    json.next();
    json.open('{');
    json.member("name", guest.id.view());
    if (!guest.shown_name.empty()) json.plain_member("shown_name", guest.shown_name.view());
    json.member("poses", guest.poses);
    json.member("lost", guest.lost);
    json.member("late", guest.late);
    json.member("jitter_ms", ms_of(guest.jitter));
    json.member("voices", guest.voices);
    json.member("voice_bytes", guest.voice_bytes);
    json.close('}');
  }
  json.close(']');
  json.close('}');
}

void add_json(const ServerRoomStatus& room, StatusJsonText& json) {
  json.next();
  json.open('{');
  json.member("name", room.name.view());
  json.member("guests", std::uint64_t{room.guests});
  json.member("listeners", std::uint64_t{room.listeners});
  json.member("codec", codec_text(room.codec));
  json.member("share_window_ms", room.share_window.as_ms());
  json.key("links");
  json.open('[');
  for (const ServerLinkStatus& link : room.links) add_json(link, json);
  json.close(']');
  json.close('}');
}

void add_json(const ServerKeyStatus& key, StatusJsonText& json) {
  json.next();
  json.open('{');
  json.member("name", key.name);
  json.member("sessions", std::uint64_t{key.sessions});
  json.member("rooms", std::uint64_t{key.rooms});
  json.member("bytes_in_per_s", key.bytes_in_per_s);
  json.member("bytes_out_per_s", key.bytes_out_per_s);
  json.member("avatar_bytes", std::uint64_t{key.avatar_bytes});
  json.close('}');
}

void add_counters(const ServerCounters& c, StatusJsonText& json) {
  json.key("totals");
  json.open('{');
  json.member("datagrams_in", c.datagrams_in);
  json.member("datagrams_out", c.datagrams_out);
  json.member("bytes_in", c.bytes_in);
  json.member("bytes_out", c.bytes_out);
  json.member("records_in", c.records_in);
  json.member("records_out", c.records_out);
  json.member("voices_in", c.voices_in);
  json.member("voices_out", c.voices_out);
  json.member("voices_crowded", c.voices_crowded);
  json.member("voices_held_back", c.voices_held_back);
  json.member("voice_bytes_out", c.voice_bytes_out);
  json.member("key_frames_asked", c.intra_frames_asked);
  json.member("sessions_begun", c.sessions_begun);
  json.member("sessions_resumed", c.sessions_resumed);
  json.member("sessions_timed_out", c.sessions_timed_out);
  json.member("sessions_removed", c.sessions_removed);
  json.member("goodbyes", c.goodbyes);
  json.close('}');
}

}  // namespace

std::string server_version() { return DANCE_VERSION; }

std::string codec_text(const CodecName& codec) {
  switch (codec.id) {
    case CodecId::kNone:
      return "none";
    case CodecId::kPlain:
      return "plain";
    case CodecId::kLattice:
      return "lattice";
  }
  // A link may bring one that is newer than this server, which looks at no payload.
  return "codec " + std::to_string(static_cast<int>(codec.id));
}

std::string to_json(const ServerStatus& status) {
  StatusJsonText json;
  json.open('{');
  json.member("version", status.version);
  json.member("address", status.address);
  json.member("uptime_s", status.uptime.as_seconds());
  json.member("window_s", kStatusWindow.as_seconds());
  json.key("rooms");
  json.open('[');
  for (const ServerRoomStatus& room : status.rooms) add_json(room, json);
  json.close(']');
  json.key("keys");
  json.open('[');
  for (const ServerKeyStatus& key : status.keys) add_json(key, json);
  json.close(']');
  add_counters(status.totals, json);
  json.member("rejects", status.rejects);
  json.member("handshakes", status.handshakes);
  if (status.cluster) add_json(*status.cluster, json);
  json.close('}');
  return json.take();
}

}  // namespace dance
