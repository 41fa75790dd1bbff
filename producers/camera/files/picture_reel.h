// PictureReel: pictures of a file or of a folder, one behind the other, each with its time from the
// beginning. PlayedReel plays it.
//
// Units/frames: times from the first picture; hertz.
// Ownership:    as each implementation says.
// Threads:      one owner.
// Failure:      step() is false at the end; read() is false where this one picture is damaged.
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>

#include "core/base/time.h"

namespace dance {

class PictureReel {
 public:
  virtual ~PictureReel() = default;
  // To the next picture, to the first at the beginning. False: there is no further one.
  virtual bool step() = 0;
  // Of the picture where it stands.
  virtual Duration time() const = 0;
  virtual bool read(cv::Mat& bgr) = 0;
  virtual bool rewind() = 0;
  // The end came before the file said.
  virtual bool is_cut_off() const = 0;

  virtual double hz() const = 0;
  virtual int width_px() const = 0;
  virtual int height_px() const = 0;
  virtual const std::string& encoding() const = 0;
  virtual const std::string& name() const = 0;
};

}  // namespace dance
