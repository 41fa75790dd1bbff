// A small client, through the real loader, of the test runtime.
#include <gtest/gtest.h>
#include <openxr/openxr.h>
#include <time.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "testing/scratch_folder.h"
#include "tests/xr_loader_leaks.h"

namespace dance {
namespace {

using ConvertTime = XrResult(XRAPI_PTR*)(XrInstance, const timespec*, XrTime*);

class XrRuntime : public ::testing::Test {
 protected:
  void SetUp() override {
    auto folder = ScratchFolder::make();
    ASSERT_TRUE(folder.has_value());
    folder_ = *std::move(folder);
    setenv("XR_RUNTIME_JSON", DANCE_BINARY_DIR "/lib/dance_test_xr.json", 1);
    setenv("DANCE_XR_SCRIPT", folder_->file("script").c_str(), 1);
    setenv("DANCE_XR_RECORD", folder_->file("record").c_str(), 1);
    setenv("XR_LOADER_DEBUG", "none", 1);
  }
  void TearDown() override {
    if (instance_) destroy();
  }

  void begin(const std::string& script) {
    std::ofstream(folder_->file("script")) << script;
    XrInstanceCreateInfo info{};
    info.type = XR_TYPE_INSTANCE_CREATE_INFO;
    std::strcpy(info.applicationInfo.applicationName, "test");
    info.applicationInfo.apiVersion = XR_CURRENT_API_VERSION;
    const char* extensions[] = {"XR_MND_headless", "XR_KHR_convert_timespec_time",
                                "XR_EXT_hand_tracking"};
    info.enabledExtensionCount = 3;
    info.enabledExtensionNames = extensions;
    ASSERT_EQ(xrCreateInstance(&info, &instance_), XR_SUCCESS);
    const XrSystemGetInfo system_info{XR_TYPE_SYSTEM_GET_INFO, nullptr,
                                      XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY};
    ASSERT_EQ(xrGetSystem(instance_, &system_info, &system_), XR_SUCCESS);
    make_actions();
  }

  void make_actions() {
    XrActionSetCreateInfo set{};
    set.type = XR_TYPE_ACTION_SET_CREATE_INFO;
    std::strcpy(set.actionSetName, "dance");
    std::strcpy(set.localizedActionSetName, "Dance");
    ASSERT_EQ(xrCreateActionSet(instance_, &set, &set_), XR_SUCCESS);
    left_ = path("/user/hand/left");
    grip_ = make_action("grip", XR_ACTION_TYPE_POSE_INPUT);
    buzz_ = make_action("buzz", XR_ACTION_TYPE_VIBRATION_OUTPUT);
    trigger_ = make_action("trigger", XR_ACTION_TYPE_FLOAT_INPUT);
    EXPECT_EQ(suggest("/user/hand/left/input/trigger/value"), XR_SUCCESS);
  }

  XrAction make_action(const char* name, XrActionType type) {
    XrActionCreateInfo info{};
    info.type = XR_TYPE_ACTION_CREATE_INFO;
    std::strcpy(info.actionName, name);
    std::strcpy(info.localizedActionName, name);
    info.actionType = type;
    info.countSubactionPaths = 1;
    info.subactionPaths = &left_;
    XrAction action = XR_NULL_HANDLE;
    EXPECT_EQ(xrCreateAction(set_, &info, &action), XR_SUCCESS);
    return action;
  }

  XrPath path(const char* text) const {
    XrPath path = XR_NULL_PATH;
    EXPECT_EQ(xrStringToPath(instance_, text, &path), XR_SUCCESS);
    return path;
  }

  XrResult suggest(const char* trigger_path) {
    const XrActionSuggestedBinding bindings[] = {{grip_, path("/user/hand/left/input/grip/pose")},
                                                 {buzz_, path("/user/hand/left/output/haptic")},
                                                 {trigger_, path(trigger_path)}};
    const XrInteractionProfileSuggestedBinding suggested{
        XR_TYPE_INTERACTION_PROFILE_SUGGESTED_BINDING, nullptr,
        path("/interaction_profiles/oculus/touch_controller"), 3, bindings};
    return xrSuggestInteractionProfileBindings(instance_, &suggested);
  }

