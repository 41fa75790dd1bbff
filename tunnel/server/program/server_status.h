// A snapshot of what goes on at the server, as plain data and as JSON: rooms, links, guests, and
// why datagrams went no further. What shows a server takes it from here: `dance status`, the
// metrics. There is no key, token or session id in it.
//
// Units/frames: Durations; rates and losses are of the last kStatusWindow, and each unit stands in
//               the JSON's names.
// Ownership:    a snapshot owns its values and refers to nothing. The maker refers to the core, and
//               keeps a few numbers of each session; sample() never allocates.
// Threads:      the maker belongs to the core's thread; a snapshot may go to any.
// Failure:      none; what is not known is not set, and null in JSON.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/time.h"
#include "tunnel/server/program/cluster/cluster_status.h"
#include "tunnel/server/server_core.h"

namespace dance {

// Long enough to tell one loss in a hundred, short enough to see what mends it.
constexpr Duration kStatusWindow = Duration::s(5);

struct NamedCount {
  std::string name;
  std::uint64_t count = 0;
};

struct ServerGuestStatus {
  GuestId id;
  std::uint64_t poses = 0;  // that came and went on
  std::uint64_t lost = 0;   // of those that it sent
  std::uint64_t late = 0;
  std::optional<Duration> jitter;
  std::uint64_t voices = 0;       // packets of 10 ms that were taken
  std::uint64_t voice_bytes = 0;  // of them
  ShownName shown_name;           // "" = none
};

struct ServerLinkStatus {
  std::string peer;                             // address, or the name of its key
  std::string key;                              // name
  std::optional<std::int64_t> key_until_utc_s;  // when its key expires; nothing = never
  Duration age;
  Duration last_heard;
  std::optional<Duration> round_trip;  // as the link's ping says
  std::optional<double> loss_up;       // of its poses, on their way to the server; 0 to 1
  std::optional<double> loss_down;     // of the others' poses, as its pings say: both halves
  std::optional<Duration> jitter;      // of the worst of its guests
  double datagrams_in_per_s = 0.0;
  double datagrams_out_per_s = 0.0;
  double bytes_in_per_s = 0.0;
  double bytes_out_per_s = 0.0;
  // What its line is held to bear; nothing = all.
  std::optional<double> budget_bytes_per_s;
  Duration share_window;
  std::size_t thinned = 0;  // guests of whom it gets fewer poses than it wants
  std::uint64_t bytes_in = 0;
  std::uint64_t bytes_out = 0;
  double voices_in_per_s = 0.0;  // packets of 10 ms of its guests, and to it
  double voices_out_per_s = 0.0;
  std::uint64_t voice_bytes_out = 0;      // of bytes_out
  std::uint32_t poses_lost = 0;           // of the others', as its newest ping says
  std::vector<ServerGuestStatus> guests;  // none: it only listens
};

struct ServerRoomStatus {
  wire::RoomName name;
  std::size_t guests = 0;
  std::size_t listeners = 0;
  CodecName codec;
  Duration share_window;  // of the link whose poses wait longest
  std::vector<ServerLinkStatus> links;
};

// Current use of one key.
struct ServerKeyStatus {
  std::string name;
  std::size_t sessions = 0;
  std::size_t rooms = 0;
  double bytes_in_per_s = 0.0;
  double bytes_out_per_s = 0.0;
  std::size_t avatar_bytes = 0;
};

struct ServerStatus {
  std::string version;
  std::string address;
  Duration uptime;
  std::vector<ServerRoomStatus> rooms;
  std::vector<ServerKeyStatus> keys;  // the most used first
  ServerCounters totals;
  std::vector<NamedCount> rejects;
  std::vector<NamedCount> handshakes;
  std::optional<ClusterStatus> cluster;
};

std::string server_version();
std::string codec_text(const CodecName& codec);
// One object, on one line.
std::string to_json(const ServerStatus& status);

class ServerStatusMaker {
 public:
  using PeerText = std::function<std::string(const ServerSession&)>;

  ServerStatusMaker(const ServerCore& core, const ServerLimits& limits, std::string address,
                    PeerText peer_text, MonoTime begin);
  // Once a second: what rates are counted from.
  void sample(MonoTime now);
  // Handshakes by cause are counted where sessions are sealed.
  ServerStatus make(MonoTime now, std::span<const NamedCount> handshakes) const;

 private:
  struct Sample {
    MonoTime at;
    LinkMeter meter;
    std::uint64_t poses_up = 0;
    std::uint64_t lost_up = 0;
    std::uint64_t voices_up = 0;
    std::uint64_t voices_down = 0;
    bool has_ping = false;
    std::uint32_t poses_down = 0;
    std::uint32_t lost_down = 0;
  };
  // The newest samples of one session, in a ring.
  struct History {
    MonoTime since;  // whose session it is
    std::array<Sample, 5> ring;
    std::size_t count = 0;
    const Sample* oldest() const;
  };

  Sample sample_of(const ServerSession& session, MonoTime now) const;
  ServerLinkStatus link_status(std::size_t session, MonoTime now) const;
  std::vector<ServerKeyStatus> key_status(const std::vector<ServerRoomStatus>& rooms) const;

  const ServerCore& core_;
  ServerLimits limits_;
  std::string address_;
  PeerText peer_text_;
  MonoTime begin_;
  std::vector<History> histories_;  // by session
};

}  // namespace dance
