// Real takes, from beside the tree or from Debian's assimp-testmodels; skipped where neither is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "core/pose/kinematics.h"
#include "formats/bvh/bvh_motion.h"
#include "formats/bvh/clip_file.h"

namespace dance {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3f;

std::string take(const std::string& name) {
  return DANCE_SOURCE_DIR "/../shared/data/mocap/" + name + ".bvh.xz";
}

std::vector<std::string> real_takes() {
  std::vector<std::string> found;
  for (const char* directory :
       {DANCE_SOURCE_DIR "/../shared/data/mocap", "/usr/share/assimp/models/BVH"}) {
    std::error_code missing;
    for (const auto& entry : fs::directory_iterator(directory, missing)) {
      const std::string path = entry.path().string();
      if (path.ends_with(".bvh") || path.ends_with(".bvh.xz")) found.push_back(path);
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

struct Take {
  Bvh bvh;
  Retargeted result;
};
Result<Take> load(const std::string& path) {
  DANCE_TRY(const std::string text, read_clip_text(path));
  DANCE_TRY(Bvh bvh, read_bvh(text));
  DANCE_TRY(Retargeted result, retarget(bvh));
  return Take{std::move(bvh), std::move(result)};
}

float lowest_of(const BodyFrames& body) {
  return std::min({body.position(Bone::kLeftFoot).y(), body.position(Bone::kRightFoot).y(),
                   body.tip(Tip::kLeftToes).y(), body.tip(Tip::kRightToes).y()});
}

#define SKIP_WITHOUT(path) \
  if (!fs::exists(path)) GTEST_SKIP() << (path) << " is missing: no real takes beside this tree"

// Measured: 0.00 mm over all salsa takes, at most 0.3 mm in the mean and 22 mm at the head where
// CMU's two neck joints are our one.
TEST(RealTakes, KeepEveryJointWhereTheFileHasIt) {
  const auto takes = real_takes();
  if (takes.empty())
    GTEST_SKIP() << "no real takes: neither beside this tree nor assimp-testmodels";
  for (const std::string& path : takes) {
    SCOPED_TRACE(path);
    const auto take = load(path);
    ASSERT_TRUE(take.has_value()) << take.error().what;
    const BvhMotion motion(take->bvh);
    BvhFigure figure;
    BodyFrames body;
    double sum_m = 0.0;
    double most_m = 0.0;
    std::size_t count = 0;
    for (std::size_t f = 0; f < take->bvh.frame_count; f += 7) {
      motion.figure_at(f, figure);
      forward_kinematics(take->result.clip.skeleton, take->result.clip.frames[f], body);
      const auto place = [&](std::size_t b) {
        const auto joint = static_cast<std::size_t>(take->result.rig.joint_of[b]);
        return Vector3f((take->result.metres_per_unit * figure.p_FJ[joint]).cast<float>());
      };
      const Vector3f floor = body.p_WB_m[0] - place(0);
      EXPECT_NEAR(floor.x(), 0.0f, 1e-5f);
      EXPECT_NEAR(floor.z(), 0.0f, 1e-5f);
      for (std::size_t b = 1; b < kBoneCount; ++b) {
        if (take->result.rig.joint_of[b] == kNoJoint) continue;
        const double error_m = static_cast<double>((body.p_WB_m[b] - floor - place(b)).norm());
        sum_m += error_m;
        most_m = std::max(most_m, error_m);
        ++count;
      }
    }
    EXPECT_LT(sum_m / static_cast<double>(count), 0.0005);
    EXPECT_LT(most_m, 0.025);
  }
}

TEST(RealTakes, AreHumansOnTheFloor) {
  const auto takes = real_takes();
  if (takes.empty())
    GTEST_SKIP() << "no real takes: neither beside this tree nor assimp-testmodels";
  for (const std::string& path : takes) {
    SCOPED_TRACE(path);
    const auto take = load(path);
    ASSERT_TRUE(take.has_value()) << take.error().what;
    const MotionClip& clip = take->result.clip;
    EXPECT_GT(standing_height_m(clip.skeleton), 1.4f);
    EXPECT_LT(standing_height_m(clip.skeleton), 2.0f);
    std::vector<float> lows;
    double knee_rad = 0.0;
    BodyFrames body;
    for (const Pose& pose : clip.frames) {
      ASSERT_TRUE(is_valid(pose));
      forward_kinematics(clip.skeleton, pose, body);
      lows.push_back(lowest_of(body));
      // The shin's direction in the thigh: backwards is −Z.
      const Vector3f shin = pose.R_PB[index_of(Bone::kLeftLowerLeg)] * -Vector3f::UnitY();
      knee_rad += std::atan2(static_cast<double>(-shin.z()), static_cast<double>(-shin.y()));
    }
    EXPECT_GT(knee_rad / static_cast<double>(clip.frames.size()), 0.1) << "knees bend backwards";
    std::sort(lows.begin(), lows.end());
    EXPECT_NEAR(lows[lows.size() / 2], 0.0f, 0.06f);
    EXPECT_GT(lows[lows.size() / 100], -0.08f);
  }
}

TEST(RealTakes, CouplesFaceEachOther) {
  SKIP_WITHOUT(take("cmu_60_01_salsa"));
  for (const std::string number : {"01", "03", "05", "07", "10", "12", "14"}) {
    const auto lead = load_clip(take("cmu_60_" + number + "_salsa"));
    const auto follow = load_clip(take("cmu_61_" + number + "_salsa"));
    ASSERT_TRUE(lead.has_value()) << lead.error().what;
    ASSERT_TRUE(follow.has_value()) << follow.error().what;
    ASSERT_EQ(lead->clip.frames.size(), follow->clip.frames.size());
    double facing = 0.0;
    double apart_m = 0.0;
    for (std::size_t f = 0; f < lead->clip.frames.size(); ++f) {
      const Pose& a = lead->clip.frames[f];
      const Pose& b = follow->clip.frames[f];
      Vector3f between = b.p_WH_m - a.p_WH_m;
      between.y() = 0.0f;
      apart_m += static_cast<double>(between.norm());
      facing += static_cast<double>((a.R_PB[0] * Vector3f::UnitZ()).dot(between.normalized()));
    }
    const auto count = static_cast<double>(lead->clip.frames.size());
    EXPECT_GT(facing / count, 0.5) << "take " << number << ": the lead looks at the follow";
    EXPECT_GT(apart_m / count, 0.4) << "take " << number;
    EXPECT_LT(apart_m / count, 1.5) << "take " << number;
  }
}

TEST(RealTakes, KeepTheirPlacesThroughTheWriter) {
  SKIP_WITHOUT(take("cmu_61_03_salsa"));
  const auto first = load_clip(take("cmu_61_03_salsa"));
  ASSERT_TRUE(first.has_value()) << first.error().what;
  const auto bvh = read_bvh(write_bvh(first->clip));
  ASSERT_TRUE(bvh.has_value()) << bvh.error().what;
  const auto second = retarget(*bvh);
  ASSERT_TRUE(second.has_value()) << second.error().what;
  ASSERT_EQ(first->clip.frames.size(), second->clip.frames.size());
  EXPECT_DOUBLE_EQ(first->clip.frame_hz, second->clip.frame_hz);
  BodyFrames a;
  BodyFrames b;
  for (std::size_t f = 0; f < first->clip.frames.size(); f += 11) {
    forward_kinematics(first->clip.skeleton, first->clip.frames[f], a);
    forward_kinematics(second->clip.skeleton, second->clip.frames[f], b);
    for (std::size_t bone = 0; bone < kBoneCount; ++bone)
      ASSERT_LT((a.p_WB_m[bone] - b.p_WB_m[bone]).norm(), 1e-4f) << kBones[bone].name;
  }
}

}  // namespace
}  // namespace dance
