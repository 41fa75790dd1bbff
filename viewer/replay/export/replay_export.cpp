#include "viewer/replay/export/replay_export.h"

#include <filesystem>

#include "viewer/replay/export/export_source.h"
#include "viewer/replay/export/video_file.h"

namespace dance {

Result<ExportKind> export_kind(const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  if (ending == ".bvh") return ExportKind::kBvh;
  if (ending == ".glb") return ExportKind::kGlb;
  if (ending == ".mp4" || ending == ".webm" || ending == ".mkv") return ExportKind::kVideo;
  if (path.ends_with('/') || ending.empty()) return ExportKind::kPictures;
  return fail("--export " + path +
              ": its ending says what it shall be: .bvh, .glb, a folder for pictures (out/), or a "
              "video: " +
              video_formats_here());
}

Result<std::unique_ptr<ExportSource>> ExportSource::open(const ExportWish& wish) {
  std::unique_ptr<ExportSource> source(new ExportSource(wish));
  auto feed = ReplayFeed::open(wish.log, wish.index, source->board_);
  if (!feed) return tl::make_unexpected(feed.error());
  source->feed_.emplace(std::move(*feed));
  return source;
}

Result<std::unique_ptr<ReplayExport>> ReplayExport::begin(const ExportWish& wish, Paint paint) {
  if (wish.to <= wish.from)
    return fail(wish.path + ": the range to export is empty; let it end after it begins");
  const bool is_motion = wish.kind == ExportKind::kBvh || wish.kind == ExportKind::kGlb;
  return is_motion ? begin_motion_export(wish) : begin_picture_export(wish, std::move(paint));
}

}  // namespace dance
