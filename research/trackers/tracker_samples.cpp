#include "research/trackers/tracker_samples.h"

#include <algorithm>

#include "core/motion/rotation_vector.h"
#include "research/trackers/worn_devices.h"
#include "testing/motion/motion_measures.h"

namespace dance {
namespace {

using Eigen::Vector3f;

constexpr float kBodySpread = 0.04f;
constexpr double kSlowestDance = 0.85, kQuickestDance = 1.2;
// What calibration leaves: of places, of turns, of the height.
constexpr double kOff_m = 0.012, kHipsOff_m = 0.025, kOff_rad = 0.06, kHeightOff = 0.015;
constexpr double kTremble_m = 0.0005, kTremble_rad = 0.001;
constexpr double kLosesOne = 0.35;

Vector3f some_vector(Random& random, double sd) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return Eigen::Vector3d(sd * x, sd * y, sd * z).cast<float>();
}

std::uint32_t some_points(Random& random) {
  const double draw = random.uniform();
  if (draw < 0.35) return point_set(3);
  if (draw < 0.50) return point_set(4);
  if (draw < 0.70) return point_set(6);
  if (draw < 0.80) return point_set(10);
  return 1u | (static_cast<std::uint32_t>(random.next_u64()) & ((1u << kTrackedPointCount) - 1));
}

// Offsets that stay for a whole sequence.
struct Worn {
  explicit Worn(Random& random) {
    for (std::size_t i = 0; i < kTrackedPointCount; ++i) {
      p_m[i] = some_vector(random, i == index_of(TrackedPoint::kHips) ? kHipsOff_m : kOff_m);
      R[i] = exp_rotation(some_vector(random, kOff_rad));
    }
  }
  std::array<Vector3f, kTrackedPointCount> p_m;
  std::array<Eigen::Quaternionf, kTrackedPointCount> R;
};

BonePlaces places_of(const BodyFrames& body, std::uint32_t points, const Worn& worn,
                     Random& random) {
  BonePlaces places;
  for (std::size_t i = 0; i < kTrackedPointCount; ++i) {
    if ((points >> i & 1u) == 0) continue;
    const std::size_t b = index_of(kPointBones[i]);
    const Eigen::Quaternionf R =
        (exp_rotation(some_vector(random, kTremble_rad)) * body.R_WB[b] * worn.R[i]).normalized();
    places.put(static_cast<TrackedPoint>(i),
               {body.p_WB_m[b] + R * worn.p_m[i] + some_vector(random, kTremble_m), R});
  }
  return places;
}

}  // namespace

std::vector<TrackerDance> tracker_dances(const PredictTake& take, int bodies, Random& random) {
  std::vector<TrackerDance> dances;
  for (int i = 0; i < 2 * bodies; ++i) {
    const float height = dancer_height_m(take) * static_cast<float>(random.uniform(0.93, 1.07));
    const Skeleton body = human_skeleton(height, kBodySpread, random);
    const double speed = i < 2 ? 1.0 : random.uniform(kSlowestDance, kQuickestDance);
    PredictTake danced =
        at_rate(on_body(i % 2 == 0 ? take : mirrored(take), body), TrackerRow::kStep_hz / speed);
    const JointTrack track(body, danced.poses, TrackerRow::kStep_hz);
    TrackerDance dance;
    dance.height_m = standing_height_m(body);
    dance.stands = stance_of(track).stands;
    dance.frames.resize(danced.poses.size());
    for (std::size_t k = 0; k < danced.poses.size(); ++k)
      forward_kinematics(body, danced.poses[k], dance.frames[k]);
    dances.push_back(std::move(dance));
  }
  return dances;
}

void draw_tracker_sequence(const TrackerDance& dance, std::size_t first, std::size_t steps,
                           Random& random, float* inputs, std::size_t inputs_wide, float* outputs,
                           std::size_t outputs_wide) {
  const std::uint32_t points = some_points(random);
  const Worn worn(random);
  const float height_m = dance.height_m * static_cast<float>(1.0 + kHeightOff * random.normal());
  std::uint32_t lost = 0;
  std::size_t lost_from = steps, lost_to = steps;
  if (random.uniform() < kLosesOne) {
    lost = 1u << (1 + random.below(kTrackedPointCount - 1));
    if (random.uniform() < 0.2) lost = 0b110;
    lost_from = random.below(steps);
    lost_to = lost_from + 20 + random.below(80);
  }
  const auto points_at = [&](std::size_t t) {
    return t >= lost_from && t < lost_to ? points & ~lost : points;
  };
  const auto seconds = static_cast<float>(1.0 / TrackerRow::kStep_hz);
  BonePlaces before = places_of(dance.frames[first], points_at(0), worn, random);
  BonePlaces now = before;
  for (std::size_t t = 0; t < steps; ++t) {
    const TrackerView view(now.of(TrackedPoint::kHead), height_m);
    write_inputs(
        view, before, now, seconds,
        std::span<float, TrackerRow::kInputs>(inputs + t * inputs_wide, TrackerRow::kInputs));
    before = now;
    now = places_of(dance.frames[first + t + 1], points_at(t + 1), worn, random);
    const TrackerView next(now.of(TrackedPoint::kHead), height_m);
    const auto& stands = dance.stands[first + t + 1];
    write_outputs(
        next, dance.frames[first + t + 1], {stands[0] ? 1.0f : 0.0f, stands[1] ? 1.0f : 0.0f},
        std::span<float, TrackerRow::kOutputs>(outputs + t * outputs_wide, TrackerRow::kOutputs));
  }
}

}  // namespace dance
