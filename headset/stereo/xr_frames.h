// XrFrames: the pictures of a session for both eyes: when the next is due and when it will be seen,
// from where it is to be drawn, and the images of the runtime that it is drawn into.
//
// Units/frames: views in the session's base space; MonoTime in this house's clock.
// Ownership:    owns the swapchains; refers to the session, which must outlive it.
// Threads:      the one whose OpenGL context is current; begin() waits for the display's turn.
// Failure:      create() names what the runtime refuses. A call that fails tells the session, which
//               knows whether it is lost; times that cannot be true are replaced and counted.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <vector>

#include "producers/xr/xr_input.h"

namespace dance {

constexpr std::size_t kXrEyes = 2;

struct XrEye {
  XrPlace in_base;
  XrFovf fov{};
  XrPosef as_told{};  // for the runtime, unchanged
};

class XrFrames {
 public:
  // `scale` times the size that the runtime recommends.
  static Result<std::unique_ptr<XrFrames>> create(XrDancerSession& session, float scale);
  ~XrFrames();
  XrFrames(const XrFrames&) = delete;
  XrFrames& operator=(const XrFrames&) = delete;

  int width_px() const { return width_px_; }
  int height_px() const { return height_px_; }

  struct Turn {
    bool is_begun = false;    // end() must follow
    bool is_to_draw = false;  // somebody looks
    XrTime display_time = 0;  // that it is drawn for
    XrTime promised = 0;      // for end(): as the runtime said it, where that can be
    MonoTime seen_at;         // display_time in this house's clock
  };
  Turn begin(const std::function<MonoTime()>& now);
  // False: they are not known, and nothing is to be shown.
  bool locate(const Turn& turn, std::array<XrEye, kXrEyes>& eyes);

  // The image of an eye to draw into, an OpenGL texture; 0 where there is none.
  unsigned acquire(std::size_t eye);
  void release(std::size_t eye);
  // With what was drawn, or with nothing.
  void end(const Turn& turn, const std::array<XrEye, kXrEyes>* eyes);

  // An error where the runtime has refused pictures for so long that the dancer sees none.
  Result<void> health() const;
  std::uint64_t bad_times() const { return bad_times_; }
  std::uint64_t pictures() const { return pictures_; }
  Duration period() const { return period_; }

 private:
  struct Chain {
    XrSwapchain handle = XR_NULL_HANDLE;
    std::vector<unsigned> textures;
  };

  explicit XrFrames(XrDancerSession& session) : session_(session) {}
  // A call whose refusal is no lost session; true where it was taken.
  bool take(XrResult result, const char* call);
  Result<void> open(float scale);
  Result<std::int64_t> choose_format() const;
  XrEnvironmentBlendMode choose_blend() const;
  Result<void> make_chain(Chain& chain, std::int64_t format) const;

  XrDancerSession& session_;
  XrEnvironmentBlendMode blend_ = XR_ENVIRONMENT_BLEND_MODE_OPAQUE;
  int width_px_ = 0, height_px_ = 0;
  std::array<Chain, kXrEyes> chains_{};
  Duration period_ = Duration::us(11'111);
  std::uint64_t bad_times_ = 0, pictures_ = 0;
  int refused_in_a_row_ = 0;
  XrResult refusal_ = XR_SUCCESS;
  const char* refused_call_ = "";
};

}  // namespace dance
