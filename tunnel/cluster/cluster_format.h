// What servers of a cluster tell each other, built and parsed: messages, and values that last.
// docs/wire-format.md says them byte by byte, and this is the only place that knows them.
//
// Units/frames: little-endian; times are microseconds of the clock that the field's name says.
// Ownership:    payloads are views of the caller's bytes.
// Threads:      none inside.
// Failure:      parse functions give nullopt for anything that build functions never make; build
//               functions give 0 bytes where the buffer is too small. Nothing here allocates.
#pragma once

#include <optional>
#include <variant>

#include "tunnel/server/core/cluster_port.h"
#include "tunnel/server/core/removal_bans.h"
#include "tunnel/wire/wire_servers.h"

namespace dance::cluster {

constexpr std::uint8_t kClusterVersion = 1;
// No message and no value is longer; nor several messages in one (cluster_bundle.h).
constexpr std::size_t kMaxBytes = 2048;
constexpr std::size_t kMaxBundle = 8192;
using Bytes = wire::Bytes;

// A server lives; several times a second, to all.
struct Heartbeat {
  ServerId server = 0;
  // Of the session clock's begin, by the server's wall clock: the oldest one's clock is the
  // cluster's.
  std::int64_t born_us = 0;
  std::uint32_t links = 0;
  std::uint32_t guests = 0;
  bool is_leaving = false;  // it ends, and its links go elsewhere
  Address address;          // as guests reach it; may be not set
};

// What time is it? The answer goes to who asked.
struct ClockQuestion {
  ServerId server = 0;        // who asks
  std::int64_t asked_us = 0;  // its own clock
};
struct ClockAnswer {
  ServerId server = 0;  // who answers
  std::int64_t asked_us = 0;
  std::int64_t received_us = 0;  // session clock
  std::int64_t sent_us = 0;
};

// A record of one guest, whose name and room stand in the subject. Its stream is that of its link.
struct RecordMessage {
  ServerId server = 0;
  std::uint64_t link_token = 0;
  wire::Record record;
};

// 10 ms of one guest's voice; its slot is not told.
struct VoiceMessage {
  ServerId server = 0;
  std::uint64_t link_token = 0;
  wire::VoiceRecord record;
};

struct FeedbackEntry {
  GuestId guest;
  RemoteFeedback feedback;  // its path is that of the message
};
constexpr std::size_t kMaxFeedbackEntries = 32;
struct FeedbackMessage {
  ServerId server = 0;
  wire::RoomName room;
  PathFeedback path;
  FixedList<FeedbackEntry, kMaxFeedbackEntries> entries;
};

// About the file of a guest's avatar, for the server through which the guest came, or from it.
struct FileMessage {
  ServerId server = 0;
  wire::RoomName room;
  GuestId guest;
  FilePart part;  // without its slot
};

// A guest is to be removed from a room, or was; to all.
struct RemovalMessage {
  ServerId server = 0;
  wire::RoomName room;
  RemovalNotice notice;
};

using Message = std::variant<Heartbeat, ClockQuestion, ClockAnswer, RecordMessage, FeedbackMessage,
                             FileMessage, VoiceMessage, RemovalMessage>;
std::size_t build(const Message& message, std::span<std::uint8_t> out);
std::optional<Message> parse_message(Bytes bytes);

// Values, by key: a server has links in a room,
struct PresenceValue {
  ServerId server = 0;
  bool has_host = false;  // one of them has a host's key
};
// a guest is in it through a server,
struct GuestValue {
  ServerId server = 0;
  std::uint64_t link_token = 0;
  std::int64_t since_us = 0;  // session clock, when its link came to that server
  CodecName codec;            // of the room
  OwnerKey key;               // of the link
};
// and states of a guest, or of the room.
struct StateValue {
  std::uint64_t link_token = 0;  // of a guest's
  GuestId setter;                // of the room's
  std::uint32_t version = 0;
  Bytes payload;
};
using Value = std::variant<PresenceValue, GuestValue, StateValue>;
std::size_t build(const Value& value, std::span<std::uint8_t> out);
std::optional<Value> parse_value(Bytes bytes);

}  // namespace dance::cluster
