// XrWorld: our side of OpenXR against the scripted test runtime, through the real loader: opens
// runtime, session and input, lets the session live, and says what the runtime recorded. A test
// fails where the runtime saw misuse.
//
// Units/frames: none.
// Ownership:    the fixture owns all; what a test makes of them ends before.
// Threads:      one.
// Failure:      what does not come to pass within a minute is false.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>
#include <thread>

#include "core/net/mono_clock.h"
#include "producers/xr/xr_input.h"
#include "tests/test_folder.h"

namespace dance {

class XrWorld : public ::testing::Test {
 protected:
  XrWorld() {
    // NOLINTBEGIN(concurrency-mt-unsafe)
    setenv("XR_RUNTIME_JSON", DANCE_BINARY_DIR "/lib/dance_test_xr.json", 1);
    setenv("XR_LOADER_DEBUG", "none", 1);
    setenv("DANCE_XR_RECORD", folder_.path("record").c_str(), 1);
    // NOLINTEND(concurrency-mt-unsafe)
  }
  void TearDown() override {
    close();
    EXPECT_EQ(record().find("misuse"), std::string::npos) << record();
    EXPECT_EQ(record().find("cannot be read"), std::string::npos) << record();
  }

  // The runtime reads it with the next instance; its clock begins anew.
  void write_script(const std::string& script) {
    const std::string path = folder_.path("script" + std::to_string(++scripts_));
    std::ofstream(path) << script;
    not_before_ = not_after_ = MonoTime();
    setenv("DANCE_XR_SCRIPT", path.c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
  }
  void open(const std::string& script) {
    close();
    write_script(script);
    open_again();
  }
  // With the clock of the script going on.
  void open_again() {
    close();
    auto runtime = XrRuntime::open(XrUse::kTracking);
    ASSERT_TRUE(runtime) << runtime.error().what;
    runtime_ = std::move(*runtime);
    auto session = XrDancerSession::create(*runtime_, nullptr);
    ASSERT_TRUE(session) << session.error().what;
    session_ = std::move(*session);
    auto input = XrInput::create(*session_);
    ASSERT_TRUE(input) << input.error().what;
    input_ = std::move(*input);
  }
  void open_focused(const std::string& script) {
    open(script);
    ASSERT_TRUE(pump_until([&] { return session_->is_focused(); })) << record();
  }
  void close() {
    input_.reset();
    session_.reset();
    runtime_.reset();
  }

  void pump() {
    const bool was_running = session_->is_running();
    const MonoTime before = mono_now();
    session_->poll();
    if (!was_running && session_->is_running() && !not_before_.is_set()) {
      not_before_ = before;
      not_after_ = mono_now();
    }
    input_->sync();
  }
  template <class Done>
  bool pump_until(Done done) {
    const MonoTime end = mono_now() + Duration::s(60);
    while (mono_now() < end) {
      pump();
      if (done()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return false;
  }
  // Until the script has come to that moment.
  bool pump_to(double script_s) {
    return pump_until([&] { return mono_now() > not_after_ + Duration::seconds(script_s); });
  }
  XrTime xr_now() const { return runtime_->xr_of(mono_now()); }
  std::string record() const { return text_of(folder_.path("record")); }
  bool has_recorded(const std::string& words) const {
    return record().find(words) != std::string::npos;
  }

  TestFolder folder_{"xr-world"};
  std::unique_ptr<XrRuntime> runtime_;
  std::unique_ptr<XrDancerSession> session_;
  std::unique_ptr<XrInput> input_;
  // Between them lies the zero of the script's clock.
  MonoTime not_before_, not_after_;

 private:
  int scripts_ = 0;
};

}  // namespace dance
