// VideoWriter: pictures into a video file beside the capture, and a table of when each was taken:
// for later evaluation with the poses of the same moments.
//
// Units/frames: times in microseconds of this machine's monotonic clock, in a text file of the
//               video's name + ".tsv": number of the picture in the video, TAB, capture time.
// Ownership:    owns its thread and files. The video is Motion JPEG in Matroska: each picture for
//               itself, readable up to where a crash ended it.
// Threads:      one inside, which encodes; add() never waits for it: pictures that it cannot take
//               are dropped and counted.
// Failure:      create() names file and reason, as where there is no FFmpeg; trouble() later tells
//               what ended it (a full disk), or that pictures of another size than the first
//               are left out, as a video has one size.
#pragma once

#include <atomic>
#include <cstdio>
#include <memory>
#include <string>
#include <thread>

#include "core/base/latest.h"
#include "core/base/result.h"
#include "formats/media/media_module.h"
#include "producers/camera/deep_picture.h"
#include "producers/camera/frame.h"

namespace dance {

// A picture on its way to the file.
struct VideoShot {
  DeepPicture picture;
  MonoTime capture_time;
};

class VideoWriter {
 public:
  // `hz` goes into the video's header, 0 where unknown; the table has the true times.
  static Result<std::unique_ptr<VideoWriter>> create(const std::string& path, double hz);
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  void add(const Frame& frame);
  // Writes what is waiting and closes the files.
  void finish();
  std::uint64_t written() const { return written_; }
  // Pictures that came faster than they could be written, or in another size than the first.
  std::uint64_t left_out() const { return shots_.overwritten() + other_size_; }
  // "" while all is well. Callable from any thread.
  std::string trouble() const;

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  VideoWriter(std::string path, double hz);
  void run();
  Result<void> open(const cv::Mat& first);
  Result<void> write(const VideoShot& shot);
  void end_with(const std::string& why);

  std::string path_;
  double hz_;
  const MediaModule* media_ = nullptr;
  std::unique_ptr<std::FILE, CloseFile> times_;
  VideoShot scratch_;  // the capture's side
  Latest<VideoShot> shots_;
  std::atomic<bool> stop_{false};
  std::atomic<bool> failed_{false};
  std::atomic<std::uint64_t> written_{0};
  std::atomic<std::uint64_t> other_size_{0};
  std::string trouble_;                  // written before failed_, read after
  std::string size_trouble_;             // as well, of other_size_
  std::unique_ptr<VideoEncoder> video_;  // the thread's
  cv::Size size_;
  std::thread thread_;
};

}  // namespace dance
