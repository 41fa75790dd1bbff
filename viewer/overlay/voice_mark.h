// The sign beside a name that says how its guest speaks: a microphone or headphones, struck through
// where nothing is said or heard.
//
// Units/frames: pixels from the top left; `size_px` is the height of the sign.
// Ownership:    draws into the list that it is given.
// Threads:      the drawing thread.
// Failure:      none.
#pragma once

#include <imgui.h>

#include "viewer/scene/scene.h"

namespace dance {

void draw_voice_mark(ImDrawList& list, VoiceMark mark, ImVec2 centre, float size_px, float alpha);

}  // namespace dance
