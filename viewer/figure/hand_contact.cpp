#include "viewer/figure/hand_contact.h"

#include <algorithm>
#include <cmath>

#include "core/motion/saturated.h"
#include "viewer/figure/arm_fit.h"
#include "viewer/figure/limb_fit.h"

namespace dance {
namespace {

using Eigen::Vector3f;

constexpr float kTogether_m = 0.08f;  // palms closer than this are held together …
constexpr float kApart_m = 0.32f;     // … and beyond this let go
constexpr float kOnBody_m = 0.03f;    // likewise of palms and a partner's skin
constexpr float kOffBody_m = 0.16f;
constexpr float kMostBodyPull_m = 0.25f;
constexpr float kOutward = 1.5f;      // of hands that come too near to their own shoulder
constexpr float kFastest_m_s = 2.5f;  // at which what is added to a palm's place changes
constexpr float kOff_m = 1e-5f;
constexpr int kSweeps = 10;          // with arms alone, and again with help
constexpr float kArmsLength = 1.4f;  // of the height of the hips, from there to the finger tips

// A sweep's share, so that all of them leave 1 - weight.
float share_of(float weight) {
  return 1.0f - std::pow(1.0f - std::min(weight, 1.0f), 0.5f / static_cast<float>(kSweeps));
}

// A body's parts that hands come to lie on, as capsules between joints that every figure has.
struct BodyEnds {
  Vector3f a;
  Vector3f b;
};
struct BodyPiece {
  float radius;  // of a dancer's hips' height
  bool is_trunk;
};
constexpr std::array<BodyPiece, 6> kPieces{{{0.13f, true},
                                            {0.085f, true},
                                            {0.05f, false},
                                            {0.05f, false},
                                            {0.04f, false},
                                            {0.04f, false}}};

std::array<BodyEnds, kPieces.size()> ends_of(const BodyFrames& at) {
  const Vector3f hips =
      0.5f * (at.position(Bone::kLeftUpperLeg) + at.position(Bone::kRightUpperLeg));
  const Vector3f &left = at.position(Bone::kLeftUpperArm),
                 &right = at.position(Bone::kRightUpperArm);
  const Vector3f neck = 0.5f * (left + right);
  return {{{hips, neck},
           {left, right},
           {left, at.position(Bone::kLeftLowerArm)},
           {right, at.position(Bone::kRightLowerArm)},
           {at.position(Bone::kLeftLowerArm), at.position(Bone::kLeftHand)},
           {at.position(Bone::kRightLowerArm), at.position(Bone::kRightHand)}}};
}

}  // namespace

void HandContacts::reserve(std::size_t figures) {
  hands_.reserve(2 * figures);
  contacts_.reserve(std::min(kMostContacts, figures + 4 * figures * figures));
  near_.reserve(std::min(kMostContacts, figures * figures / 2));
}

void HandContacts::list_hands(std::span<const FigureFit> figures) {
  hands_.clear();
  for (const FigureFit& fit : figures)
    for (std::size_t side = 0; side < 2; ++side) {
      Hand hand;
      hand.danced_W_m = fit.danced_palm_W_m(side);
      hand.natural_W_m = hand.wanted_W_m = fit.palm_W_m(side);
      hand.from_palm_m = fit.frames.position(kArmLimbs[side].end) - hand.natural_W_m;
      hand.shoulder_W_m = fit.frames.position(kArmLimbs[side].upper);
      hand.reach_m =
          std::max(arm_reach_m(fit, side),
                   (fit.frames.position(kArmLimbs[side].end) - hand.shoulder_W_m).norm());
      hand.help_m = arm_help_m(fit, side);
      hand.folded_m =
          std::min(kFoldedLimb / kStraightLimb * arm_reach_m(fit, side),
                   (fit.frames.position(kArmLimbs[side].end) - hand.shoulder_W_m).norm());
      hand.danced_arm_m =
          fit.danced.position(kArmLimbs[side].end) - fit.danced.position(kArmLimbs[side].upper);
      hands_.push_back(hand);
    }
}

void HandContacts::add_pair(std::size_t a, std::size_t b) {
  const Vector3f danced_m = hands_[b].danced_W_m - hands_[a].danced_W_m;
  const float distance2 = danced_m.squaredNorm();
  if (distance2 >= kApart_m * kApart_m || contacts_.size() >= kMostContacts) return;
  Contact contact;
  contact.a = static_cast<std::uint32_t>(a);
  contact.b = static_cast<std::int32_t>(b);
  contact.wanted_m = danced_m;
  contact.weight = smooth_between(kApart_m, kTogether_m, std::sqrt(distance2));
  for (const std::size_t hand : {a, b})
    hands_[hand].held = std::max(hands_[hand].held, contact.weight);
  contacts_.push_back(contact);
}

// The palm's place seen from the nearest points of a body's pieces, the nearer the more it counts:
// so a hand that slides from the back to the shoulder does not jump.
void HandContacts::add_body(std::size_t index, const FigureFit& body) {
  const Hand& hand = hands_[index];
  if (hand.held >= 1.0f) return;  // it holds a hand
  const float size_m =
      body.rig->leg_ratio > 0.0f ? body.rig->body.hips_height_m() / body.rig->leg_ratio : 0.0f;
  const auto danced = ends_of(body.danced), shown = ends_of(body.frames);
  Vector3f sum = Vector3f::Zero();
  float weights = 0.0f, most = 0.0f;
  for (std::size_t i = 0; i < kPieces.size(); ++i) {
    const Vector3f along = danced[i].b - danced[i].a;
    const float length2 = std::max(along.squaredNorm(), 1e-6f);
    const float t = std::clamp(along.dot(hand.danced_W_m - danced[i].a) / length2, 0.0f, 1.0f);
    const Vector3f off = hand.danced_W_m - danced[i].a - t * along;
    const float radius = kPieces[i].radius * size_m;
    const float distance = off.norm();
    const float weight = smooth_between(kOffBody_m, kOnBody_m, distance - radius);
    if (weight <= 0.0f) continue;
    // As far from the skin as danced; the trunk is as much broader as its shoulders are.
    const float girth = kPieces[i].is_trunk ? body.rig->girth_ratio : 1.0f;
    const float from_axis = std::min(distance, radius) * girth + std::max(distance - radius, 0.0f);
    const float longer = distance > 1e-4f ? from_axis / distance : 1.0f;
    const float counts = weight * weight;
    sum += counts * (shown[i].a + t * (shown[i].b - shown[i].a) + longer * off);
    weights += counts;
    most = std::max(most, weight);
  }
  if (weights <= 0.0f || contacts_.size() >= kMostContacts) return;
  Contact contact;
  contact.a = static_cast<std::uint32_t>(index);
  contact.wanted_m =
      hand.natural_W_m + saturated(sum / weights - hand.natural_W_m, kMostBodyPull_m);
  contact.weight = most * (1.0f - hand.held);
  contacts_.push_back(contact);
}

void HandContacts::find(std::span<const FigureFit> figures) {
  contacts_.clear();
  near_.clear();
  for (std::size_t i = 0; i < figures.size(); ++i) {
    const FigureFit& one = figures[i];
    add_pair(2 * i, 2 * i + 1);
    for (std::size_t j = i + 1; j < figures.size(); ++j) {
      const FigureFit& other = figures[j];
      const float reach = kArmsLength * (one.danced.p_WB_m[0].y() + other.danced.p_WB_m[0].y());
      const float nearest = std::max(reach, 2.0f);
      if ((one.danced.p_WB_m[0] - other.danced.p_WB_m[0]).squaredNorm() > nearest * nearest)
        continue;
      for (std::size_t k = 0; k < 4; ++k) add_pair(2 * i + k / 2, 2 * j + k % 2);
      if (near_.size() < kMostContacts)
        near_.emplace_back(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j));
    }
  }
  for (const auto& [i, j] : near_)
    for (std::size_t side = 0; side < 2; ++side) {
      add_body(2 * i + side, figures[j]);
      add_body(2 * j + side, figures[i]);
    }
  settle_shares();
}

