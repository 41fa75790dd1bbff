// GuestBoard: where the bus thread leaves each guest's newest state and the drawing thread finds
// it. A guest captured in this house is shown straight from the capture, but from the stage while
// that moves the arms of each captured pose (hold-hands); all others from the stage. The pose that
// came and the staged one are both kept beside it.
//
// Units/frames: MonoTime of this process; poses in W.
// Ownership:    holds kMaxGuests slots; never allocates after construction.
// Threads:      on_*() on the bus thread; take() on the drawing thread.
// Failure:      a guest without a slot evicts one that has been silent for long; without such it is
//               counted (no_room()).
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>

#include "core/base/latest.h"
#include "core/bus/channel.h"
#include "core/bus/messages.h"
#include "core/bus/state_messages.h"
#include "core/bus/voice.h"
#include "core/pose/music_here.h"
#include "viewer/feed/arrival_meter.h"
#include "viewer/feed/chat_board.h"
#include "viewer/feed/profile_board.h"
#include "viewer/feed/voice_board.h"
#include "viewer/scene/scene.h"

namespace dance {

// The content of a slot.
struct GuestNews {
  GuestId id;
  Pose pose;  // to be shown
  MonoTime heard;
  // The moment that the pose stands for, in this house's clock: of a capture when it was taken, of
  // a stage when it was staged. Not set: not known.
  MonoTime moment;
  // For views that compare: what came into this house, and what its routes made of it.
  Pose arriving;
  MonoTime arriving_heard;  // not set: nothing came
  std::optional<BeatFigures> arriving_beat;
  Pose staged;
  MonoTime staged_heard;
  Skeleton skeleton = average_skeleton();
  Hands hands;
  MonoTime hands_heard;  // not set: none
  Face face;
  MonoTime face_heard;  // not set: none
  AvatarWish wish;
  GuestFigures figures;
  int voice_dbfs = kSilence_dbfs;
  MonoTime voice_heard;        // not set: none
  VoiceState voice_state;      // of a guest of another house
  MonoTime voice_state_heard;  // not set: none
  ChatKind sign = ChatKind::kHeart;
  MonoTime sign_shown;  // not set: none
};

class GuestBoard {
 public:
  static constexpr std::size_t kMaxGuests = 128;

  // With `stage_only` no guest is shown from the capture while on the stage.
  GuestBoard(std::uint64_t clock_id, bool stage_only);
  // Poses of POSE/guest are for comparison only, unless they are what is to be shown. Before the
  // first pose.
  void show_guest_channel() { shows_guest_channel_ = true; }

  void on_pose(Where where, const GuestId& guest, const Pose& pose, MonoTime now);
  void on_face(const GuestId& guest, const Face& face, MonoTime now);
  void on_hands(Where where, const GuestId& guest, const Hands& hands, MonoTime now);
  void on_skeleton(const GuestId& guest, const Skeleton& skeleton, MonoTime now);
  void on_avatar(const GuestId& guest, const Avatar& avatar, MonoTime now);
  void on_avatar(const GuestId& guest, const AvatarFile& file, MonoTime now);
  void on_status(const GuestId& guest, const GuestStatus& status, MonoTime now);
  void on_voice(const GuestId& guest, const Voice& voice, MonoTime now);
  // Guests of this house, and guests of others.
  void on_voice_state(const GuestId& guest, const VoiceState& state, MonoTime now) {
    voices_.on_state(guest, state, now);
  }
  void on_remote_voice_state(const GuestId& guest, const VoiceState& state, MonoTime now);
  void on_profile(Where where, const GuestId& guest, const Profile& profile, MonoTime now) {
    profiles_.on_profile(guest, where == Where::kGuest, profile, now);
  }
  void on_chat(const GuestId& guest, const Chat& chat, MonoTime now);
  void on_beat(const Beat& beat);

  // Of a recording, with one thread for all. Forgets everything: what follows is of another moment.
  void clear(std::uint64_t clock_id);
  // Changes with each clear().
  std::uint32_t epoch() const { return epoch_; }
  // As on_pose(), of a pose that is not shown, as others follow: its body does not matter.
  void pass_over(Where where, const GuestId& guest, const Pose& pose, MonoTime now);
  // Shows an archive all that outlives a guest's next pose and hands, to be kept and set again.
  // has_samples(guest, of_arriving) says whose beat meter's samples are among it.
  template <class Archive, class HasSamples>
  void carry(Archive& archive, HasSamples has_samples);
  // Of a guest who is here; 0 of others.
  std::size_t beat_samples_of(const GuestId& guest, bool of_arriving) const;

