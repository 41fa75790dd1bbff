#include "lobby/run/seen_and_heard.h"

#include <algorithm>
#include <utility>

namespace dance {
namespace {

// From the quietest that a bar shows to full scale.
float share_of(float level_db) { return std::clamp(1.0f + level_db / 60.0f, 0.0f, 1.0f); }

bool take_texts(std::span<const Text> from, std::vector<Text>& to) {
  if (std::equal(from.begin(), from.end(), to.begin(), to.end())) return false;
  to.assign(from.begin(), from.end());
  return true;
}

std::vector<LobbySoundDevice> devices_of(std::span<const ListedSound> listed) {
  std::vector<LobbySoundDevice> devices;
  for (const ListedSound& it : listed) devices.push_back({it.name, it.description});
  return devices;
}

}  // namespace

void SeenAndHeard::look_for_cameras(LobbyModel& model) {
  cameras_.reset();
  if (model.has_camera) {
    if (auto started = CameraList::start()) {
      cameras_ = std::move(*started);
      return;
    }
  }
  model.cameras.clear();
  model.knows_cameras = true;
}

void SeenAndHeard::stop(LobbyModel& model) {
  camera_.reset();
  sound_.reset();
  model.preview_texture = nullptr;
  model.advice.clear();
  model.sound = SoundFacts();
}

void SeenAndHeard::play_count_in() {
  if (sound_) sound_->play_count_in();
}

void SeenAndHeard::begin_and_end(LobbyModel& model) {
  const LobbySettings& settings = model.settings;
  const bool is_here =
      model.screen == LobbyScreen::kYou && !model.is_going_in && !model.join_request;
  const bool wants_camera = is_here && settings.source == DancerSource::kCamera &&
                            model.has_camera && !model.cameras.empty();
  if (camera_ && (!wants_camera || camera_device_ != settings.camera)) {
    camera_.reset();
    model.preview_texture = nullptr;
    model.advice.clear();
  }
  if (wants_camera && !camera_) {
    camera_device_ = settings.camera;
    if (auto started = CameraCheck::start(camera_device_)) camera_ = std::move(*started);
  }
  const SoundChoice choice{settings.microphone, settings.loudspeaker};
  const bool wants_sound = is_here && settings.speaks && model.sound.is_tested;
  if (!wants_sound && (sound_ || model.sound.is_tested)) {
    sound_.reset();
    model.sound = SoundFacts();
  }
  if (wants_sound && !sound_) sound_ = SoundCheck::start(sound_choice_ = choice);
  if (sound_ && !(choice == sound_choice_)) sound_->choose(sound_choice_ = choice);
}

bool SeenAndHeard::take_cameras(LobbyModel& model) {
  if (!cameras_) return false;
  cameras_->read();
  if (!cameras_->is_done()) return false;
  model.cameras.clear();
  for (const ListedCamera& it : cameras_->cameras())
    model.cameras.push_back({it.device, it.name, it.trouble});
  model.knows_cameras = true;
  cameras_.reset();
  return true;
}

bool SeenAndHeard::take_picture(LobbyModel& model, LobbyPainter& painter, MonoTime now) {
  if (!camera_) return false;
  camera_->read(now);
  PreviewPicture picture;
  const bool is_new = camera_->take(picture);
  if (is_new) {
    model.preview_texture = painter.texture_of(picture);
    model.preview_aspect =
        static_cast<float>(picture.width) / static_cast<float>(std::max(picture.height, 1));
  }
  return take_texts(camera_->advice(), model.advice) || is_new;
}

bool SeenAndHeard::take_sound(LobbyModel& model, MonoTime now) {
  if (!sound_) return false;
  const std::uint64_t before = sound_->level().windows;
  sound_->read(now);
  const SoundLevel& level = sound_->level();
  SoundFacts& facts = model.sound;
  facts.level = share_of(level.rms_db);
  facts.held = share_of(level.held_db);
  if (facts.microphones.size() != sound_->microphones().size() ||
      facts.loudspeakers.size() != sound_->loudspeakers().size()) {
    facts.microphones = devices_of(sound_->microphones());
    facts.loudspeakers = devices_of(sound_->loudspeakers());
  }
  return take_texts(sound_->advice(), facts.advice) || level.windows != before;
}

bool SeenAndHeard::look(LobbyModel& model, LobbyPainter& painter, MonoTime now) {
  begin_and_end(model);
  const bool has_cameras = take_cameras(model);
  const bool has_picture = take_picture(model, painter, now);
  return take_sound(model, now) || has_picture || has_cameras;
}

}  // namespace dance
