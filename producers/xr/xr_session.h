// XrSession: a session with the headset, through its states: it begins and ends as the runtime
// says, and tells when it is over.
//
// Units/frames: the base space is the runtime's stage (+Y up, floor at 0), or where it has none its
//               local space, whose floor is not known.
// Ownership:    owns session and spaces; refers to the runtime, which must outlive it.
// Threads:      poll() and the frame loop on one thread; is_running() and is_focused() on any.
//               Everything that uses handles on other threads ends before it is destroyed.
// Failure:      create() names what the runtime refuses; a session that is lost says so by
//               over(), and is made anew with another runtime.
#pragma once

#include <atomic>
#include <optional>

#include "core/base/spsc_ring.h"
#include "producers/xr/xr_runtime.h"

namespace dance {

// The base space becomes another one.
struct XrSpaceMove {
  XrTime at = 0;          // from then on
  bool is_known = false;  // where the new one is
  XrPosef new_in_old{};
};

class XrDancerSession {
 public:
  // kEnded: the runtime has ended it in order, as it does when it is closed or starts anew.
  enum class Over { kNot, kLost, kEnded };

  // `graphics` is the binding of the extension that draws; null for a session without pictures.
  static Result<std::unique_ptr<XrDancerSession>> create(const XrRuntime& runtime,
                                                         const void* graphics);
  ~XrDancerSession();
  XrDancerSession(const XrDancerSession&) = delete;
  XrDancerSession& operator=(const XrDancerSession&) = delete;

  // Takes all events that the runtime has.
  void poll();
  // A call told that the session is lost.
  void note(XrResult result);
  void ask_to_end();

  XrSession handle() const { return session_; }
  XrSpace base() const { return base_; }
  XrSpace view() const { return view_; }
  const XrRuntime& runtime() const { return runtime_; }
  bool has_stage() const { return has_stage_; }
  bool is_running() const { return is_running_.load(std::memory_order_acquire); }
  // Whether input comes: not while the runtime's own menu is open, or the headset is put down. Of
  // sessions without pictures some runtimes never say so: those count until one says no.
  bool is_focused() const { return is_focused_.load(std::memory_order_acquire); }
  bool is_visible() const { return is_visible_; }
  Over over() const { return over_; }
  // How often the runtime has said that its base space is moved.
  std::uint32_t recentres() const { return recentres_.load(std::memory_order_acquire); }
  // The moves, in order, for one thread; as many as recentres() but for those that are too many.
  std::optional<XrSpaceMove> take_move() const { return moves_.pop(); }
  std::uint32_t profile_changes() const { return profile_changes_; }

 private:
  explicit XrDancerSession(const XrRuntime& runtime) : runtime_(runtime) {}
  Result<void> open(const void* graphics);
  Result<XrSpace> make_space(XrReferenceSpaceType type) const;
  bool offers(XrReferenceSpaceType type) const;
  void take(XrSessionState state);

  const XrRuntime& runtime_;
  XrSession session_ = XR_NULL_HANDLE;
  XrSpace base_ = XR_NULL_HANDLE, view_ = XR_NULL_HANDLE;
  bool has_stage_ = false;
  bool is_visible_ = false, is_headless_ = false, was_focused_ = false;
  std::atomic<bool> is_running_{false}, is_focused_{false};
  std::atomic<std::uint32_t> recentres_{0};
  mutable SpscRing<XrSpaceMove, 16> moves_;
  std::uint32_t profile_changes_ = 0;
  Over over_ = Over::kNot;
};

}  // namespace dance
