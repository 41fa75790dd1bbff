// OscHaptics: what is to be felt as messages of Open Sound Control, for vests, gloves and programs
// of others: /dance/haptic/<bone> with amplitude, seconds and hertz as it begins, and the level as
// /avatar/parameters/dance_<bone>, 0 at the end.
//
// Units/frames: amplitude 0 to 1; bones by their names of VRM 1.0.
// Ownership:    owns its socket; never allocates once that is open.
// Threads:      sends in the call. Of later() one, named haptics-osc, until the address is found,
//               as looking a name up may take seconds; the end may wait for it.
// Failure:      open() names an address that is none; later() looks for it each kLooks. What
//               cannot be sent is counted.
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "consumers/osc/osc_output.h"
#include "core/base/result.h"
#include "haptics/haptic_output.h"

namespace dance {

class OscHaptics final : public HapticOutput {
 public:
  static constexpr const char* kUsualAddress = "127.0.0.1:9001";
  static constexpr Duration kLooks = Duration::s(3);

  static Result<std::unique_ptr<HapticOutput>> open(const std::string& address);
  // To an address that cannot be had now, as of a name that is not known yet.
  static std::unique_ptr<HapticOutput> later(const std::string& address);
  ~OscHaptics() override;

  bool play(const Haptic& haptic, MonoTime now) override;
  MonoTime work(MonoTime now) override;
  void stop() override;
  bool is_there() const override { return way_ != nullptr; }
  std::string name() const override;
  std::string summary() const override;

 private:
  struct Way {
    explicit Way(OscOutput opened) : output(std::move(opened)), writer(output) {}
    OscOutput output;
    OscBundleWriter writer;
  };
  explicit OscHaptics(const std::string& address) : address_(address) {}
  void send_level(std::size_t bone, float level);
  void search();

  std::string address_;
  std::unique_ptr<Way> way_;  // null: still searched
  // The thread's, until it has found it.
  std::unique_ptr<Way> found_way_;
  std::atomic<bool> found_{false};
  std::mutex mutex_;
  std::condition_variable ended_;
  bool ends_search_ = false;
  std::thread search_;
  std::array<MonoTime, kBoneCount> ends_{};  // not set: nothing is felt there
};

}  // namespace dance
