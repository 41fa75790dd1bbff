// BeatTeller: says on BEAT/local where the music stands, ten times a second and right after each
// beat, and notices who else says so in this house: two musics would pull every dancer to and fro.
//
// Units/frames: as core/base/beat.h.
// Ownership:    refers to the bus and the poller, which must outlive it; the program drains the
//               bus.
// Threads:      none inside; runs in the poller's thread.
// Failure:      says nothing while nothing is known.
#pragma once

#include <array>
#include <functional>
#include <optional>

#include "core/base/beat.h"
#include "core/bus/bus.h"
#include "core/net/poller.h"

namespace dance {

constexpr const char* kAnotherSaysTheBeat =
    "another program says the beat in this house: dancers hear both; end one of them (dance top "
    "shows the channels)";

class BeatTeller {
 public:
  // The next beat as it is known now.
  using Source = std::function<std::optional<Beat>(MonoTime now)>;

  BeatTeller(Bus& bus, Poller& poller, Source source);
  BeatTeller(const BeatTeller&) = delete;
  BeatTeller& operator=(const BeatTeller&) = delete;

  // Says it at once, out of turn: the music has stopped, or the program ends.
  void tell(MonoTime now);
  // Somebody else has said a beat in the last seconds.
  bool hears_another(MonoTime now) const;
  std::uint64_t told() const { return told_; }

 private:
  MonoTime work(MonoTime now);
  void hear(const Beat& beat, MonoTime now);

  Bus& bus_;
  Source source_;
  // What was said last, as our own comes back from the bus.
  std::array<Beat, 64> own_{};
  std::uint64_t told_ = 0;
  MonoTime heard_another_;
};

}  // namespace dance
