// A face that is captured in one house is heard in the other.
#include "core/codec/face_codec.h"
#include "tests/tunnel/removal/two_houses.h"

namespace dance {
namespace {

class FaceBus : public RemovalHouses {
 protected:
  void SetUp() override {
    RemovalHouses::SetUp();
    if (HasFatalFailure()) return;
    host_->viewer->subscribe<Face>(Where::kGuest,
                                   [this](const Channel& channel, const Face& face, MonoTime) {
                                     heard_.emplace_back(channel.guest(), face);
                                   });
    poller_->add_timer(mono_now(), [this](MonoTime now) {
      if (is_sending_) {
        face_.sequence++;
        face_.capture_time = now;
        bob_->port->publish(Channel::of(Signal::kFace, Where::kCapture, named("bob")), face_);
      }
      return now + Duration::ms(30);
    });
  }
  static Face smiling() {
    Face face;
    face.presence = kFaceSeen;
    face[Expression::kMouthSmileLeft] = 0.8f;
    face[Expression::kMouthSmileRight] = 0.7f;
    face[Expression::kJawOpen] = 0.25f;
    face.R_PB = Eigen::AngleAxisf(0.4f, Eigen::Vector3f::UnitY());
    face.clock_id = this_clock_id();
    return face;
  }

  Face face_ = smiling();
  bool is_sending_ = false;
  std::vector<std::pair<GuestId, Face>> heard_;
};

TEST_F(FaceBus, IsHeardInTheOtherHouseAsItWasCaptured) {
  is_sending_ = true;
  ASSERT_TRUE(turn_until([&] { return heard_.size() >= 5; }));
  const auto& [guest, face] = heard_.back();
  EXPECT_EQ(guest, named("bob"));
  EXPECT_EQ(face.presence, kFaceSeen);
  for (std::size_t i = 0; i < kExpressionCount; ++i)
    EXPECT_NEAR(face.weight[i], face_.weight[i], kFaceWeightError + 1e-5f) << kExpressionNames[i];
  EXPECT_LT(57.3f * face.R_PB.angularDistance(face_.R_PB), kFaceHeadError_deg);
  EXPECT_EQ(face.clock_id, this_clock_id());
  EXPECT_EQ(face.sequence, heard_.size());
  // No raw message of the channel that they travel in comes onto a bus.
  EXPECT_EQ(host_->link->core().counters().channels_invalid, 0u);
}

TEST_F(FaceBus, NothingIsSentWhereNoFaceIsCaptured) {
  const MonoTime end = mono_now() + Duration::ms(500);
  while (mono_now() < end) poller_->run_once(Duration::ms(5));
  EXPECT_TRUE(heard_.empty());
  EXPECT_EQ(bob_->link->core().counters().channels_sent, 0u);
}

}  // namespace
}  // namespace dance