  void begin_session() {
    const XrSessionCreateInfo info{XR_TYPE_SESSION_CREATE_INFO, nullptr, 0, system_};
    ASSERT_EQ(xrCreateSession(instance_, &info, &session_), XR_SUCCESS);
    const XrSessionActionSetsAttachInfo attach{XR_TYPE_SESSION_ACTION_SETS_ATTACH_INFO, nullptr, 1,
                                               &set_};
    ASSERT_EQ(xrAttachSessionActionSets(session_, &attach), XR_SUCCESS);
    ASSERT_TRUE(wait_state(XR_SESSION_STATE_READY));
    const XrSessionBeginInfo begin{XR_TYPE_SESSION_BEGIN_INFO, nullptr,
                                   XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO};
    ASSERT_EQ(xrBeginSession(session_, &begin), XR_SUCCESS);
    ASSERT_TRUE(wait_state(XR_SESSION_STATE_FOCUSED));
    stage_ = reference(XR_REFERENCE_SPACE_TYPE_STAGE);
    view_ = reference(XR_REFERENCE_SPACE_TYPE_VIEW);
    const XrActionSpaceCreateInfo hand{
        XR_TYPE_ACTION_SPACE_CREATE_INFO, nullptr, grip_, left_, {{0, 0, 0, 1}, {0, 0, 0}}};
    ASSERT_EQ(xrCreateActionSpace(session_, &hand, &hand_), XR_SUCCESS);
  }

  XrSpace reference(XrReferenceSpaceType type) const {
    const XrReferenceSpaceCreateInfo info{
        XR_TYPE_REFERENCE_SPACE_CREATE_INFO, nullptr, type, {{0, 0, 0, 1}, {0, 0, 0}}};
    XrSpace space = XR_NULL_HANDLE;
    EXPECT_EQ(xrCreateReferenceSpace(session_, &info, &space), XR_SUCCESS);
    return space;
  }

