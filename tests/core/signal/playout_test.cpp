#include "core/signal/playout.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

Playout known(PlayoutReason reason, float beats) {
  Playout playout;
  playout.reason = reason;
  playout.beats = beats;
  playout.delay_ms = 187.4f;
  playout.error_mm = 73.6f;
  playout.limit_mm = 60.0f;
  return playout;
}

TEST(Playout, SaysInOneLineWhatIsShownAndWhy) {
  EXPECT_EQ(playout_text(known(PlayoutReason::kTooFar, 1.0f)),
            "1 beat behind: predictions as far ahead as poses are late are 74 mm off, 60 are "
            "allowed");
  EXPECT_EQ(playout_text(known(PlayoutReason::kGoodEnough, 0.02f)),
            "now: predictions as far ahead as poses are late are 74 mm off, 60 are allowed");
  EXPECT_EQ(playout_text(known(PlayoutReason::kAsked, 2.0f)), "2 beats behind, as asked");
  EXPECT_EQ(playout_text(known(PlayoutReason::kAsked, 1.44f)), "1.4 beats behind, as asked");
  EXPECT_EQ(playout_text(known(PlayoutReason::kMusicMissing, Playout::kNotKnown)),
            "187 ms late: no music is heard here");
  EXPECT_EQ(playout_text(known(PlayoutReason::kNoRhythm, Playout::kNotKnown)), "187 ms late");
  EXPECT_EQ(playout_text(Playout()), "? ms late");
}

TEST(Playout, NamesThePartner) {
  Playout playout = known(PlayoutReason::kAsked, 0.0f);
  playout.partner = *GuestId::parse("alice");
  EXPECT_EQ(playout_text(playout), "now, as asked; beside alice");
}

}  // namespace
}  // namespace dance
