// EvdevOutput: a gamepad or another device of the kernel's force feedback. An effect is uploaded
// and started in the call that brings it; the kernel ends it.
//
// Units/frames: below kLowMotor_hz the heavy motor turns, above the light one.
// Ownership:    owns the device file. kSlots effects at a time, the oldest gives way; never
//               allocates in play(). In sum they keep to the limit: the stronger one goes on.
// Threads:      none inside. Writes never wait: the file is non-blocking.
// Failure:      open() names the device and the cure. One that is pulled out is looked for again
//               each kLooks, under the same name; so is one of later().
#pragma once

#include <array>
#include <memory>
#include <string>

#include "core/base/result.h"
#include "haptics/haptic_output.h"

namespace dance {

// What the output asks of the kernel, so that tests can stand in for it.
class ForceFeedbackFile {
 public:
  virtual ~ForceFeedbackFile() = default;
  // -1 with errno, as the kernel's calls.
  virtual int upload(void* ff_effect) = 0;
  virtual int remove(int id) = 0;
  virtual int write_event(int code, int value) = 0;  // of type EV_FF
  virtual bool is_there() = 0;
};

class EvdevOutput final : public HapticOutput {
 public:
  static constexpr float kLowMotor_hz = 100.0f;
  static constexpr std::size_t kSlots = 4;
  static constexpr Duration kLooks = Duration::s(3);

  // `device`: a path (or a link to one, as those in /dev/input/by-id, which stay the same when it
  // is plugged in again), a part of a name, or "" = the first that rumbles.
  static Result<std::unique_ptr<HapticOutput>> open(const std::string& device);
  // One that is not there yet.
  static std::unique_ptr<HapticOutput> later(const std::string& device);
  // For tests: a device that is open.
  EvdevOutput(std::string name, std::unique_ptr<ForceFeedbackFile> file, bool rumbles, int effects);
  ~EvdevOutput() override;

  bool play(const Haptic& haptic, MonoTime now) override;
  MonoTime work(MonoTime now) override;
  void set_limit(float limit) override { limit_ = limit; }
  void stop() override;
  bool is_there() const override { return file_ != nullptr; }
  std::string name() const override { return name_; }
  std::string summary() const override;

 private:
  struct Slot {
    int id = -1;
    MonoTime until;
    float level = 0.0f;
  };
  void lose();
  static std::unique_ptr<EvdevOutput> not_there_yet(const std::string& device);
  // Opens the first device that is wanted and can be had; its name.
  Result<std::string> find();
  // How strong an effect may be beside what runs in the other slots; 0 = those are enough.
  float make_room(const Slot& slot, float level, MonoTime now);

  std::string wanted_, name_;
  std::unique_ptr<ForceFeedbackFile> file_;  // null: pulled out
  bool rumbles_ = true, looks_ = false;
  float limit_ = 1.0f;
  MonoTime looked_;
  std::size_t slot_count_ = kSlots;
  std::array<Slot, kSlots> slots_{};
  std::uint64_t lost_ = 0;
};

}  // namespace dance
