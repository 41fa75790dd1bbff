#include "producers/camera/advice/camera_advice.h"

#include <gtest/gtest.h>

#include <functional>

#include "tests/allocation_guard.h"
#include "tests/formats/camera_view/drawn_view.h"

namespace dance {
namespace {

// Ten pictures a second.
class Watcher {
 public:
  Watcher() { advice.note(running_status()); }
  void see(const CameraFacts& facts, double seconds) {
    for (int i = 0; i < static_cast<int>(seconds * 10.0); ++i) {
      now += Duration::ms(100);
      const Text before = advice.texts().front();
      advice.see(facts, now);
      if (advice.texts().front() != before) ++changes;
    }
  }
  std::vector<Text> texts() const { return {advice.texts().begin(), advice.texts().end()}; }

  CameraAdvice advice;
  MonoTime now = MonoTime::from_us(1'000'000);
  int changes = 0;
};

using Texts1 = std::vector<Text>;

struct Seen {
  Text text;
  std::function<void(CameraFacts&)> change;
};

void hide(CameraFacts& facts, std::size_t from) {
  for (std::size_t i = from; i < kSeenPoints; ++i) facts.body.points[i].visibility = 0.15f;
}

const std::vector<Seen> kTroubles{
    {Text::kCameraLensCovered,
     [](CameraFacts& f) {
       f.light = {0.02f, 0.03f, 0.0f, 0.02f, 0.02f}, f.body = {};
     }},
    {Text::kCameraTooDark,
     [](CameraFacts& f) {
       f.light = {0.1f, 0.3f, 0.0f, 0.1f, 0.1f};
     }},
    {Text::kCameraTooBright,
     [](CameraFacts& f) {
       f.light = {0.9f, 0.3f, 0.6f, 0.9f, 0.9f};
     }},
    {Text::kCameraBackLight,
     [](CameraFacts& f) {
       f.light = {0.6f, 0.9f, 0.2f, 0.2f, 0.7f};
     }},
    {Text::kCameraNobody, [](CameraFacts& f) { f.body = {}; }},
    {Text::kCameraHeadCutOff, [](CameraFacts& f) { f.body = standing_in(0.9f, -0.1f); }},
    {Text::kCameraFeetCutOff, [](CameraFacts& f) { f.body = standing_in(0.9f, 0.25f); }},
    {Text::kCameraStepBack, [](CameraFacts& f) { f.body = standing_in(1.4f, -0.2f); }},
    {Text::kCameraLegsHidden, [](CameraFacts& f) { hide(f, 25); }},
    {Text::kCameraComeCloser, [](CameraFacts& f) { f.body = standing_in(0.25f, 0.3f); }},
    {Text::kCameraStepToMiddle, [](CameraFacts& f) { f.body = standing_in(0.75f, 0.12f, 0.9f); }},
    {Text::kCameraShakes, [](CameraFacts& f) { f.shake = 0.05f; }},
    {Text::kCameraSlow, [](CameraFacts& f) { f.pictures_hz = 12.0f; }},
    {Text::kCameraHandsCutOff, [](CameraFacts& f) { f.body.points[15].x = 1.1f; }},
};

TEST(CameraAdvice, ADancerWhoIsSeenFromHeadToFeetIsToldSo) {
  Watcher watcher;
  EXPECT_EQ(watcher.texts(), Texts1{Text::kCameraOpening});
  watcher.see(good_facts(), 1.0);
  EXPECT_EQ(watcher.texts(), Texts1{Text::kCameraSeenWhole});
  EXPECT_TRUE(watcher.advice.is_good());
}

TEST(CameraAdvice, EachTroubleIsToldAndItsEndToo) {
  for (const Seen& trouble : kTroubles) {
    Watcher watcher;
    watcher.see(good_facts(), 2.0);
    CameraFacts facts = good_facts();
    trouble.change(facts);
    watcher.see(facts, 0.8);
    EXPECT_TRUE(watcher.advice.is_good())
        << "for less than a second: " << Texts(Language::kEnglish)[trouble.text];
    watcher.see(facts, 2.0);
    EXPECT_EQ(watcher.texts(), Texts1{trouble.text}) << Texts(Language::kEnglish)[trouble.text];
    watcher.see(good_facts(), 2.0);
    EXPECT_TRUE(watcher.advice.is_good()) << Texts(Language::kEnglish)[trouble.text];
  }
}

TEST(CameraAdvice, NoPoseNetworkIsTold) {
  Watcher watcher;
  CameraStatus status = running_status();
  status.has_network = false;
  watcher.advice.note(status);
  CameraFacts facts = good_facts();
  facts.body = {};
  watcher.see(facts, 3.0);
  EXPECT_EQ(watcher.texts(), Texts1{Text::kCameraNoNetwork});
}

// Each measure goes back and forth across the limit at which its text begins, by less than the two
// limits are apart.
TEST(CameraAdvice, NoTextFlickersAtItsLimit) {
  Watcher watcher;
  watcher.see(good_facts(), 2.0);
  watcher.changes = 0;
  for (int i = 0; i < 100; ++i) {
    CameraFacts facts = good_facts();
    facts.light.mean = i % 4 < 2 ? 0.135f : 0.165f;
    watcher.see(facts, 0.7);
  }
  EXPECT_EQ(watcher.texts(), Texts1{Text::kCameraTooDark});
  EXPECT_EQ(watcher.changes, 1);
}

TEST(CameraAdvice, AMomentOutOfThePictureIsNoTrouble) {
  Watcher watcher;
  watcher.see(good_facts(), 2.0);
  watcher.changes = 0;
  CameraFacts facts = good_facts();
  facts.body.points[15].x = 1.2f;
  for (int i = 0; i < 20; ++i) {
    watcher.see(facts, 0.7);
    watcher.see(good_facts(), 0.7);
  }
  EXPECT_EQ(watcher.changes, 0);
}

TEST(CameraAdvice, WhatMattersMostIsSaidFirstAndNoMoreThanThree) {
  Watcher watcher;
  CameraFacts facts = good_facts();
  facts.light.mean = 0.1f;
  facts.body = standing_in(0.9f, 0.25f, 0.92f);
  facts.shake = 0.1f;
  facts.pictures_hz = 10.0f;
  watcher.see(facts, 3.0);
  EXPECT_EQ(watcher.texts(),
            (Texts1{Text::kCameraTooDark, Text::kCameraFeetCutOff, Text::kCameraStepToMiddle}));
}

TEST(CameraAdvice, ACameraThatDoesNotRunSaysWhy) {
  const auto text = [](CameraState state, CameraCause cause) {
    CameraStatus status;
    status.state = state;
    status.cause = cause;
    CameraAdvice advice;
    advice.note(status);
    advice.see(good_facts(), MonoTime::from_us(1));
    EXPECT_EQ(advice.texts().size(), 1u);
    return advice.texts().front();
  };
  using enum CameraState;
  EXPECT_EQ(text(kOpening, CameraCause::kNone), Text::kCameraOpening);
  EXPECT_EQ(text(kUnplugged, CameraCause::kNone), Text::kCameraUnplugged);
  EXPECT_EQ(text(kSilent, CameraCause::kNone), Text::kCameraSilent);
  EXPECT_EQ(text(kFailed, CameraCause::kInUse), Text::kCameraInUse);
  EXPECT_EQ(text(kFailed, CameraCause::kAbsent), Text::kCameraNone);
  EXPECT_EQ(text(kFailed, CameraCause::kNoPermission), Text::kCameraNoPermission);
  EXPECT_EQ(text(kFailed, CameraCause::kOther), Text::kCameraFailed);
}

TEST(CameraAdvice, ACameraThatIsBackBeginsAnew) {
  Watcher watcher;
  CameraFacts dark = good_facts();
  dark.light.mean = 0.1f;
  watcher.see(dark, 2.0);
  CameraStatus gone = running_status();
  gone.state = CameraState::kUnplugged;
  watcher.advice.note(gone);
  EXPECT_EQ(watcher.texts(), Texts1{Text::kCameraUnplugged});
  watcher.advice.note(running_status());
  watcher.see(good_facts(), 1.0);
  EXPECT_TRUE(watcher.advice.is_good());
}

TEST(CameraAdvice, AllocatesNothing) {
  CameraAdvice advice;
  advice.note(running_status());
  const CameraFacts facts = good_facts();
  AllocationGuard guard;
  for (int i = 0; i < 100; ++i) advice.see(facts, MonoTime::from_us(1 + i * 100'000));
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace dance
