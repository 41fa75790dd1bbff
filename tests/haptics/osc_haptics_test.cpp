#include "haptics/osc/osc_haptics.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "core/net/udp_socket.h"
#include "formats/osc/osc_reader.h"
#include "tests/haptics/haptic_notes.h"

namespace dance {
namespace {

struct OscNotes final : OscMessageSink {
  void on_message(const OscMessage& message) override {
    ++messages;
    first[std::string(message.address)] = message.arguments[0].real;
  }
  int messages = 0;
  std::map<std::string, float> first;  // the first value of each address, as it came last
};

void hear(UdpSocket& ear, OscNotes& notes, int messages) {
  OscReader reader;
  for (int i = 0; i < 2000 && notes.messages < messages; ++i) {
    for (const auto& datagram : ear.receive()) EXPECT_TRUE(reader.read(datagram.bytes, notes));
    if (notes.messages < messages) usleep(1000);
  }
}

TEST(OscHaptics, SaysWhatIsFeltAndThatItEnds) {
  auto ear = UdpSocket::bind(Address::loopback(0));
  ASSERT_TRUE(ear);
  auto output = OscHaptics::open(ear->local_address().to_string());
  ASSERT_TRUE(output) << output.error().what;
  const MonoTime now = MonoTime::from_us(1'000'000);
  Haptic haptic = some_haptic(now);
  EXPECT_TRUE((*output)->play(haptic, now));
  OscNotes notes;
  hear(*ear, notes, 2);
  EXPECT_FLOAT_EQ(notes.first["/dance/haptic/leftHand"], 0.5f);
  EXPECT_FLOAT_EQ(notes.first["/avatar/parameters/dance_leftHand"], 0.5f);
  // It asks to be called when that is over, and then says so once.
  EXPECT_EQ((*output)->work(now + Duration::ms(10)), now + haptic.duration);
  EXPECT_FALSE((*output)->work(now + haptic.duration).is_set());
  hear(*ear, notes, 3);
  EXPECT_EQ(notes.messages, 3);
  EXPECT_EQ(notes.first["/avatar/parameters/dance_leftHand"], 0.0f);
  haptic.bone = Bone::kHead;
  EXPECT_TRUE((*output)->play(haptic, now));
  (*output)->stop();
  hear(*ear, notes, 6);
  EXPECT_EQ(notes.first["/avatar/parameters/dance_head"], 0.0f);
}

TEST(OscHaptics, OneThatIsLookedForIsFoundAndPlays) {
  auto ear = UdpSocket::bind(Address::loopback(0));
  ASSERT_TRUE(ear);
  const auto output = OscHaptics::later(ear->local_address().to_string());
  for (int i = 0; i < 5000 && !output->is_there(); ++i) {
    output->work(MonoTime::from_us(1'000'000));
    usleep(1000);
  }
  ASSERT_TRUE(output->is_there());
  const MonoTime now = MonoTime::from_us(1'000'000);
  EXPECT_TRUE(output->play(some_haptic(now), now));
  OscNotes notes;
  hear(*ear, notes, 2);
  EXPECT_FLOAT_EQ(notes.first["/dance/haptic/leftHand"], 0.5f);
}

TEST(OscHaptics, OneThatIsNotFoundTakesNothingSaysSoAndEnds) {
  const auto output = OscHaptics::later("an address that is none:x");
  output->work(MonoTime::from_us(1'000'000));
  output->stop();
  EXPECT_FALSE(output->play(some_haptic(MonoTime()), MonoTime()));
  EXPECT_EQ(output->summary(), "osc to an address that is none:x, not found yet");
}

}  // namespace
}  // namespace dance
