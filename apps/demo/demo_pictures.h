// The pictures of a demo's comparison, made when the dance is over: six beats as they came above
// the same six as the stage showed them, the sway of the hips over the beats, and a film where one
// is wanted. They are drawn from the demo's log, so that neither the dance nor the pictures wait
// for the other.
//
// Units/frames: none.
// Ownership:    plain values.
// Threads:      waits for the program that draws.
// Failure:      names what could not be drawn and why; what was drawn before stays.
#pragma once

#include <string>

#include "apps/demo/demo_options.h"
#include "apps/demo/demo_rhythm.h"

namespace dance {

struct DemoPictures {
  std::string strip, sway, film;  // files, and the folder of the film; "" = not made
};

// `rhythm` as measured on the trace.
Result<DemoPictures> draw_comparison(const DemoOptions& options, const DemoPlan& plan,
                                     const DemoTrace& trace, const DemoRhythm& rhythm);

}  // namespace dance
