#include "producers/camera/check/camera_cause.h"

#include "tests/producers/camera/v4l2/shim_fixture.h"

namespace dance {
namespace {

class CameraCauses : public CameraTest {};

TEST_F(CameraCauses, TellApartWhatADancerMends) {
  shim_->set_up("modes=YUYV:64x48@30 busy=1");
  EXPECT_EQ(cause_of_failure(kPath), CameraCause::kInUse);
  EXPECT_EQ(cause_of_failure(""), CameraCause::kInUse);
  shim_->set_up("modes=YUYV:64x48@30 denied=1");
  EXPECT_EQ(cause_of_failure(kPath), CameraCause::kNoPermission);
  EXPECT_EQ(cause_of_failure(""), CameraCause::kNoPermission);
  shim_->set_up("modes=YUYV:64x48@30 absent=1");
  EXPECT_EQ(cause_of_failure(kPath), CameraCause::kAbsent);
  shim_->set_up("modes=YUYV:64x48@30");
  EXPECT_EQ(cause_of_failure("/dev/video63"), CameraCause::kAbsent);
  EXPECT_EQ(cause_of_failure("elgato"), CameraCause::kAbsent);
  EXPECT_EQ(cause_of_failure("/dev/null"), CameraCause::kOther);
}

}  // namespace
}  // namespace dance
