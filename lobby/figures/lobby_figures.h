// LobbyFigures: draws the lobby's dancers into textures: the couple of the page Dance, the chosen
// figure, which dances, and a still picture of each figure that can be chosen. One step draws at
// most one picture.
//
// Units/frames: pixels; MonoTime of this process.
// Ownership:    owns its OpenGL objects until release(). The model refers to the textures.
// Threads:      the drawing thread; a second thread makes the models.
// Failure:      if drawing fails the model has no textures, and the page has no pictures.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "core/store/avatar_store.h"
#include "lobby/figures/drawing_pace.h"
#include "lobby/figures/figure_models.h"
#include "lobby/figures/lobby_dancers.h"
#include "lobby/screen/lobby_model.h"
#include "viewer/stage/stage_renderer.h"

namespace dance {

class LobbyFigures {
 public:
  static constexpr std::size_t kMostOwn = 6;  // files of the user's store

  LobbyFigures(const AvatarStore& store, const std::string& shipped_folder);

  // Draws one picture if it is due and the current page shows it. `scale` is the window's. True if
  // the page must be drawn again.
  bool step(LobbyModel& model, float scale, MonoTime now);
  // Time until the next picture is due; nullopt if the current page shows none.
  std::optional<Duration> time_until_due(const LobbyModel& model, MonoTime now) const;
  void note_input(MonoTime now) { pace_.note_input(now); }
  // Releases all OpenGL objects, before their context ends or shows a dance.
  void release(LobbyModel& model);

  // For tests.
  int drawn() const { return drawn_; }
  const DrawingPace& pace() const { return pace_; }

 private:
  // A picture that stays until it is drawn again.
  struct Canvas {
    GlTexture texture;
    GlFramebuffer framebuffer;
    int width_px = 0, height_px = 0;
    std::string key;  // the figure in it, as FigureChoice::key()
    void* id() const;
  };
  enum class Drawn { kYes, kNotReady, kFailed };

  static bool shows_figures(const LobbyModel& model);
  bool make_renderer();
  void update_options(LobbyModel& model);
  Drawn draw(const SceneState& scene, const OrbitCamera& camera, int stage, Canvas& canvas,
             float width_u, float height_u);
  void resize(Canvas& canvas, int width_px, int height_px);
  Drawn draw_couple(LobbyModel& model);
  Drawn draw_chosen(LobbyModel& model);
  // Draws the first portrait that is missing or shows another look.
  Drawn draw_portrait(LobbyModel& model);
  std::optional<SceneGuest> guest_of(const FigureChoice& choice, SalsaRole role, Duration since);
  FigureChoice choice_of(const LobbyModel& model, const std::string& avatar) const;

  FigureModels models_;
  AvatarStore store_;
  LobbyDancers dancers_;
  DrawingPace pace_;
  std::unique_ptr<StageRenderer> renderer_;
  Canvas couple_, chosen_;
  std::map<std::string, Canvas> portraits_;  // by LobbySettings::avatar
  std::shared_ptr<const AvatarModel> last_chosen_;
  MonoTime begun_, now_;
  float scale_ = 1.0f;
  bool cannot_draw_ = false;
  bool is_portraits_turn_ = false;
  int drawn_ = 0;
};

}  // namespace dance
