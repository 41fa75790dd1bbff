// BeatPublisher: publishes the next beat on BEAT/local ten times a second and right after each
// beat, and detects other publishers in this house: dancers cannot follow two musics.
//
// Units/frames: as core/base/beat.h.
// Ownership:    refers to the bus and the poller, which must outlive it; the program drains the
//               bus.
// Threads:      none inside; runs in the poller's thread.
// Failure:      publishes nothing while no beat is known.
#pragma once

#include <array>
#include <functional>
#include <optional>

#include "core/base/beat.h"
#include "core/bus/signal_port.h"
#include "core/net/poller.h"

namespace dance {

constexpr const char* kAnotherPublisher =
    "another program publishes beats in this house: dancers receive both; end one of them "
    "(dance top shows the channels)";

class BeatPublisher {
 public:
  // The next beat as it is known now.
  using Source = std::function<std::optional<Beat>(MonoTime now)>;

  BeatPublisher(SignalPort& bus, Poller& poller, Source source);
  BeatPublisher(const BeatPublisher&) = delete;
  BeatPublisher& operator=(const BeatPublisher&) = delete;

  // At once, between two periods: the music has stopped, or the program ends.
  void publish(MonoTime now);
  // Another program has published a beat in the last seconds.
  bool has_other_publisher(MonoTime now) const;
  std::uint64_t published() const { return published_; }

 private:
  MonoTime work(MonoTime now);
  void on_beat_heard(const Beat& beat, MonoTime now);

  SignalPort& bus_;
  Source source_;
  // The last ones published: the bus delivers them to this program too.
  std::array<Beat, 64> own_{};
  std::uint64_t published_ = 0;
  MonoTime other_heard_;
};

}  // namespace dance
