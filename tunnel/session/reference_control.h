// Which earlier frames the encoder of one guest may refer to, and when it makes a frame that refers
// to none (an intra frame) or only to what all receivers have (a base frame). The sender holds a
// ReferenceControl; the server, which knows the receivers, sums them up in a ReceiverSummary; the
// feedback between the two is wire::GuestFeedback.
//
// Units/frames: sequences are 32 bit, of which feedback tells 16; MonoTime of the owner's clock.
// Ownership:    plain values; encoders are the caller's. Never allocates.
// Threads:      none inside.
// Failure:      feedback about frames that were never sent, or of another stream, does nothing.
#pragma once

#include <cstdint>

#include "core/base/time.h"
#include "core/codec/pose_codec.h"
#include "tunnel/session/frame_window.h"
#include "tunnel/session/reference_policy.h"
#include "tunnel/wire/wire_records.h"

namespace dance {

class ReferenceControl {
 public:
  // A new encoder: receivers have nothing of what it refers to.
  void begin(PoseEncoder& encoder);
  // The producer began anew: no earlier frame is a reference.
  void restart(PoseEncoder& encoder, std::uint16_t stream);

  // Before each frame, with its capture time: tells the encoder what it may refer to. True for a
  // base frame.
  bool prepare(PoseEncoder& encoder, MonoTime capture, Duration intra_period, MonoTime now);
  void note_sent(std::uint32_t sequence, bool is_intra, MonoTime now);
  // True where an intra frame is asked for.
  bool take(const wire::GuestFeedback& about, const PathStats& path, PoseEncoder& encoder,
            MonoTime now);

  References references() const { return policy_.current(); }
  // For a while no receiver has been sent every pose: all see the dancer from afar.
  bool is_far_from_all(MonoTime now) const {
    return far_since_.is_set() && now - far_since_ >= kFarForGood;
  }
  // Between captures, as it is of late.
  Duration frame() const { return frame_; }
  // What the encoder was told that all receivers have.
  const FrameWindow& acked_frames() const { return acked_frames_; }
  std::uint64_t sent() const { return sent_; }
  std::uint64_t acked() const { return acked_; }
  std::uint64_t intra_asked() const { return intra_asked_; }

 private:
  void note_capture(MonoTime capture);
  void refresh(PoseEncoder& encoder, Duration intra_period, MonoTime now);
  void acknowledge(const wire::GuestFeedback& about, PoseEncoder& encoder, MonoTime now);
  void note_distance(const wire::GuestFeedback& about, MonoTime now);
  template <class Tell>
  void each_new(std::uint16_t newest, std::uint16_t before, FrameWindow& told, Tell tell) const;

  ReferencePolicy policy_;
  References told_ = policy_.current();  // to the encoder
  Duration frame_ = Duration::us(16'667);
  MonoTime last_capture_;
  std::uint16_t stream_ = 0;
  std::uint32_t last_sequence_ = 0;
  FrameWindow sent_frames_;        // what there is to acknowledge,
  FrameWindow acked_frames_;       // what the encoder was told of it,
  FrameWindow base_acked_frames_;  // and of what those have too who get only base frames
  MonoTime acked_at_;
  // For receivers who want less than all: each 2^n-th is a base frame (0: none), or an intra frame.
  std::uint8_t base_log2_ = 0;
  std::uint8_t intra_log2_ = kFewestIntra_log2;
  MonoTime intra_at_;              // the newest intra frame, whatever for,
  std::uint32_t since_intra_ = 0;  // and the frames since then
  static constexpr Duration kFarForGood = Duration::s(2);
  MonoTime far_since_;
  std::uint8_t requests_seen_ = 0;
  MonoTime refreshed_at_;
  std::uint64_t sent_ = 0;
  std::uint64_t acked_ = 0;
  std::uint64_t intra_asked_ = 0;
};

// What receivers of one guest have in common, and how often those want it who want less than all.
struct CommonFrames {
  bool has_full = false;  // somebody gets all, and has something of late
  bool has_base = false;  // somebody gets all or base frames, and has something of late
  FrameWindow full;       // of those who get all
  FrameWindow base;       // and of those too who get only base frames
  std::uint8_t base_log2 = 0;
  std::uint8_t intra_log2 = kFewestIntra_log2;

  bool operator==(const CommonFrames&) const = default;
};

// What the receivers of one guest have in common, added up one by one.
class ReceiverSummary {
 public:
  // Of the guest: whether a pose has come, and of the newest the stream and sequence.
  ReceiverSummary(bool has_any, std::uint32_t stream, std::uint32_t newest)
      : has_any_(has_any), stream_(stream), newest_(newest) {}

  // One receiver: how often it wants the guest, and which of the guest's frames it has.
  void add(std::uint8_t divider, const FrameWindow& frames);
  // Those of another server, summed up there.
  void add(const CommonFrames& others);
  const CommonFrames& common() const { return common_; }
  void fill(wire::GuestFeedback& about) const;

 private:
  static void intersect(const FrameWindow& frames, bool& has_some, FrameWindow& common);
  bool is_of_late(const FrameWindow& frames) const;

  bool has_any_;
  std::uint32_t stream_;
  std::uint32_t newest_;
  CommonFrames common_;
};

}  // namespace dance
