// Preview: the camera's picture with the skeleton over it, on request: in a window, or
// as a picture file that is rewritten several times a second. Nothing of it happens on the way
// of a pose but one shrunken copy.
//
// Units/frames: pixels; the preview is at most 640 wide.
// Ownership:    owns its thread and its window.
// Threads:      one inside, which draws and writes; show() never waits for it.
// Failure:      open() says why there can be no window, or that the file cannot be written; later
//               trouble with the file or a picture ends the preview, and trouble() gives the
//               reason.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <thread>

#include "core/base/latest.h"
#include "core/base/result.h"
#include "producers/camera/body_landmarks.h"
#include "producers/camera/deep_picture.h"
#include "producers/camera/frame.h"

namespace dance {

// One picture on its way to the preview.
struct PreviewShot {
  static constexpr std::size_t kMostBodies = 4;
  DeepPicture picture;
  std::array<BodyLandmarks, kMostBodies> bodies;
  std::size_t body_count = 0;
  std::array<char, 120> caption{};
};

struct PreviewOptions {
  bool window = false;
  std::string file;          // .jpg or .png; "" = none
  bool is_mirrored = false;  // shown as in a mirror
  std::string title;
};

class Preview {
 public:
  static Result<std::unique_ptr<Preview>> open(const PreviewOptions& options);
  ~Preview();
  Preview(const Preview&) = delete;
  Preview& operator=(const Preview&) = delete;

  // Of more than PreviewShot::kMostBodies the first ones.
  void show(const Frame& frame, std::span<const BodyLandmarks> bodies, std::string_view caption);
  // True once the window was closed by its user.
  bool was_closed() const { return was_closed_; }
  // Set once: what ended the preview; "" while all is well. Callable from any thread.
  std::string trouble() const { return failed_ ? trouble_ : std::string(); }

 private:
  explicit Preview(const PreviewOptions& options) : options_(options) {}
  void run();
  void draw_all();
  bool write_file(const cv::Mat& picture);

  PreviewOptions options_;
  PreviewShot scratch_;  // the capture's side
  Latest<PreviewShot> shots_;
  std::atomic<bool> stop_{false};
  std::atomic<bool> was_closed_{false};
  std::atomic<bool> failed_{false};
  std::string trouble_;  // written before failed_, read after
  std::thread thread_;
};

}  // namespace dance
