// A link's guests: those of this house, which it sends, and those of the others, which it hears.
//
// Units/frames: as in tunnel/wire/wire.h.
// Ownership:    own their codecs; made when a guest comes, not while poses pass.
// Threads:      none inside.
// Failure:      StreamTag::advance() is false for what is not newer.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "core/codec/hands_codec.h"
#include "core/codec/plain_codec.h"
#include "core/codec/pose_codec.h"
#include "core/codec/quality_by_rate.h"
#include "tunnel/link/link_options.h"
#include "tunnel/link/link_states.h"
#include "tunnel/session/reference_control.h"
#include "tunnel/session/repetition.h"
#include "tunnel/session/stream_gate.h"

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

struct LocalGuest {
  GuestId id;
  bool has_slot = false;
  wire::Slot slot;
  MonoTime refused_until;       // set: not asked for before then
  bool came_with_pose = false;  // not announced: goes when its producer does
  MonoTime last_pose;
  StreamTag poses;
  StreamTag hands;
  std::unique_ptr<PoseEncoder> encoder;
  QualityByRate quality;
  ReferenceControl references;
  std::uint32_t unstamped = 0;  // poses since one brought its hops; 0 = the next one does
  SentPose previous;            // goes once more where the way loses some
  // Skeleton, avatar, style and placement, by wire::place_of().
  std::array<ReplicatedState, wire::kFirstChannelPlace> states;
  // What this guest wished for the room last: programs say it again each second, which is no new
  // wish.
  std::optional<Music> wished_music;  // in our clock
  std::optional<Scene> wished_scene;
};

struct RemoteGuest {
  bool in_use = false;
  bool is_ours = false;
  GuestId id;
  std::uint16_t generation = 0;
  StreamGate poses;
  StreamGate hands;
  bool has_decoded = false;  // some pose, since the gates were new
  MonoTime shown;            // capture of the newest that went on, of this generation
  std::uint64_t invalid = 0;
  std::uint64_t reference_missing = 0;
  std::uint64_t skeleton_missing = 0;
  std::uint64_t key_frames_asked = 0;
  MonoTime key_asked_at;
  std::array<std::uint32_t, wire::kGuestStates> state_versions{};  // 0 = not heard yet
  std::array<RemoteChannel, kMaxChannelsPerGuest> channels;
  bool has_skeleton = false;  // of this guest, of this session or one before
  Skeleton skeleton;
  std::unique_ptr<PoseDecoder> decoder;
};

// Puts the parts of a roster together, newest version first.
class RosterAssembly {
 public:
  // False for a part that is older than what is there.
  bool take(const wire::RosterPart& part);
  std::uint32_t whole_version() const { return whole_; }  // 0 = none
  void reset() { *this = RosterAssembly(); }

 private:
  std::uint32_t version_ = 0;
  std::uint32_t parts_seen_ = 0;
  std::uint32_t whole_ = 0;
};

}  // namespace dance