// A hand that is near two others follows the one that it is nearer to.
void HandContacts::settle_shares() {
  for (Contact& contact : contacts_) {
    float held = hands_[contact.a].held;
    if (contact.b >= 0) {
      // Two arms' own directions add up to where neither body is.
      Hand &a = hands_[contact.a], &b = hands_[static_cast<std::size_t>(contact.b)];
      const Vector3f outward = contact.weight * (a.danced_arm_m + b.danced_arm_m);
      a.outward += outward;
      b.outward += outward;
      held = std::max(held, hands_[static_cast<std::size_t>(contact.b)].held);
      const float rank = contact.weight / std::max(held, 1e-6f);
      contact.weight *= rank * rank;
    }
    contact.weight = share_of(contact.weight);
  }
}

// Whether any contact is not as it is danced.
bool HandContacts::is_off() const {
  return std::ranges::any_of(contacts_, [&](const Contact& contact) {
    const Hand& a = hands_[contact.a];
    const Vector3f is =
        contact.b < 0
            ? a.natural_W_m
            : Vector3f(hands_[static_cast<std::size_t>(contact.b)].natural_W_m - a.natural_W_m);
    return (is - contact.wanted_m).cwiseAbs().maxCoeff() > kOff_m;
  });
}

void HandContacts::relax(bool with_help) {
  for (Hand& hand : hands_) {
    hand.pull.setZero();
    hand.pull_weight = 0.0f;
  }
  for (const Contact& contact : contacts_) {
    Hand& a = hands_[contact.a];
    a.pull_weight += contact.weight;
    if (contact.b < 0) {
      a.pull += contact.weight * (contact.wanted_m - a.wanted_W_m);
      continue;
    }
    Hand& b = hands_[static_cast<std::size_t>(contact.b)];
    const Vector3f half =
        (0.5f * contact.weight) * (b.wanted_W_m - a.wanted_W_m - contact.wanted_m);
    a.pull += half;
    b.pull -= half;
    b.pull_weight += contact.weight;
  }
  for (Hand& hand : hands_) {
    if (hand.pull_weight <= 0.0f) continue;
    hand.wanted_W_m += hand.pull / std::max(hand.pull_weight, 1.0f);
    hand.wanted_W_m = reachable(hand, hand.wanted_W_m, with_help ? hand.help_m : 0.0f);
  }
}

