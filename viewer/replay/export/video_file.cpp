#include "viewer/replay/export/video_file.h"

#include "core/program/part_file.h"
#include "formats/media/media_module.h"

namespace dance {
namespace {

class EncodedVideoFile : public VideoFile {
 public:
  EncodedVideoFile(std::string path, int width_px, int height_px, std::unique_ptr<PartFile> part,
                   std::unique_ptr<VideoEncoder> encoder)
      : path_(std::move(path)),
        width_px_(width_px),
        height_px_(height_px),
        part_(std::move(part)),
        encoder_(std::move(encoder)) {}

  Result<void> add(const Picture& picture) override {
    if (picture.width_px != width_px_ || picture.height_px != height_px_)
      return fail(path_ + ": a picture has another size; keep the size while exporting");
    return encoder_->add(picture.rgb);
  }

  Result<void> finish() override {
    if (auto finished = encoder_->finish(); !finished) return finished;
    return part_->keep();
  }

  std::string encoder() const override { return encoder_->encoder(); }

 private:
  std::string path_;
  int width_px_;
  int height_px_;
  std::unique_ptr<PartFile> part_;
  std::unique_ptr<VideoEncoder> encoder_;  // closed before its file may be removed
};

}  // namespace

std::string video_formats_here() {
  const auto module = media_module();
  return module ? (*module)->video_formats() : "none: " + module.error().what;
}

Result<std::unique_ptr<VideoFile>> VideoFile::create(const std::string& path, int width_px,
                                                     int height_px, double hz) {
  const auto module = media_module();
  if (!module) return fail(path + ": " + module.error().what + "; or export a folder of pictures");
  DANCE_TRY(auto part, PartFile::create(path));
  VideoWish wish;
  wish.path = part->path();
  wish.name = path;
  wish.width_px = width_px;
  wish.height_px = height_px;
  wish.hz = hz;
  auto encoder = (*module)->create_video(wish);
  if (!encoder) return tl::make_unexpected(encoder.error());
  return std::make_unique<EncodedVideoFile>(path, width_px, height_px, std::move(part),
                                            std::move(*encoder));
}

}  // namespace dance
