#include "core/program/talk.h"
#include "viewer/program/view_program.h"
#include "viewer/window/window_run.h"

namespace dance {

Result<void> run_window(const ViewOptions& options) {
  DANCE_TRY(auto source, PictureSource::open(options));
  DANCE_TRY(auto run, WindowRun::create(options, *source));
  auto ended = run->run();
  if (source->board().no_room() > 0)
    talk::warn("{} messages of guests beyond the {} that fit were left out",
               source->board().no_room(), GuestBoard::kMaxGuests);
  return ended;
}

}  // namespace dance
