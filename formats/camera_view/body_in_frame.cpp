#include "formats/camera_view/body_in_frame.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

// Points by their places in the network's order.
constexpr std::size_t kNose = 0;
constexpr std::array<std::size_t, 5> kFace{0, 2, 5, 7, 8};  // nose, eyes, ears
constexpr std::array<std::size_t, 2> kEars{7, 8};
constexpr std::array<std::size_t, 2> kShoulders{11, 12};
constexpr std::array<std::size_t, 2> kWrists{15, 16};
constexpr std::array<std::size_t, 2> kHips{23, 24};
constexpr std::array<std::size_t, 2> kKnees{25, 26};
constexpr std::array<std::array<std::size_t, 3>, 2> kFeet{{{27, 29, 31}, {28, 30, 32}}};

// Of people who stand: from the shoulders to the ears 11.5 % of their height, from there to the
// crown 7.5 %; from the shoulders to the hips 31 %, as the network sees both.
constexpr float kCrownAboveEars = 0.65f;
constexpr float kTorsoOfHeight = 0.31f;

constexpr float kSeenWell = 0.5f;
constexpr float kAtTheEdge = 0.04f;  // a hidden point so near to the edge is beyond it

float margin_of(const SeenPoint& p) {
  return std::min(std::min(p.x, 1.0f - p.x), std::min(p.y, 1.0f - p.y));
}

template <std::size_t kCount>
SeenPoint middle_of(const SeenBody2d& body, const std::array<std::size_t, kCount>& which) {
  SeenPoint middle;
  for (const std::size_t i : which) {
    middle.x += body.points[i].x / kCount;
    middle.y += body.points[i].y / kCount;
    middle.visibility = std::max(middle.visibility, body.points[i].visibility);
  }
  return middle;
}

// A pair of which one is enough is seen where its better one is.
PartInFrame one_of(const SeenBody2d& body, const std::array<std::size_t, 2>& pair) {
  const SeenPoint& a = body.points[pair[0]];
  const SeenPoint& b = body.points[pair[1]];
  const SeenPoint& better = a.visibility >= b.visibility ? a : b;
  return {margin_of(better), better.visibility};
}

PartInFrame both_of(const SeenBody2d& body, const std::array<std::size_t, 2>& pair) {
  const SeenPoint& a = body.points[pair[0]];
  const SeenPoint& b = body.points[pair[1]];
  return {std::min(margin_of(a), margin_of(b)), std::max(a.visibility, b.visibility)};
}

PartInFrame head_of(const SeenBody2d& body, const SeenPoint& crown) {
  PartInFrame head{margin_of(crown), 0.0f};
  for (const std::size_t i : kFace) {
    head.margin = std::min(head.margin, margin_of(body.points[i]));
    head.visibility = std::max(head.visibility, body.points[i].visibility);
  }
  return head;
}

// Toes may reach over the edge; ankle and heel may not.
PartInFrame feet_of(const SeenBody2d& body) {
  PartInFrame feet{1.0f, 0.0f};
  for (const auto& [ankle, heel, toes] : kFeet) {
    feet.margin =
        std::min({feet.margin, margin_of(body.points[ankle]), margin_of(body.points[heel])});
    feet.visibility = std::max({feet.visibility, body.points[ankle].visibility,
                                body.points[heel].visibility, body.points[toes].visibility});
  }
  return feet;
}

}  // namespace

BodyInFrame body_in_frame(const SeenBody2d& body) {
  BodyInFrame found;
  found.is_found = body.is_found;
  if (!body.is_found) return found;
  const SeenPoint shoulders = middle_of(body, kShoulders);
  const SeenPoint ears = middle_of(body, kEars);
  const SeenPoint hips = middle_of(body, kHips);
  const SeenPoint crown{ears.x + kCrownAboveEars * (ears.x - shoulders.x),
                        ears.y + kCrownAboveEars * (ears.y - shoulders.y), ears.visibility};
  found.head = head_of(body, crown);
  found.hands = both_of(body, kWrists);
  found.knees = one_of(body, kKnees);
  found.feet = feet_of(body);
  found.top_y = std::min(crown.y, body.points[kNose].y);
  found.bottom_y = found.top_y;
  for (const auto& foot : kFeet)
    for (const std::size_t i : foot) found.bottom_y = std::max(found.bottom_y, body.points[i].y);
  found.height =
      std::max(found.bottom_y - found.top_y, std::abs(hips.y - shoulders.y) / kTorsoOfHeight);
  found.centre_x = 0.5f * (shoulders.x + hips.x);
  return found;
}

PartSeen seen(const PartInFrame& part) {
  if (part.margin < 0.0f) return PartSeen::kCutOff;
  if (part.visibility >= kSeenWell) return PartSeen::kSeen;
  return part.margin < kAtTheEdge ? PartSeen::kCutOff : PartSeen::kHidden;
}

}  // namespace dance
