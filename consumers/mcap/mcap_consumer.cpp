#include "consumers/mcap/mcap_consumer.h"

namespace dance {

McapConsumer::McapConsumer(std::shared_ptr<OutputFile> output, double hz, Duration wall_ahead)
    : output_(std::move(output)),
      writer_([this](std::span<const std::uint8_t> bytes) {
        output_->write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
      }),
      pose_limit_(hz),
      hands_limit_(hz),
      wall_ahead_(wall_ahead) {}

void McapConsumer::on_pose(const GuestId& guest, const Pose& pose, MonoTime now) {
  if (pose_limit_.lets_through(guest, pose.capture_time))
    writer_.on_pose(guest, pose, wall_us(now));
}

void McapConsumer::on_skeleton(const GuestId& guest, const Skeleton& skeleton, MonoTime now) {
  writer_.on_skeleton(guest, skeleton, wall_us(now));
}

void McapConsumer::on_hands(const GuestId& guest, const Hands& hands, MonoTime now) {
  if (hands_limit_.lets_through(guest, hands.capture_time))
    writer_.on_hands(guest, hands, wall_us(now));
}

void McapConsumer::on_beat(const Beat& beat, MonoTime now) { writer_.on_beat(beat, wall_us(now)); }

void McapConsumer::on_second(MonoTime) { writer_.end_chunk(); }

Result<void> McapConsumer::finish() {
  if (!is_finished_) writer_.finish();
  is_finished_ = true;
  return output_->flush();
}

std::string McapConsumer::summary() const {
  const DanceMcapWriter::Counters& counters = writer_.counters();
  std::string text = std::to_string(counters.poses) + " poses and " +
                     std::to_string(counters.hands) + " hands of " +
                     std::to_string(writer_.guests()) + " guests to " + output_->name();
  const auto add = [&text](std::uint64_t count, const char* what) {
    if (count > 0) text += "; " + std::to_string(count) + what;
  };
  add(counters.beyond_guests, " messages left out, as they were of too many guests");
  add(counters.before_1970, " messages left out, as this machine's date is wrong");
  add(writer_.file().left_out(), " messages left out, as the file is too long: record in parts");
  return text;
}

}  // namespace dance
