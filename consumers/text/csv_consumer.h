// CsvConsumer: a wide table, one row for each pose: for spreadsheets and notebooks. The first row
// names the columns and their units.
//
// Units/frames: capture_us and heard_us in microseconds, the former of the clock clock_id; hips in
//               metres in W; each bone's rotation in its parent as unit quaternion x, y, z, w; then
//               each bone's place and the ends of the body, metres in W, of the guest's skeleton,
//               and of an average body until that is heard. An empty music_beats is no music.
// Ownership:    keeps its output, and the skeletons of kMostGuests guests.
// Threads:      none inside; one owner.
// Failure:      finish() tells what could not be written.
#pragma once

#include "consumers/output_file.h"
#include "consumers/pose_consumer.h"
#include "consumers/rate_limit.h"
#include "consumers/text/line_builder.h"
#include "core/base/fixed_list.h"

namespace dance {

class CsvConsumer : public PoseConsumer {
 public:
  static constexpr std::size_t kMostGuests = 64;

  // At most hz rows a second for each guest; 0 = all.
  CsvConsumer(std::shared_ptr<OutputFile> output, double hz);

  void on_pose(const GuestId& guest, const Pose& pose, MonoTime now) override;
  void on_skeleton(const GuestId& guest, const Skeleton& skeleton, MonoTime now) override;
  Result<void> flush() override { return output_->flush(); }
  Result<void> finish() override { return output_->flush(); }
  std::string summary() const override;

 private:
  struct Body {
    GuestId guest;
    Skeleton skeleton;
  };
  const Skeleton& skeleton_of(const GuestId& guest) const;
  void add_places(const GuestId& guest, const Pose& pose);

  std::shared_ptr<OutputFile> output_;
  RateLimit limit_;
  LineBuilder line_;
  FixedList<Body, kMostGuests> bodies_;
  Skeleton average_ = average_skeleton();
  std::uint64_t heard_ = 0;
  std::uint64_t written_ = 0;
};

}  // namespace dance
