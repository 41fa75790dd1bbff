// PicturePool: a few pictures in turn, so that one that is still held is not overwritten, and
// frames need no allocation.
//
// Ownership: shares the pictures that it gave out.
// Threads:   one owner; a picture may be released on any thread.
// Failure:   none; where all are held one more is allocated.
#pragma once

#include <array>
#include <opencv2/core/mat.hpp>

namespace dance {

class PicturePool {
 public:
  // One without other holders.
  cv::Mat& unheld() {
    for (cv::Mat& picture : pictures_) {
      if (picture.u == nullptr || __atomic_load_n(&picture.u->refcount, __ATOMIC_ACQUIRE) == 1) {
        return picture;
      }
    }
    pictures_[0] = cv::Mat();
    return pictures_[0];
  }

 private:
  std::array<cv::Mat, 4> pictures_;
};

}  // namespace dance
