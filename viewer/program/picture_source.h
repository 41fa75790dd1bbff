// PictureSource: what pictures are drawn of: a live house, whose moments have to be waited for, or
// a recorded one, which is at any moment at once, and in a window begins again at its end.
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

#include "viewer/program/guest_board.h"
#include "viewer/program/stage_roster.h"
#include "viewer/program/view_options.h"

namespace dance {

class PictureSource {
 public:
  static Result<std::unique_ptr<PictureSource>> open(const ViewOptions& options);
  virtual ~PictureSource() = default;

  virtual GuestBoard& board() = 0;
  virtual MonoTime begin() const = 0;
  // Returns when it is that moment, or the program is to end, with the time that it is.
  virtual MonoTime wait_until(MonoTime moment) = 0;
  // Of a beat of the house's music; nothing where it is not known yet.
  virtual std::optional<MonoTime> time_of_beat(double) const { return std::nullopt; }
  // What the last picture showed first, and when it was on the screen.
  virtual void report_shown(std::span<const StageRoster::Fresh>, MonoTime) {}
  // How long a recorded house was; nothing of a live one.
  virtual Duration recorded() const { return Duration(); }
  virtual bool is_over() const = 0;
  virtual const std::string& name() const = 0;  // for people
};

}  // namespace dance
