// What the server knows: sessions, rooms, guests; its bounds; and its counters. Plain data that
// ServerCore works on.
//
// Units/frames: MonoTime of the server's clock.
// Ownership:    plain values of fixed size; sessions and rooms refer to each other by index.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "core/base/fixed_list.h"
#include "core/base/time.h"
#include "core/base/token_bucket.h"
#include "tunnel/policy/chat_budget.h"
#include "tunnel/server/core/access.h"
#include "tunnel/server/core/cluster_port.h"
#include "tunnel/server/core/link_meter.h"
#include "tunnel/server/pace/pose_flow.h"
#include "tunnel/server/pace/session_pace.h"
#include "tunnel/server/voice/voice_flow.h"
#include "tunnel/session/arrival_jitter.h"
#include "tunnel/session/interest_filter.h"
#include "tunnel/session/peer.h"
#include "tunnel/session/repetition.h"
#include "tunnel/session/stream.h"
#include "tunnel/session/stream_gate.h"
#include "tunnel/wire/wire_records.h"
#include "tunnel/wire/wire_state.h"
#include "tunnel/wire/wire_voice.h"

namespace dance {

struct ServerLimits {
  std::size_t sessions = 256;
  std::size_t rooms = 64;
  // Limits of one person's key; quota_of() in tunnel/server/core/key_quota.h has those of others.
  std::size_t sessions_per_key = 8;
  std::size_t rooms_per_key = 4;
  std::size_t files_per_key = 64;
  std::size_t guests_per_key = wire::kMaxGuestsPerLink;  // in one room
  // Through links of this server; those of others come to them, up to kMaxGuestsPerRoom together.
  std::size_t guests_per_room = wire::kSlotsPerPage;
  std::size_t listeners_per_room = 64;  // links without guests
  // Of a cluster: in each room that has links here, each other server whose guests are in it.
  std::size_t remote_servers = 0;
  // Per session: 16 guests with hands at 60 Hz need 2,000 datagrams a second.
  double datagrams_per_second = 4000.0;
  double datagram_burst = 1000.0;
  double bytes_per_second = 2e6;
  double byte_burst = 500e3;
  // With one key: each may change the room's roster.
  double hellos_per_second = 20.0;
  double hello_burst = 200.0;
  // Per guest: poses and hands at 240 Hz, and every receiver must decode them.
  double records_per_second = 600.0;
  double record_burst = 150.0;
  // Per guest: messages of its further channels.
  double channel_records_per_second = 500.0;
  double channel_record_burst = 100.0;
  double channel_bytes_per_second = 128e3;
  double channel_byte_burst = 32e3;
  // Per guest: packets of its voice. One comes each 10 ms; more is a clock that runs fast, or what
  // a hiccup held up.
  double voices_per_second = wire::kVoicesPerSecond;
  double voice_burst = wire::kVoiceBurst;
  double voice_bytes_per_second = 16e3;
  double voice_byte_burst = 4e3;
  // Per guest: changes of its states and of those of the room that it sets.
  double state_changes_per_second = 60.0;
  double state_change_burst = 60.0;
  // Files of avatars, kept while their room lives: in all (0 = none, as an older server), and of
  // the guests of one session or of one person's key.
  std::size_t file_bytes = std::size_t{128} << 20;
  std::size_t file_bytes_per_session = std::size_t{32} << 20;
  std::size_t files = 512;
  // That go out: to all together, which an uplink at home of 20 Mbit/s bears, and to one session,
  // of which links ask half unless told otherwise.
  double file_bytes_per_second = 2e6;
  double file_bytes_per_second_of_session = 256e3;
  // Records to one receiver wait this long for others to share a datagram with, unless all who
  // dance have one in it already; 0 = not beyond the turn. Nothing: as long as the receiver's line
  // and the server's work ask for, tunnel/server/signals/server_pace.h.
  std::optional<Duration> share_window{};
  // Up to here each record may have a datagram of its own. A datagram takes about six microseconds
  // of a core (dance crowd): half of one.
  double eager_records_per_second = 80e3;
  // Poses go once more with the next where a path loses some.
  bool repeats = true;
};

// Why a datagram, or a record of it, went no further.
enum class ServerReject : std::uint8_t {
  kTooShort,
  kMalformed,
  kUnknownType,
  kVersion,
  kOldHello,
  kNoSession,
  kSessionRate,
  kGuestRate,
  kForeignSlot,
  kBadTime,
  kBadAck,
  kLate,
  kDuplicate,
  kRefused,
  kNotAllowed,
  kOverruled,
  kStateRate,
  kChannelRate,
  kFileNotAsked,
  kVoiceRate,
  kKeyRate,
  kChatRate,
  kCount,
};
constexpr std::size_t kServerRejects = static_cast<std::size_t>(ServerReject::kCount);
// As the log and the summary say it.
constexpr std::array<std::string_view, kServerRejects> kServerRejectNames{
    "too_short",      "malformed",  "unknown_type", "version",   "old_hello",  "no_session",
    "session_rate",   "guest_rate", "foreign_slot", "bad_time",  "bad_ack",    "late",
    "duplicate",      "refused",    "not_allowed",  "overruled", "state_rate", "channel_rate",
    "file_not_asked", "voice_rate", "key_rate",     "chat_rate"};

struct ServerCounters {
  std::uint64_t datagrams_in = 0;
  std::uint64_t bytes_in = 0;
  std::uint64_t datagrams_out = 0;
  std::uint64_t bytes_out = 0;
  std::uint64_t records_in = 0;        // poses, hands and messages of channels that were taken
  std::uint64_t states_in = 0;         // changes that were taken
  std::uint64_t states_out = 0;        // once per receiver, and again where not acknowledged
  std::uint64_t records_out = 0;       // once per receiver
  std::uint64_t records_repeated = 0;  // besides: once more, where a path loses some
  std::uint64_t datagrams_acked = 0;   // of records, by their receivers
  std::uint64_t voices_in = 0;         // packets of voices that were taken
  std::uint64_t voices_out = 0;        // once per receiver
  std::uint64_t voices_crowded = 0;    // not sent: all places for talkers are taken
  std::uint64_t voices_held_back = 0;  // not sent: the receiver's line bears its poses, not these
  std::uint64_t voice_bytes_out = 0;   // of bytes_out
  std::uint64_t intra_frames_wanted = 0;  // by newcomers, and by who could not decode
  std::uint64_t intra_frames_asked = 0;   // of the senders: several wants in one
  std::uint64_t file_chunks_in = 0;
  std::uint64_t file_chunks_out = 0;
  std::uint64_t file_refusals = 0;  // a file that is not offered, or has no room
  std::uint64_t sessions_begun = 0;
  std::uint64_t sessions_resumed = 0;
  std::uint64_t sessions_timed_out = 0;
  std::uint64_t sessions_removed = 0;  // by hosts
  std::uint64_t goodbyes = 0;
  std::array<std::uint64_t, kServerRejects> rejected{};

