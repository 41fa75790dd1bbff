// A link's guests: those of this house, which it sends, and those of the others, which it hears.
//
// Units/frames: as in tunnel/wire/wire.h.
// Ownership:    own their codecs; made when a guest comes, not while poses pass.
// Threads:      none inside.
// Failure:      StreamTag::advance() is false for what is not newer.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/base/deadline.h"
#include "core/base/token_bucket.h"
#include "core/codec/hands_codec.h"
#include "core/codec/plain_codec.h"
#include "core/codec/pose_codec.h"
#include "core/codec/quality_by_rate.h"
#include "tunnel/link/core/link_options.h"
#include "tunnel/policy/chat_budget.h"
#include "tunnel/session/reference_control.h"
#include "tunnel/session/repetition.h"
#include "tunnel/session/state_replicator.h"
#include "tunnel/session/stream_gate.h"
#include "tunnel/wire/wire_chat.h"
#include "tunnel/wire/wire_voice.h"

namespace dance {

// Tells a producer that began anew (its sequence starts over, or leaps, while capture goes on) from
// a pose that is merely old. Each new start is a new stream.
class StreamTag {
 public:
  bool advance(std::uint32_t sequence, MonoTime capture, std::uint64_t clock_id);
  std::uint16_t stream() const { return stream_; }
  std::uint64_t restarts() const { return restarts_; }

 private:
  bool has_any_ = false;
  std::uint16_t stream_ = 0;
  std::uint32_t sequence_ = 0;
  MonoTime capture_;
  std::uint64_t clock_id_ = 0;
  std::uint64_t restarts_ = 0;
};

// One further channel of a guest of another house; without a rule its records go no further.
struct RemoteChannel {
  bool is_named = false;
  ForeignName name;
  const ChannelRule* rule = nullptr;
  TokenBucket messages;
  bool has_any = false;
  std::uint32_t sequence = 0;
};

// The newest lines and signs of a guest of this house, in this house's clock.
struct ChatOutbox {
  wire::ChatHistory history;
  ChatBudget budget;
};

struct LocalGuest {
  GuestId id;
  bool has_slot = false;
  wire::Slot slot;
  MonoTime refused_until;       // set: not asked for before then
  bool came_with_pose = false;  // not announced: goes when its producer does
  MonoTime last_pose;
  MonoTime last_voice;
  TokenBucket voice_budget{wire::kVoicesPerSecond, wire::kVoiceBurst};
  StreamTag poses;
  StreamTag hands;
  std::unique_ptr<PoseEncoder> encoder;
  QualityByRate quality;
  double encoded_quality_m = 0.0;  // as the encoder was told; 0 = not yet
  ReferenceControl references;
  std::uint32_t unstamped = 0;  // poses since one brought its hops; 0 = the next one does
  SentPose previous;            // goes once more where the path loses some
  ChatOutbox chat;
  // Skeleton, avatar, style, placement, avatar file and chat, by wire::place_of().
  std::array<ReplicatedState, wire::kFirstChannelPlace> states;
  // What this guest requested for the room last: programs say it again each second, which is no new
  // request.
  std::optional<Music> requested_music;  // in our clock
  std::optional<RoomSong> requested_song;
  std::optional<Scene> requested_scene;
};

// The guests of this house.
class LocalGuests {
 public:
  LocalGuests() { guests_.reserve(wire::kMaxGuestsPerLink); }

  auto begin() { return guests_.begin(); }
  auto end() { return guests_.end(); }
  auto begin() const { return guests_.begin(); }
  auto end() const { return guests_.end(); }
  LocalGuest& operator[](std::size_t place) { return guests_[place]; }
  std::size_t size() const { return guests_.size(); }
  bool is_full() const { return guests_.size() == wire::kMaxGuestsPerLink; }

  LocalGuest& add(const GuestId& id, const QualityByRate& quality);
  // Those who came with a pose or a voice and whose producers have ended give their names back to
  // the room.
  bool evict_silent(MonoTime now);
  LocalGuest* find(const GuestId& id);
  LocalGuest* find_slot(std::uint8_t slot);
  // Guests of whom something came of late: whose records are worth waiting for.
  std::size_t count_dancing(MonoTime now) const;
  bool is_ours(const wire::RosterEntry& entry) const;
  std::vector<LocalGuestStats> stats() const;

 private:
  std::vector<LocalGuest> guests_;  // reserved
};

struct RemoteGuest {
  bool in_use = false;
  bool is_ours = false;
  GuestId id;
  std::uint16_t generation = 0;
  // What was heard in this session and slot.
  struct Heard {
    StreamGate poses;
    StreamGate hands;
    bool has_decoded = false;                                        // some pose
    std::array<std::uint32_t, wire::kGuestStates> state_versions{};  // 0 = not heard yet
    std::array<RemoteChannel, kMaxChannelsPerGuest> channels;
  };
  Heard heard;
  MonoTime shown;           // capture of the newest pose that went on, of this generation
  RemoteGuestStats counts;  // of this generation, but for what the gates count
  MonoTime intra_asked_at;
  bool has_skeleton = false;  // of this guest, of this session or one before
  Skeleton skeleton;
  std::unique_ptr<PoseDecoder> decoder;
};

// The guests of the other houses, by slot; and the counts of those who left or got another slot, so
// that a summary at the end has everybody.
class RemoteGuests {
 public:
  RemoteGuests();

  auto begin() { return guests_.begin(); }
  auto end() { return guests_.end(); }
  auto begin() const { return guests_.begin(); }
  auto end() const { return guests_.end(); }
  RemoteGuest& operator[](std::size_t slot) { return guests_[slot]; }
  std::uint8_t slot_of(const RemoteGuest& guest) const {
    return static_cast<std::uint8_t>(&guest - guests_.data());
  }
  bool is_present(const GuestId& id) const;
  // Of those here who are named.
  wire::InterestList interest_list(const Interest& interest, const Hearing& hearing) const;
  // Before a guest's counting begins anew: it left, or it came back in another slot or session.
  void keep_counts(const RemoteGuest& guest);
  std::vector<RemoteGuestStats> stats() const;

 private:
  std::vector<RemoteGuest> guests_;
  std::vector<RemoteGuestStats> departed_;  // reserved; the oldest makes room
};

// Puts the parts of a roster together, newest version first.
class RosterAssembly {
 public:
  // False for a part that is older than what is there.
  bool take(const wire::RosterPart& part);
  std::uint32_t whole_version() const { return whole_; }  // 0 = none

 private:
  std::uint32_t version_ = 0;
  std::uint32_t parts_seen_ = 0;
  std::uint32_t whole_ = 0;
};

}  // namespace dance
