// HistoryMatch: when a dancer last moved as now: the past twelve seconds beside the last half
// second, joint by joint, so that what came after it then can be shown in place of what does not
// arrive now.
//
// Units/frames: places of the limbs' joints relative to the hips, in the dancer's heading; lags are
//               Durations before the newest pose. Looked at about 30 times a second, at poses that
//               came: nothing is interpolated.
// Ownership:    fixed arrays (60 kB); never allocates.
// Threads:      none inside; one owner.
// Failure:      best() is nullopt where the history is too short, or has gaps everywhere.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "core/pose/history.h"
#include "core/pose/kinematics.h"

namespace dance {

class HistoryMatch {
 public:
  static constexpr Duration kLookBack = Duration::s(12);
  static constexpr Duration kWindow = Duration::ms(400);

  // Takes the history as it is. About 100 us.
  void look(const PoseHistory& history, const Skeleton& skeleton);

  struct Match {
    Duration lag;
    float distance;  // mean square, m²; small is alike
  };
  // The lag between two bounds whose motion is most like the newest.
  std::optional<Match> best(Duration least, Duration most) const;

  std::size_t size() const { return size_; }
  MonoTime time(std::size_t back) const { return times_[back]; }
  // The balls' height over the whole, where the lower of them stands.
  float floor_m() const { return floor_m_; }

 private:
  static constexpr std::size_t kMost = 384;
  static constexpr std::size_t kJoints = 10;
  static constexpr std::size_t kColumns = 32;
  static constexpr std::size_t kWindowRows = 12;
  using Row = Eigen::Array<float, static_cast<int>(kColumns), 1>;

  void measure(const Skeleton& skeleton, const Pose& pose, std::size_t at);
  void find_distances();
  void find_floor();

  std::size_t size_ = 0;
  std::array<Row, kMost> rows_;
  std::array<MonoTime, kMost> times_{};
  std::array<float, kMost> low_m_{};       // the lower ball's height
  std::array<float, kMost> distance_{};    // less than 0: not usable
  std::array<bool, kMost> after_a_gap_{};  // between this and the one after it in time
  std::array<bool, kMost> is_broken_{};    // the same: an impossible jump
  float floor_m_ = 0.0f;
};

}  // namespace dance