  // Polls for up to ten seconds.
  bool wait_event(const std::function<bool(const XrEventDataBuffer&)>& is_it) const {
    for (int i = 0; i < 2000; ++i) {
      XrEventDataBuffer event{};
      event.type = XR_TYPE_EVENT_DATA_BUFFER;
      if (xrPollEvent(instance_, &event) == XR_SUCCESS) {
        if (is_it(event)) return true;
        continue;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
  }
  bool wait_state(XrSessionState state) const {
    return wait_event([&](const XrEventDataBuffer& event) {
      const auto& changed = reinterpret_cast<const XrEventDataSessionStateChanged&>(event);
      return event.type == XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED && changed.state == state;
    });
  }

  XrTime now() const {
    ConvertTime convert = nullptr;
    EXPECT_EQ(xrGetInstanceProcAddr(instance_, "xrConvertTimespecTimeToTimeKHR",
                                    reinterpret_cast<PFN_xrVoidFunction*>(&convert)),
              XR_SUCCESS);
    timespec clock{};
    clock_gettime(CLOCK_MONOTONIC, &clock);
    XrTime time = 0;
    EXPECT_EQ(convert(instance_, &clock, &time), XR_SUCCESS);
    return time;
  }

  XrResult sync() const {
    const XrActiveActionSet active{set_, XR_NULL_PATH};
    const XrActionsSyncInfo info{XR_TYPE_ACTIONS_SYNC_INFO, nullptr, 1, &active};
    return xrSyncActions(session_, &info);
  }

  void end_session() {
    ASSERT_EQ(xrRequestExitSession(session_), XR_SUCCESS);
    ASSERT_TRUE(wait_state(XR_SESSION_STATE_STOPPING));
    ASSERT_EQ(xrEndSession(session_), XR_SUCCESS);
    ASSERT_TRUE(wait_state(XR_SESSION_STATE_EXITING));
  }
  void destroy() {
    if (session_) xrDestroySession(session_);
    xrDestroyActionSet(set_);
    xrDestroyInstance(instance_);
    session_ = XR_NULL_HANDLE;
    instance_ = XR_NULL_HANDLE;
  }

  std::string record() const {
    std::ostringstream text;
    text << std::ifstream(folder_->file("record")).rdbuf();
    return text.str();
  }
  bool has_recorded(const std::string& text) const {
    return record().find(text) != std::string::npos;
  }

  std::unique_ptr<ScratchFolder> folder_;
  XrInstance instance_ = XR_NULL_HANDLE;
  XrSystemId system_ = XR_NULL_SYSTEM_ID;
  XrSession session_ = XR_NULL_HANDLE;
  XrActionSet set_ = XR_NULL_HANDLE;
  XrAction grip_ = XR_NULL_HANDLE;
  XrAction buzz_ = XR_NULL_HANDLE;
  XrAction trigger_ = XR_NULL_HANDLE;
  XrPath left_ = XR_NULL_PATH;
  XrSpace stage_ = XR_NULL_HANDLE;
  XrSpace view_ = XR_NULL_HANDLE;
  XrSpace hand_ = XR_NULL_HANDLE;
};

TEST_F(XrRuntime, ServesACorrectHeadlessClientWithoutMisuse) {
  begin("at 0 pose left-hand -0.4 1.2 -0.3 0 0 0 1\nat 0 press left trigger 0.75\n");
  begin_session();
  ASSERT_EQ(sync(), XR_SUCCESS);

  XrSpaceVelocity velocity{XR_TYPE_SPACE_VELOCITY, nullptr, 0, {}, {}};
  XrSpaceLocation location{XR_TYPE_SPACE_LOCATION, &velocity, 0, {}};
  ASSERT_EQ(xrLocateSpace(hand_, stage_, now(), &location), XR_SUCCESS);
  EXPECT_EQ(location.locationFlags, 15u);
  EXPECT_NEAR(location.pose.position.x, -0.4f, 1e-5f);
  EXPECT_NE(velocity.velocityFlags, 0u);
  ASSERT_EQ(xrLocateSpace(hand_, view_, now(), &location), XR_SUCCESS);
  EXPECT_NEAR(location.pose.position.y, 1.2f - 1.65f, 1e-5f);

  const XrActionStateGetInfo get{XR_TYPE_ACTION_STATE_GET_INFO, nullptr, trigger_, left_};
  XrActionStateFloat state{XR_TYPE_ACTION_STATE_FLOAT, nullptr, 0.0f, 0, 0, 0};
  ASSERT_EQ(xrGetActionStateFloat(session_, &get, &state), XR_SUCCESS);
  EXPECT_TRUE(state.isActive);
  EXPECT_EQ(state.currentState, 0.75f);

  const XrHapticActionInfo where{XR_TYPE_HAPTIC_ACTION_INFO, nullptr, buzz_, left_};
  const XrHapticVibration buzz{XR_TYPE_HAPTIC_VIBRATION, nullptr, 50'000'000, 160.0f, 0.5f};
  ASSERT_EQ(
      xrApplyHapticFeedback(session_, &where, reinterpret_cast<const XrHapticBaseHeader*>(&buzz)),
      XR_SUCCESS);
  ASSERT_EQ(xrStopHapticFeedback(session_, &where), XR_SUCCESS);
  end_session();
  destroy();
  EXPECT_TRUE(has_recorded("haptic left 0.5000 50000000 160.00 "));
  EXPECT_TRUE(has_recorded("haptic_stop left"));
  EXPECT_TRUE(has_recorded("located left-hand"));
  EXPECT_TRUE(has_recorded("session EXITING"));
  EXPECT_FALSE(has_recorded("misuse")) << record();
}

TEST_F(XrRuntime, KeepsATimeOfItsOwn) {
  begin("");
  timespec clock{};
  clock_gettime(CLOCK_MONOTONIC, &clock);
  EXPECT_NEAR(static_cast<double>(now()) * 1e-9 - static_cast<double>(clock.tv_sec), 7000.0, 60.0);
}

TEST_F(XrRuntime, FindsMisuse) {
  begin("");
  EXPECT_EQ(suggest("/user/hand/left/input/trigger/click"), XR_ERROR_PATH_UNSUPPORTED);
  EXPECT_TRUE(has_recorded("misuse xrSuggestInteractionProfileBindings: "));
  begin_session();
  XrSpaceLocation location{XR_TYPE_SPACE_LOCATION, nullptr, 0, {}};
  EXPECT_EQ(xrLocateSpace(hand_, stage_, 0, &location), XR_ERROR_TIME_INVALID);
  EXPECT_TRUE(has_recorded("misuse xrLocateSpace: a time of 0 or less"));
  location.type = XR_TYPE_VIEW;
  EXPECT_EQ(xrLocateSpace(hand_, stage_, now(), &location), XR_ERROR_VALIDATION_FAILURE);
  EXPECT_EQ(xrEndSession(session_), XR_ERROR_SESSION_NOT_STOPPING);
  EXPECT_EQ(xrBeginFrame(session_, nullptr), XR_ERROR_CALL_ORDER_INVALID);
  const XrFrameEndInfo end{XR_TYPE_FRAME_END_INFO,           nullptr, now(),
                           XR_ENVIRONMENT_BLEND_MODE_OPAQUE, 0,       nullptr};
  EXPECT_EQ(xrEndFrame(session_, &end), XR_ERROR_CALL_ORDER_INVALID);
  ASSERT_EQ(xrDestroySpace(view_), XR_SUCCESS);
  EXPECT_EQ(xrDestroySpace(view_), XR_ERROR_HANDLE_INVALID);
  xrDestroyInstance(instance_);
  instance_ = XR_NULL_HANDLE;
  EXPECT_TRUE(has_recorded("misuse xrDestroyInstance: 1 sessions are left")) << record();
}

TEST_F(XrRuntime, LosesASessionAndLetsOneBeginAgain) {
  begin("at 0.05 lose_session\n");
  begin_session();
  ASSERT_TRUE(wait_state(XR_SESSION_STATE_LOSS_PENDING));
  XrResult result = XR_SUCCESS;
  for (int i = 0; i < 2000 && result != XR_ERROR_SESSION_LOST; ++i) {
    result = sync();
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_EQ(result, XR_ERROR_SESSION_LOST);
  ASSERT_EQ(xrDestroySession(session_), XR_SUCCESS);
  begin_session();
  EXPECT_EQ(sync(), XR_SUCCESS);
  end_session();
  destroy();
  EXPECT_FALSE(has_recorded("misuse")) << record();
}

TEST_F(XrRuntime, StopsAndIsReadyAgain) {
  begin("at 0.05 stop\nat 0.1 ready\n");
  begin_session();
  ASSERT_TRUE(wait_state(XR_SESSION_STATE_STOPPING));
  ASSERT_EQ(xrEndSession(session_), XR_SUCCESS);
  ASSERT_TRUE(wait_state(XR_SESSION_STATE_READY));
}

TEST_F(XrRuntime, JumpsAndFailsOnOrder) {
  begin("at 0 fail xrSyncActions XR_ERROR_RUNTIME_FAILURE\nat 0.05 jump 1 0 0 0\n");
  begin_session();
  EXPECT_EQ(sync(), XR_ERROR_RUNTIME_FAILURE);
  EXPECT_EQ(sync(), XR_SUCCESS);
  ASSERT_TRUE(wait_event([](const XrEventDataBuffer& event) {
    return event.type == XR_TYPE_EVENT_DATA_REFERENCE_SPACE_CHANGE_PENDING;
  }));
  XrSpaceLocation location{XR_TYPE_SPACE_LOCATION, nullptr, 0, {}};
  ASSERT_EQ(xrLocateSpace(view_, stage_, now(), &location), XR_SUCCESS);
  EXPECT_NEAR(location.pose.position.x, -1.0f, 1e-5f);
}

TEST_F(XrRuntime, BearsASecondThreadBesideTheFrames) {
  begin("refresh 500\nat 0 pose left-hand -1 1 0 0 0 0 1\nat 1 pose left-hand 1 1 0 0 0 0 1\n");
  begin_session();
  std::atomic<bool> is_over{false};
  std::thread locator([&] {
    while (!is_over) {
      XrSpaceLocation location{XR_TYPE_SPACE_LOCATION, nullptr, 0, {}};
      EXPECT_EQ(xrLocateSpace(hand_, stage_, now(), &location), XR_SUCCESS);
      EXPECT_EQ(sync(), XR_SUCCESS);
    }
  });
  XrTime last = 0;
  for (int i = 0; i < 100; ++i) {
    XrFrameState state{XR_TYPE_FRAME_STATE, nullptr, 0, 0, 0};
    EXPECT_EQ(xrWaitFrame(session_, nullptr, &state), XR_SUCCESS);
    EXPECT_GT(state.predictedDisplayTime, last);
    EXPECT_FALSE(state.shouldRender);
    last = state.predictedDisplayTime;
    EXPECT_EQ(xrBeginFrame(session_, nullptr), XR_SUCCESS);
    const XrFrameEndInfo end{XR_TYPE_FRAME_END_INFO,           nullptr, last,
                             XR_ENVIRONMENT_BLEND_MODE_OPAQUE, 0,       nullptr};
    EXPECT_EQ(xrEndFrame(session_, &end), XR_SUCCESS);
  }
  is_over = true;
  locator.join();
  end_session();
  destroy();
  EXPECT_TRUE(has_recorded("frame 99 "));
  EXPECT_FALSE(has_recorded("misuse")) << record();
}

}  // namespace
}  // namespace dance
