// Continuation: what a dancer probably goes on with while no poses come: first what followed when
// they last moved as now, then, where there is music, a loop of whole bars that stays on the beat,
// and after some seconds standing at ease. Made of the dancer's own past; as alive as they were, on
// the floor, near where they were, without a pop where parts meet.
//
// Units/frames: as core/pose/pose.h; moments are told as the time since the newest pose.
// Ownership:    refers to the history, which must live on until end(), and keep what is older than
//               the newest of now; never allocates (80 kB inside).
// Threads:      none inside; one owner.
// Failure:      begin() of an empty history is false; of a short one it stands at ease from the
//               newest pose on. at() is the same for the same moment, in whatever order moments are
//               asked for.
#pragma once

#include <array>

#include "core/motion/spring.h"
#include "core/pose/history.h"
#include "transformers/conceal/history_match.h"

namespace dance {

class Continuation {
 public:
  // Until here what is predicted is better, from there on what is continued; between them they are
  // mixed.
  static constexpr Duration kPredictedUntil = Duration::ms(250);
  static constexpr Duration kContinuedFrom = Duration::ms(550);
  static constexpr Duration kLoopedFrom = Duration::s(2);
  static constexpr Duration kCalmingFrom = Duration::s(4);
  static constexpr Duration kCalmFrom = Duration::s(8);
  // From there on nobody is shown who is not there.
  static constexpr Duration kLongest = Duration::s(10);
  // How much of what is shown is continued, 0 … 1: C1 over the two moments above.
  static float share_at(Duration since_newest);

  // The poses have stopped: looks for what to go on with, once. `beat`: a beat of the music; 0:
  // read off the poses' musical time, where they carry it, and no loop on the beat otherwise.
  bool begin(const PoseHistory& history, const Skeleton& skeleton, Duration beat = Duration());
  // Turns and shifts everything, so that the dancer at `since_newest` stands and faces as in
  // `there`. At most once after a begin(), before the first at().
  void put(Duration since_newest, const Pose& there);
  void end() { history_ = nullptr; }
  bool is_running() const { return history_ != nullptr; }
  MonoTime newest_time() const { return newest_.capture_time; }

  // The pose `since_newest` after the newest that came. False where nothing was begun.
  bool at(Duration since_newest, Pose& out) const;

  // What was found: for reports and tests. 0: nothing to go on with, or no music.
  Duration lag() const { return lag_; }
  Duration loop() const { return loop_; }

 private:
  static constexpr std::size_t kMostSegments = 16;
  static constexpr std::size_t kCalmSteps = 64;
  // A stretch of the past, put where the dancer is: turned by yaw about the vertical and shifted.
  struct Segment {
    Duration begin;       // since the newest pose
    MonoTime source;      // what is shown then
    bool stands = false;  // no past to show: the newest pose stands
    float yaw_rad = 0.0f;
    Eigen::Vector3f shift_m = Eigen::Vector3f::Zero();
    // What is left of the difference to what was shown before, by bone, and of the hips' place.
    std::array<Spring, kBoneCount> turn;
    Spring place;
    float y = 0.0f;  // of the springs, 1/s
  };
  // Where the dancer goes while calming down.
  struct Place {
    float yaw_rad = 0.0f;
    Eigen::Vector3f p_m = Eigen::Vector3f::Zero();
  };

  void find_lags(Duration beat);
  void make_segments();
  void add_segment(Duration begin, Duration lag, Duration half_life);
  void find_ease(const Skeleton& skeleton);
  void find_places();
  Pose dance_at(std::size_t segment, Duration since) const;
  Pose dance_at(Duration since) const;
  std::size_t segment_at(Duration since) const;
  void bound(Pose& pose) const;
  void calm(Duration since, Pose& pose) const;

  const PoseHistory* history_ = nullptr;
  HistoryMatch match_;
  Pose newest_;
  Duration lag_, loop_;
  std::array<Segment, kMostSegments> segments_;
  std::size_t segment_count_ = 0;
  Pose ease_;  // standing at ease, heading 0, at the origin
  std::array<Place, kCalmSteps + 1> places_;
};

}  // namespace dance