  std::uint64_t of(ServerReject cause) const { return rejected[static_cast<std::size_t>(cause)]; }
  std::uint64_t rejected_total() const {
    std::uint64_t sum = 0;
    for (const std::uint64_t n : rejected) sum += n;
    return sum;
  }
};

// What passed between this server and another, of one room, since that one came into it.
struct RemoteMeter {
  std::uint64_t records_in = 0;
  std::uint64_t records_out = 0;  // published once for all servers that are in the room
  std::uint64_t feedback_in = 0;  // guests that were spoken of
  std::uint64_t feedback_out = 0;
};

// The receivers of another server, in one room: as it told last.
struct RemoteReceivers {
  ServerId server = 0;    // 0: this place is free
  bool has_host = false;  // a link there has a host's key
  RemoteMeter meter;
  PathFeedback path;
  std::array<CommonFrames, wire::kMaxGuestsPerRoom> frames;          // by slot of a guest here
  std::array<std::uint8_t, wire::kMaxGuestsPerRoom> intra_frames{};  // asked for, counted there
};
constexpr std::size_t kNoRemote = SIZE_MAX;

struct ServerSession {
  bool in_use = false;
  PeerId peer = 0;
  Access access;
  std::size_t key_use = 0;  // of its key, in the server's KeyUses; of a link only
  std::uint64_t token = 0;
  std::uint64_t epoch = 0;  // another one for the link = nothing earlier counts
  MonoTime last_heard;
  std::int64_t hello_time_us = 0;  // link's clock; an older hello is a stale copy
  std::size_t room = 0;
  // Of a link kMaxGuestsPerLink at most; of another server all of its guests in the room.
  FixedList<std::uint8_t, wire::kMaxGuestsPerRoom> slots;
  std::size_t remote = kNoRemote;  // another server of the cluster, not a link: in remote_receivers
  bool is_remote() const { return remote != kNoRemote; }
  // Counts a datagram: false where the link sends more than it may.
  bool admits(std::size_t datagram_bytes, MonoTime now) {
    return datagrams.take(1.0, now) && bytes.take(static_cast<double>(datagram_bytes), now);
  }
  std::size_t state_cursor = 0;  // slot to begin with when not all fitted the last time
  TokenBucket datagrams;
  TokenBucket bytes;
  TokenBucket removals{1.0, 16.0};  // of guests, that a host asks for
  std::uint32_t datagrams_received = 0;
  wire::Ping newest_ping;
  LinkMeter meter;
  // Records wait here for the end of this turn, or of their window.
  Stream stream;
  SessionPace pace;
  SessionVoice voice;
  // What it wants of the others: the list as it said it, and what follows for each slot.
  wire::InterestList interest;
  std::array<InterestFilter, wire::kMaxGuestsPerRoom> filters;
  std::size_t full_shares = 0;  // others in the room whose every pose it gets
  // Whether poses go once more, to the link and from it.
  Repetition repeats_down;
  Repetition repeats_up;
  std::uint64_t files_epoch = 0;  // in which the link has said file terms
  bool knows_files() const { return files_epoch == epoch && epoch != 0; }
  bool knows_epoch = false;  // what comes is of this session, not of the link's last one
  // When the link is next told what its receivers have; not set = nothing new.
  MonoTime feedback_due;    // goes along with a bundle from then on,
  MonoTime feedback_alone;  // and alone from then on
  MonoTime feedback_made;
  bool tolerates_loss = false;      // as told then: nothing that was lost is missed for long
  bool feedback_is_repeat = false;  // goes out though nothing has changed
};

// The newest version of one state, for those who have not got it.
struct RetainedState : ReplicatedState {
  bool is_fresh = false;  // not told yet
};

// Of one further channel of a guest: newest wins in each by itself.
struct ChannelGate {
  bool has_any = false;
  std::uint32_t sequence = 0;
};

// Where a guest's dance is put on the stage, from the guest's state; the middle before it.
struct GuestPlace {
  float x_m = 0.0f, z_m = 0.0f;
};

// The newest intra frame of a guest, for those who come later.
struct RetainedPose {
  bool is_set = false;
  wire::Record record;  // but for its payload
  std::size_t size = 0;
  std::array<std::uint8_t, wire::kMaxPayload> payload;
};

struct ServerGuest {
  bool in_use = false;
  GuestId id;
  std::uint16_t generation = 0;
  std::size_t owner = 0;         // session
  bool is_wanted = false;        // of another server: by a link here, and that server is told so
  std::uint64_t link_token = 0;  // of the link that brought it, whichever server that speaks to
  OwnerKey key;                  // of that link
  StreamGate poses;
  StreamGate hands;
  ArrivalJitter jitter;  // of poses
  PoseFlow flow;
  GuestPlace place;
  TokenBucket records;
  SentPose previous;  // goes once more to whom it may be lost
  bool intra_wanted = false;
  std::uint8_t intra_frames = 0;  // counts intra frames asked for
  MonoTime intra_asked_at;
  wire::GuestFeedback told;  // what the link was told last
  RetainedPose retained;
  MonoTime last_pose;            // when the newest came in
  std::uint32_t base_count = 0;  // base frames that came
  std::uint32_t hands_count = 0;
  InterestFilter::Counts counts() const { return {base_count, hands_count, told.base_log2}; }
  std::array<RetainedState, wire::kGuestStates> states;
  TokenBucket state_changes;
  ChatBudget chat;
  std::array<ChannelGate, kMaxChannelsPerGuest> channels{};
  TokenBucket channel_records;
  TokenBucket channel_bytes;
  GuestVoice voice;
};

struct ServerRoom {
  bool in_use = false;
  wire::RoomName name;
  GuestId opened_by;  // name of the key
  CodecName codec;
  std::uint32_t roster_version = 1;
  bool is_listed = false;  // in the list of those with something to tell
  bool roster_changed = false;
  bool interest_changed = false;  // of a link, or who is there to be wanted
  std::uint16_t next_generation = 0;
  std::array<RetainedState, wire::kRoomStates> states;
  std::array<GuestId, wire::kRoomStates> setters;
  bool has_fresh_states = false;
  MonoTime fresh_states_due;    // not before then
  bool has_first_body = false;  // fresh: a guest's first proportions, without which no pose decodes
  std::vector<std::size_t> members;  // sessions
  // Of a cluster: it is not known yet who is in it at other servers. Newcomers are told nothing
  // until then, or they would see all leave who dance on. Not set: known.
  MonoTime settled_at;
  std::size_t guest_count = 0;
  std::size_t remote_count = 0;  // members that are other servers
  std::size_t host_count = 0;    // links of it with a host's key
  std::size_t remote_hosts = 0;  // other servers that have such links
  std::array<ServerGuest, wire::kMaxGuestsPerRoom> guests;
  // Of the names of those in use, else 0: a name is found without comparing each.
  std::array<std::uint32_t, wire::kMaxGuestsPerRoom> name_hashes{};

  std::size_t link_count() const { return members.size() - remote_count; }
  bool has_host() const { return host_count > 0 || remote_hosts > 0; }
};

}  // namespace dance
