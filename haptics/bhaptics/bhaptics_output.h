// BhapticsOutput: a bHaptics suit, through the bHaptics Player's WebSocket on this machine or
// another. Orders go through a ring to the thread that libwebsockets runs in, which writes them as
// they come.
//
// Units/frames: as haptics/bhaptics/bhaptics_frame.h.
// Ownership:    owns its thread and connection; 64 orders may wait for it, the oldest give way.
// Threads:      one, named haptics-ws; play() waits for nothing.
// Failure:      open() names an address that is none, and, after kAnswers at most, one where no
//               player is; of later() it is looked for once a second, as is one that ends. Of a
//               name with several addresses each is tried, with its part of kAnswers. Orders
//               that find no connection are refused, those that a stall has made late are left
//               out; both are counted.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/net/address.h"
#include "haptics/haptic_output.h"

namespace dance {

class BhapticsOutput final : public HapticOutput {
 public:
  static constexpr const char* kUsualAddress = "127.0.0.1:15881";
  static constexpr Duration kAnswers = Duration::s(2);
  static constexpr const char* kPath = "/v2/feedbacks?app_id=dancegraph&app_name=DanceGraph";

  // The places of a player, in the order in which they are to be tried; may take seconds.
  using LookUp = std::function<Result<std::vector<Address>>()>;

  static Result<std::unique_ptr<HapticOutput>> open(const std::string& address);
  static Result<std::unique_ptr<HapticOutput>> open(const std::string& address,
                                                    const LookUp& look_up);
  // One that may not be there yet; null where the library cannot be started.
  static std::unique_ptr<HapticOutput> later(const std::string& address);
  ~BhapticsOutput() override;

  bool play(const Haptic& haptic, MonoTime now) override;
  void stop() override;
  bool is_there() const override;
  std::string name() const override;
  std::string summary() const override;

 private:
  struct Impl;
  static std::unique_ptr<BhapticsOutput> start(const std::string& address, LookUp look_up);
  explicit BhapticsOutput(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace dance
