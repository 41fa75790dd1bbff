// ShimWords: what dance_video_shim is told, read from its words.
//
// Units/frames: pixels, hertz, milliseconds as named.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      an unknown word or a wrong number ends the process with a line.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace dance {

struct ShimMode {
  std::uint32_t fourcc = 0;
  int width_px = 0;
  int height_px = 0;
  int hz = 0;
};

// Sizes between two, in steps.
struct ShimFree {
  ShimMode least;
  ShimMode most;
  int step_px = 0;  // 0: none
};

struct ShimWords {
  int device = 42;
  std::string card = "Shim Camera";
  std::string bus = "usb-shim-1";
  std::vector<ShimMode> modes;
  ShimFree free;
  ShimMode makes;
  int pad_bytes = 0;
  bool is_busy = false;
  bool is_denied = false;
  bool is_absent = false;
  bool has_metadata = false;
  std::string stamp = "monotonic";
  int age_ms = 0;
  int priority = -1;  // -1: there is no such control
  std::set<std::uint32_t> gaps;
  std::set<std::uint32_t> errors;
  std::set<std::uint32_t> cut;
  std::string file;
  int hz = 0;  // 0: nobody ticks by itself
  int slow_start_ms = 0;
  int unplug_after = 0;
  int replug_ms = 0;
  int again = -1;

  void read(const std::string& words);
};

// Pictures one behind the other in a file: by their size, or of JPEG by their marks.
std::vector<std::vector<std::uint8_t>> read_pictures(const std::string& path, const ShimMode& mode);

// Without padding; JPEG: as much as it may have.
std::size_t picture_bytes(const ShimMode& mode, int pad_bytes);
bool is_jpeg_mode(const ShimMode& mode);
// How many rows of how many bytes a picture has, over all its planes.
int row_count(const ShimMode& mode);
int row_bytes(const ShimMode& mode);

}  // namespace dance
