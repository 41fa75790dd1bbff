#include "producers/receive/one_sender.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

using Verdict = OneSender::Verdict;

const Address kFirst = Address::loopback(5000);
const Address kSecond = Address::loopback(5001);

MonoTime sender_time(std::int64_t ms) { return MonoTime::from_us(7'000'000) + Duration::ms(ms); }

TEST(OneSender, ReadsAnyoneUntilAPacketMadeAPose) {
  OneSender sender;
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(sender.admit(kSecond, sender_time(i)), Verdict::kRead);
    EXPECT_EQ(sender.admit(kFirst, sender_time(i)), Verdict::kRead);
  }
  EXPECT_FALSE(sender.is_kept());
  sender.keep(kFirst, sender_time(10));
  EXPECT_EQ(sender.admit(kSecond, sender_time(11)), Verdict::kOther);
  EXPECT_EQ(sender.admit(kFirst, sender_time(12)), Verdict::kRead);
  EXPECT_EQ(sender.others(), 1u);
}

TEST(OneSender, IsReleasedOnceWhenItIsSilent) {
  OneSender sender;
  sender.keep(kFirst, sender_time(0));
  EXPECT_EQ(sender.admit(kFirst, sender_time(1500)), Verdict::kRead);
  EXPECT_EQ(sender.admit(kSecond, sender_time(3499)), Verdict::kOther);
  EXPECT_EQ(sender.admit(kSecond, sender_time(3500)), Verdict::kReadAnew);
  EXPECT_FALSE(sender.is_kept());
  EXPECT_EQ(sender.admit(kSecond, sender_time(3501)), Verdict::kRead);
  EXPECT_EQ(sender.admit(kFirst, sender_time(3502)), Verdict::kRead);
}

TEST(OneSender, TheSameAfterAPauseIsRead) {
  OneSender sender;
  sender.keep(kFirst, sender_time(0));
  EXPECT_EQ(sender.admit(kFirst, sender_time(60'000)), Verdict::kRead);
  EXPECT_EQ(sender.admit(kSecond, sender_time(60'001)), Verdict::kOther);
}

}  // namespace
}  // namespace dance
