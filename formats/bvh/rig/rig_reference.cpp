#include "formats/bvh/rig/rig_reference.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "core/pose/shortest_turn.h"
#include "formats/bvh/rig/rig_canonical.h"
#include "formats/bvh/rig/rig_correction.h"
#include "formats/bvh/rig/rig_stance.h"

namespace dance {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kUpright = 0.85;  // cosine: within 32° of up
constexpr double kTypicalHeight_m = 1.7;
// Bounds of a person's height, within which the unit that fits best is taken.
constexpr double kSmallest_m = 1.0;
constexpr double kTallest_m = 2.4;

struct Unit {
  double metres;
  const char* name;
};
constexpr Unit kUnits[] = {{1.0, "metres"},
                           {0.01, "centimetres"},
                           {0.001, "millimetres"},
                           {0.0254, "inches"},
                           {0.0254 / 0.45, "CMU's units of 0.0564444 m"},
                           {0.1, "decimetres"},
                           {0.3048, "feet"}};

std::string printed(const char* format, auto... values) {
  char buffer[200];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

const char* axis_name(const Vector3d& direction) {
  constexpr const char* kNames[] = {"+X", "+Y", "+Z", "-X", "-Y", "-Z"};
  int axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  return kNames[axis + (direction[axis] < 0.0 ? 3 : 0)];
}

Vector3d guess_up(const BvhMotion& motion, const Rig& rig, std::vector<std::string>& notes) {
  const Vector3d up = mean_up(motion, rig);
  int axis = 0;
  const double most = up.cwiseAbs().maxCoeff(&axis);
  if (!(most > 0.3)) {
    notes.emplace_back("nobody stands upright in this file: +Y taken as up");
    return Vector3d::UnitY();
  }
  const Vector3d snapped = Vector3d::Unit(axis) * (up[axis] < 0.0 ? -1.0 : 1.0);
  if (snapped != Vector3d::UnitY())
    notes.push_back(std::string("up is ") + axis_name(snapped) + " in this file: turned to +Y");
  return snapped;
}

Quaterniond rotation_to_stage(const Vector3d& up) {
  if (up == Vector3d(-Vector3d::UnitY())) return Quaterniond(0.0, 1.0, 0.0, 0.0);  // half about X
  return shortest_turn(up, Vector3d::UnitY());
}

double guess_unit(double height, std::vector<std::string>& notes) {
  const Unit* best = nullptr;
  const auto distance = [&](const Unit& unit) {
    return std::abs(std::log(height * unit.metres / kTypicalHeight_m));
  };
  for (const Unit& unit : kUnits) {
    const double tall_m = height * unit.metres;
    if (tall_m < kSmallest_m || tall_m > kTallest_m) continue;
    if (!best || distance(unit) < distance(*best)) best = &unit;
  }
  if (best) {
    notes.push_back(std::string("units are ") + best->name +
                    printed(": the figure is %.2f m tall", height * best->metres));
    return best->metres;
  }
  notes.push_back(
      printed("no unit fits a figure %.4g tall: scaled to %.2f m", height, kTypicalHeight_m));
  return kTypicalHeight_m / height;
}

// The first frame if it will do, else the one in which the figure stands best.
std::size_t best_standing_frame(const BvhMotion& motion, const Rig& rig, const Vector3d& up) {
  const std::size_t count = motion.bvh().frame_count;
  const std::size_t step = sample_step(motion.bvh());
  std::size_t best = 0;
  double best_score = -1e9;
  BvhFigure figure;
  for (std::size_t f = 0; f < count; f += step) {
    motion.figure_at(f, figure);
    const RigStance stance = stance_of(motion.bvh(), rig, figure);
    const bool is_good = stance.stands() && stance.up().dot(up) > kUpright;
    if (f == 0 && is_good) return 0;
    const double score = stance.score() + (is_good ? 10.0 : 0.0);
    if (score <= best_score) continue;
    best = f;
    best_score = score;
  }
  return best;
}

void note_facing(const RigStance& stance, std::vector<std::string>& notes) {
  const Vector3d forward = stance.hips_left.cross(stance.trunk);
  notes.push_back(std::string("the rest pose faces ") + axis_name(forward) + ", up " +
                  axis_name(stance.trunk));
  if (stance.toes_forward.norm() > 0.02 * stance.height &&
      forward.normalized().dot(stance.toes_forward.normalized()) < -0.5)
    notes.emplace_back("toes point backwards: left and right may be swapped in this file");
}

}  // namespace

RigReference find_reference(const BvhMotion& motion, const Rig& rig, const RetargetOptions& options,
                            std::vector<std::string>& notes) {
  RigReference reference;
  reference.is_canonical = is_canonical(motion.bvh()) && options.up != UpAxis::kZ;
  Vector3d up = Vector3d::UnitY();
  if (options.up == UpAxis::kZ) up = Vector3d::UnitZ();
  if (options.up == UpAxis::kGuess && !reference.is_canonical) up = guess_up(motion, rig, notes);
  reference.R_WF = rotation_to_stage(up);

  motion.zero_figure(reference.figure);
  RigStance stance = stance_of(motion.bvh(), rig, reference.figure);
  if (!stance.stands() && !reference.is_canonical) {
    const std::size_t frame = best_standing_frame(motion, rig, up);
    motion.figure_at(frame, reference.figure);
    stance = stance_of(motion.bvh(), rig, reference.figure);
    reference.is_zero_pose = false;
    notes.push_back("without rotations the figure does not stand: frame " +
                    std::to_string(frame + 1) + " taken as its rest pose");
  }
  note_facing(stance, notes);

  if (options.metres_per_unit)
    reference.metres_per_unit = *options.metres_per_unit;
  else if (reference.is_canonical)
    notes.push_back(printed("units are metres: the figure is %.2f m tall", stance.height));
  else if (stance.height > 0.0 && std::isfinite(stance.height))
    reference.metres_per_unit = guess_unit(stance.height, notes);
  reference.height_m = stance.height * reference.metres_per_unit;
  find_corrections(motion.bvh(), rig, reference);
  return reference;
}

}  // namespace dance
