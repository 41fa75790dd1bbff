#include "formats/bvh/rig/rig_fingers.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace dance {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kPhalanges = 3;
constexpr std::size_t kFewestFingers = 3;
constexpr std::size_t kMostFingers = 5;
// A thumb begins nearer to the wrist than this part of the way to the next finger.
constexpr double kThumbOfWay = 0.75;

bool has_end(const RigTree& tree, int joint) {
  const auto& end = tree.at(joint).end_site;
  return end && end->norm() > tree.shortest_bone();
}

struct Finger {
  std::vector<int> chain;
  std::vector<int> bones;  // of them the phalanges
  Vector3d knuckle = Vector3d::Zero();
};

// Follows each end below the hand up to the joint at which fingers part.
std::vector<Finger> fingers_below(const RigTree& tree, int hand) {
  std::vector<Finger> fingers;
  for (int joint = hand + 1; joint < static_cast<int>(tree.size()); ++joint) {
    if (!tree.is_above(hand, joint) || !tree.children(joint).empty()) continue;
    Finger finger;
    for (int at = joint; at != hand; at = tree.parent(at)) {
      finger.chain.push_back(at);
      if (tree.children(tree.parent(at)).size() > 1) break;
    }
    std::reverse(finger.chain.begin(), finger.chain.end());
    if (finger.chain.size() >= 2) fingers.push_back(std::move(finger));
  }
  return fingers;
}

// Begins with the thumb; the others by their distance from it across the palm.
void sort_from_thumb(const Vector3d& wrist, std::vector<Finger>& fingers) {
  Vector3d middle = Vector3d::Zero();
  for (const Finger& finger : fingers) middle += finger.knuckle - wrist;
  const Vector3d along = middle.normalized();
  const auto reach = [&](const Finger& finger) { return along.dot(finger.knuckle - wrist); };
  std::sort(fingers.begin(), fingers.end(),
            [&](const Finger& a, const Finger& b) { return reach(a) < reach(b); });
  Vector3d others = Vector3d::Zero();
  for (std::size_t i = 1; i < fingers.size(); ++i)
    others += (fingers[i].knuckle - wrist) / static_cast<double>(fingers.size() - 1);
  Vector3d across = fingers.front().knuckle - wrist - others;
  const Vector3d outwards = others.normalized();
  across -= across.dot(outwards) * outwards;
  std::sort(fingers.begin() + 1, fingers.end(), [&](const Finger& a, const Finger& b) {
    return across.dot(a.knuckle) > across.dot(b.knuckle);
  });
}

void place_hand(const RigTree& tree, Bone hand_bone, std::size_t first_slot, Rig& rig) {
  const int hand = rig.joint(hand_bone);
  if (hand == kNoJoint) return;
  std::vector<Finger> fingers = fingers_below(tree, hand);
  if (fingers.size() < kFewestFingers || fingers.size() > kMostFingers) return;
  for (Finger& finger : fingers) {
    const auto bones = finger_bones_of(tree, hand, finger.chain, false, false);
    finger.bones.assign(bones.begin(), bones.end());
    finger.knuckle = tree.rest(finger.bones.front());
  }
  const Vector3d wrist = tree.rest(hand);
  sort_from_thumb(wrist, fingers);
  const double thumb_way = (fingers[0].knuckle - wrist).norm();
  double next_way = (fingers[1].knuckle - wrist).norm();
  for (std::size_t i = 1; i < fingers.size(); ++i)
    next_way = std::min(next_way, (fingers[i].knuckle - wrist).norm());
  const bool has_thumb = thumb_way < kThumbOfWay * next_way || fingers.size() == kMostFingers;
  if (has_thumb) {
    const auto bones = finger_bones_of(tree, hand, fingers[0].chain, true, false);
    fingers[0].bones.assign(bones.begin(), bones.end());
  }
  for (std::size_t i = 0; i < fingers.size(); ++i) {
    const std::size_t finger = has_thumb ? i : i + 1;
    for (std::size_t phalanx = 0; phalanx < fingers[i].bones.size(); ++phalanx)
      rig.finger_of[first_slot + kPhalanges * finger + phalanx] = fingers[i].bones[phalanx];
  }
}

}  // namespace

std::span<const int> finger_bones_of(const RigTree& tree, int hand, const std::vector<int>& chain,
                                     bool is_thumb, bool begins_with_palm) {
  const std::span<const int> all(chain);
  if (chain.size() <= kPhalanges) return all;
  const bool ends_in_tip = !has_end(tree, chain.back());
  const double to_first = (tree.rest(chain[0]) - tree.rest(hand)).norm();
  const double to_second = tree.length(chain[1]);
  // A joint of the palm lies near the wrist, and the knuckle follows after a long bone. A thumb's
  // metacarpal does so too, and is a bone of it.
  const bool is_palm = begins_with_palm || chain.size() > kPhalanges + 1 ||
                       (is_thumb ? !ends_in_tip : to_second > to_first);
  return all.subspan(is_palm ? 1 : 0, kPhalanges);
}

void place_fingers_by_shape(const RigTree& tree, Rig& rig) {
  place_hand(tree, Bone::kLeftHand, 0, rig);
  place_hand(tree, Bone::kRightHand, kFingerBoneCount / 2, rig);
}

}  // namespace dance
