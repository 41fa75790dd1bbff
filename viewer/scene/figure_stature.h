// FigureStature: how large a guest's figure is beside the dancer whose pose it shows, for cameras,
// which are placed before figures are posed: near enough to keep a figure in the picture, and to
// stand at its eyes.
//
// Units/frames: metres in W.
// Ownership:    plain values; never allocates.
// Threads:      none inside.
// Failure:      what cannot be measured of an avatar is taken to be as the dancer's.
#pragma once

#include "viewer/scene/scene.h"

namespace dance {

struct FigureStature {
  float scale = 1.0f;  // from the avatar's model to what is shown
  float legs = 1.0f;   // the figure's legs to the dancer's
  float body = 1.0f;   // what is above them, likewise
};

FigureStature stature_of(const SceneGuest& guest);
float figure_height_m(const SceneGuest& guest);
// The dancer's joints and ends where the figure's are, more or less: the middle of the hips as high
// as its legs are long, all else as far from there as it is large.
void figure_frames(const SceneGuest& guest, BodyFrames& frames);
// Where the figure's eyes are.
Eigen::Vector3f figure_eyes_W_m(const SceneGuest& guest);

}  // namespace dance
