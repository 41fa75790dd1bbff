// The tunnel's datagrams, built and parsed: docs/wire-format.md says them byte by byte, and this is
// the only place that knows them. Parsing looks at the bytes where they stand; nothing is laid over
// them.
//
// Units/frames: little-endian; times are microseconds of the clock that the field's name says.
// Ownership:    parsed texts and payloads are copies or views of the caller's bytes, as the type
//               says.
// Threads:      none inside.
// Failure:      parse functions give nullopt for anything that build functions never make; build
//               functions give 0 bytes where the buffer is too small.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "core/base/byte_reader.h"
#include "core/base/byte_writer.h"
#include "core/base/fixed_list.h"
#include "core/base/guest_id.h"
#include "core/codec/pose_codec.h"
#include "tunnel/seal/seal_format.h"

namespace dance::wire {

constexpr std::uint8_t kWireVersion = 6;
// What the seal adds.
constexpr std::size_t kSealOverhead = seal::kOverhead;
// An inner datagram, as the state machines see it.
constexpr std::size_t kMaxPlain = seal::kMaxPlain;
// No hello, welcome or refusal is longer.
constexpr std::size_t kMaxHello = 512;
constexpr std::size_t kMaxGuestsPerLink = 16;
constexpr std::size_t kMaxGuestsPerRoom = 128;
// Slots come in pages. A link's own guests are in the first.
constexpr std::size_t kSlotsPerPage = 64;
constexpr std::size_t kMaxCodecs = 8;
constexpr std::size_t kMaxPayload = 512;

using Bytes = std::span<const std::uint8_t>;
// Room names follow the same rule as guest ids.
using RoomName = GuestId;

enum class Type : std::uint8_t {
  // These three begin with type and version in every version of the format.
  kHello = 1,
  kWelcome = 2,
  kRefusal = 3,
  kPing = 16,
  kPong = 17,
  kRecords = 18,  // never written: of these the first byte is kRecordsMark and flags
  kRoster = 19,
  kState = 20,
  kStateAck = 21,
  kGoodbye = 22,
  kInterest = 23,
  kInterestAck = 24,
  // tunnel/wire/wire_files.h.
  kFileTerms = 25,
  kFileWant = 26,
  kFileChunk = 27,
  kFileRefusal = 28,
  // tunnel/wire/wire_servers.h.
  kServers = 29,
  // tunnel/wire/wire_voice.h.
  kVoices = 30,
  // tunnel/wire/wire_removal.h.
  kRemoval = 31,
  kRemovalAnswer = 32,
  kRights = 33,
  // tunnel/wire/wire_room.h.
  kRoomQuestion = 34,
  kRoomAnswer = 35,
};

enum class Refusal : std::uint16_t {
  kVersion = 1,         // the server speaks another version of this format
  kBadName = 2,         // room or guest name breaks the rule
  kNameTaken = 3,       // a guest of this name is in the room through another link
  kRoomFull = 4,        // no slot for another guest
  kServerFull = 5,      // no place for another session or room
  kCodec = 6,           // the room speaks a codec that this link does not know
  kNotAllowedRoom = 7,  // the link's key does not open this room
  kNotAllowedName = 8,  // the link's key does not allow a guest of this name
  kOnlyListens = 9,     // the link's key allows no guests at all
  kListenersFull = 10,  // no place for another link without guests in this room
  kRemoved = 11,        // a host has removed this house's guests from the room
  kKeySessions = 12,    // the link's key has as many sessions as one key may have
  kKeyRooms = 13,       // the link's key has opened as many rooms as one key may open
  kKeyExpired = 14,     // the link's key was good until a time that is over
  kKeyGuests = 15,      // the link's key has as many places in this room as one key may have
};

struct Hello {
  std::uint8_t version = kWireVersion;
  std::uint64_t nonce = 0;  // echoed in the answer, so that it is known what is answered
  std::uint64_t token = 0;  // names the link from its start to its end
  std::int64_t link_time_us = 0;
  FixedList<CodecName, kMaxCodecs> codecs;  // the preferred one first
  RoomName room;
  // How often it wants whom it says nothing about: tunnel/policy/pose_share.h.
  std::uint8_t default_divider = 1;
  FixedList<GuestId, kMaxGuestsPerLink> guests;
};

struct Slot {
  std::uint8_t slot = 0;
  std::uint16_t generation =
      0;  // counts who has had a slot of this room; never the same twice soon
  bool operator==(const Slot&) const = default;
};

struct Welcome {
  std::uint8_t version = kWireVersion;  // of the hello
  std::uint64_t nonce = 0;
  std::uint64_t epoch = 0;        // random, never 0: another one says that all begins anew
  std::int64_t link_time_us = 0;  // of the hello
  std::int64_t server_receive_us = 0;
  std::int64_t server_send_us = 0;
  CodecName codec;                           // what this room speaks
  FixedList<Slot, kMaxGuestsPerLink> slots;  // in the order of the hello's guests
};

struct RefusalNotice {
  std::uint8_t server_version = kWireVersion;
  std::uint64_t nonce = 0;
  Refusal cause = Refusal::kVersion;
  GuestId guest;  // whom it is about, where it is about one
  // Of kRemoved, not 0: so long it is refused. It comes unasked too, with the nonce 0.
  std::uint16_t seconds = 0;
};

struct Ping {
  std::uint32_t sequence = 0;
  std::int64_t link_time_us = 0;
  std::uint32_t roster_version = 0;  // newest that the link has whole; 0 = none
  std::uint32_t round_trip_us = 0;   // the link's newest estimate; 0 = none yet
  std::uint32_t datagrams_received = 0;
  std::uint32_t poses_received = 0;
  std::uint32_t poses_lost = 0;
  std::uint32_t epoch = 0;  // low half of that of the session the link takes it for
};

struct Pong {
  std::uint32_t sequence = 0;
  std::int64_t link_time_us = 0;  // of the ping
  std::int64_t server_receive_us = 0;
  std::int64_t server_send_us = 0;
  std::uint32_t datagrams_received = 0;  // from this session
};

struct RosterEntry {
  Slot slot;
  GuestId guest;
};
// One part of the roster: all that stands in the slots first … first + span − 1.
struct RosterPart {
  std::uint32_t version = 0;
  std::uint8_t part = 0;
  std::uint8_t parts = 1;
  std::uint8_t first_slot = 0;
  std::uint8_t slot_span = 0;
  FixedList<RosterEntry, 32> entries;
};
constexpr std::uint8_t kSlotsPerRosterPart = 32;

// Which guests a link wants, and how often: all that it wants, each time. What a divider means is
// said in tunnel/policy/pose_share.h.
struct InterestEntry {
  Slot slot;
  std::uint8_t divider = 1;
  bool operator==(const InterestEntry&) const = default;
};
// Whose voices it wants: everybody's, or nobody's, but for the guests who are excepted.
struct VoiceInterest {
  bool hears_others = true;
  FixedList<Slot, kMaxGuestsPerRoom> exceptions;
  // Nothing is said about it; nor could it be to a peer of version 4.
  bool is_default() const { return hears_others && exceptions.empty(); }
  bool operator==(const VoiceInterest& o) const {
    return hears_others == o.hears_others && std::equal(exceptions.begin(), exceptions.end(),
                                                        o.exceptions.begin(), o.exceptions.end());
  }
};
struct InterestList {
  std::uint32_t version = 0;  // not 0; the link counts its changes
  std::uint8_t default_divider = 1;
  FixedList<InterestEntry, kMaxGuestsPerRoom> entries;
  VoiceInterest voices;
};

// How a datagram begins.
struct Opening {
  Type type = Type::kHello;
  Bytes body;  // what follows
};
constexpr std::size_t kSessionHeader = 1;
constexpr std::uint8_t kRecordsMark = 0x80;
std::optional<Opening> parse_opening(Bytes datagram);

// Building: whole datagrams, opening included; the number of bytes, or 0.
std::size_t build(const Hello& hello, std::span<std::uint8_t> out);
std::size_t build(const Welcome& welcome, std::span<std::uint8_t> out);
std::size_t build(const RefusalNotice& refusal, std::span<std::uint8_t> out);
std::size_t build(const Ping& ping, std::span<std::uint8_t> out);
std::size_t build(const Pong& pong, std::span<std::uint8_t> out);
std::size_t build(const RosterPart& part, std::span<std::uint8_t> out);
std::size_t build(const InterestList& interest, std::span<std::uint8_t> out);
std::size_t build_interest_ack(std::uint32_t version, std::span<std::uint8_t> out);
std::size_t build_bare(Type type, std::span<std::uint8_t> out);

// Parsing of what follows the opening.
struct HelloProblem {
  // Of both, the nonce is known, so that they can be answered.
  bool is_other_version = false;
  bool is_bad_name = false;  // well formed but for a name
  std::uint64_t nonce = 0;
};
std::optional<Hello> parse_hello(Bytes body, HelloProblem& problem);
std::optional<Welcome> parse_welcome(Bytes body);
std::optional<RefusalNotice> parse_refusal(Bytes body);
std::optional<Ping> parse_ping(Bytes body);
std::optional<Pong> parse_pong(Bytes body);
std::optional<RosterPart> parse_roster(Bytes body);
std::optional<InterestList> parse_interest_list(Bytes body);
std::optional<std::uint32_t> parse_interest_ack(Bytes body);  // the version

}  // namespace dance::wire
