#include "lobby/figures/lobby_figures.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <utility>

#include "core/net/mono_clock.h"
#include "core/program/talk.h"
#include "lobby/settings/chosen_look.h"
#include "viewer/avatar/user_avatars.h"
#include "viewer/gl/offscreen.h"

namespace dance {
namespace {

// Software drawing uses this share of the pixels; the page enlarges the pictures.
constexpr float kSoftwareShare = 0.6f;
constexpr float kTurn_rad_per_s = 0.55f;
constexpr float kPortraitTurn_rad = 0.4f;
constexpr Duration kPortraitMoment = Duration::ms(2300);  // since the dance began
constexpr int kCoupleStage = 0, kChosenStage = 1, kPortraitStage = 2;
constexpr const char* kPartner = "partner";  // the virtual partner's id

int px_of(float u, float scale) { return std::max(8, static_cast<int>(std::lround(u * scale))); }

SalsaRole own_role(const LobbySettings& settings) {
  const bool follows =
      settings.role == "follow" || (settings.role == "any" && settings.window.partner == "lead");
  return follows ? SalsaRole::kFollow : SalsaRole::kLead;
}

SalsaRole other_role(SalsaRole role) {
  return role == SalsaRole::kLead ? SalsaRole::kFollow : SalsaRole::kLead;
}

bool is_file(const std::string& avatar) { return avatar.find('/') != std::string::npos; }

}  // namespace

void* LobbyFigures::Canvas::id() const {
  return reinterpret_cast<void*>(static_cast<std::uintptr_t>(texture.name()));
}

LobbyFigures::LobbyFigures(const AvatarStore& store, const std::string& shipped_folder)
    : models_(avatars_of(store, shipped_folder, {}).sources), store_(store) {}

bool LobbyFigures::shows_figures(const LobbyModel& model) {
  if (model.is_going_in || model.join_request || model.chooser.is_open()) return false;
  return model.screen == LobbyScreen::kDance || model.screen == LobbyScreen::kYou;
}

std::optional<Duration> LobbyFigures::time_until_due(const LobbyModel& model, MonoTime now) const {
  if (cannot_draw_ || !shows_figures(model)) return std::nullopt;
  return pace_.left(now);
}

void LobbyFigures::release(LobbyModel& model) {
  renderer_.reset();
  couple_ = Canvas();
  chosen_ = Canvas();
  portraits_.clear();
  model.figures.couple_texture = model.figures.chosen_texture = nullptr;
  for (FigureOption& option : model.figures.options) option.texture = nullptr;
}

bool LobbyFigures::make_renderer() {
  if (renderer_ || cannot_draw_) return renderer_ != nullptr;
  pace_.set_software(is_software_rendering());
  auto made = StageRenderer::create(pace_.is_software() ? Quality::kLow : Quality::kHigh);
  if (!made) {
    talk::warn("the lobby shows no dancers: {}", made.error().what);
    cannot_draw_ = true;
    return false;
  }
  renderer_ = std::move(*made);
  renderer_->build_meshes_beside();
  return true;
}

// Lists the mannequin, the shipped avatars, the chosen file, and the files of the user's store.
void LobbyFigures::update_options(LobbyModel& model) {
  auto& options = model.figures.options;
  const auto has = [&](const std::string& avatar) {
    return std::ranges::any_of(options, [&](const auto& it) { return it.avatar == avatar; });
  };
  const std::string& chosen = model.settings.avatar;
  if (!options.empty() && has(chosen)) return;
  if (options.empty()) {
    options.push_back({"", "", nullptr});
    for (const std::string& name : model.avatars) options.push_back({name, name, nullptr});
  }
  if (!has(chosen)) {
    const std::string name = std::filesystem::path(chosen).filename().string();
    options.push_back({chosen, name, nullptr});
  }
  if (model.figures.has_listed_own) return;
  model.figures.has_listed_own = true;
  std::error_code error;
  const auto chosen_bytes = is_file(chosen) ? std::filesystem::file_size(chosen, error) : 0;
  std::size_t own = 0;
  for (const StoredAvatar& it : store_.list()) {
    // A file of the same size is the store's copy of the chosen file.
    if (!it.is_own || it.size_bytes == chosen_bytes || has(it.path) || own >= kMostOwn) continue;
    options.push_back({it.path, "", nullptr});
    ++own;
  }
}

FigureChoice LobbyFigures::choice_of(const LobbyModel& model, const std::string& avatar) const {
  LobbySettings settings = model.settings;
  settings.avatar = avatar;
  return {avatar, chosen_look(settings)};
}

// nullopt until the model is ready.
std::optional<SceneGuest> LobbyFigures::guest_of(const FigureChoice& choice, SalsaRole role,
                                                 Duration since) {
  SceneGuest guest;
  guest.id = *GuestId::parse(role == SalsaRole::kLead ? "lead" : "follow");
  guest.avatar = models_.find(choice, dancers_.skeleton(role));
  if (!guest.avatar) return std::nullopt;
  dancers_.dance_at(role, since, guest);
  return guest;
}

void LobbyFigures::resize(Canvas& canvas, int width_px, int height_px) {
  if (canvas.width_px == width_px && canvas.height_px == height_px) return;
  canvas.texture = GlTexture::make();
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, canvas.texture.name());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width_px, height_px, 0, GL_RGBA, GL_UNSIGNED_BYTE,
               nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  canvas.framebuffer = GlFramebuffer::make();
  glBindFramebuffer(GL_FRAMEBUFFER, canvas.framebuffer.name());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, canvas.texture.name(),
                         0);
  canvas.width_px = width_px;
  canvas.height_px = height_px;
}

