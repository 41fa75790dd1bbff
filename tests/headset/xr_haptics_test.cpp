// The controllers of a headset as a device that is felt.
#include "headset/haptics/xr_haptics.h"

#include "tests/producers/xr/xr_world.h"
#include "tests/xr_loader_leaks.h"

namespace dance {
namespace {

class XrHapticsTest : public XrWorld {
 protected:
  static Haptic at(Bone bone) {
    Haptic haptic;
    haptic.bone = bone;
    haptic.amplitude = 0.8f;
    haptic.duration = Duration::ms(100);
    return haptic;
  }
};

TEST_F(XrHapticsTest, WhatIsForAnArmIsFeltInThatHandAndAllElseInBoth) {
  open_focused("");
  pump();
  XrHaptics haptics(*session_, *input_);
  EXPECT_TRUE(haptics.is_there());
  for (const Bone bone :
       {Bone::kLeftShoulder, Bone::kLeftUpperArm, Bone::kLeftLowerArm, Bone::kLeftHand})
    EXPECT_TRUE(haptics.play(at(bone), mono_now()));
  EXPECT_TRUE(has_recorded("haptic left 0.8000 100000000 0.00 ")) << record();
  EXPECT_FALSE(has_recorded("haptic right")) << record();
  EXPECT_TRUE(haptics.play(at(Bone::kRightHand), mono_now()));
  EXPECT_TRUE(has_recorded("haptic right")) << record();
  const auto count = [&](const std::string& words) {
    const std::string all = record();
    int times = 0;
    for (std::size_t from = 0; (from = all.find(words, from)) != std::string::npos; ++from) ++times;
    return times;
  };
  const int left = count("haptic left "), right = count("haptic right ");
  for (const Bone bone : {Bone::kHips, Bone::kHead, Bone::kRightToes})
    EXPECT_TRUE(haptics.play(at(bone), mono_now()));
  EXPECT_EQ(count("haptic left "), left + 3);
  EXPECT_EQ(count("haptic right "), right + 3);
  EXPECT_NE(haptics.summary().find("8 felt, 0 not taken"), std::string::npos) << haptics.summary();
  haptics.stop();
  EXPECT_TRUE(has_recorded("haptic_stop left") && has_recorded("haptic_stop right"));
}

TEST_F(XrHapticsTest, SidesOfTheEnvelopeMakeItWeaker) {
  open_focused("");
  pump();
  XrHaptics haptics(*session_, *input_);
  Haptic haptic = at(Bone::kLeftHand);
  haptic.attack = Duration::ms(20);
  haptic.release = Duration::ms(30);
  haptic.frequency_hz = 120.0f;
  EXPECT_TRUE(haptics.play(haptic, mono_now()));
  EXPECT_TRUE(has_recorded("haptic left 0.6000 100000000 120.00 ")) << record();
}

TEST_F(XrHapticsTest, WhatCannotBeFeltIsNotTaken) {
  open_focused("at 0.1 focus off\n");
  ASSERT_TRUE(pump_until([&] { return !session_->is_focused(); }));
  XrHaptics haptics(*session_, *input_);
  EXPECT_FALSE(haptics.is_there());
  EXPECT_FALSE(haptics.play(at(Bone::kHips), mono_now()));
  EXPECT_NE(haptics.summary().find("0 felt, 1 not taken"), std::string::npos);
}

}  // namespace
}  // namespace dance
