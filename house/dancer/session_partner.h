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

// Removes the server, so that nobody else joins.
void dance_alone(HouseConfig& session);
// Adds one dancer to this house: a synthetic one ("lead" or "follow"), or one from a file. If the
// file has several dancers, it takes one that the first guest does not already use.
Result<void> add_partner(HouseConfig& session, const std::string& partner);
// Adds the house band, unless the session has music or excludes the band.
void let_band_play(HouseConfig& session, const std::string& style);
// This music, over and over, for this house alone.
void practise_to(HouseConfig& session, const std::string& music);

}  // namespace dance
