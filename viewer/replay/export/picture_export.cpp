// A range as pictures of the stage, each in a file or all in a video, with the sound of the range.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "core/store/folder_entries.h"
#include "viewer/replay/export/export_source.h"
#include "viewer/replay/export/video_file.h"
#include "viewer/replay/sound/sound_track.h"

namespace dance {
namespace {

constexpr double kUsualPictures_hz = 30.0;
constexpr std::int64_t kMostPictures = 1'000'000;

// "000017.png", as this export names its files.
bool is_numbered(const std::string& name) {
  return name.size() >= 10 && name.ends_with(".png") &&
         name.find_first_not_of("0123456789") == name.size() - 4;
}

class PictureExport : public ReplayExport {
 public:
  // `sound` is nullptr for an export without sound.
  PictureExport(const ExportWish& wish, std::unique_ptr<ExportSource> source,
                std::unique_ptr<SoundTrack> sound, Paint paint)
      : ReplayExport(wish.path),
        wish_(wish),
        source_(std::move(source)),
        sound_(std::move(sound)),
        paint_(std::move(paint)),
        hz_(wish.hz > 0.0 ? wish.hz : kUsualPictures_hz) {
    // The moment of the end is not shown any more, as the next range may begin with it.
    const double frames = (wish.to - wish.from).as_seconds() * hz_ - 1e-6;
    count_ =
        std::clamp<std::int64_t>(static_cast<std::int64_t>(std::ceil(frames)), 1, kMostPictures);
  }
  ~PictureExport() override {
    if (is_kept_) return;
    std::error_code ignored;
    for (std::int64_t i = 0; i < at_ && !is_video(); ++i)
      std::filesystem::remove(file_of(i), ignored);
    if (made_folder_) std::filesystem::remove(wish_.path, ignored);  // if nothing else is in it
  }

  Result<void> make_folder() {
    if (is_video()) return {};
    std::error_code error;
    made_folder_ = std::filesystem::create_directories(wish_.path, error);
    if (error)
      return fail("--export " + wish_.path + " cannot be made: " + error.message() +
                  "; choose another folder");
    for (const auto& file : folder_entries(wish_.path, error))
      if (is_numbered(file.path().filename().string()))
        return fail(file.path().string() +
                    ": is there already, of another export; remove it or choose another folder");
    if (error) return fail("--export " + wish_.path + " cannot be read: " + error.message());
    return {};
  }

  Result<bool> step() override {
    if (sound_ != nullptr && search_ == SoundTrack::Search::kGoesOn) {
      search_ = sound_->search();
      return false;
    }
    const MonoTime moment = wish_.from + Duration::seconds(static_cast<double>(at_) / hz_);
    SceneState scene;
    source_->show(moment, scene);
    const Duration passed = at_ == 0 ? Duration() : Duration::period_of_hz(hz_);
    DANCE_TRY(const Picture picture, paint_(scene, passed));
    if (auto written = is_video() ? add(picture) : write_picture(picture); !written)
      return tl::make_unexpected(written.error());
    ++at_;
    progress_ = static_cast<double>(at_) / static_cast<double>(count_);
    if (at_ < count_) return false;
    if (video_)
      if (auto finished = video_->finish(); !finished) return tl::make_unexpected(finished.error());
    is_kept_ = true;
    std::array<char, 64> rate{};
    std::snprintf(rate.data(), rate.size(), "%lld pictures, %g a second",
                  static_cast<long long>(count_), hz_);
    outcome_ = rate.data();
    if (video_) outcome_ += ", " + video_->encoder();
    if (sound_) outcome_ += "; " + outcome_of_sound();
    return true;
  }

 private:
  bool is_video() const { return wish_.kind == ExportKind::kVideo; }
  std::string file_of(std::int64_t i) const {
    std::array<char, 40> name{};
    std::snprintf(name.data(), name.size(), "%06lld.png", static_cast<long long>(i + 1));
    return (std::filesystem::path(wish_.path) / name.data()).string();
  }
  // One that has come meanwhile is somebody's: neither overwritten nor removed.
  Result<void> write_picture(const Picture& picture) const {
    std::error_code error;
    if (std::filesystem::exists(file_of(at_), error))
      return fail(file_of(at_) + ": has come meanwhile; choose another folder");
    return write_png(file_of(at_), picture);
  }
  // The first picture says how large it is.
  Result<void> add(const Picture& picture) {
    if (!video_) {
      DANCE_TRY(video_, VideoFile::create(wish_.path, {picture.width_px, picture.height_px, hz_,
                                                       search_ == SoundTrack::Search::kSound}));
    }
    if (auto added = video_->add(picture); !added) return added;
    return sound_ == nullptr ? Result<void>() : add_sound();
  }
  // Adds the sound of the last picture, up to the start of the next. The sound of a silent video is
  // read, too: only then is it known what is missing.
  Result<void> add_sound() {
    const double frames = static_cast<double>(at_ + 1) / hz_ * SoundTrack::kSoundRate_hz;
    const auto end_frame = static_cast<std::int64_t>(std::llround(frames));
    stereo_.resize(static_cast<std::size_t>(2 * (end_frame - sound_frames_)));
    sound_frames_ = end_frame;
    if (auto read = sound_->read(stereo_); !read) return read;
    return video_->sound_encoder().empty() ? Result<void>() : video_->add_sound(stereo_);
  }
  std::string outcome_of_sound() const {
    std::string text = "silent: no music of the house band and no voices in this range";
    if (search_ == SoundTrack::Search::kSound)
      text = "silent: FFmpeg here has no sound encoder for such a file";
    if (!video_->sound_encoder().empty()) {
      const std::string heard = sound_->description();
      text = (heard.empty() ? "no sound in this range" : "sound: " + heard) + ", " +
             video_->sound_encoder();
    }
    const std::string missing = sound_->missing();
    return missing.empty() ? text : text + "; " + missing;
  }

  ExportWish wish_;
  std::unique_ptr<ExportSource> source_;
  std::unique_ptr<SoundTrack> sound_;
  SoundTrack::Search search_ = SoundTrack::Search::kGoesOn;
  std::int64_t sound_frames_ = 0;
  std::vector<float> stereo_;
  Paint paint_;
  double hz_;
  std::int64_t at_ = 0, count_ = 1;
  std::unique_ptr<VideoFile> video_;
  bool made_folder_ = false;
  bool is_kept_ = false;
};

}  // namespace

Result<std::unique_ptr<ReplayExport>> begin_picture_export(const ExportWish& wish,
                                                           ReplayExport::Paint paint) {
  std::error_code error;
  if (wish.kind == ExportKind::kVideo && std::filesystem::exists(wish.path, error))
    return fail(wish.path + ": is there already; remove it or choose another name");
  DANCE_TRY(auto source, ExportSource::open(wish));
  std::unique_ptr<SoundTrack> sound;
  if (wish.kind == ExportKind::kVideo && !wish.is_silent) {
    DANCE_TRY(sound, SoundTrack::open(wish.log, *wish.index, {wish.from, wish.to}, wish.band));
  }
  auto pictures =
      std::make_unique<PictureExport>(wish, std::move(source), std::move(sound), std::move(paint));
  if (auto made = pictures->make_folder(); !made) return tl::make_unexpected(made.error());
  return pictures;
}

}  // namespace dance
