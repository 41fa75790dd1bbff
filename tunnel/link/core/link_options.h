// What a link is told, what it tells back, and what it counts.
//
// Units/frames: poses handed to the handlers are in this house's clock.
// Ownership:    plain values; handlers must outlive the link.
// Threads:      none inside; handlers run on the link's thread.
// Failure:      none.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/fixed_list.h"
#include "core/bus/chat.h"
#include "core/bus/house_messages.h"
#include "core/bus/state_messages.h"
#include "core/bus/voice.h"
#include "core/codec/pose_codec.h"
#include "core/net/address.h"
#include "core/pose/pose.h"
#include "core/pose/skeleton.h"
#include "tunnel/files/chunked_file.h"
#include "tunnel/policy/channel_rule.h"
#include "tunnel/policy/hearing.h"
#include "tunnel/policy/pose_share.h"
#include "tunnel/seal/seal_trouble.h"
#include "tunnel/session/reference_policy.h"
#include "tunnel/wire/wire.h"
#include "tunnel/wire/wire_servers.h"
#include "tunnel/wire/wire_state.h"

namespace dance {

struct LinkOptions {
  wire::RoomName room;
  FixedList<GuestId, wire::kMaxGuestsPerLink> guests;  // more may come with their first pose
  bool listen_only = false;    // no guests, not even one that comes with a pose
  std::uint64_t token = 0;     // random, new with each start of a link; gives it its place back
  std::uint64_t clock_id = 0;  // this house's clock: poses of another one are stamped anew
  std::uint64_t seed = 1;      // for the nonces of hellos: random outside of tests
  FixedList<CodecName, wire::kMaxCodecs> codecs;  // empty = all that this build knows
  // Where codecs come from: tests bring their own.
  std::function<std::unique_ptr<PoseEncoder>(CodecName)> make_encoder = make_pose_encoder;
  std::function<std::unique_ptr<PoseDecoder>(CodecName)> make_decoder = make_pose_decoder;
  // Records wait this long for those of the house's other guests; 0 = each leaves at once.
  Duration share_window = Duration::ms(1);
  // An intra frame comes this often, asked for or not; 0 = only when asked for.
  Duration intra_frame_period = Duration::s(2);
  // Every so many poses bring the ages of their hops.
  std::uint32_t poses_per_stamp = 32;
  // Whom it wants to hear, and how often; LinkCore::set_interest() changes it.
  Interest interest;
  // Whose voices; LinkCore::set_hearing() changes it.
  Hearing hearing;
  // The largest error in any joint that own guests are sent with, in metres;
  double quality_m = 0.001;
  // and what the payloads of each of them may cost: where they cost more, the error grows up to 5
  // mm, core/codec/quality_by_rate.h. 0 = whatever it costs.
  double pose_bytes_per_second = 0.0;
  // Of avatars' files, that it sends and takes at most; 0 = neither.
  double file_bytes_per_second = 131'072.0;
  // Further channels that ride along; at most kMaxChannelRules.
  std::vector<ChannelRule> channels;
  // Resolves the server's name, in a thread of its own, while the server is silent; not set: its
  // addresses stay as they are. Used by Link.
  std::function<Result<std::vector<Address>>()> look_up;
};

enum class LinkState : std::uint8_t {
  kConnecting,  // no session yet
  kConnected,
  kLapsed,  // had a session, hears nothing, asks for it again
};

struct LinkHandlers {
  std::function<void(const GuestId&, const Pose&, MonoTime now)> on_pose;
  std::function<void(const GuestId&, const Hands&, MonoTime now)> on_hands;
  std::function<void(const GuestId&, const Voice&, MonoTime now)> on_voice;
  std::function<void(const GuestId&, const Skeleton&, MonoTime now)> on_skeleton;
  std::function<void(const GuestId&, const Avatar&, MonoTime now)> on_avatar;
  std::function<void(const GuestId&, const AvatarFile&, MonoTime now)> on_avatar_file;
  std::function<void(const GuestId&, const Style&, MonoTime now)> on_style;
  std::function<void(const GuestId&, const Placement&, MonoTime now)> on_placement;
  // A line or sign of another guest, once, in the order in which they wrote.
  std::function<void(const GuestId&, const Chat&, MonoTime now)> on_chat;
  // What holds in the room, and who set it: also a guest of this house.
  std::function<void(const GuestId&, const Music&, MonoTime now)> on_music;
  std::function<void(const GuestId&, const RoomSong&, MonoTime now)> on_song;
  std::function<void(const GuestId&, const Scene&, MonoTime now)> on_scene;
  // A guest of this house requested something else: overruled, or not allowed to.
  std::function<void(wire::StateKind, wire::StateVerdict)> on_room_state_refused;
  // A message of a further channel of another house: of a name, size and layout that a rule lets
  // in.
  std::function<void(const GuestId&, std::string_view name, ChannelClass, wire::Bytes message,
                     MonoTime now)>
      on_channel;
  // A file that was asked for with LinkFiles::fetch() is here whole, its hash not checked yet:
  // LinkFiles::settle() is to be told whether it is right. Blocks are told in order, to be kept for
  // a restart.
  std::function<void(const GuestId&, const FileHash&, ChunkedFile&&)> on_file;
  std::function<void(const GuestId&, const FileHash&, const ChunkedFile&, std::size_t block)>
      on_file_block;
  std::function<void(const GuestId&, const FileHash&, wire::FileRefusalCause)> on_file_refused;
  std::function<void(const GuestId&, MonoTime now)> on_guest_joined;
  std::function<void(const GuestId&, MonoTime now)> on_guest_left;
  std::function<void(LinkState, MonoTime now)> on_state;
  // Guest is set where it is about one of ours. refusal_line() says it for people.
  std::function<void(const wire::RefusalNotice&, MonoTime now)> on_refused;
  // What became of a guest whom this house wanted removed; first that it is asked.
  std::function<void(std::int32_t number, RemovalVerdict)> on_removal;
  // The other servers of the cluster, each time the server lists them. A Link sets its own handler.
  std::function<void(const wire::ServerList&, MonoTime now)> on_servers;
  // The link moved to another server: the one before is silent or ends, or this one is nearer. Link
  // calls it.
  std::function<void(const Address&)> on_other_server;
  // This address of the server has never answered, after several tries; the next ones go to
  // another, or leave from a new socket. Link calls it each time.
  std::function<void(const Address&)> on_no_answer;
  // There is no sealed session with the server, and why. Link calls it with each try.
  std::function<void(SealTrouble)> on_no_entry;
  // The server's name has other addresses now, the first of which is tried; or it cannot be
  // resolved, and why. Link calls them each time.
  std::function<void(const Address&)> on_new_address;
  std::function<void(const std::string& why)> on_unknown_name;
};

struct LinkCounters {
  std::uint64_t poses_offered = 0;  // by this house
  std::uint64_t poses_sent = 0;
  std::uint64_t poses_repeated = 0;  // of them, once more with the next
  std::uint64_t poses_received = 0;  // records of poses that came in
  std::uint64_t poses_delivered = 0;
  std::uint64_t hands_sent = 0;
  std::uint64_t hands_delivered = 0;
  std::uint64_t late = 0;                // both ways: not newer than what went before
  std::uint64_t invalid = 0;             // both ways: not a pose, or of no time under way
  std::uint64_t reference_missing = 0;   // refers to a frame that has not come
  std::uint64_t skeleton_missing = 0;    // came before the guest's proportions
  std::uint64_t intra_frames_asked = 0;  // by this link, of the others
  std::uint64_t intra_frames_sent = 0;   // because somebody asked
  std::uint64_t datagrams_acked = 0;     // of ours with records, by the server
  std::uint64_t unrouted = 0;            // not connected, or a guest without a slot
  std::uint64_t overflow = 0;            // more guests than a link may have
  std::uint64_t foreign_clock = 0;       // poses of another clock, stamped anew
  std::uint64_t states_sent = 0;         // repetitions included
  std::uint64_t states_delivered = 0;
  std::uint64_t states_invalid = 0;    // both ways
  std::uint64_t states_overruled = 0;  // requests for the room that somebody else's replaced
  std::uint64_t states_refused = 0;    // requests that the server does not allow
  std::uint64_t chats_limited = 0;     // both ways: lines and signs above a guest's rate
  std::uint64_t channels_sent = 0;     // messages of further channels
  std::uint64_t channels_delivered = 0;
  std::uint64_t channels_unlisted = 0;  // both ways: no rule lets them pass
  std::uint64_t channels_invalid = 0;   // both ways: too long, or not of the layout
  std::uint64_t channels_limited = 0;   // both ways: above the rule's rate
  std::uint64_t channels_late = 0;      // not newer than what went before
  std::uint64_t channels_unrouted = 0;  // no guest to send them by, or not announced yet
  std::uint64_t channels_overflow = 0;  // more channels than a guest or a house may have
  std::uint64_t voices_sent = 0;        // packets of 10 ms, of guests of this house
  std::uint64_t voices_delivered = 0;   // of others
  std::uint64_t voice_bytes_in = 0;     // of bytes_in,
  std::uint64_t voice_bytes_out = 0;    // and of bytes_out
  std::uint64_t voice_datagrams_in = 0;
  std::uint64_t voice_datagrams_out = 0;
  std::uint64_t voices_limited = 0;  // more than a microphone makes
  std::uint64_t voices_invalid = 0;  // both ways: no voice, or of no time under way
  std::uint64_t voices_unrouted =
      0;  // not connected, an older server, an unknown or unwanted guest
  std::uint64_t stream_restarts = 0;  // producers of ours that began anew
  std::uint64_t datagrams_in = 0;
  std::uint64_t datagrams_out = 0;
  std::uint64_t bytes_in = 0;
  std::uint64_t bytes_out = 0;
  std::uint64_t rejected_datagrams = 0;
  std::uint64_t hellos = 0;
  std::uint64_t lapses = 0;
  std::uint64_t reconnects = 0;  // sessions begun or taken up again after a lapse
};

// One guest of another house, as this link hears it.
struct RemoteGuestStats {
  GuestId guest;
  bool is_here = true;      // false: counts of one who has left
  std::uint64_t bytes = 0;  // of records of poses and hands
  std::uint64_t received = 0;
  std::uint64_t lost = 0;  // gaps, less what arrived late
  std::uint64_t late = 0;
  std::uint64_t duplicate = 0;
  std::uint64_t invalid = 0;
  std::uint64_t reference_missing = 0;
  std::uint64_t skeleton_missing = 0;
  std::uint64_t intra_frames_asked = 0;
  std::uint64_t voices = 0;       // packets
  std::uint64_t voice_bytes = 0;  // of their records
};

// One guest of this house, as this link sends it.
struct LocalGuestStats {
  GuestId guest;
  References references = References::kPreviousTwice;
  std::uint64_t sent = 0;
  std::uint64_t acked = 0;  // frames that every receiver has
  std::uint64_t intra_frames_sent = 0;
  double quality_m = 0.001;
};

// One line: what was refused, why, and the cure.
std::string refusal_line(const wire::RefusalNotice& refusal, const wire::RoomName& room);
// One line: what became of a guest's request for the room.
std::string room_state_line(wire::StateKind kind, wire::StateVerdict verdict);
// One line: which server does not answer, and what to look at.
std::string no_answer_line(const Address& server);
std::string other_server_line(const Address& server);
// `server` as the user named it.
std::string new_address_line(const std::string& server, const Address& address);
std::string unknown_name_line(const std::string& why);
// Why a server that answers does not let this house in, and the cure. `server` as the user named
// it.
std::string no_entry_line(SealTrouble trouble, const std::string& server);

}  // namespace dance
