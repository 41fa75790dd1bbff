// WindowExport: an export that a window writes while it goes on showing: a part of it with each
// picture.
//
// Units/frames: as viewer/replay/export/replay_export.h.
// Ownership:    owns the export that runs; borrows source, view and avatars.
// Threads:      the drawing thread.
// Failure:      note() says what went wrong, and the cure.
#pragma once

#include <memory>
#include <string>

#include "viewer/program/export_painter.h"
#include "viewer/replay/export/replay_export.h"
#include "viewer/replay/timeline/timeline_panel.h"

namespace dance {

class WindowExport {
 public:
  WindowExport(const ViewOptions& options, PictureSource& source, const ViewDirector& view,
               AvatarLibrary& avatars)
      : options_(options), source_(source), view_(view), avatars_(avatars) {}

  // For the timeline; nothing of a live house.
  TimelinePanel::Exporting for_timeline();
  bool is_running() const { return work_ != nullptr; }
  // What became of it.
  std::string cancel();
  // The present picture's size and whether hands leave trails in it, and a part of the work, drawn
  // by that painter.
  void step(ViewPictureSize size, bool trails, StagePainter& painter);

 private:
  void start(ExportKind kind);
  std::string note() const;

  const ViewOptions& options_;
  PictureSource& source_;
  const ViewDirector& view_;
  AvatarLibrary& avatars_;
  std::unique_ptr<ReplayExport> work_;
  std::unique_ptr<ExportPainter> pictures_;
  StagePainter* painter_ = nullptr;  // during step()
  ViewPictureSize size_;
  bool trails_ = false;
  std::string said_;
};

}  // namespace dance
