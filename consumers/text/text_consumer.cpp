#include "consumers/text/text_consumer.h"

#include <algorithm>
#include <bit>

namespace dance {

void TextConsumer::on_pose(const GuestId& guest, const Pose& pose, MonoTime now) {
  if (heard_++ == 0) first_ = now;
  if (!limit_.lets_through(guest, pose.capture_time)) return;
  line_.clear();
  line_.fixed((now - first_).as_seconds(), 3);
  line_.text(" s  ");
  line_.text(guest.view());
  line_.text("  #");
  line_.integer(pose.sequence);
  line_.text("  age ");
  // Times of another clock cannot be compared with ours.
  if (pose.clock_id == own_clock_id_)
    line_.fixed((now - pose.capture_time).as_ms(), 1);
  else
    line_.text("?");
  line_.text(" ms  hips");
  for (int axis = 0; axis < 3; ++axis) {
    line_.text(" ");
    line_.fixed(static_cast<double>(pose.p_WH_m[axis]), 3);
  }
  line_.text(" m  ");
  line_.integer(std::popcount(pose.presence));
  line_.text(" bones seen");
  if (std::isfinite(pose.music_beats)) {
    line_.text("  beat ");
    line_.fixed(std::clamp(pose.music_beats, -1e15, 1e15), 2);
  }
  line_.text("\n");
  output_->write(line_.view());
  ++written_;
}

std::string TextConsumer::summary() const {
  return std::to_string(written_) + " lines of " + std::to_string(heard_) + " poses to " +
         output_->name();
}

}  // namespace dance
