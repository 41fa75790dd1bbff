// A dance without others: what `dance join --alone`, --partner and --music make of a session.
//
// Units/frames: none.
// Ownership:    plain values.
// Threads:      none inside. add_partner() reads a file where it is named one.
// Failure:      says what is wrong with the file, or that nobody dances here.
#pragma once

#include <string>

#include "house/session.h"

namespace dance {

// Nobody else: without the server.
void dance_alone(HouseConfig& session);
// One more dancer in this house: a synthetic one who leads or follows ("lead", "follow"), or one of
// a file; of a file with several not the one whom the first guest's stand-in is.
Result<void> add_partner(HouseConfig& session, const std::string& partner);
// This music, over and over, for this house alone.
void practise_to(HouseConfig& session, const std::string& music);

}  // namespace dance
