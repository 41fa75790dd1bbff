#include "core/control/voice_switch.h"

#include <gtest/gtest.h>

#include "core/net/mono_clock.h"

namespace dance {
namespace {

constexpr const char* kSwitchBus = "udpm://239.255.76.67:7754?ttl=0";

TEST(VoiceSwitch, DeliversOnAndOffAndIgnoresOtherLines) {
  const GuestId ann = *GuestId::parse("ann"), bob = *GuestId::parse("bob");
  auto poller = Poller::create();
  ASSERT_TRUE(poller);
  std::vector<bool> switched;
  auto control = open_voice_switch(
      kSwitchBus, ann, [&](bool is_on) { switched.push_back(is_on); }, **poller);
  ASSERT_TRUE(control) << control.error().what;
  EXPECT_TRUE(has_voice_switch(kSwitchBus, ann));
  EXPECT_FALSE(has_voice_switch(kSwitchBus, bob));
  EXPECT_FALSE(send_voice_switch(kSwitchBus, bob, true));
  ASSERT_TRUE(send_voice_switch(kSwitchBus, ann, true));
  for (const char* line : {"", "On", "on ", "off\n", "onoff", "\x01"})
    ASSERT_TRUE(send_to_program(control_path("voice-switch", kSwitchBus, ann), line));
  ASSERT_TRUE(send_voice_switch(kSwitchBus, ann, false));
  const MonoTime end = mono_now() + Duration::s(20);
  while (switched.size() < 2 && mono_now() < end) (*poller)->run_once(Duration::ms(20));
  EXPECT_EQ(switched, (std::vector<bool>{true, false}));
  control->reset();
  EXPECT_FALSE(has_voice_switch(kSwitchBus, ann));
}

}  // namespace
}  // namespace dance
