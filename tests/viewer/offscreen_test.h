// OffscreenTest: tests that draw without a window, with one OpenGL context for all of a suite; they
// are skipped where no EGL driver can.
//
// Ownership: the suite's context; a painter that a test makes ends before it.
// Threads:   the test's.
// Failure:   why there is no context is told with the skip.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "tests/viewer/driver_memory.h"
#include "viewer/gl/offscreen.h"

namespace dance {

class OffscreenTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    auto made = OffscreenContext::create();
    if (!made) {
      why_not_ = made.error().what;
      return;
    }
    context_ = std::move(*made);
    keep_drivers_loaded();
  }
  static void TearDownTestSuite() { context_.reset(); }
  void SetUp() override {
    if (!context_) GTEST_SKIP() << why_not_;
  }

 private:
  static inline std::unique_ptr<OffscreenContext> context_;
  static inline std::string why_not_;
};

}  // namespace dance
