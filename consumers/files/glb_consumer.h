// GlbConsumer: what all guests dance as one GLB, at a steady frame rate: the figures and their
// animation, for Blender, web pages and engines. A GLB begins with its sizes, so the dance is kept
// in memory and written at the end.
//
// Units/frames: see formats/recording/clips_together.h and formats/gltf/glb.h.
// Ownership:    keeps its output, and at most kMostPoses poses and as many hands (about 400 MB).
// Threads:      none inside; one owner.
// Failure:      finish() says when no pose was heard or writing failed. What is left out is
//               counted.
#pragma once

#include "consumers/output_file.h"
#include "consumers/pose_consumer.h"
#include "formats/recording/recording.h"

namespace dance {

class GlbConsumer : public PoseConsumer {
 public:
  static constexpr std::size_t kMostGuests = 32;
  static constexpr std::size_t kMostPoses = 2 * 60 * 3600;  // a couple's hour

  // All guests, or the one that is set.
  GlbConsumer(std::shared_ptr<OutputFile> output, double hz, const GuestId& guest,
              std::size_t most_poses = kMostPoses);

  void on_pose(const GuestId& guest, const Pose& pose, MonoTime now) override;
  void on_skeleton(const GuestId& guest, const Skeleton& skeleton, MonoTime now) override;
  void on_hands(const GuestId& guest, const Hands& hands, MonoTime now) override;
  Result<void> finish() override;
  std::uint64_t left_out() const override { return left_out_; }  // known when it is finished
  std::string summary() const override;

 private:
  bool is_wanted(const GuestId& guest) const { return !only_.is_set() || guest == only_; }

  std::shared_ptr<OutputFile> output_;
  double hz_;
  GuestId only_;
  Recording recording_;
  bool is_finished_ = false;
  std::uint64_t left_out_ = 0;
  std::string written_;
};

}  // namespace dance
