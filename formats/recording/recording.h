// Recording: a recorded night in memory: for each guest its skeletons, poses and hands with their
// times, and the beats of the house.
//
// Units/frames: as formats/recording/recording_sink.h.
// Ownership:    keeps copies, as many as its limits allow.
// Threads:      none inside; one owner.
// Failure:      what is beyond the limits is left out and counted.
#pragma once

#include <vector>

#include "formats/recording/recording_sink.h"

namespace dance {

template <class T>
struct Recorded {
  std::int64_t time_us = 0;
  T value;
};

struct RecordedGuest {
  GuestId guest;
  std::vector<Recorded<Skeleton>> skeletons;  // the first holds from the beginning
  std::vector<Recorded<Pose>> poses;
  std::vector<Recorded<Hands>> hands;

  // That of its last poses; an average body where none was recorded.
  Skeleton skeleton() const {
    return skeletons.empty() ? average_skeleton() : skeletons.back().value;
  }
};

// Of all guests together.
struct RecordingLimits {
  std::size_t guests = 64;
  std::size_t skeletons = 16'384;
  std::size_t poses = std::size_t{1} << 21;  // of 464 bytes: ten hours of one guest at 60 Hz
  std::size_t hands = std::size_t{1} << 20;
  std::size_t beats = std::size_t{1} << 20;
};

class Recording : public RecordingSink {
 public:
  // What did not fit.
  struct Overflow {
    std::uint64_t guests = 0;  // messages of guests beyond the limit
    std::uint64_t skeletons = 0;
    std::uint64_t poses = 0;
    std::uint64_t hands = 0;
    std::uint64_t beats = 0;
    std::uint64_t total() const { return guests + skeletons + poses + hands + beats; }
  };

  explicit Recording(const RecordingLimits& limits = {}) : limits_(limits) {}

  void on_skeleton(const GuestId& guest, const Skeleton& skeleton, std::int64_t time_us) override;
  void on_pose(const GuestId& guest, const Pose& pose, std::int64_t time_us) override;
  void on_hands(const GuestId& guest, const Hands& hands, std::int64_t time_us) override;
  void on_beat(const Beat& beat, std::int64_t time_us) override;

  // In the order in which they came.
  const std::vector<RecordedGuest>& guests() const { return guests_; }
  const RecordedGuest* find(const GuestId& guest) const;
  const std::vector<Recorded<Beat>>& beats() const { return beats_; }
  const Overflow& overflow() const { return overflow_; }

  // Tells all of it by time; of the same time skeletons, poses and hands in this order.
  void play_into(RecordingSink& sink) const;

 private:
  RecordedGuest* guest_of(const GuestId& guest);

  RecordingLimits limits_;
  std::vector<RecordedGuest> guests_;
  std::vector<Recorded<Beat>> beats_;
  std::size_t skeleton_count_ = 0;
  std::size_t pose_count_ = 0;
  std::size_t hands_count_ = 0;
  Overflow overflow_;
};

}  // namespace dance