LobbyFigures::Drawn LobbyFigures::draw(const SceneState& scene, const OrbitCamera& camera,
                                       int stage, Canvas& canvas, float width_u, float height_u) {
  const float scale = pace_.is_software() ? kSoftwareShare * scale_ : scale_;
  const int width_px = px_of(width_u, scale), height_px = px_of(height_u, scale);
  StageLook look;
  look.stage = stage;
  look.pulse = false;
  renderer_->set_look(look);
  renderer_->set_light_yaw(camera.yaw_rad);
  if (auto done = renderer_->draw(scene, camera, width_px, height_px); !done) {
    talk::warn("the lobby's dancers cannot be drawn: {}", done.error().what);
    cannot_draw_ = true;
    return Drawn::kFailed;
  }
  if (renderer_->is_waiting()) return Drawn::kNotReady;  // for a mesh
  resize(canvas, width_px, height_px);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, renderer_->target().finished().name());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, canvas.framebuffer.name());
  glDisable(GL_SCISSOR_TEST);
  glBlitFramebuffer(0, 0, width_px, height_px, 0, 0, width_px, height_px, GL_COLOR_BUFFER_BIT,
                    GL_NEAREST);
  if (pace_.is_software()) glFinish();  // so that the measured time includes the drawing
  check_gl("LobbyFigures::draw");
  return Drawn::kYes;
}

LobbyFigures::Drawn LobbyFigures::draw_couple(LobbyModel& model) {
  const Duration since = now_ - begun_;
  const SalsaRole role = own_role(model.settings);
  FigureChoice own = choice_of(model, model.settings.avatar);
  if (models_.has_failed(own, dancers_.skeleton(role))) own = choice_of(model, "");
  const auto dancer = guest_of(own, role, since);
  const auto partner = guest_of({"", look_of(*GuestId::parse(kPartner))}, other_role(role), since);
  if (!dancer || !partner) return Drawn::kNotReady;
  SceneState scene;
  scene.time = now_;
  scene.guests = {*dancer, *partner};
  scene.guests.front().height_scale = static_cast<float>(model.settings.figure_height);
  const Drawn drawn = draw(scene, couple_camera(scene, since), kCoupleStage, couple_,
                           FigureFacts::kCoupleWidth_u, FigureFacts::kCoupleHeight_u);
  if (drawn == Drawn::kYes) model.figures.couple_texture = couple_.id();
  return drawn;
}

