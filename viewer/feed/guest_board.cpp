#include "viewer/feed/guest_board.h"

namespace dance {
namespace {
// How long one source of a guest's poses takes precedence after its last pose.
constexpr Duration kSourceHolds = Duration::s(1);
// How long an own guest is shown from the stage after arms that reached; and at most after a staged
// pose, so that a stage that ends leaves the capture.
constexpr Duration kReachHolds = Duration::ms(500);
constexpr Duration kStageHolds = Duration::ms(250);
constexpr Duration kStatusHolds = Duration::s(3);
// Eviction: after so much silence a slot may go to another guest; by then this one has faded out.
constexpr Duration kSlotHolds = Duration::s(10);

bool is_fresh(MonoTime heard, MonoTime now, Duration holds) {
  return heard.is_set() && now - heard < holds;
}

// More than the bus rounds; less than can be seen.
bool has_other_rotations(const Pose& a, const Pose& b) {
  constexpr float kSame = 1e-4f;
  for (std::size_t bone = 0; bone < kBoneCount; ++bone)
    if ((a.R_PB[bone].coeffs() - b.R_PB[bone].coeffs()).cwiseAbs().maxCoeff() > kSame) return true;
  return false;
}

// A capture, and what a stage without delay made of it.
bool is_same_moment(const Pose& a, const Pose& b) {
  return a.sequence == b.sequence && a.clock_id == b.clock_id && a.capture_time == b.capture_time &&
         a.p_WH_m == b.p_WH_m;
}
}  // namespace

GuestBoard::GuestBoard(std::uint64_t clock_id, bool stage_only)
    : clock_id_(clock_id),
      stage_only_(stage_only),
      slots_(std::make_unique<Slot[]>(kMaxGuests)),
      music_(clock_id) {}

GuestBoard::Slot* GuestBoard::slot_of(const GuestId& guest, MonoTime now) {
  Slot* spare = nullptr;
  for (std::size_t i = 0; i < kMaxGuests; ++i) {
    Slot& slot = slots_[i];
    if (slot.news.id == guest) {
      slot.last_heard = now;
      return &slot;
    }
    if (!slot.last_heard.is_set() || now - slot.last_heard > kSlotHolds)
      if (spare == nullptr || slot.last_heard < spare->last_heard) spare = &slot;
  }
  if (spare == nullptr) {
    no_room_.fetch_add(1, std::memory_order_relaxed);
    return nullptr;
  }
  spare->news = GuestNews();
  spare->news.id = guest;
  spare->meter = ArrivalMeter();
  spare->beat_meter = BeatMeter();
  spare->arriving_beat_meter = BeatMeter();
  spare->capture_heard = spare->status_heard = spare->reached = MonoTime();
  spare->last_heard = now;
  return spare;
}

bool GuestBoard::is_superseded(const Slot& slot, Where where, MonoTime now) const {
  if (where == Where::kGuest && !shows_guest_channel_) return true;
  if (stage_only_ || !is_fresh(slot.capture_heard, now, kSourceHolds)) return false;
  const bool stage_reaches = is_fresh(slot.reached, now, kReachHolds) &&
                             is_fresh(slot.news.staged_heard, now, kStageHolds);
  return stage_reaches == (where == Where::kCapture);
}

void GuestBoard::note_reach(Slot& slot, MonoTime now) const {
  const Pose &captured = slot.news.arriving, &staged = slot.news.staged;
  if (is_fresh(slot.capture_heard, now, kSourceHolds) &&
      is_fresh(slot.news.staged_heard, now, kStageHolds) && is_same_moment(captured, staged) &&
      has_other_rotations(captured, staged))
    slot.reached = now;
}

// An own guest's moment is the same by either way, so that a change of way is no jump in time. What
// the stage delays is another moment than the newest captured.
MonoTime GuestBoard::moment_of(const Slot& slot, Where where, const Pose& pose,
                               MonoTime now) const {
  if (pose.clock_id != clock_id_) return {};
  const Pose& captured = slot.news.arriving;
  const bool is_own = is_fresh(slot.capture_heard, now, kSourceHolds) &&
                      captured.clock_id == pose.clock_id &&
                      pose.capture_time >= captured.capture_time;
  if (where != Where::kStage || (!stage_only_ && is_own)) return pose.capture_time;
  return pose.stamped(Hop::kStaged);
}

bool GuestBoard::note_for_comparison(Slot& slot, Where where, const Pose& pose, MonoTime now) {
  if (where == Where::kStage) {
    slot.news.staged = pose;
    slot.news.staged_heard = now;
    note_reach(slot, now);
    return false;
  }
  // The house's own dancer comes by both: the capture is the earlier.
  if (where == Where::kGuest && is_fresh(slot.capture_heard, now, kSourceHolds)) return false;
  slot.news.arriving = pose;
  slot.news.arriving_heard = now;
  if (where == Where::kCapture) note_reach(slot, now);
  const BeatClock& music = music_.clock();
  if (!music.is_known(now)) return false;
  std::optional<Duration> age;
  if (pose.clock_id == clock_id_ && pose.capture_time.is_set()) age = now - pose.capture_time;
  slot.arriving_beat_meter.add(pose.music_beats, music.position(now), music.beats_per_second(),
                               age);
  return true;
}

GuestBoard::Measured GuestBoard::measure(Where where, const GuestId& guest, const Pose& pose,
                                         MonoTime now) {
  Slot* slot = slot_of(guest, now);
  if (slot == nullptr) return {};
  if (where != Where::kGuest || shows_guest_channel_)
    poses_.fetch_add(1, std::memory_order_relaxed);
  if (where == Where::kCapture) {
    slot->capture_heard = now;
    music_.see(pose);
  }
  const bool reached_before = is_fresh(slot->reached, now, kReachHolds);
  Measured measured{slot, note_for_comparison(*slot, where, pose, now), nullptr};
  if (!is_superseded(*slot, where, now)) measured.shown = &pose;
  // The first that is seen to reach, and the stage's came before its capture: no picture is missed.
  if (where == Where::kCapture && !reached_before && !stage_only_ && slot->reached == now)
    measured.shown = &slot->news.staged;
  if (measured.shown == nullptr) return measured;

  // Ages compare stamps of one clock only.
  std::optional<Duration> age;
  if (pose.clock_id == clock_id_ && pose.capture_time.is_set()) age = now - pose.capture_time;
  slot->meter.on_pose(pose.sequence, now, age);
  if (!is_fresh(slot->status_heard, now, kStatusHolds)) slot->news.figures = slot->meter.figures();
  const BeatClock& music = music_.clock();
  if (music.is_known(now))
    slot->beat_meter.add(pose.music_beats, music.position(now), music.beats_per_second(), age);
  slot->news.heard = now;
  return measured;
}

void GuestBoard::on_pose(Where where, const GuestId& guest, const Pose& pose, MonoTime now) {
  const auto [slot, is_arriving, shown] = measure(where, guest, pose, now);
  if (slot == nullptr) return;
  if (where == Where::kCapture) music_latest_.put(music_.clock());
  if (is_arriving) slot->news.arriving_beat = slot->arriving_beat_meter.figures();
  if (shown != nullptr) {
    slot->news.figures.beat = slot->beat_meter.figures();
    slot->news.pose = *shown;
    slot->news.moment = moment_of(*slot, where, *shown, now);
  }
  slot->latest.put(slot->news);
}

void GuestBoard::pass_over(Where where, const GuestId& guest, const Pose& pose, MonoTime now) {
  measure(where, guest, pose, now);
}

void GuestBoard::clear(std::uint64_t clock_id) {
  clock_id_ = clock_id;
  ++epoch_;
  for (std::size_t i = 0; i < kMaxGuests; ++i) {
    Slot& slot = slots_[i];
    slot.latest.take();
    slot.news = GuestNews();
    slot.meter = ArrivalMeter();
    slot.beat_meter = slot.arriving_beat_meter = BeatMeter();
    slot.last_heard = slot.capture_heard = slot.status_heard = slot.reached = MonoTime();
  }
  chat_.clear();
  music_ = MusicHere(clock_id);
  music_latest_.put(music_.clock());
}

std::size_t GuestBoard::beat_samples_of(const GuestId& guest, bool of_arriving) const {
  for (std::size_t i = 0; i < kMaxGuests; ++i) {
    const Slot& slot = slots_[i];
    if (slot.news.id != guest) continue;
    return of_arriving ? slot.arriving_beat_meter.count() : slot.beat_meter.count();
  }
  return 0;
}

void GuestBoard::on_hands(Where where, const GuestId& guest, const Hands& hands, MonoTime now) {
  Slot* slot = slot_of(guest, now);
  if (slot == nullptr || is_superseded(*slot, where, now)) return;
  // Published with the next pose: hands alone show nothing new.
  slot->news.hands = hands;
  slot->news.hands_heard = now;
}

// Of the capture or from another house, never from the stage: it is shown with whatever pose is.
void GuestBoard::on_face(const GuestId& guest, const Face& face, MonoTime now) {
  Slot* slot = slot_of(guest, now);
  if (slot == nullptr) return;
  slot->news.face = face;
  slot->news.face_heard = now;
}

void GuestBoard::on_skeleton(const GuestId& guest, const Skeleton& skeleton, MonoTime now) {
  if (Slot* slot = slot_of(guest, now)) slot->news.skeleton = skeleton;
}

// Shown with the next pose, as proportions are.
void GuestBoard::on_avatar(const GuestId& guest, const Avatar& avatar, MonoTime now) {
  Slot* slot = slot_of(guest, now);
  if (slot == nullptr) return;
  AvatarWish& wish = slot->news.wish;
  wish.name = avatar.name;
  wish.colour_rgb = avatar.colour_rgb;
  wish.height_scale = avatar.height_scale;
}

void GuestBoard::on_avatar(const GuestId& guest, const AvatarFile& file, MonoTime now) {
  if (Slot* slot = slot_of(guest, now)) slot->news.wish.file = file.hash;
}

void GuestBoard::on_remote_voice_state(const GuestId& guest, const VoiceState& state,
                                       MonoTime now) {
  Slot* slot = slot_of(guest, now);
  if (slot == nullptr) return;
  slot->news.voice_state = state;
  slot->news.voice_state_heard = now;
  slot->latest.put(slot->news);
}

// Shown with the next pose too: a voice is shown at a tag, and a tag needs a dancer.
void GuestBoard::on_voice(const GuestId& guest, const Voice& voice, MonoTime now) {
  Slot* slot = slot_of(guest, now);
  if (slot == nullptr) return;
  slot->news.voice_dbfs = voice.level_dbfs;
  slot->news.voice_heard = now;
}

// A line or sign keeps the time at which it was written, but is never later than its arrival.
void GuestBoard::on_chat(const GuestId& guest, const Chat& chat, MonoTime now) {
  const MonoTime written = chat.clock_id == clock_id_ ? std::min(chat.time, now) : now;
  if (chat.is_line()) return chat_.on_line({guest, chat.text, written});
  Slot* slot = slot_of(guest, now);
  if (slot == nullptr) return;
  slot->news.sign = chat.kind;
  slot->news.sign_shown = written;
  slot->latest.put(slot->news);
}

void GuestBoard::on_beat(const Beat& beat) {
  music_.hear(beat);
  music_latest_.put(music_.clock());
}

void GuestBoard::on_status(const GuestId& guest, const GuestStatus& status, MonoTime now) {
  // Only of guests who dance: the roster also names those who have not come yet.
  if (!status.alive) return;
  Slot* slot = slot_of(guest, now);
  if (slot == nullptr) return;
  slot->status_heard = now;
  GuestFigures& figures = slot->news.figures;
  figures.arrival_hz = status.arrival_hz;
  figures.age_ms.reset();
  if (status.age_p50_ms > 0.0f) figures.age_ms = status.age_p50_ms;
  figures.loss_percent.reset();
  const std::int64_t sent = status.received + status.lost;
  if (sent > 0)
    figures.loss_percent =
        static_cast<float>(100.0 * static_cast<double>(status.lost) / static_cast<double>(sent));
}

}  // namespace dance
