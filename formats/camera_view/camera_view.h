// CameraView: one picture of a camera, made small, and what is seen in it: light, motion of the
// camera itself, and the points of a dancer's body. CameraStatus: what the camera is doing.
//
// Units/frames: luma, shares and visibility from 0 to 1. A point is in shares of the picture's
//               width and height, (0, 0) its left upper corner; one outside the picture is below 0
//               or above 1. Left and right are the dancer's own. Pictures are red, green, blue, a
//               byte each, rows without padding.
// Ownership:    plain values; a view's picture is a view of the owner's bytes.
// Threads:      none inside.
// Failure:      is_valid() is false for numbers that are not finite or out of these ranges.
// Source:       order of the points: MediaPipe Pose (BlazePose GHUM 3D model card).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/fixed_string.h"
#include "core/base/time.h"

namespace dance {

struct SeenPoint {
  float x = 0.0f;
  float y = 0.0f;
  float visibility = 0.0f;  // in the picture and not hidden
};
constexpr std::size_t kSeenPoints = 33;
constexpr float kFarthestPoint = 3.0f;  // a point is no farther outside than so many pictures

struct SeenBody2d {
  bool is_found = false;
  std::array<SeenPoint, kSeenPoints> points{};  // meaningless where nobody is found
};

struct PictureLight {
  float mean = 0.0f;         // luma of the whole picture
  float spread = 0.0f;       // between the darkest and the brightest twentieth of the pixels
  float white_share = 0.0f;  // of the pixels, at the upper end of what the camera can show
  // Mean luma of the body and of what is around it; equal where nobody is found.
  float body = 0.0f;
  float around = 0.0f;
};

struct CameraFacts {
  MonoTime time;             // when the picture was taken, by this machine's monotonic clock
  float pictures_hz = 0.0f;  // that the camera gives; 0 before it is known
  float shake = 0.0f;        // how fast the view itself moves, in picture widths a second
  PictureLight light;
  SeenBody2d body;
};

struct PreviewPicture {
  int width = 0;
  int height = 0;
  std::span<const std::uint8_t> rgb;
};
constexpr int kWidestPreview = 320;
constexpr int kHighestPreview = 320;
constexpr std::size_t kMostPreview_bytes = 3UL * kWidestPreview * kHighestPreview;

enum class CameraState : std::uint8_t {
  kOpening,
  kRunning,
  kUnplugged,  // while open; it is looked for
  kSilent,     // open, and without pictures for seconds
  kFailed,     // cannot be opened; it is tried again
  kCount
};
enum class CameraCause : std::uint8_t {
  kNone,
  kInUse,         // another program has it
  kAbsent,        // no such camera, or none at all
  kNoPermission,  // of this user
  kOther,
  kCount
};

struct CameraStatus {
  CameraState state = CameraState::kOpening;
  CameraCause cause = CameraCause::kNone;  // of kFailed
  bool has_network = false;                // the pose network is there: bodies can be seen
  int width_px = 0;                        // of the camera's own pictures
  int height_px = 0;
  FixedString<80> name;    // of the camera, printable
  FixedString<240> words;  // of the trouble, in English, with its cure, printable
};

bool is_valid(const CameraFacts& facts);
bool is_valid(const CameraStatus& status);
// The picture has a size within the bounds, and as many bytes as that needs.
bool is_valid(const PreviewPicture& picture);

}  // namespace dance
