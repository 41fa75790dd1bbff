#include "producers/dancer_feed.h"

#include "core/net/mono_clock.h"
#include "producers/first_sequence.h"

namespace dance {
DancerFeed::DancerFeed(std::unique_ptr<Dancer> dancer, const GuestId& guest, double hz,
                       CaptureSink& sink, Poller& poller, MonoTime start)
    : dancer_(std::move(dancer)),
      guest_(guest),
      sink_(sink),
      start_(start),
      pacer_(start, hz),
      sequence_(first_sequence(mono_now())) {
  pacer_.begin_at(mono_now());
  poller.add_timer(pacer_.deadline(), [this](MonoTime now) { return dance(now); });
}

void DancerFeed::publish_skeleton(MonoTime now) {
  published_skeleton_ = &dancer_->skeleton();
  sink_.capture(guest_, TimedSkeleton{dancer_->skeleton(), now, this_clock_id()});
  if (dancer_->is_moved_to_music(now - start_)) {
    Steps steps;
    steps.time = now;
    steps.clock_id = this_clock_id();
    sink_.tell(guest_, steps);
  }
  next_skeleton_ += Duration::s(1);
  if (next_skeleton_ <= now) next_skeleton_ = now + Duration::s(1);
}

MonoTime DancerFeed::dance(MonoTime now) {
  const MonoTime deadline = pacer_.deadline();
  const Duration t = deadline - start_;
  if (dancer_->is_over(t)) {
    is_over_ = true;
    return {};
  }
  Pose pose;
  dancer_->dance_at(t, pose);
  pose.sequence = sequence_ + sent_++;
  pose.clock_id = this_clock_id();
  pose.capture_time = deadline;
  // Nobody can decode a dancer of unknown proportions: new ones go before the pose, repeated ones
  // after it.
  if (published_skeleton_ != &dancer_->skeleton()) publish_skeleton(now);
  sink_.capture(guest_, pose, now);

  Hands hands;
  if (dancer_->hands_at(t, hands)) {
    hands.sequence = pose.sequence;
    hands.clock_id = pose.clock_id;
    hands.capture_time = pose.capture_time;
    sink_.capture(guest_, hands);
  }
  if (now >= next_skeleton_) publish_skeleton(now);
  pacer_.advance(now);
  return pacer_.deadline();
}

}  // namespace dance
