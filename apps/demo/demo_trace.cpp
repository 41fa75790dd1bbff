#include "apps/demo/demo_trace.h"

#include "core/base/raw_twin.h"
#include "core/net/mono_clock.h"

namespace dance {
namespace {

// The newest kKept at least, and never more than twice as many.
template <class T>
void keep_newest(std::vector<T>& list, const T& next) {
  if (list.size() >= 2 * DemoTrace::kKept)
    list.erase(list.begin(), list.end() - static_cast<std::ptrdiff_t>(DemoTrace::kKept));
  list.push_back(next);
}

}  // namespace

DemoTrace::DemoTrace(SignalPort& bus_a, SignalPort& bus_b, const GuestId& here,
                     const GuestId& remote)
    : here_(here), remote_(remote), heard_(this_clock_id()) {
  bus_a.subscribe<Beat>(Where::kLocal,
                        [this](const Channel&, const Beat& beat, MonoTime) { heard_.hear(beat); });
  bus_a.subscribe<Pose>(
      {Where::kCapture, here_}, [this](const Channel&, const Pose& pose, MonoTime) {
        heard_.see(pose);
        keep(captured_here_, pose, pose.capture_time);
        const BeatClock& clock = heard_.clock();
        const MonoTime at = pose.capture_time;
        if (!is_over_ && clock.is_known(at))
          keep_newest(music_, TracedBeats{at, clock.position(at), clock.beats_per_second()});
      });
  bus_b.subscribe<Pose>({Where::kCapture, remote_},
                        [this](const Channel&, const Pose& pose, MonoTime) {
                          keep(danced_, pose, pose.capture_time);
                        });
  bus_a.subscribe<Pose>({Where::kStage, remote_},
                        [this](const Channel&, const Pose& pose, MonoTime) {
                          keep(shown_, pose, pose.stamped(Hop::kStaged));
                        });
  if (const auto twin = raw_twin_of(remote_))
    bus_a.subscribe<Pose>({Where::kStage, *twin},
                          [this](const Channel&, const Pose& pose, MonoTime) {
                            keep(raw_, pose, pose.stamped(Hop::kStaged));
                          });
  bus_a.subscribe<TimedSkeleton>({Where::kCapture, here_},
                                 [this](const Channel&, const TimedSkeleton& timed, MonoTime) {
                                   body_of_here_ = timed.skeleton;
                                 });
  bus_b.subscribe<TimedSkeleton>({Where::kCapture, remote_},
                                 [this](const Channel&, const TimedSkeleton& timed, MonoTime) {
                                   body_of_remote_ = timed.skeleton;
                                 });
}

void DemoTrace::keep(std::vector<TracedPose>& list, const Pose& pose, MonoTime at) {
  if (is_over_ || pose.clock_id != this_clock_id() || !at.is_set()) return;
  if (!list.empty() && at <= list.back().at) return;
  keep_newest(list, TracedPose{at, pose});
}

}  // namespace dance
