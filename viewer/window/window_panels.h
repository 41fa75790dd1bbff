// The panels of the window: the one place that names them.
//
// Ownership: the stack owns what is added.
// Threads:   the drawing thread.
// Failure:   add_panels() names the session file that cannot be read.
#pragma once

#include <functional>
#include <string>

#include "viewer/dance_panel/banner_watch.h"
#include "viewer/dance_panel/dance_wishes.h"
#include "viewer/feed/picture_source.h"
#include "viewer/instruments/instrument_records.h"
#include "viewer/panel/panel_stack.h"
#include "viewer/replay/timeline/timeline_panel.h"

namespace dance {

// What panels may work with; it outlives them.
struct PanelNeeds {
  const ViewOptions& options;
  PictureSource& source;
  InstrumentRecords& records;
  TimelinePanel::Exporting exporting;  // of a recording
  DanceWishes& wishes;
  const BannerWatch::Drawing& drawing;
  TeacherChoices* teacher = nullptr;  // null: there is none
  std::function<std::string()> teacher_note = {};
};

// The first hears keys first; the last is drawn in front.
Result<void> add_panels(const PanelNeeds& needs, PanelStack& panels);

}  // namespace dance