  // The newest of a slot if it is new since the last call, else nullptr. Valid until the next call.
  const GuestNews* take(std::size_t slot) { return slots_[slot].latest.take(); }

  // As take(), of this house's music.
  const BeatClock* take_music() { return music_latest_.take(); }
  // As take(), of this house's voices.
  const VoiceBoard::Voices* take_voices() { return voices_.take(); }
  // Returns the guests' profiles, as take() does.
  const ProfileBoard::Profiles* take_profiles() { return profiles_.take(); }
  // Returns the newest lines of chat, as take() does.
  const ChatBoard::Lines* take_lines() { return chat_.take(); }

  std::uint64_t poses() const { return poses_.load(std::memory_order_relaxed); }
  std::uint64_t no_room() const { return no_room_.load(std::memory_order_relaxed); }

 private:
  struct Slot {
    template <class Archive>
    void carry(Archive& archive, bool has_samples, bool has_arriving_samples);

    // Of the bus thread; `latest` passes it to the drawing thread.
    GuestNews news;
    ArrivalMeter meter;
    BeatMeter beat_meter;
    BeatMeter arriving_beat_meter;
    MonoTime last_heard;  // anything of this guest
    MonoTime capture_heard;
    MonoTime status_heard;
    MonoTime reached;  // when the stage last moved the arms of a pose captured here
    Latest<GuestNews> latest;
  };

  Slot* slot_of(const GuestId& guest, MonoTime now);
  bool is_superseded(const Slot& slot, Where where, MonoTime now) const;
  // Notes where the stage gave the captured pose on at once, with other arms. To be called with
  // either: a house's process stages what it hosts before the bus has its capture.
  void note_reach(Slot& slot, MonoTime now) const;
  // Whether it came into this house just now.
  bool note_for_comparison(Slot& slot, Where where, const Pose& pose, MonoTime now);
  MonoTime moment_of(const Slot& slot, Where where, const Pose& pose, MonoTime now) const;
  // The slot of a pose, after all that is measured of it; nullptr where there is no room.
  struct Measured {
    Slot* slot = nullptr;
    bool is_arriving = false;
    const Pose* shown = nullptr;  // nullptr: nothing new
  };
  Measured measure(Where where, const GuestId& guest, const Pose& pose, MonoTime now);

  std::uint64_t clock_id_;
  bool stage_only_;
  bool shows_guest_channel_ = false;
  std::unique_ptr<Slot[]> slots_;
  MusicHere music_;  // the bus thread's
  Latest<BeatClock> music_latest_;
  VoiceBoard voices_;
  ProfileBoard profiles_;
  ChatBoard chat_;
  std::atomic<std::uint64_t> poses_{0};
  std::atomic<std::uint64_t> no_room_{0};
  std::uint32_t epoch_ = 0;
};

template <class Archive>
void GuestBoard::Slot::carry(Archive& archive, bool has_samples, bool has_arriving_samples) {
  archive(last_heard), archive(capture_heard), archive(status_heard);
  archive(news.heard), archive(news.hands_heard);
  archive(news.figures.arrival_hz), archive(news.figures.age_ms);
  archive(news.figures.loss_percent), archive(news.skeleton);
  meter.carry(archive);
  archive(news.arriving_heard), archive(news.staged_heard);
  beat_meter.carry(archive, has_samples);
  arriving_beat_meter.carry(archive, has_arriving_samples);
}

template <class Archive, class HasSamples>
void GuestBoard::carry(Archive& archive, HasSamples has_samples) {
  music_.carry(archive);
  chat_.carry(archive);
  for (std::size_t i = 0; i < kMaxGuests; ++i) {
    Slot& slot = slots_[i];
    archive(slot.news.id);
    if (!slot.news.id.is_set()) continue;
    bool with_samples = has_samples(slot.news.id, false);
    bool with_arriving_samples = has_samples(slot.news.id, true);
    archive(with_samples), archive(with_arriving_samples);
    slot.carry(archive, with_samples, with_arriving_samples);
  }
  music_latest_.put(music_.clock());
}

}  // namespace dance
