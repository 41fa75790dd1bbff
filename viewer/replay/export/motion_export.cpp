// A range as motion: what the stage showed of each dancer, interpolated to a steady rate.
#include <algorithm>

#include "core/program/part_file.h"
#include "core/program/whole_file.h"
#include "formats/bvh/bvh.h"
#include "formats/gltf/glb.h"
#include "formats/recording/clips_together.h"
#include "viewer/replay/export/export_source.h"

namespace dance {
namespace {

constexpr double kUsualMotion_hz = 60.0;
// Poses that come closer together are one.
constexpr Duration kLook = Duration::ms(4);
constexpr int kLooksInStep = 100;

class MotionExport : public ReplayExport {
 public:
  MotionExport(const ExportWish& wish, std::unique_ptr<ExportSource> source,
               std::unique_ptr<PartFile> part)
      : ReplayExport(wish.path),
        wish_(wish),
        source_(std::move(source)),
        part_(std::move(part)),
        at_(wish.from) {}

  Result<bool> step() override {
    for (int i = 0; i < kLooksInStep && at_ <= wish_.to; ++i, at_ += kLook) look();
    progress_ = std::min(
        1.0, (at_ - wish_.from).as_seconds() / (wish_.to - wish_.from + kLook).as_seconds());
    if (at_ <= wish_.to) return false;
    if (auto written = write(); !written) return tl::make_unexpected(written.error());
    return true;
  }

 private:
  void look() {
    source_->show(at_, scene_);
    for (const StageRoster::Fresh& fresh : source_->fresh()) {
      if (fresh.heard < wish_.from) continue;  // that of the moment before
      const auto guest =
          std::find_if(scene_.guests.begin(), scene_.guests.end(),
                       [&](const SceneGuest& each) { return each.id == fresh.guest; });
      if (guest == scene_.guests.end()) continue;
      const std::int64_t us = fresh.heard.since_zero_us() + wish_.index->wall_ahead_us;
      const RecordedGuest* known = recording_.find(guest->id);
      if (known == nullptr || known->skeletons.empty() || known->skeleton() != guest->skeleton)
        recording_.on_skeleton(guest->id, guest->skeleton, us);
      recording_.on_pose(guest->id, guest->pose, us);
      if (guest->hands) recording_.on_hands(guest->id, *guest->hands, us);
    }
  }

  Result<void> write() {
    ClipsTogether together =
        clips_together(recording_, wish_.hz > 0.0 ? wish_.hz : kUsualMotion_hz);
    if (together.clips.empty())
      return fail(wish_.path + ": nobody dances in this range; choose another");
    std::size_t frames = 0;
    for (const auto& each : together.clips) frames = std::max(frames, each.clip.frames.size());
    outcome_ = std::to_string(frames) + " frames of " +
               (together.clips.size() == 1 ? "a guest"
                                           : std::to_string(together.clips.size()) + " guests");
    if (wish_.kind == ExportKind::kBvh) return write_one(together);
    std::vector<NamedClip> clips;
    for (auto& [guest, clip] : together.clips)
      clips.push_back({std::string(guest.view()), std::move(clip), {}});
    const auto bytes = write_glb(clips);
    if (!bytes) return fail(wish_.path + ": " + bytes.error().what);
    return keep(std::span<const std::uint8_t>(*bytes));
  }

  Result<void> write_one(const ClipsTogether& together) {
    std::string names;
    const ClipsTogether::Of* chosen = nullptr;
    for (const auto& each : together.clips) {
      names += (names.empty() ? "" : ", ") + std::string(each.guest.view());
      if (each.guest == wish_.guest) chosen = &each;
    }
    if (!wish_.guest.is_set() && together.clips.size() == 1) chosen = &together.clips.front();
    if (chosen == nullptr)
      return fail(wish_.path + ": a BVH holds one dancer, and here are " + names +
                  "; choose with --focus (in the window with the keys 1 to 9), or export a .glb");
    outcome_ = std::to_string(chosen->clip.frames.size()) + " frames of " +
               std::string(chosen->guest.view());
    const std::string text = write_bvh(chosen->clip);
    return keep({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }

  Result<void> keep(std::span<const std::uint8_t> bytes) {
    if (auto written = write_whole_file(part_->path(), bytes); !written) return written;
    return part_->keep();
  }

  ExportWish wish_;
  std::unique_ptr<ExportSource> source_;
  std::unique_ptr<PartFile> part_;
  MonoTime at_;
  SceneState scene_;
  Recording recording_;
};

}  // namespace

Result<std::unique_ptr<ReplayExport>> begin_motion_export(const ExportWish& wish) {
  DANCE_TRY(auto source, ExportSource::open(wish));
  DANCE_TRY(auto part, PartFile::create(wish.path));
  return std::make_unique<MotionExport>(wish, std::move(source), std::move(part));
}

}  // namespace dance