LobbyFigures::Drawn LobbyFigures::draw_chosen(LobbyModel& model) {
  const Duration since = now_ - begun_;
  const SalsaRole role = own_role(model.settings);
  const FigureChoice choice = choice_of(model, model.settings.avatar);
  model.figures.is_unreadable = models_.has_failed(choice, dancers_.skeleton(role));
  auto guest = guest_of(choice, role, since);
  if (guest) last_chosen_ = guest->avatar;
  if (!last_chosen_) return Drawn::kNotReady;
  if (!guest) {  // the previous figure dances until the chosen one is ready
    guest.emplace();
    guest->id = *GuestId::parse("lead");
    guest->avatar = last_chosen_;
    dancers_.dance_at(role, since, *guest);
  }
  guest->height_scale = static_cast<float>(model.settings.figure_height);
  SceneState scene;
  scene.time = now_;
  scene.guests = {*guest};
  // The camera is set for the unscaled figure, so that a chosen height is visible.
  SceneGuest plain = *guest;
  plain.height_scale = 1.0f;
  const float turn_rad =
      kTurn_rad_per_s * static_cast<float>(std::fmod(since.as_seconds(), 3600.0));
  const Drawn drawn = draw(scene, figure_camera(plain, turn_rad), kChosenStage, chosen_,
                           FigureFacts::kChosenWidth_u, FigureFacts::kChosenHeight_u);
  if (drawn == Drawn::kYes) model.figures.chosen_texture = chosen_.id();
  return drawn;
}

LobbyFigures::Drawn LobbyFigures::draw_portrait(LobbyModel& model) {
  const SalsaRole role = own_role(model.settings);
  int number = 0;
  Drawn result = Drawn::kNotReady;
  for (FigureOption& option : model.figures.options) {
    const FigureChoice choice = choice_of(model, option.avatar);
    Canvas& canvas = portraits_[option.avatar];
    ++number;
    if (canvas.key == choice.key()) continue;
    auto guest = guest_of(choice, role, kPortraitMoment);
    if (!guest) continue;
    SceneState scene;
    scene.time = now_;
    scene.guests = {*guest};
    result = draw(scene, figure_camera(*guest, kPortraitTurn_rad), kPortraitStage + number, canvas,
                  FigureFacts::kPortraitWidth_u, FigureFacts::kPortraitHeight_u);
    if (result == Drawn::kFailed) return result;
    if (result != Drawn::kYes) continue;
    canvas.key = choice.key();
    option.texture = canvas.id();
    return result;
  }
  return result;
}

bool LobbyFigures::step(LobbyModel& model, float scale, MonoTime now) {
  if (!shows_figures(model)) return false;
  if (model.screen == LobbyScreen::kYou) update_options(model);  // even if nothing can be drawn
  if (!pace_.is_due(now) || !make_renderer()) return false;
  if (!begun_.is_set()) begun_ = now;
  if (!pace_.has_input()) pace_.note_input(now);
  now_ = now;
  scale_ = scale;
  const MonoTime begin = mono_now();
  models_.begin_picture();
  Drawn drawn = Drawn::kNotReady;
  if (model.screen == LobbyScreen::kDance) {
    drawn = draw_couple(model);
  } else {
    // The chosen figure keeps moving while portraits are still missing.
    is_portraits_turn_ = !is_portraits_turn_;
    if (is_portraits_turn_) drawn = draw_portrait(model);
    if (drawn == Drawn::kNotReady) drawn = draw_chosen(model);
  }
  const Duration took = mono_now() - begin;
  pace_.note_drawn(took, now + took);
  if (drawn == Drawn::kFailed) release(model);
  if (drawn == Drawn::kYes) ++drawn_;
  return drawn == Drawn::kYes;
}

}  // namespace dance
