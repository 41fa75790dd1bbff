#include "viewer/feed/guest_board.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/allocation_guard.h"
#include "viewer/feed/photon_predictor.h"
#include "viewer/feed/stage_roster.h"

namespace dance {
namespace {

constexpr std::uint64_t kOurClock = 42;
const MonoTime kStart = MonoTime::from_us(1'000'000);

GuestId guest(const std::string& name) { return *GuestId::parse(name); }

Pose pose_at(float x_m, std::uint32_t sequence = 1) {
  Pose pose;
  pose.p_WH_m.x() = x_m;
  pose.sequence = sequence;
  return pose;
}

SceneState scene_of(StageRoster& roster, MonoTime now) {
  SceneState scene;
  roster.update(now, scene);
  return scene;
}

TEST(GuestBoard, ShowsOwnGuestsStraightFromTheCapture) {
  GuestBoard board(kOurClock, false);
  StageRoster roster(board);
  board.on_pose(Where::kCapture, guest("alice"), pose_at(1.0f), kStart);
  board.on_pose(Where::kStage, guest("alice"), pose_at(2.0f), kStart + Duration::ms(1));
  board.on_pose(Where::kStage, guest("bob"), pose_at(3.0f), kStart);
  const SceneState scene = scene_of(roster, kStart + Duration::ms(2));
  ASSERT_EQ(scene.guests.size(), 2u);
  EXPECT_EQ(scene.guests[0].pose.p_WH_m.x(), 1.0f);
  EXPECT_EQ(scene.guests[1].pose.p_WH_m.x(), 3.0f);
}

TEST(GuestBoard, TurnsToTheStageWhenTheCaptureFallsSilent) {
  GuestBoard board(kOurClock, false);
  StageRoster roster(board);
  board.on_pose(Where::kCapture, guest("alice"), pose_at(1.0f), kStart);
  const MonoTime later = kStart + Duration::ms(1500);
  board.on_pose(Where::kStage, guest("alice"), pose_at(2.0f), later);
  EXPECT_EQ(scene_of(roster, later).guests.at(0).pose.p_WH_m.x(), 2.0f);
}

TEST(GuestBoard, TakesTheStageAloneWhenToldTo) {
  GuestBoard board(kOurClock, true);
  StageRoster roster(board);
  board.on_pose(Where::kCapture, guest("alice"), pose_at(1.0f), kStart);
  board.on_pose(Where::kStage, guest("alice"), pose_at(2.0f), kStart);
  EXPECT_EQ(scene_of(roster, kStart).guests.at(0).pose.p_WH_m.x(), 2.0f);
}

TEST(GuestBoard, KeepsTheNewestPose) {
  GuestBoard board(kOurClock, false);
  StageRoster roster(board);
  for (std::uint32_t i = 1; i <= 10; ++i)
    board.on_pose(Where::kStage, guest("bob"), pose_at(static_cast<float>(i), i), kStart);
  EXPECT_EQ(scene_of(roster, kStart).guests.at(0).pose.sequence, 10u);
  EXPECT_EQ(roster.fresh().size(), 1u);
  scene_of(roster, kStart);
  EXPECT_TRUE(roster.fresh().empty()) << "nothing new in the second picture";
}

TEST(GuestBoard, CountsGuestsWhoDoNotFitAndGivesThemTheSlotsOfTheSilent) {
  GuestBoard board(kOurClock, false);
  StageRoster roster(board);
  for (std::size_t i = 0; i < GuestBoard::kMaxGuests + 3; ++i)
    board.on_pose(Where::kStage, guest("g-" + std::to_string(i)), pose_at(0.0f), kStart);
  EXPECT_EQ(board.no_room(), 3u);
  EXPECT_EQ(scene_of(roster, kStart).guests.size(), GuestBoard::kMaxGuests);

  const MonoTime later = kStart + Duration::s(20);
  board.on_pose(Where::kStage, guest("late"), pose_at(7.0f), later);
  EXPECT_EQ(board.no_room(), 3u);
  const SceneState scene = scene_of(roster, later);
  ASSERT_EQ(scene.guests.size(), 1u) << "all others have been silent for long";
  EXPECT_EQ(scene.guests[0].id, guest("late"));
}

TEST(GuestBoard, MeasuresRateAgeAndLossWhereNobodySaysThem) {
  GuestBoard board(kOurClock, false);
  StageRoster roster(board);
  MonoTime now = kStart;
  for (std::uint32_t i = 0; i < 200; ++i) {
    now = kStart + Duration::ms(10) * i;
    if (i % 10 == 5) continue;  // one of ten is lost
    Pose pose = pose_at(0.0f, i);
    pose.clock_id = kOurClock;
    pose.capture_time = now - Duration::ms(7);
    board.on_pose(Where::kStage, guest("bob"), pose, now);
  }
  const GuestFigures figures = scene_of(roster, now).guests.at(0).figures;
  EXPECT_NEAR(figures.arrival_hz, 90.0f, 2.0f);
  ASSERT_TRUE(figures.age_ms);
  EXPECT_NEAR(*figures.age_ms, 7.0f, 0.01f);
  ASSERT_TRUE(figures.loss_percent);
  EXPECT_NEAR(*figures.loss_percent, 10.0f, 1.0f);
}

TEST(GuestBoard, ShowsWhoSpeaksAndHowLoudUntilTheVoiceIsGone) {
  GuestBoard board(kOurClock, false);
  StageRoster roster(board);
  Voice voice;
  const auto loudness_at = [&](int level_dbfs, Duration later) {
    voice.level_dbfs = level_dbfs;
    board.on_voice(guest("bob"), voice, kStart);
    board.on_pose(Where::kStage, guest("bob"), pose_at(0.0f), kStart + later);
    return scene_of(roster, kStart + later).guests.at(0).voice;
  };
  EXPECT_GT(loudness_at(-25, Duration()), 0.5f);
  EXPECT_GT(loudness_at(-15, Duration()), loudness_at(-40, Duration()));
  EXPECT_EQ(loudness_at(kSilence_dbfs, Duration()), 0.0f);
  EXPECT_EQ(loudness_at(-25, Duration::ms(400)), 0.0f);
}

TEST(GuestBoard, ShowsVoiceMarksOfOtherHousesUntilTheLinkIsSilent) {
  GuestBoard board(kOurClock, false);
  StageRoster roster(board);
  VoiceState state;
  const auto mark = [&](Duration later) {
    board.on_pose(Where::kStage, guest("bob"), pose_at(0.0f), kStart + later);
    const SceneState scene = scene_of(roster, kStart + later);
    EXPECT_TRUE(scene.voices.empty()) << "the keys of this window are not theirs";
    return scene.guests.at(0).voice_mark;
  };
  state.is_heard = false;
  board.on_remote_voice_state(guest("bob"), state, kStart);
  EXPECT_EQ(mark(Duration()), VoiceMark::kNone);
  state.is_heard = true;
  board.on_remote_voice_state(guest("bob"), state, kStart);
  EXPECT_EQ(mark(Duration()), VoiceMark::kTalking);
  state.is_muted = true;
  board.on_remote_voice_state(guest("bob"), state, kStart);
  EXPECT_EQ(mark(Duration()), VoiceMark::kMuted);
  EXPECT_EQ(mark(Duration::s(2)), VoiceMark::kMuted);
  EXPECT_EQ(mark(Duration::s(4)), VoiceMark::kNone);
}

TEST(GuestBoard, ShowsHowThisHousesGuestsSpeakUntilTheirVoicesAreGone) {
  GuestBoard board(kOurClock, false);
  StageRoster roster(board);
  VoiceState state;
  state.is_muted = true;
  board.on_voice_state(guest("dora"), VoiceState(), kStart);  // who does not dance
  board.on_voice_state(guest("bob"), state, kStart);
  board.on_pose(Where::kStage, guest("bob"), pose_at(0.0f), kStart);
  board.on_pose(Where::kStage, guest("amy"), pose_at(0.0f), kStart);
  SceneState scene = scene_of(roster, kStart);
  ASSERT_EQ(scene.voices.size(), 2u);
  EXPECT_EQ(scene.voices[0].guest, guest("bob")) << "by name";
  EXPECT_TRUE(scene.voices[0].is_muted);
  EXPECT_FALSE(scene.voices[1].is_muted);
  EXPECT_EQ(scene.guests.at(0).voice_mark, VoiceMark::kNone);
  EXPECT_EQ(scene.guests.at(1).voice_mark, VoiceMark::kMuted);
  // At once, without another pose.
  state.is_muted = false;
  board.on_voice_state(guest("bob"), state, kStart + Duration::ms(100));
  scene = scene_of(roster, kStart + Duration::ms(100));
  EXPECT_EQ(scene.guests.at(1).voice_mark, VoiceMark::kNone);
  board.on_pose(Where::kStage, guest("bob"), pose_at(0.0f, 2), kStart + Duration::s(4));
  EXPECT_TRUE(scene_of(roster, kStart + Duration::s(4)).voices.empty());
  // More than fit: those that were heard last.
  for (int i = 0; i < 40; ++i)
    board.on_voice_state(guest("g" + std::to_string(i)), state, kStart + Duration::ms(5000 + i));
  scene = scene_of(roster, kStart + Duration::ms(5100));
  EXPECT_EQ(scene.voices.size(), VoiceBoard::kMostVoices);
  EXPECT_EQ(scene.voices.front().guest, guest("g24"));
}

TEST(GuestBoard, SaysNoAgeOfPosesStampedByAnotherClock) {
  GuestBoard board(kOurClock, false);
  StageRoster roster(board);
  for (std::uint32_t i = 0; i < 200; ++i) {
    Pose pose = pose_at(0.0f, i);
    pose.clock_id = kOurClock + 1;
    pose.capture_time = kStart;
    board.on_pose(Where::kStage, guest("bob"), pose, kStart + Duration::ms(10) * i);
  }
  EXPECT_FALSE(scene_of(roster, kStart + Duration::s(2)).guests.at(0).figures.age_ms);
}

TEST(GuestBoard, BelievesTheManagersFiguresWhileTheyAreFresh) {
  GuestBoard board(kOurClock, false);
  StageRoster roster(board);
  GuestStatus status;
  status.alive = true;
  status.arrival_hz = 33.0f;
  status.age_p50_ms = 21.0f;
  status.received = 75;
  status.lost = 25;
  board.on_status(guest("bob"), status, kStart);
  board.on_pose(Where::kStage, guest("bob"), pose_at(0.0f), kStart + Duration::ms(1));
  const GuestFigures figures = scene_of(roster, kStart + Duration::ms(2)).guests.at(0).figures;
  EXPECT_EQ(figures.arrival_hz, 33.0f);
  EXPECT_EQ(figures.age_ms, 21.0f);
  EXPECT_EQ(figures.loss_percent, 25.0f);
}

TEST(GuestBoard, KeepsWhatCameBesideWhatIsStagedInAnyHouse) {
  GuestBoard board(kOurClock, false);
  StageRoster roster(board);
  board.on_pose(Where::kGuest, guest("bob"), pose_at(1.0f, 1), kStart);
  EXPECT_TRUE(scene_of(roster, kStart).guests.empty()) << "not on the stage, not shown";
  EXPECT_EQ(board.poses(), 0u);
  board.on_pose(Where::kStage, guest("bob"), pose_at(2.0f, 1), kStart + Duration::ms(1));
  board.on_pose(Where::kGuest, guest("bob"), pose_at(3.0f, 2), kStart + Duration::ms(2));
  // This house's own dancer comes by capture, and by the link too when it hears itself.
  board.on_pose(Where::kCapture, guest("alice"), pose_at(4.0f, 1), kStart + Duration::ms(1));
  board.on_pose(Where::kGuest, guest("alice"), pose_at(5.0f, 1), kStart + Duration::ms(1));
  board.on_pose(Where::kStage, guest("alice"), pose_at(6.0f, 1), kStart + Duration::ms(2));
  const SceneState scene = scene_of(roster, kStart + Duration::ms(3));
  ASSERT_EQ(scene.guests.size(), 2u);
  const SceneGuest& alice = scene.guests[0];
  const SceneGuest& bob = scene.guests[1];
  EXPECT_EQ(alice.pose.p_WH_m.x(), 4.0f) << "shown straight from the capture, as ever";
  ASSERT_TRUE(alice.arriving && alice.staged && bob.arriving && bob.staged);
  EXPECT_EQ(alice.arriving->p_WH_m.x(), 4.0f);
  EXPECT_EQ(alice.staged->p_WH_m.x(), 6.0f);
  EXPECT_EQ(bob.pose.p_WH_m.x(), 2.0f);
  EXPECT_EQ(bob.arriving->p_WH_m.x(), 3.0f);
  EXPECT_EQ(bob.staged->p_WH_m.x(), 2.0f);
}

TEST(StageRoster, TellsAPoseOnceThoughTheOtherHalfOfAComparisonGoesOn) {
  GuestBoard board(kOurClock, false);
  StageRoster roster(board);
  board.on_pose(Where::kStage, guest("bob"), pose_at(1.0f, 1), kStart);
  scene_of(roster, kStart);
  EXPECT_EQ(roster.fresh().size(), 1u);
  board.on_pose(Where::kGuest, guest("bob"), pose_at(2.0f, 2), kStart + Duration::ms(5));
  scene_of(roster, kStart + Duration::ms(6));
  EXPECT_TRUE(roster.fresh().empty()) << "what is shown has not changed";
}

TEST(PhotonPredictor, BringsPosesOfKnownMomentsToTheLightAndLeavesOthers) {
  GuestBoard board(kOurClock, false);
  StageRoster roster(board);
  PhotonPredictor predictor;
  SceneState scene;
  MonoTime now = kStart;
  for (std::uint32_t i = 0; i < 10; ++i, now += Duration::ms(16)) {
    Pose pose = pose_at(0.016f * static_cast<float>(i), i);  // a metre a second
    pose.clock_id = kOurClock;
    pose.capture_time = now - Duration::ms(2);
    board.on_pose(Where::kCapture, guest("alice"), pose, now);
    pose.stamp(Hop::kStaged, now - Duration::ms(1));
    pose.capture_time = now - Duration::ms(80);
    board.on_pose(Where::kStage, guest("bob"), pose, now);
    pose.clock_id = kOurClock + 1;
    board.on_pose(Where::kStage, guest("carl"), pose, now);
    roster.update(now, scene);
    predictor.observe(roster.fresh());
  }
  const MonoTime last = now - Duration::ms(16);
  predictor.predict(last + Duration::ms(14), scene);
  ASSERT_EQ(scene.guests.size(), 3u);
  EXPECT_NEAR(scene.guests[0].pose.p_WH_m.x(), 0.144f + 0.0145f, 1e-3f) << "since its capture";
  EXPECT_NEAR(scene.guests[1].pose.p_WH_m.x(), 0.144f + 0.0137f, 1e-3f) << "since it was staged";
  EXPECT_FLOAT_EQ(scene.guests[2].pose.p_WH_m.x(), 0.144f) << "another clock";
}

TEST(PhotonPredictor, AllocatesNothing) {
  GuestBoard board(kOurClock, false);
  StageRoster roster(board);
  PhotonPredictor predictor;
  SceneState scene;
  MonoTime now = kStart;
  for (std::uint32_t i = 0; i < 10; ++i, now += Duration::ms(16)) {
    Pose pose = pose_at(0.0f, i);
    pose.clock_id = kOurClock;
    pose.capture_time = now;
    board.on_pose(Where::kCapture, guest("alice"), pose, now);
    roster.update(now, scene);
    const AllocationGuard guard;
    predictor.observe(roster.fresh());
    predictor.predict(now + Duration::ms(16), scene);
    EXPECT_EQ(guard.allocations(), 0u);
  }
}

TEST(GuestBoard, AllocatesNothingPerPose) {
  GuestBoard board(kOurClock, false);
  const GuestId bob = guest("bob");
  const Pose pose = pose_at(1.0f);
  const AllocationGuard guard;
  for (int i = 0; i < 100; ++i) board.on_pose(Where::kStage, bob, pose, kStart);
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(StageRoster, FadesOutTheSilentAndWelcomesThemBack) {
  GuestBoard board(kOurClock, false);
  StageRoster roster(board);
  board.on_pose(Where::kStage, guest("bob"), pose_at(0.0f), kStart);
  EXPECT_EQ(scene_of(roster, kStart + Duration::ms(2900)).guests.at(0).opacity, 1.0f);
  const float fading = scene_of(roster, kStart + Duration::ms(3400)).guests.at(0).opacity;
  EXPECT_GT(fading, 0.3f);
  EXPECT_LT(fading, 0.7f);
  EXPECT_TRUE(scene_of(roster, kStart + Duration::s(5)).guests.empty());
  board.on_pose(Where::kStage, guest("bob"), pose_at(0.0f), kStart + Duration::s(6));
  EXPECT_EQ(scene_of(roster, kStart + Duration::s(6)).guests.at(0).opacity, 1.0f);
}

TEST(StageRoster, GivesHandsOnlyWhileTheyAreSent) {
  GuestBoard board(kOurClock, false);
  StageRoster roster(board);
  board.on_hands(Where::kStage, guest("bob"), Hands(), kStart);
  board.on_pose(Where::kStage, guest("bob"), pose_at(0.0f), kStart);
  EXPECT_TRUE(scene_of(roster, kStart).guests.at(0).hands);
  board.on_pose(Where::kStage, guest("bob"), pose_at(0.0f), kStart + Duration::s(2));
  EXPECT_FALSE(scene_of(roster, kStart + Duration::s(2)).guests.at(0).hands);
}

TEST(StageRoster, GivesFacesOnlyWhileTheyAreSeen) {
  GuestBoard board(kOurClock, false);
  StageRoster roster(board);
  Face face;
  face.presence = kFaceSeen;
  face[Expression::kJawOpen] = 0.5f;
  board.on_face(guest("bob"), face, kStart);
  EXPECT_TRUE(scene_of(roster, kStart).guests.empty()) << "a face alone is nobody";
  board.on_pose(Where::kStage, guest("bob"), pose_at(0.0f), kStart);
  const auto shown = scene_of(roster, kStart).guests.at(0).face;
  ASSERT_TRUE(shown.has_value());
  EXPECT_EQ((*shown)[Expression::kJawOpen], 0.5f);
  board.on_pose(Where::kStage, guest("bob"), pose_at(0.0f), kStart + Duration::s(2));
  EXPECT_FALSE(scene_of(roster, kStart + Duration::s(2)).guests.at(0).face) << "long ago";
  face.presence = 0;
  board.on_face(guest("bob"), face, kStart + Duration::s(2));
  board.on_pose(Where::kStage, guest("bob"), pose_at(0.0f), kStart + Duration::ms(2010));
  EXPECT_FALSE(scene_of(roster, kStart + Duration::ms(2010)).guests.at(0).face) << "not seen";
}

TEST(ArrivalMeter, TakesASenderThatBeginsAnewForNoLoss) {
  ArrivalMeter meter;
  MonoTime now = kStart;
  for (std::uint32_t i = 5000; i < 5100; ++i) meter.on_pose(i, now += Duration::ms(10), {});
  for (std::uint32_t i = 0; i < 150; ++i) meter.on_pose(i, now += Duration::ms(10), {});
  ASSERT_TRUE(meter.figures().loss_percent);
  EXPECT_EQ(*meter.figures().loss_percent, 0.0f);
}

TEST(ArrivalMeter, TakesDisorderForNoLoss) {
  ArrivalMeter meter;
  MonoTime now = kStart;
  for (std::uint32_t i = 0; i < 200; i += 2)
    for (const std::uint32_t sequence : {i + 1, i})
      meter.on_pose(sequence, now += Duration::ms(10), {});
  EXPECT_EQ(*meter.figures().loss_percent, 0.0f);
}

}  // namespace
}  // namespace dance
