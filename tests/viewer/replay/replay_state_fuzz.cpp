// libFuzzer target: any bytes as the state of a checkpoint, as an index that came along with a log
// is a stranger's: what a board takes over is drawn from as any other, and carried on.
#include <cstddef>
#include <cstdint>

#include "core/base/assert.h"
#include "tests/fuzz_target.h"
#include "viewer/feed/guest_board.h"
#include "viewer/feed/stage_roster.h"
#include "viewer/replay/state_bytes.h"

DANCE_FUZZ_TARGET(replay_state) {
  using namespace dance;
  constexpr std::uint64_t kClock = 7;
  static GuestBoard board(kClock, false);
  static StageRoster roster(board);
  board.clear(kClock);
  StateReader reader({data, size});
  board.carry(reader, [](const GuestId&, bool) { return false; });
  if (!reader.is_fine()) board.clear(kClock);

  const GuestId guest = *GuestId::parse("alice");
  Pose pose;
  pose.clock_id = kClock;
  SceneState scene;
  for (int i = 0; i < 3; ++i) {
    const MonoTime now = MonoTime() + Duration::seconds(500.0 + i);
    pose.sequence = static_cast<std::uint32_t>(i);
    pose.capture_time = now;
    pose.music_beats = 2.0 * i;
    board.on_pose(Where::kStage, guest, pose, now);
    roster.update(now, scene);
    for (const SceneGuest& shown : scene.guests) {
      DANCE_ASSERT(is_valid(shown.skeleton));
      DANCE_ASSERT(std::isfinite(shown.opacity));
    }
    if (scene.music) DANCE_ASSERT(std::isfinite(scene.music->beats));
  }
  ReplayStateWriter writer;
  board.carry(writer, [](const GuestId&, bool) { return true; });
  return 0;
}
