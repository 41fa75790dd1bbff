// dance_video_shim: a camera that is not there. Preloaded (LD_PRELOAD) into a program it answers
// for /dev/video42 what the kernel would: formats, buffers that are mapped, poll(), stamps, gaps,
// errors, an unplugged cable. What it shows are pictures that a test hands it or a file of raw
// pictures.
//
// A test in the same process turns the wheel by hand: no picture comes before tick(). A program of
// its own is given all in the environment, DANCE_VIDEO_SHIM="modes=YUYV:1280x720@30
// file=/tmp/x.yuyv hz=30 unplug=100 replug_ms=500", and a thread ticks.
//
//   device=42 card=A_Camera bus=usb-1      number of the device, name (_ for blanks), socket
//   modes=YUYV:64x48@30,MJPG:64x48@60      what it offers; @0: it does not say its rates
//   free=YUYV:16x16-640x480/8@60           any size between two, in steps, at any rate up to one
//   makes=YUYV:32x24@10                    whatever it is asked for, it makes this of it
//   pad=16                                 bytes behind each row
//   busy=1 denied=1 absent=1 metadata=1    another program has it; no permission; not plugged in; a
//   second node without pictures stamp=monotonic|realtime|zero age_ms=9 the driver's clock, and how
//   old its stamps are; age_ms=-9: of the future priority=1                             it has the
//   control by which exposure may slow down the rate gap=3,4 error=5 truncate=6             by
//   sequence: pictures that never come, are marked damaged, or are cut in half file=… hz=30
//   slow_start_ms=…           for a program: the pictures, one behind the other, and their pace
//   unplug=100 replug_ms=500 again=43      for a program: unplugged when it fetched so many, back
//   after so long under that number
//
// Ownership: one per process; it copies what it is given.
// Threads:   any; one lock.
// Failure:   a word it does not know ends the process with a line: a test must not believe in a
//            fault that was never there.
#pragma once

#include <cstddef>
#include <cstdint>

namespace dance {

// Only plain values pass: the shim is built without the sanitizers that a test may have.
class VideoShim {
 public:
  // As it was when the process began, then as `words` say.
  virtual void set_up(const char* words) = 0;
  // Words on top of what is set, from the next picture on.
  virtual void change(const char* words) = 0;
  // Raw or compressed, rows without padding. They are shown in turn, by sequence.
  virtual void add_picture(const std::uint8_t* bytes, std::size_t size) = 0;
  // The sensor takes n pictures; those for which no buffer waits are lost.
  virtual void tick(int n) = 0;
  virtual void unplug() = 0;
  virtual void plug() = 0;

  virtual std::int64_t newest_stamp_us() const = 0;  // of the newest that came into a buffer
  virtual int free_buffers() const = 0;              // handed to the driver, empty
  virtual int open_files() const = 0;
  virtual int priority() const = 0;

 protected:
  ~VideoShim() = default;
};

}  // namespace dance

// Found by dlsym(): nullptr where it was not preloaded.
extern "C" dance::VideoShim* dance_video_shim();
