#include "viewer/replay/recorded_teacher.h"

#include <algorithm>
#include <utility>

#include "core/program/talk.h"

namespace dance {
namespace {

// The pupil's own figure stays the one that is seen first.
constexpr float kTeacherOpacity = 0.45f;
constexpr std::string_view kTeacherId = "teacher";

bool is_here(const SceneState& scene, const GuestId& id) {
  return std::any_of(scene.guests.begin(), scene.guests.end(),
                     [&](const SceneGuest& guest) { return guest.id == id; });
}

// A guest may be called so, too.
GuestId free_id(const SceneState& scene) {
  std::string name(kTeacherId);
  for (int i = 2; is_here(scene, *GuestId::parse(name)); ++i)
    name = std::string(kTeacherId) + "-" + std::to_string(i);
  return *GuestId::parse(name);
}

}  // namespace

RecordedTeacher::RecordedTeacher(RecordingLog log, const TeacherOptions& options)
    : log_(std::move(log)), dancer_(options.dancer) {
  view_.log = options.file;
  if (log_.is_made()) view_.made_log = log_.path();
}

Result<std::unique_ptr<RecordedTeacher>> RecordedTeacher::open(const TeacherOptions& options) {
  DANCE_TRY(RecordingLog log, RecordingLog::open(options.file));
  for (const std::string& note : log.notes()) talk::info("{}: {}", options.file, note);
  std::unique_ptr<RecordedTeacher> teacher(new RecordedTeacher(std::move(log), options));
  DANCE_TRY(teacher->source_, ReplaySource::open(teacher->view_));
  teacher->roster_.emplace(teacher->source_->board());
  return teacher;
}

// The first who is there stays the teacher.
const SceneGuest* RecordedTeacher::find() const {
  for (const SceneGuest& guest : recorded_.guests)
    if (!dancer_.is_set() || guest.id == dancer_) return &guest;
  return nullptr;
}

void RecordedTeacher::join(const std::optional<GuestId>& pupil, const TeacherChoices& choices,
                           SceneState& scene) {
  source_->wait_until(scene.time);
  ReplayPlayer* player = source_->player();
  if (player == nullptr) return;
  if (!player->loops()) player->toggle_loop();
  player->set_speed(std::clamp(choices.speed, TeacherChoices::kSlowest, TeacherChoices::kFastest));
  roster_->update(player->position(), recorded_);
  const SceneGuest* recorded = find();
  if (recorded == nullptr) return;
  dancer_ = recorded->id;
  if (!place_.has_begun()) place_.begin(*recorded);
  const auto at = std::find_if(scene.guests.begin(), scene.guests.end(),
                               [&](const SceneGuest& guest) { return guest.id == pupil; });
  if (at != scene.guests.end() && (!place_.has_pupil() || was_over_ != choices.is_over)) {
    place_.put_beside(*at, choices.is_over);
    was_over_ = choices.is_over;
  }
  SceneGuest figure;
  figure.id = free_id(scene);
  figure.skeleton = recorded->skeleton;
  figure.pose = recorded->pose;
  figure.hands = recorded->hands;
  figure.face = recorded->face;
  figure.wish = recorded->wish;
  figure.opacity = kTeacherOpacity * recorded->opacity;
  place_.apply(figure, choices.is_mirrored);
  const auto behind = std::find_if(scene.guests.begin(), scene.guests.end(),
                                   [&](const SceneGuest& guest) { return figure.id < guest.id; });
  scene.guests.insert(behind, std::move(figure));
}

}  // namespace dance
