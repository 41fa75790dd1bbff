// ShimDevice: the driver and the sensor behind dance_video_shim: answers ioctl()s, fills buffers,
// keeps one handle for each open(). A handle is the reading end of a pipe: poll() then works by
// itself (a byte a filled buffer, the other end closed when unplugged).
//
// Units/frames: as the Video for Linux API has them.
// Ownership:    the pipes' writing ends and the memory of the buffers.
// Threads:      any; one lock.
// Failure:      as a driver answers: errno.
// Source:       Video for Linux API, kernel documentation.
#pragma once

#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "tests/producers/camera/v4l2/shim_words.h"
#include "tests/producers/camera/v4l2/video_shim.h"

namespace dance {

class ShimDevice : public VideoShim {
 public:
  static ShimDevice& here();
  // Without any lock or memory.
  static int open_handles();
  static bool is_video(const char* path);

  void set_up(const char* words) override;
  void change(const char* words) override;
  void add_picture(const std::uint8_t* bytes, std::size_t size) override;
  void tick(int n) override;
  void unplug() override;
  void plug() override;
  std::int64_t newest_stamp_us() const override;
  int free_buffers() const override;
  int open_files() const override;
  int priority() const override;

  // -1 with errno; -2: not a path of ours.
  int open(const char* path, int flags);
  bool is_ours(int fd) const;
  void close(int fd);
  // 0 or errno.
  int answer(int fd, unsigned long request, void* argument);
  // The memory to map in place of the handle; -1: none.
  int memory_of(int fd) const;

 private:
  struct Handle {
    int write_fd = -1;  // -1: the device is gone
    bool is_metadata = false;
  };
  struct Buffer {
    bool is_queued = false;
    std::uint32_t used = 0;
    std::uint32_t sequence = 0;
    std::uint32_t flags = 0;
    std::int64_t stamp_us = 0;
  };

  ShimDevice();
  void run_by_itself();
  int answer_format(int fd, unsigned long request, void* argument);
  int answer_stream(int fd, unsigned long request, void* argument);
  int enumerate(unsigned long request, void* argument) const;
  void tick_once();
  void fill(std::uint32_t index, std::uint32_t sequence);
  void stop_stream();
  bool is_of_another(int fd) const { return words_.is_busy || (owner_ != -1 && owner_ != fd); }

  mutable std::mutex lock_;
  ShimWords words_;
  std::vector<std::vector<std::uint8_t>> pictures_;
  bool is_plugged_ = false;
  std::map<int, Handle> handles_;
  ShimMode now_;        // the format that is set
  int owner_ = -1;      // the handle that has the buffers
  int memory_fd_ = -1;  // of the buffers
  std::uint8_t* memory_ = nullptr;
  std::size_t buffer_bytes_ = 0;
  std::vector<Buffer> buffers_;
  std::vector<std::uint32_t> empty_;  // in turn; their memory stays
  std::vector<std::uint32_t> full_;
  bool is_streaming_ = false;
  std::uint32_t sequence_ = 0;
  std::int64_t newest_stamp_us_ = 0;
  int fetched_ = 0;  // pictures that the program took out
};

}  // namespace dance
