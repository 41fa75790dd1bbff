#include "producers/camera/people/person_look.h"

#include <algorithm>

#include "core/base/median.h"

namespace dance {
namespace {

constexpr float kLeastVisibility = 0.5f;
// The light on a dancer changes more than the colour.
const PictureColour kLeastVariance(0.08f * 0.08f, 0.03f * 0.03f, 0.03f * 0.03f);
constexpr float kMostDistance = 9.0f;
constexpr float kDiffers = 2.0f;
constexpr int kRemembered = 150;  // pictures

struct Samples {
  static constexpr std::size_t kMost = 24;
  std::array<std::array<float, kMost>, 3> channel{};
  std::size_t count = 0;

  void add(const std::optional<PictureColour>& colour) {
    if (!colour || count == kMost) return;
    for (std::size_t c = 0; c < 3; ++c) channel[c][count] = (*colour)[static_cast<int>(c)];
    ++count;
  }
  bool median(PictureColour& out) {
    constexpr std::size_t kEnough = 4;
    if (count < kEnough) return false;
    for (std::size_t c = 0; c < 3; ++c)
      out[static_cast<int>(c)] = median_of(std::span(channel[c].data(), count));
    return true;
  }
};

bool is_visible(const SeenBody& body, Landmark landmark) {
  return body.visibility[index_of(landmark)] > kLeastVisibility;
}

void sample_limb(const SeenBody& body, Landmark from, Landmark to, PeopleVision& vision,
                 Samples& samples) {
  if (!is_visible(body, from) || !is_visible(body, to)) return;
  const Eigen::Vector2f a = body.place_px(from), b = body.place_px(to);
  for (const float share : {0.25f, 0.4f, 0.55f, 0.7f, 0.85f})
    samples.add(vision.colour(a + share * (b - a)));
}

void sample_trunk(const SeenBody& body, PeopleVision& vision, Samples& samples) {
  for (const Landmark l :
       {Landmark::kLeftShoulder, Landmark::kRightShoulder, Landmark::kLeftHip, Landmark::kRightHip})
    if (!is_visible(body, l)) return;
  for (const float down : {0.2f, 0.35f, 0.5f, 0.65f, 0.8f})
    for (const float aside : {0.2f, 0.4f, 0.6f, 0.8f}) {
      const Eigen::Vector2f left =
          body.place_px(Landmark::kLeftShoulder) +
          down * (body.place_px(Landmark::kLeftHip) - body.place_px(Landmark::kLeftShoulder));
      const Eigen::Vector2f right =
          body.place_px(Landmark::kRightShoulder) +
          down * (body.place_px(Landmark::kRightHip) - body.place_px(Landmark::kRightShoulder));
      samples.add(vision.colour(left + aside * (right - left)));
    }
}

}  // namespace

PersonLook look_of(const SeenBody& body, PeopleVision& vision) {
  PersonLook look;
  std::array<Samples, kLookParts> samples;
  sample_trunk(body, vision, samples[0]);
  sample_limb(body, Landmark::kLeftHip, Landmark::kLeftKnee, vision, samples[1]);
  sample_limb(body, Landmark::kRightHip, Landmark::kRightKnee, vision, samples[1]);
  sample_limb(body, Landmark::kLeftKnee, Landmark::kLeftAnkle, vision, samples[2]);
  sample_limb(body, Landmark::kRightKnee, Landmark::kRightAnkle, vision, samples[2]);
  sample_limb(body, Landmark::kLeftShoulder, Landmark::kLeftElbow, vision, samples[3]);
  sample_limb(body, Landmark::kRightShoulder, Landmark::kRightElbow, vision, samples[3]);
  for (std::size_t part = 0; part < kLookParts; ++part) {
    look.colour[part].setZero();
    look.is_seen[part] = samples[part].median(look.colour[part]);
  }
  return look;
}

void LookModel::learn(const PersonLook& look) {
  bool is_any = false;
  for (std::size_t i = 0; i < kLookParts; ++i) {
    if (!look.is_seen[i]) continue;
    is_any = true;
    Part& part = parts_[i];
    part.pictures = std::min(part.pictures + 1, kRemembered);
    const float weight = 1.0f / static_cast<float>(part.pictures);
    const PictureColour difference = look.colour[i] - part.mean;
    part.mean += weight * difference;
    part.variance += weight * (difference.cwiseProduct(difference) - part.variance);
  }
  if (is_any) pictures_ = std::min(pictures_ + 1, kRemembered);
}

float LookModel::Part::squared(const PictureColour& colour) const {
  const PictureColour difference = colour - mean;
  return std::min(kMostDistance,
                  (difference.array().square() / variance.cwiseMax(kLeastVariance).array()).sum());
}

float LookModel::distance(const PictureColour& colour) const {
  float least = kMostDistance;
  for (const Part& part : parts_)
    if (part.pictures > 0) least = std::min(least, part.squared(colour));
  return least;
}

bool LookModel::differs_from(const LookModel& other) const {
  float sum = 0.0f;
  int count = 0;
  for (std::size_t i = 0; i < kLookParts; ++i) {
    if (parts_[i].pictures == 0 || other.parts_[i].pictures == 0) continue;
    sum +=
        std::min(parts_[i].squared(other.parts_[i].mean), other.parts_[i].squared(parts_[i].mean));
    ++count;
  }
  return count > 0 && sum > kDiffers * static_cast<float>(count);
}

std::optional<float> LookModel::distance(const PersonLook& look) const {
  float sum = 0.0f;
  int count = 0;
  for (std::size_t i = 0; i < kLookParts; ++i) {
    if (!look.is_seen[i] || parts_[i].pictures == 0) continue;
    sum += parts_[i].squared(look.colour[i]);
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / static_cast<float>(count);
}

}  // namespace dance
