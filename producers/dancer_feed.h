// DancerFeed: dances a Dancer into a sink at a steady rate, by absolute deadlines: numbers and
// stamps the poses, and publishes the skeleton when it changes and once a second for late
// subscribers. For a dancer whose steps are shifted to the music it publishes Steps of weight 0
// then, as they give no evidence of the music's beat.
//
// Units/frames: `start` is the dance's own zero; it may lie in the past, so that a couple in two
//               processes, or a producer that was started again, dances on in step. The capture
//               time of a pose is its deadline, in this house's clock.
// Ownership:    owns the dancer; refers to the sink and the poller, which must outlive it.
// Threads:      none inside; runs in the poller's thread.
// Failure:      deadlines missed by more than a period are skipped and counted, not made up in a
//               burst.
#pragma once

#include <memory>

#include "core/base/pacer.h"
#include "core/net/poller.h"
#include "producers/capture_sink.h"
#include "producers/dancer.h"

namespace dance {

class DancerFeed {
 public:
  DancerFeed(std::unique_ptr<Dancer> dancer, const GuestId& guest, double hz, CaptureSink& sink,
             Poller& poller, MonoTime start);

  const GuestId& guest() const { return guest_; }
  std::uint32_t sent() const { return sent_; }
  std::uint64_t skipped() const { return pacer_.skipped(); }
  bool is_over() const { return is_over_; }

 private:
  MonoTime dance(MonoTime now);
  void publish_skeleton(MonoTime now);

  std::unique_ptr<Dancer> dancer_;
  GuestId guest_;
  CaptureSink& sink_;
  MonoTime start_;
  Pacer pacer_;
  MonoTime next_skeleton_;
  const Skeleton* published_skeleton_ = nullptr;
  std::uint32_t sequence_;
  std::uint32_t sent_ = 0;
  bool is_over_ = false;
};

}  // namespace dance
