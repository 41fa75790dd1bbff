#include "viewer/replay/export/video_file.h"

#include "core/program/part_file.h"
#include "formats/media/media_module.h"

namespace dance {
namespace {

class EncodedVideoFile : public VideoFile {
 public:
  EncodedVideoFile(std::string path, const Format& format, std::unique_ptr<PartFile> part,
                   std::unique_ptr<VideoEncoder> encoder)
      : path_(std::move(path)),
        format_(format),
        part_(std::move(part)),
        encoder_(std::move(encoder)) {}

  Result<void> add(const Picture& picture) override {
    if (picture.width_px != format_.width_px || picture.height_px != format_.height_px)
      return fail(path_ + ": a picture has another size; keep the size while exporting");
    return encoder_->add(picture.rgb);
  }

  Result<void> add_sound(std::span<const float> stereo) override {
    return encoder_->add_sound(stereo);
  }

  Result<void> finish() override {
    if (auto finished = encoder_->finish(); !finished) return finished;
    return part_->keep();
  }

  std::string encoder() const override { return encoder_->encoder(); }
  std::string sound_encoder() const override { return encoder_->sound_encoder(); }

 private:
  std::string path_;
  Format format_;
  std::unique_ptr<PartFile> part_;
  std::unique_ptr<VideoEncoder> encoder_;  // closed before its file may be removed
};

}  // namespace

std::string video_formats_here() {
  const auto module = media_module();
  return module ? (*module)->video_formats() : "none: " + module.error().what;
}

Result<std::unique_ptr<VideoFile>> VideoFile::create(const std::string& path,
                                                     const Format& format) {
  const auto module = media_module();
  if (!module) return fail(path + ": " + module.error().what + "; or export a folder of pictures");
  DANCE_TRY(auto part, PartFile::create(path));
  VideoWish wish;
  wish.path = part->path();
  wish.name = path;
  wish.width_px = format.width_px;
  wish.height_px = format.height_px;
  wish.hz = format.hz;
  wish.has_sound = format.has_sound;
  auto encoder = (*module)->create_video(wish);
  if (!encoder) return tl::make_unexpected(encoder.error());
  return std::make_unique<EncodedVideoFile>(path, format, std::move(part), std::move(*encoder));
}

}  // namespace dance
