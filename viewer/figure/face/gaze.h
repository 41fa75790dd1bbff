// Gaze: the eyes of a figure point at the face of the nearest dancer in front of it, within the
// range that eyes turn without the head, with the small jumps of living eyes. The head stays as it
// was captured.
//
// Units/frames: radians to the dancer's left and up, relative to the head, as Face::gaze_rad.
// Threads:      any.
// Source:       ranges and fixation times: Land and Tatler, Looking and Acting, 2009.
#pragma once

#include <Eigen/Geometry>
#include <span>

#include "core/base/guest_id.h"
#include "core/base/time.h"
#include "viewer/figure/face/dancer_view.h"

namespace dance {

constexpr float kMostGazeAside_rad = 0.52f;
constexpr float kMostGazeUp_rad = 0.3f;
constexpr float kMostGazeDown_rad = 0.42f;

// The angles from the head's forward axis to `target`; more than a quarter turn aside is behind.
Eigen::Vector2f aim_gaze(const DancerView& from, const Eigen::Vector3f& target_W_m);

// Limits the angles to the comfortable range of eyes. For targets far outside that range the result
// returns to zero.
Eigen::Vector2f limit_gaze(const Eigen::Vector2f& aimed_rad);

// The nearest dancer in front of `views[self]`, or `kept` while no other is clearly nearer; the
// number of views where there is none.
std::size_t find_gaze_partner(std::span<const DancerView> views, std::size_t self,
                              const GuestId& kept);

// The offset of the eyes from their target: a new fixation about every second.
Eigen::Vector2f saccade_at(const GuestId& guest, MonoTime time);

}  // namespace dance
