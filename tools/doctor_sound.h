// Whether music can be heard from this machine: the sound server is asked, and silence played for half a second.
//
// Ownership: plain values.
// Threads:   call from main.
// Failure:   the finding says what is missing and the cure; nobody needs sound to dance.
#pragma once

#include "producers/music/loudspeaker.h"
#include "tools/doctor_checks.h"

namespace dance {

// From what was found of the loudspeaker, or why nothing was.
Finding check_loudspeaker(const Result<Loudspeaker>& loudspeaker);

Finding check_sound();

}  // namespace dance
