// The places, each in a file of its own.
//
// Units/frames: as viewer/stage/place/place_shape.h.
#pragma once

#include "viewer/stage/place/place_shape.h"

namespace dance {

// A dance school in the evening: wooden floor, mirror and barre, tall windows.
namespace studio_place {
PlaceShape make(const PlaceRoom& room);
}
// A bar at night: counter, warm lamps, strings of lights, dark walls.
namespace bar_place {
PlaceShape make(const PlaceRoom& room);
}
// A terrace above a town after sunset: balustrade, lanterns, hills and distant lights.
namespace terrace_place {
PlaceShape make(const PlaceRoom& room);
}

}  // namespace dance
