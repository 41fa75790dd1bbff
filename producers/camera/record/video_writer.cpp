#include "producers/camera/record/video_writer.h"

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>

#include "formats/media/media_module.h"

namespace dance {
namespace {

// Of a camera that does not say.
constexpr double kUsualHz = 30.0;

std::string text_of(const cv::Size& size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

}  // namespace

VideoWriter::VideoWriter(std::string path, double hz)
    : path_(std::move(path)), hz_(std::isfinite(hz) && hz > 0.0 ? hz : kUsualHz) {}

std::string VideoWriter::trouble() const {
  if (failed_) return trouble_;
  return other_size_ > 0 ? size_trouble_ : std::string();
}

Result<std::unique_ptr<VideoWriter>> VideoWriter::create(const std::string& path, double hz) {
  const auto module = media_module();
  if (!module) return fail("'" + path + "' cannot be written: " + module.error().what);
  std::unique_ptr<VideoWriter> writer(new VideoWriter(path, hz));
  writer->media_ = *module;
  const std::string table = path + ".tsv";
  writer->times_.reset(std::fopen(table.c_str(), "wx"));
  if (!writer->times_) return fail("'" + table + "' cannot be written: " + std::strerror(errno));
  std::fputs("picture\tcapture_us\n", writer->times_.get());
  writer->thread_ = std::thread([w = writer.get()] { w->run(); });
  return writer;
}

VideoWriter::~VideoWriter() { finish(); }

void VideoWriter::finish() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
  times_.reset();
}

void VideoWriter::add(const Frame& frame) {
  scratch_.picture.pixels = frame.image;  // shares; put() copies the pixels
  scratch_.capture_time = frame.capture_time;
  shots_.put(scratch_);
  scratch_.picture.pixels.release();
}

void VideoWriter::end_with(const std::string& why) {
  trouble_ = "the video '" + path_ + "' cannot be written (" + why +
             "); is its folder there, and has the disk room?";
  failed_ = true;
}

Result<void> VideoWriter::open(const cv::Mat& first) {
  VideoWish wish;
  wish.path = wish.name = path_;
  wish.use = VideoUse::kToBeMeasured;
  wish.order = PixelOrder::kBgr;
  wish.width_px = first.cols;
  wish.height_px = first.rows;
  wish.hz = hz_;
  DANCE_TRY(video_, media_->create_video(wish));
  size_ = first.size();
  return {};
}

Result<void> VideoWriter::write(const VideoShot& shot) {
  const cv::Mat& pixels = shot.picture.pixels;
  if (pixels.type() != CV_8UC3 || !pixels.isContinuous())
    return fail("a picture is not of three bytes a pixel");
  if (!video_)
    if (auto opened = open(pixels); !opened) return opened;
  // A video has one size.
  if (pixels.size() != size_) {
    if (other_size_ == 0)
      size_trouble_ = "the video '" + path_ + "' has pictures of " + text_of(size_) +
                      "; those of " + text_of(pixels.size()) +
                      " are left out; record them into another folder";
    ++other_size_;
    return {};
  }
  if (auto added = video_->add({pixels.data, pixels.total() * pixels.elemSize()}); !added)
    return added;
  const std::uint64_t number = written_++;
  if (std::fprintf(times_.get(), "%llu\t%lld\n", static_cast<unsigned long long>(number),
                   static_cast<long long>(shot.capture_time.since_zero_us())) < 0 ||
      std::fflush(times_.get()) != 0)
    return fail("its table of times cannot be written");
  return {};
}

void VideoWriter::run() {
  for (bool is_last_look = false;;) {
    const VideoShot* shot = shots_.take();
    if (!shot) {
      if (is_last_look) break;
      is_last_look = stop_;
      if (!is_last_look) std::this_thread::sleep_for(std::chrono::milliseconds(2));
      continue;
    }
    if (auto written = write(*shot); !written) return end_with(written.error().what);
  }
  if (video_)
    if (auto finished = video_->finish(); !finished) end_with(finished.error().what);
}

}  // namespace dance
