#include "viewer/window/window_export.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "viewer/replay/replay_source.h"

namespace dance {
namespace {

constexpr int kMostNames = 999;

// "couple-12.5-20.mp4" in the present folder, or with a number where that is there.
std::string free_name(const std::string& log, ExportKind kind, double from_s, double to_s) {
  constexpr std::array<const char*, 4> kEndings{".bvh", ".glb", "", ".mp4"};
  std::array<char, 64> range{};
  std::snprintf(range.data(), range.size(), "-%.1f-%.1f", from_s, to_s);
  std::string ending = kEndings[static_cast<std::size_t>(kind)];
  // A folder has none: it would be taken for one.
  std::string stem = std::filesystem::path(log).stem().string() + range.data();
  if (kind == ExportKind::kPictures)
    for (char& c : stem) c = c == '.' ? '_' : c;
  std::error_code error;
  std::string name = stem + ending;
  for (int i = 2; std::filesystem::exists(name, error) && i < kMostNames; ++i)
    name = stem + "-" + std::to_string(i) + ending;
  return name;
}

}  // namespace

TimelinePanel::Exporting WindowExport::for_timeline() {
  return {[this](ExportKind kind) { start(kind); }, [this] { cancel(); }, [this] { return note(); },
          [this] { return is_running(); }};
}

std::string WindowExport::cancel() {
  if (work_) said_ = work_->path() + ": cancelled, and removed";
  work_.reset();
  return said_;
}

void WindowExport::start(ExportKind kind) {
  ReplaySource* replay = source_.replay();
  if (replay == nullptr || replay->player() == nullptr || is_running()) return;
  const ReplayPlayer& player = *replay->player();
  ExportWish wish;
  wish.log = options_.log_to_read();
  wish.stage_only = options_.feed.stage_only;
  wish.index = replay->index();
  wish.from = player.range_begin();
  wish.to = player.range_end();
  wish.hz = options_.export_hz;
  wish.kind = kind;
  if (kind == ExportKind::kVideo) wish.band = best_band_sound();
  if (view_.chosen()) wish.guest = *view_.chosen();
  const MonoTime begin = wish.index->begin;
  wish.path = free_name(options_.log, kind, (wish.from - begin).as_seconds(),
                        (wish.to - begin).as_seconds());
  pictures_ = std::make_unique<ExportPainter>(view_, size_, options_.tags, trails_);
  auto begun = ReplayExport::begin(wish, [this](SceneState& scene, Duration passed) {
    return pictures_->paint(scene, passed, false, avatars_, *painter_);
  });
  if (begun)
    work_ = std::move(*begun);
  else
    said_ = begun.error().what;
}

void WindowExport::step(ViewPictureSize size, bool trails, StagePainter& painter) {
  if (!is_running()) {
    size_ = size;
    trails_ = trails;
    return;
  }
  painter_ = &painter;
  const auto stepped = work_->step();
  painter_ = nullptr;
  if (stepped && !*stepped) return;
  said_ = stepped ? work_->path() + ": " + work_->outcome() : stepped.error().what;
  work_.reset();
}

std::string WindowExport::note() const {
  if (!is_running()) return said_;
  std::array<char, 16> percent{};
  std::snprintf(percent.data(), percent.size(), ": %d %%",
                static_cast<int>(work_->progress() * 100.0));
  return "writing " + work_->path() + percent.data();
}

}  // namespace dance
