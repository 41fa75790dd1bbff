// The two modes of `dance view`: a window, and pictures in files. Both take poses from a
// PictureSource, live or recorded, and draw through a StagePainter.
//
// Ownership: each call owns all it needs while it runs.
// Threads:   call from main; a live source starts the bus thread.
// Failure:   the Error names what is missing and the cure.
#pragma once

#include "viewer/program/view_options.h"

namespace dance {

// Until the window is closed or a signal comes.
Result<void> run_window(const ViewOptions& options);
// Writes the range of a recording that the options name, and says what.
Result<void> run_export(const ViewOptions& options);
// Prints the name of each picture on stdout. An Error when no pose was received.
Result<void> run_headless(const ViewOptions& options);

}  // namespace dance