// The nearest place for the palm that the arm reaches, and that is not in its own shoulder.
Vector3f HandContacts::reachable(const Hand& hand, const Vector3f& palm_W_m, float help_m) {
  const Vector3f wrist = palm_W_m + hand.from_palm_m - hand.shoulder_W_m;
  const float reach = hand.reach_m + help_m;
  const float distance = wrist.norm();
  if (distance > reach) return palm_W_m - wrist * (1.0f - reach / distance);
  if (distance >= hand.folded_m) return palm_W_m;
  const float size = hand.outward.norm();
  Vector3f towards = wrist;
  if (size > 1e-3f) towards += (kOutward * (hand.folded_m - distance) / size) * hand.outward;
  const float length = towards.norm();
  if (length < 1e-4f) return palm_W_m;
  return palm_W_m + towards * (hand.folded_m / length) - wrist;
}

void HandContacts::fit(std::span<FigureFit> figures) {
  list_hands(figures);
  find(figures);
  if (is_off()) {
    for (int sweep = 0; sweep < kSweeps; ++sweep) relax(false);
    for (int sweep = 0; sweep < kSweeps; ++sweep) relax(true);
  }
  for (std::size_t i = 0; i < figures.size(); ++i) {
    std::array<std::optional<Vector3f>, 2> palms;
    for (std::size_t side = 0; side < 2; ++side) {
      const Hand& hand = hands_[2 * i + side];
      const Vector3f correction =
          reachable(hand, hand.natural_W_m + shown_correction(hand, figures[i], side),
                    hand.help_m) -
          hand.natural_W_m;
      if (figures[i].past) figures[i].past->corrections_W_m[side] = correction;
      if (correction.cwiseAbs().maxCoeff() > kOff_m) palms[side] = hand.natural_W_m + correction;
    }
    fit_arms(palms, figures[i]);
  }
}

// A palm's correction changes no faster than an arm may: contacts that begin or end abruptly do not
// show as a jump.
Vector3f HandContacts::shown_correction(const Hand& hand, const FigureFit& figure,
                                        std::size_t side) const {
  const Vector3f wanted = hand.wanted_W_m - hand.natural_W_m;
  if (!figure.past || !figure.past->is_known) return wanted;
  const Vector3f change = wanted - figure.past->corrections_W_m[side];
  const float size = change.norm(), most = kFastest_m_s * figure.past->passed_s;
  return size <= most ? wanted
                      : Vector3f(figure.past->corrections_W_m[side] + change * (most / size));
}

}  // namespace dance
