// The choreography of a salsa couple: which figure is danced in which eight, and for every count of
// the music where each dancer's body is, where the stepping foot lands and how the hands are held.
// Both dancers read the same score, so that they dance together without a connection.
//
// Units/frames: count n is beat n of the music; places in W, metres and radians (yaw about +Y).
// Ownership:    plain values, no allocation.
// Threads:      none inside; const and pure.
// Failure:      none for a checked style.
#pragma once

#include <array>
#include <cstdint>

#include "producers/salsa/salsa_style.h"

namespace dance {

enum class SalsaFigure : std::uint8_t {
  kBasic,          // lead forward on 1 and back on 5, in closed or open hold
  kSide,           // to the side and back, in closed hold
  kOpenBreak,      // both break back, two hands held
  kCrossBodyLead,  // the follow passes the lead; they change places
  kRightTurn,      // the follow turns under the raised hand on 5, 6, 7
};

// A place on the floor and the direction one faces there.
struct FloorPlace {
  double x_m = 0.0;
  double z_m = 0.0;
  double yaw_rad = 0.0;
  FloorPlace operator+(const FloorPlace& o) const {
    return {x_m + o.x_m, z_m + o.z_m, yaw_rad + o.yaw_rad};
  }
  FloorPlace operator-(const FloorPlace& o) const {
    return {x_m - o.x_m, z_m - o.z_m, yaw_rad - o.yaw_rad};
  }
  FloorPlace operator*(double s) const { return {x_m * s, z_m * s, yaw_rad * s}; }
};

// Where the hands are; the first three shares add up to 1 (lead's left and follow's right, which
// are always joined), the next three as well (lead's right and follow's left).
struct SalsaHold {
  double low = 1.0;       // between the two, at the waist
  double side = 0.0;      // out to the side, at the shoulder
  double over = 0.0;      // above the follow's head
  double joined = 1.0;    // between the two, at the waist
  double embrace = 0.0;   // his hand on her shoulder blade, hers on his shoulder
  double free = 0.0;      // each styles
  double flourish = 0.0;  // free hands: 0 near the body, 1 out
  SalsaHold operator+(const SalsaHold& o) const;
  SalsaHold operator-(const SalsaHold& o) const;
  SalsaHold operator*(double s) const;
};

// One count of one dancer.
struct SalsaCount {
  FloorPlace body;
  FloorPlace foot;            // where the foot lands that steps on this count
  bool is_step = false;       // false on 4 and 8
  bool is_left = false;       // which foot bears the weight from this count on
  double sway = 0.0;          // of the hips, −1 right to +1 left, about
  double hip_turn_rad = 0.0;  // of the pelvis against the body's own direction
  double heel_rad = 0.0;      // how high the heel is at landing
  double drop_m = 0.0;        // how much lower the hips are, in long steps
  SalsaHold hold;
};

// The counts around a moment, of one dancer: count n is at(n), first() <= n <= last().
class SalsaCounts {
 public:
  static constexpr int kBefore = 7;
  static constexpr int kAfter = 4;

  const SalsaCount& at(std::int64_t n) const;
  std::int64_t first() const { return first_; }
  std::int64_t last() const { return first_ + static_cast<std::int64_t>(counts_.size()) - 1; }

 private:
  friend class SalsaScore;
  bool is_filled_ = false;
  std::int64_t first_ = 0;
  std::array<SalsaCount, kBefore + kAfter + 1> counts_;
};

class SalsaScore {
 public:
  explicit SalsaScore(const SalsaStyle& style);

  // Figure of an eight; eight k is beats 8k to 8k + 8.
  SalsaFigure figure(std::int64_t eight) const;
  // The counts around a moment of the music. Body yaws are unwrapped from the first on. `out` holds
  // one role's counts of one score for good: within a beat they are not worked out again.
  void counts_around(SalsaRole role, double beats, SalsaCounts& out) const;

 private:
  struct Eight {
    SalsaFigure figure = SalsaFigure::kBasic;
    bool is_closed = false;   // hold at its end
    bool is_swapped = false;  // lead and follow have changed places before it
    double spacing_m = 0.8;   // between the two, from count 3 on
    double step_gain = 1.0;
    double sway_gain = 1.0;
  };
  static constexpr int kEightsInChorus = 8;

  Eight eight(std::int64_t index) const;
  SalsaCount count(SalsaRole role, std::int64_t n, const Eight& before, const Eight& now) const;
  FloorPlace own_frame(SalsaRole role, std::int64_t n, bool is_swapped, double spacing_m) const;

  SalsaStyle style_;
  double drift_phase_rad_;
  double step_scale_;
};

}  // namespace dance
