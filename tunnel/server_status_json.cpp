// The snapshot as JSON.
#include <cmath>
#include <nlohmann/json.hpp>

#include "tunnel/server_status.h"

namespace dance {
namespace {

using nlohmann::ordered_json;

// To a thousandth: more digits are only longer.
double rounded(double value) { return std::round(value * 1e3) / 1e3; }

ordered_json ms_or_null(const std::optional<Duration>& duration) {
  return duration ? ordered_json(rounded(duration->as_ms())) : ordered_json();
}

ordered_json share_or_null(const std::optional<double>& share) {
  return share ? ordered_json(*share) : ordered_json();
}

ordered_json json_of(const ServerLinkStatus& link) {
  ordered_json guests = ordered_json::array();
  for (const ServerGuestStatus& guest : link.guests)
    guests.push_back({{"name", std::string(guest.id.view())},
                      {"poses", guest.poses},
                      {"lost", guest.lost},
                      {"late", guest.late},
                      {"jitter_ms", ms_or_null(guest.jitter)}});
  return {{"peer", link.peer},
          {"age_s", rounded(link.age.as_seconds())},
          {"last_heard_s", rounded(link.last_heard.as_seconds())},
          {"round_trip_ms", ms_or_null(link.round_trip)},
          {"loss_up", share_or_null(link.loss_up)},
          {"loss_down", share_or_null(link.loss_down)},
          {"jitter_ms", ms_or_null(link.jitter)},
          {"datagrams_in_per_s", rounded(link.datagrams_in_per_s)},
          {"datagrams_out_per_s", rounded(link.datagrams_out_per_s)},
          {"bytes_in_per_s", rounded(link.bytes_in_per_s)},
          {"bytes_out_per_s", rounded(link.bytes_out_per_s)},
          {"bytes_in", link.bytes_in},
          {"bytes_out", link.bytes_out},
          {"poses_lost", link.poses_lost},
          {"guests", guests}};
}

ordered_json json_of(const ServerCounters& c) {
  return {{"datagrams_in", c.datagrams_in},
          {"datagrams_out", c.datagrams_out},
          {"bytes_in", c.bytes_in},
          {"bytes_out", c.bytes_out},
          {"records_in", c.records_in},
          {"records_out", c.records_out},
          {"key_frames_asked", c.key_frames_asked},
          {"sessions_begun", c.sessions_begun},
          {"sessions_resumed", c.sessions_resumed},
          {"sessions_timed_out", c.sessions_timed_out},
          {"goodbyes", c.goodbyes}};
}

ordered_json json_of(const std::vector<NamedCount>& counts) {
  ordered_json object = ordered_json::object();
  for (const NamedCount& count : counts) object[count.name] = count.count;
  return object;
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
  // A link may bring one that is newer than this server: it looks at no payload.
  return "codec " + std::to_string(static_cast<int>(codec.id));
}

std::string to_json(const ServerStatus& status) {
  ordered_json rooms = ordered_json::array();
  for (const ServerRoomStatus& room : status.rooms) {
    ordered_json links = ordered_json::array();
    for (const ServerLinkStatus& link : room.links) links.push_back(json_of(link));
    rooms.push_back({{"name", std::string(room.name.view())},
                     {"guests", room.guests},
                     {"listeners", room.listeners},
                     {"codec", codec_text(room.codec)},
                     {"share_window_ms", room.share_window.as_ms()},
                     {"links", std::move(links)}});
  }
  const ordered_json all{{"version", status.version},
                         {"address", status.address},
                         {"uptime_s", rounded(status.uptime.as_seconds())},
                         {"window_s", kStatusWindow.as_seconds()},
                         {"rooms", std::move(rooms)},
                         {"totals", json_of(status.totals)},
                         {"rejects", json_of(status.rejects)},
                         {"handshakes", json_of(status.handshakes)}};
  // The texts are checked names and addresses; what is not UTF-8 all the same is replaced.
  return all.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace dance
