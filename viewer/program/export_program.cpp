// `dance view LOG --export FILE`: a range of a recorded night as a file, without a window.
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <utility>

#include "core/program/program.h"
#include "core/program/talk.h"
#include "viewer/avatar/user_avatars.h"
#include "viewer/gl/offscreen.h"
#include "viewer/program/export_painter.h"
#include "viewer/program/view_program.h"
#include "viewer/replay/export/replay_export.h"
#include "viewer/replay/replay_source.h"

namespace dance {
namespace {

Result<ExportWish> wish_of(const ViewOptions& options, const ReplaySource& source) {
  ExportWish wish;
  wish.log = options.log_to_read();
  wish.stage_only = options.feed.stage_only;
  wish.index = source.index();
  wish.path = options.export_to;
  wish.hz = options.export_hz;
  if (options.focus) wish.guest = *options.focus;
  DANCE_TRY(wish.kind, export_kind(options.export_to));
  wish.is_silent = options.export_silent;
  wish.band = best_band_sound();
  const double length_s = source.recorded().as_seconds();
  if (options.export_from_s > length_s || options.export_until_s > length_s + 0.5)
    return fail("--from and --to: choose within the recording, which is " +
                std::to_string(length_s) + " s long");
  wish.from = wish.index->begin + Duration::seconds(options.export_from_s);
  wish.to = options.export_until_s > 0.0
                ? wish.index->begin + Duration::seconds(options.export_until_s)
                : wish.index->end;
  return wish;
}

// Without a terminal one line is printed every five percent, for programs such as the lobby that
// read it.
void show_progress(double share, int& shown) {
  const bool is_terminal = isatty(STDERR_FILENO) == 1;
  const int step = is_terminal ? 1 : 5;
  const int percent = static_cast<int>(share * 100.0) / step * step;
  if (percent == shown) return;
  shown = percent;
  if (!is_terminal) return talk::info("writing: {} %", percent);
  if (percent < 100)
    std::fprintf(stderr, "\rwriting: %d %%", percent);
  else
    std::fprintf(stderr, "\r%20s\r", "");
}

}  // namespace

Result<void> run_export(const ViewOptions& options) {
  DANCE_TRY(auto source, ReplaySource::open(options));
  DANCE_TRY(const ExportWish wish, wish_of(options, *source));
  const bool draws = wish.kind == ExportKind::kPictures || wish.kind == ExportKind::kVideo;
  std::unique_ptr<OffscreenContext> context;
  std::unique_ptr<StagePainter> painter;
  AvatarLibrary avatars(
      avatars_of(AvatarStore::of_user(), data_folder() + "/avatars", options.avatars));
  ViewDirector view(options.camera, options.view);
  if (options.focus) view.choose(*options.focus);
  ExportPainter pictures(view, options.size, options.tags, false);
  bool is_first = true;
  const auto paint = [&](SceneState& scene, Duration passed) {
    return pictures.paint(scene, passed, std::exchange(is_first, false), avatars, *painter);
  };
  DANCE_TRY(auto work, ReplayExport::begin(wish, paint));
  if (draws) {
    DANCE_TRY(context, OffscreenContext::create());
    const Quality quality = options.quality == QualityWish::kLow ? Quality::kLow : Quality::kHigh;
    DANCE_TRY(painter, StagePainter::create(quality, 1.0f));
    painter->set_place(place_to_draw(options));
  }
  int shown = -1;
  for (;;) {
    DANCE_TRY(const bool is_done, work->step());
    show_progress(work->progress(), shown);
    if (is_done) break;
  }
  std::printf("%s: %s\n", work->path().c_str(), work->outcome().c_str());
  return {};
}

}  // namespace dance
