#include "consumers/text/bvh_consumer.h"

#include "core/base/assert.h"
#include "core/pose/interpolate.h"
#include "formats/bvh/bvh.h"

namespace dance {

BvhConsumer::BvhConsumer(std::shared_ptr<OutputFile> output, double hz, const GuestId& guest,
                         std::size_t most_frames)
    : output_(std::move(output)), guest_(guest), most_frames_(most_frames) {
  DANCE_ASSERT(hz > 0.0, hz);
  clip_.frame_hz = hz;
  clip_.skeleton = average_skeleton();
}

void BvhConsumer::on_skeleton(const GuestId& guest, const Skeleton& skeleton, MonoTime) {
  if (!guest_.is_set()) guest_ = guest;
  if (!(guest == guest_)) return;
  clip_.skeleton = skeleton;
  has_skeleton_ = true;
}

void BvhConsumer::begin_grid(const Pose& pose) {
  grid_start_ = pose.capture_time;
  grid_index_ = 1;
  add_frame(pose);
}

void BvhConsumer::add_frame(const Pose& pose) {
  if (clip_.frames.size() < most_frames_)
    clip_.frames.push_back(pose);
  else
    ++beyond_bound_;
}

void BvhConsumer::on_pose(const GuestId& guest, const Pose& pose, MonoTime) {
  if (!guest_.is_set()) guest_ = guest;
  if (!(guest == guest_)) {
    ++of_others_;
    return;
  }
  if (!previous_) {
    begin_grid(pose);
  } else if (pose.clock_id != previous_->clock_id ||
             pose.capture_time - previous_->capture_time > kLongestGap) {
    // Another clock, or a long silence: the pause is cut out.
    ++gaps_;
    begin_grid(pose);
  } else if (pose.capture_time <= previous_->capture_time) {
    ++not_newer_;
    return;
  } else {
    // Frame k stands at start + k/hz, between the pose before it and this one.
    const double step_s = (pose.capture_time - previous_->capture_time).as_seconds();
    for (;; ++grid_index_) {
      const MonoTime t =
          grid_start_ + Duration::seconds(static_cast<double>(grid_index_) / clip_.frame_hz);
      if (t > pose.capture_time) break;
      const double fraction = (t - previous_->capture_time).as_seconds() / step_s;
      add_frame(interpolate(*previous_, pose, static_cast<float>(fraction)));
    }
  }
  previous_ = pose;
}

Result<void> BvhConsumer::finish() {
  if (is_finished_) return output_->flush();
  is_finished_ = true;
  if (clip_.frames.empty())
    return fail(output_->name() + ": no BVH written, as no pose was heard" +
                (guest_.is_set() ? " of " + std::string(guest_.view()) : std::string()) +
                "; dance top lists who is on the bus");
  output_->write(write_bvh(clip_));
  return output_->flush();
}

std::string BvhConsumer::summary() const {
  std::string text = std::to_string(clip_.frames.size()) + " frames of " +
                     std::string(guest_.view()) + " to " + output_->name();
  const auto add = [&text](std::uint64_t count, const char* what) {
    if (count > 0) text += "; " + std::to_string(count) + what;
  };
  if (!has_skeleton_) text += "; proportions of an average body, as the guest's were not heard";
  add(of_others_, " poses of other guests left out (choose with --guest)");
  add(not_newer_, " poses left out, as they were not newer");
  add(gaps_, " silences cut out");
  add(beyond_bound_, " frames left out, as they were too many");
  return text;
}

}  // namespace dance
