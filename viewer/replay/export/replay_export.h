// Exports of a recording's range: as motion for other programs (BVH, GLB), or as pictures of the
// stage (PNG sequence, video with its sound).
//
// Units/frames: moments in the recorded house's clock; frames a second.
// Ownership:    an export has a feed and a board of its own, so that the player stays where it is.
// Threads:      none inside; a window takes step() once a picture, on the drawing thread.
// Failure:      each Error names the file and the cure. Nothing is overwritten; what was not
//               finished is removed.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/base/guest_id.h"
#include "core/base/result.h"
#include "formats/replay/replay_index.h"
#include "producers/music/band/band_audio.h"
#include "viewer/gl/picture.h"
#include "viewer/scene/scene.h"

namespace dance {

// Menus offer them in this order: the kinds that dancers use are first.
enum class ExportKind { kVideo, kPictures, kGlb, kBvh };

// By the name's ending: .bvh, .glb, .mp4 or .webm or .mkv, or a folder ("out/" or no ending).
Result<ExportKind> export_kind(const std::string& path);

struct ExportWish {
  std::string log;
  bool stage_only = false;
  std::shared_ptr<const ReplayIndex> index;
  MonoTime from, to;
  double hz = 0.0;  // 0: 60 of motion, 30 of pictures
  GuestId guest;    // of a BVH; not set: the only one
  std::string path;
  ExportKind kind = ExportKind::kGlb;
  bool is_silent = false;  // a video without sound
  BandSound band;          // plays the house band in a video
};

class ReplayExport {
 public:
  // Draws a scene for the export, `passed` after the last one.
  using Paint = std::function<Result<Picture>(SceneState& scene, Duration passed)>;

  // `paint` is needed for pictures and video.
  static Result<std::unique_ptr<ReplayExport>> begin(const ExportWish& wish, Paint paint);
  virtual ~ReplayExport() = default;

  // Does a part of the work, about as long as a picture takes; true when all is written.
  virtual Result<bool> step() = 0;
  double progress() const { return progress_; }
  const std::string& path() const { return path_; }
  // What was written, for people: "240 frames of 2 guests".
  const std::string& outcome() const { return outcome_; }

 protected:
  explicit ReplayExport(std::string path) : path_(std::move(path)) {}
  double progress_ = 0.0;
  std::string outcome_;

 private:
  std::string path_;
};

}  // namespace dance
