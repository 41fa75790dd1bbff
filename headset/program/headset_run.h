// HeadsetRun: `dance headset`: looks for a headset until there is one, dances with it, and looks
// again when it is gone. What was found of the body, and the place on the stage, outlive a session.
//
// Units/frames: none.
// Ownership:    owns all.
// Threads:      the main thread; capture and bus have their own.
// Failure:      run() fails where there can be no pictures at all (no display, no OpenGL), and
//               where the runtime has ended the session: it wants its programs to end, and a house
//               starts this one again. What comes and goes (runtime, headset, session) is told in
//               one line each, and waited for.
#pragma once

#include <memory>

#include "core/net/poller.h"
#include "headset/program/headset_options.h"
#include "headset/program/stall_guard.h"

namespace dance {

// What a session is shown with: the stage in stereo, or nothing.
class HeadsetShow {
 public:
  virtual ~HeadsetShow() = default;
  virtual XrUse use() const = 0;
  // Before a session: what it is made with; null for none. An error is for good.
  virtual Result<const void*> binding(const XrRuntime& runtime) = 0;
  virtual Result<void> begin(XrDancerSession& session, XrInput& input, HeadsetCapture& capture) = 0;
  // While the session runs; waits for the display's turn, or a moment.
  virtual Result<void> turn() = 0;
  virtual void end() = 0;
  // Waits while there is no session.
  virtual void wait(Duration longest) = 0;
  virtual bool is_over() const = 0;  // a signal, or the window was closed
  // As far as can be told on any thread.
  virtual bool was_asked_to_end() const { return false; }
  virtual bool has_left() const = 0;  // the dancer said so
  virtual std::string summary() const { return {}; }
};

// Tracking alone; the first to be made, as it takes the signals.
Result<std::unique_ptr<HeadsetShow>> make_tracking_show();
// The stage in both eyes; fails where this build has no viewer.
Result<std::unique_ptr<HeadsetShow>> make_stereo_show(const HeadsetOptions& options);

class HeadsetRun {
 public:
  HeadsetRun(const HeadsetOptions& options, HeadsetShow& show)
      : options_(options), show_(show), guard_([&show] { return show.was_asked_to_end(); }) {}
  Result<void> run();

 private:
  bool is_over() const;
  // From the runtime's beginning to the session's end.
  Result<void> dance_once();
  void sum_up() const;
  Result<void> find_headset();
  Result<void> begin();
  Result<void> pump(XrDancerSession& session);
  void tell_worn(const XrDancerSession& session);
  void end_gracefully(XrDancerSession& session);

  const HeadsetOptions& options_;
  HeadsetShow& show_;
  HeadsetMemory memory_;
  MonoTime ends_;
  std::unique_ptr<XrRuntime> runtime_;
  StallGuard guard_;
  std::string trouble_;  // as it was said last; "" while it works
  bool was_there_ = false;
  bool is_over_ = false;   // by what the dancer or the user wanted
  bool is_fatal_ = false;  // by an error
  bool is_worn_ = true;
  MonoTime worn_;
};

}  // namespace dance
