// PictureSource: the source of scenes to draw: a live house, in real time, or a recorded one
// (viewer/replay/replay_source.h).
//
// Units/frames: moments in the house's clock.
// Ownership:    owns its feed.
// Threads:      one owner, the drawing thread.
// Failure:      open() names the bus or the log.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "viewer/dance_panel/dance_board.h"
#include "viewer/feed/guest_board.h"
#include "viewer/feed/stage_roster.h"
#include "viewer/instruments/instrument_board.h"
#include "viewer/practice/step_score_board.h"
#include "viewer/program/view_options.h"

namespace dance {

class ReplaySource;

class PictureSource {
 public:
  static Result<std::unique_ptr<PictureSource>> open(const ViewOptions& options);
  virtual ~PictureSource() = default;

  virtual GuestBoard& board() = 0;
  virtual InstrumentBoard& instruments() = 0;
  // Of a live house; nullptr of a recorded one.
  virtual DanceBoard* dance() { return nullptr; }
  // The same.
  virtual StepScoreBoard* step_scores() { return nullptr; }
  virtual MonoTime begin() const = 0;
  // Waits until that moment or a request to end; returns the present time.
  virtual MonoTime wait_until(MonoTime moment) = 0;
  // Of a beat of the house's music; nullopt where it is not known yet.
  virtual std::optional<MonoTime> time_of_beat(double) const { return std::nullopt; }
  // Reports the poses that the last picture showed first, and when it was on the screen.
  virtual void report_shown(std::span<const StageRoster::Fresh>, MonoTime) {}
  // This source where it is a recording; else nullptr.
  virtual ReplaySource* replay() { return nullptr; }
  // Length of a recording; 0 of a live house.
  virtual Duration recorded() const { return Duration(); }
  virtual bool is_over() const = 0;
  virtual const std::string& name() const = 0;  // for people
};

}  // namespace dance
