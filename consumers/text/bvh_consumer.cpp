#include "consumers/text/bvh_consumer.h"

#include "formats/bvh/bvh.h"

namespace dance {

BvhConsumer::BvhConsumer(std::shared_ptr<OutputFile> output, double hz, const GuestId& guest,
                         std::size_t most_frames)
    : output_(std::move(output)), guest_(guest), clip_(hz, most_frames) {}

void BvhConsumer::on_skeleton(const GuestId& guest, const Skeleton& skeleton, MonoTime) {
  if (!guest_.is_set()) guest_ = guest;
  if (guest == guest_) clip_.set_skeleton(skeleton);
}

void BvhConsumer::on_pose(const GuestId& guest, const Pose& pose, MonoTime) {
  if (!guest_.is_set()) guest_ = guest;
  if (guest == guest_)
    clip_.add(pose);
  else
    ++of_others_;
}

void BvhConsumer::on_hands(const GuestId& guest, const Hands& hands, MonoTime) {
  if (guest == guest_) clip_.add(hands);
}

Result<void> BvhConsumer::finish() {
  if (is_finished_) return output_->flush();
  is_finished_ = true;
  if (clip().frames.empty())
    return fail(output_->name() + ": no BVH written, as no pose was heard" +
                (guest_.is_set() ? " of " + std::string(guest_.view()) : std::string()) +
                "; dance top lists who is on the bus");
  output_->write(write_bvh(clip_.with_hands()));
  return output_->flush();
}

std::string BvhConsumer::summary() const {
  std::string text = std::to_string(clip().frames.size()) + " frames of " +
                     std::string(guest_.view()) + " to " + output_->name();
  const auto add = [&text](std::uint64_t count, const char* what) {
    if (count > 0) text += "; " + std::to_string(count) + what;
  };
  if (!clip_.has_skeleton())
    text += "; proportions of an average body, as the guest's were not heard";
  add(of_others_, " poses of other guests left out (choose with --guest)");
  add(clip_.counters().not_newer, " poses left out, as they were not newer");
  add(clip_.counters().gaps, " silences cut out");
  add(clip_.counters().beyond_bound, " frames left out, as they were too many");
  return text;
}

}  // namespace dance
