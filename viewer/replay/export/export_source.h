// ExportSource: the scenes of a recording's range, one after the other, on a feed of its own.
//
// Units/frames: as viewer/replay/export/replay_export.h.
// Ownership:    owns board and feed.
// Threads:      none inside.
// Failure:      open() names the log.
#pragma once

#include "viewer/feed/stage_roster.h"
#include "viewer/replay/export/replay_export.h"
#include "viewer/replay/replay_feed.h"

namespace dance {

class ExportSource {
 public:
  static Result<std::unique_ptr<ExportSource>> open(const ExportWish& wish);

  // `scene` as it was at that moment.
  void show(MonoTime moment, SceneState& scene) {
    feed_->show(moment);
    roster_.update(moment, scene);
  }
  std::span<const StageRoster::Fresh> fresh() const { return roster_.fresh(); }

 private:
  explicit ExportSource(const ExportWish& wish)
      : board_(wish.index->clock_id, wish.stage_only), roster_(board_) {}

  GuestBoard board_;
  StageRoster roster_;
  std::optional<ReplayFeed> feed_;
};

Result<std::unique_ptr<ReplayExport>> begin_motion_export(const ExportWish& wish);
Result<std::unique_ptr<ReplayExport>> begin_picture_export(const ExportWish& wish,
                                                           ReplayExport::Paint paint);

}  // namespace dance
