// A device and a sink of the tests, which note what came.
//
// Units/frames: times of this machine's clock.
// Ownership:    the notes are the test's.
// Threads:      none.
// Failure:      none.
#pragma once

#include <vector>

#include "haptics/haptic_maker.h"
#include "haptics/haptic_output.h"

namespace dance {

struct HapticNotes final : HapticSink {
  void on_haptic(const Haptic& haptic) override { felt.push_back(haptic); }
  std::vector<Haptic> felt;
};

struct DeviceNotes {
  std::vector<Haptic> played;
  std::vector<MonoTime> at;
  int stops = 0, works = 0;
  MonoTime wants;  // when work() is to be called next
  bool refuses = false, is_there = true;
  float limit = 1.0f;
  Duration latency;
};

class NotedOutput final : public HapticOutput {
 public:
  explicit NotedOutput(DeviceNotes& notes) : notes_(notes) {}
  bool play(const Haptic& haptic, MonoTime now) override {
    if (notes_.refuses || !notes_.is_there) return false;
    notes_.played.push_back(haptic);
    notes_.at.push_back(now);
    return true;
  }
  MonoTime work(MonoTime) override {
    ++notes_.works;
    return notes_.wants;
  }
  void stop() override { ++notes_.stops; }
  void set_limit(float limit) override { notes_.limit = limit; }
  bool is_there() const override { return notes_.is_there; }
  std::string name() const override { return "a device"; }
  Duration latency() const override { return notes_.latency; }
  std::string summary() const override { return "notes"; }

 private:
  DeviceNotes& notes_;
};

inline Haptic some_haptic(MonoTime play) {
  Haptic haptic;
  haptic.time = haptic.play_time = play;
  haptic.clock_id = 1;
  haptic.amplitude = 0.5f;
  haptic.bone = Bone::kLeftHand;
  haptic.frequency_hz = 170.0f;
  return haptic;
}

}  // namespace dance
