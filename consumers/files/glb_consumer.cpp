#include "consumers/files/glb_consumer.h"

#include "formats/gltf/glb.h"
#include "formats/recording/clips_together.h"

namespace dance {
namespace {

RecordingLimits limits_for(std::size_t most_poses) {
  RecordingLimits limits;
  limits.guests = GlbConsumer::kMostGuests;
  limits.skeletons = 1024;
  limits.poses = most_poses;
  limits.hands = most_poses;
  limits.beats = 0;
  return limits;
}

void add(std::string& text, std::uint64_t count, const char* what) {
  if (count > 0) text += "; " + std::to_string(count) + what;
}

}  // namespace

GlbConsumer::GlbConsumer(std::shared_ptr<OutputFile> output, double hz, const GuestId& guest,
                         std::size_t most_poses)
    : output_(std::move(output)), hz_(hz), only_(guest), recording_(limits_for(most_poses)) {}

void GlbConsumer::on_pose(const GuestId& guest, const Pose& pose, MonoTime now) {
  if (is_wanted(guest)) recording_.on_pose(guest, pose, now.since_zero_us());
}

void GlbConsumer::on_skeleton(const GuestId& guest, const Skeleton& skeleton, MonoTime now) {
  if (is_wanted(guest)) recording_.on_skeleton(guest, skeleton, now.since_zero_us());
}

void GlbConsumer::on_hands(const GuestId& guest, const Hands& hands, MonoTime now) {
  if (is_wanted(guest)) recording_.on_hands(guest, hands, now.since_zero_us());
}

Result<void> GlbConsumer::finish() {
  if (is_finished_) return output_->flush();
  is_finished_ = true;
  ClipsTogether together = clips_together(recording_, hz_);
  if (together.clips.empty())
    return fail(output_->name() + ": no GLB written, as no pose was heard" +
                (only_.is_set() ? " of " + std::string(only_.view()) : std::string()) +
                "; dance top lists who is on the bus");
  std::vector<NamedClip> clips;
  written_ = std::to_string(together.clips.front().clip.frames.size()) + " frames of ";
  for (auto& [guest, clip] : together.clips) {
    written_ += (clips.empty() ? "" : ", ") + std::string(guest.view());
    clips.push_back({std::string(guest.view()), std::move(clip), {}});
  }
  add(written_, together.counters.not_newer, " poses and hands left out, as they were not newer");
  add(written_, together.counters.silences, " silences, in which the dancer stands still");
  add(written_, together.counters.beyond_bound, " frames left out, as they were too many");
  add(written_, recording_.overflow().total(), " messages left out, as they were too many");
  left_out_ = together.counters.beyond_bound + recording_.overflow().total();
  DANCE_TRY(const auto bytes, write_glb(clips));
  output_->write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  return output_->flush();
}

std::string GlbConsumer::summary() const {
  return (written_.empty() ? "nothing" : written_) + " to " + output_->name();
}

}  // namespace dance
