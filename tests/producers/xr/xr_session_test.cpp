// Runtime and session as a headset lets them live and die, and what is said where there is none.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/producers/xr/xr_world.h"
#include "tests/xr_loader_leaks.h"

namespace dance {
namespace {

using Over = XrDancerSession::Over;

class XrLife : public XrWorld {
 protected:
  std::string why_not(const std::string& script, XrUse use) {
    write_script(script);
    std::string line = "it opens";
    if (const auto runtime = XrRuntime::open(use); !runtime) line = runtime.error().what;
    forget_runtime();
    return line;
  }
  // The loader keeps what a runtime could do until an instance ends.
  static void forget_runtime() {
    XrInstanceCreateInfo info{};
    info.type = XR_TYPE_INSTANCE_CREATE_INFO;
    info.applicationInfo.applicationName[0] = 'a';
    info.applicationInfo.apiVersion = XR_MAKE_VERSION(1, 0, 0);
    XrInstance instance = XR_NULL_HANDLE;
    if (XR_SUCCEEDED(xrCreateInstance(&info, &instance))) xrDestroyInstance(instance);
  }
};

bool says(const std::string& line, std::initializer_list<const char*> words) {
  return std::find(line.begin(), line.end(), '\n') == line.end() &&
         std::all_of(words.begin(), words.end(),
                     [&](const char* word) { return line.find(word) != std::string::npos; });
}

TEST_F(XrLife, WithoutARuntimeOneLineNamesTheCure) {
  setenv("XR_RUNTIME_JSON", folder_.path("nowhere.json").c_str(), 1);
  const std::string line = why_not("", XrUse::kTracking);
  EXPECT_TRUE(says(line, {"no OpenXR runtime", "SteamVR", "XR_RUNTIME_JSON"})) << line;
}

TEST_F(XrLife, AManifestWhoseLibraryIsMissingIsNamedWithTheLibrary) {
  const std::string manifest = folder_.path("gone.json");
  std::ofstream(manifest) << R"({"file_format_version": "1.0.0", "runtime": {"library_path": )"
                          << R"("/opt/gone/libruntime.so"}})";
  setenv("XR_RUNTIME_JSON", manifest.c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
  std::string line = why_not("", XrUse::kTracking);
  EXPECT_TRUE(says(line, {manifest.c_str(), "is missing: /opt/gone/libruntime.so", "install"}))
      << line;
  // A library that is there, and none.
  std::ofstream(folder_.path("libtext.so")) << "no library";
  std::ofstream(manifest) << R"({"file_format_version": "1.0.0", "runtime": {"library_path": )"
                          << R"("./libtext.so"}})";
  line = why_not("", XrUse::kTracking);
  EXPECT_TRUE(says(line, {manifest.c_str(), "cannot be loaded", "libtext.so", "install"})) << line;
}

TEST_F(XrLife, ARuntimeThatLacksSomethingIsOneLineThatNamesItAndTheCure) {
  std::string line = why_not("without XR_MND_headless\n", XrUse::kTracking);
  EXPECT_TRUE(says(line, {"XR_MND_headless", "leave --tracking-only out"})) << line;
  line = why_not("without XR_KHR_convert_timespec_time\n", XrUse::kTracking);
  EXPECT_TRUE(says(line, {"XR_KHR_convert_timespec_time", "use another runtime"})) << line;
  line = why_not("without XR_KHR_opengl_enable\n", XrUse::kDisplay);
  EXPECT_TRUE(says(line, {"XR_KHR_opengl_enable", "--tracking-only"})) << line;
  line = why_not("at 0 fail xrCreateInstance XR_ERROR_RUNTIME_FAILURE\n", XrUse::kTracking);
  EXPECT_TRUE(says(line, {"does not answer", "XR_ERROR_RUNTIME_FAILURE", "running"})) << line;
  // What is not needed may be missing.
  EXPECT_EQ(why_not("without XR_MND_headless\n", XrUse::kDisplay), "it opens");
  EXPECT_EQ(why_not("without XR_KHR_opengl_enable\nwithout XR_EXT_hand_tracking\n"
                    "without XR_HTCX_vive_tracker_interaction\nwithout XR_FB_body_tracking\n",
                    XrUse::kTracking),
            "it opens");
}

TEST_F(XrLife, AHeadsetThatIsAsleepIsOneLineAndIsHereOnceItIsWorn) {
  const std::string line = why_not("no system\n", XrUse::kTracking);
  EXPECT_TRUE(says(line, {"asleep or not connected", "put it on", "plug it in"})) << line;
  write_script("no system until 0.3\n");
  EXPECT_FALSE(XrRuntime::open(XrUse::kTracking));
  bool is_there = false;
  for (int i = 0; i < 3000 && !is_there; ++i) {
    is_there = XrRuntime::open(XrUse::kTracking).has_value();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_TRUE(is_there);
}

TEST_F(XrLife, TellsWhatTheHeadsetSees) {
  open("body on\n");
  EXPECT_NE(runtime_->name().find("DanceGraph test runtime"), std::string::npos);
  EXPECT_TRUE(runtime_->sees_hands());
  EXPECT_TRUE(runtime_->sees_body_fb());
  EXPECT_TRUE(runtime_->sees_legs_fb());
  open("system hands off\nbody on\nwithout XR_META_body_tracking_full_body\n");
  EXPECT_FALSE(runtime_->sees_hands());
  EXPECT_TRUE(runtime_->sees_body_fb());
  EXPECT_FALSE(runtime_->sees_legs_fb());
  open("body on\nwithout XR_FB_body_tracking\n");
  EXPECT_FALSE(runtime_->has("XR_META_body_tracking_full_body")) << "it is a part of the other";
  EXPECT_FALSE(runtime_->sees_body_fb());
  EXPECT_TRUE(runtime_->sees_body_bd());
}

TEST_F(XrLife, ConvertsTimesThereAndBackAndRefusesNone) {
  open("");
  const MonoTime now = mono_now();
  EXPECT_GT(runtime_->xr_of(now), 0);
  EXPECT_NE(runtime_->xr_of(now), now.since_zero_ns()) << "its clock is another";
  EXPECT_EQ(runtime_->mono_of(runtime_->xr_of(now)), now);
  EXPECT_EQ(runtime_->xr_of(now + Duration::s(1)) - runtime_->xr_of(now), 1'000'000'000);
  EXPECT_FALSE(runtime_->mono_of(0).is_set());
  EXPECT_FALSE(runtime_->mono_of(-5).is_set());
}

TEST_F(XrLife, RunsHasFocusAndEndsAsItWasAsked) {
  open("");
  EXPECT_FALSE(session_->is_running());
  EXPECT_TRUE(session_->has_stage());
  ASSERT_TRUE(pump_until([&] { return session_->is_focused(); }));
  EXPECT_TRUE(session_->is_running());
  EXPECT_TRUE(session_->is_visible());
  EXPECT_EQ(session_->over(), Over::kNot);
  session_->ask_to_end();
  ASSERT_TRUE(pump_until([&] { return session_->over() != Over::kNot; }));
  EXPECT_EQ(session_->over(), Over::kEnded);
  EXPECT_FALSE(session_->is_running());
  EXPECT_TRUE(has_recorded("session EXITING"));
}

TEST_F(XrLife, TheHeadsetsOwnMenuTakesTheFocusAndSleepTheSession) {
  open_focused(
      "at 0.3 focus off\nat 2.5 visible off\nat 2.8 visible on\nat 3 focus on\n"
      "at 5 stop\nat 7 ready\n");
  ASSERT_TRUE(pump_until([&] { return !session_->is_focused(); }));
  ASSERT_TRUE(pump_until([&] { return session_->is_focused(); }));
  ASSERT_TRUE(pump_until([&] { return !session_->is_running(); }));
  EXPECT_FALSE(session_->is_focused());
  EXPECT_EQ(session_->over(), Over::kNot) << "it may come back";
  ASSERT_TRUE(pump_until([&] { return session_->is_running(); }));
  ASSERT_TRUE(pump_until([&] { return session_->is_focused(); }));
}

TEST_F(XrLife, AnEndByTheHeadsetsMenuIsTheUsersWish) {
  open_focused("at 0.2 exit\n");
  ASSERT_TRUE(pump_until([&] { return session_->over() != Over::kNot; }));
  EXPECT_EQ(session_->over(), Over::kEnded);
}

TEST_F(XrLife, ALostSessionIsToldAndAnotherWorks) {
  open_focused("at 0.2 lose_session\n");
  ASSERT_TRUE(pump_until([&] { return session_->over() != Over::kNot; }));
  EXPECT_EQ(session_->over(), Over::kLost);
  EXPECT_FALSE(session_->is_running());
  EXPECT_FALSE(session_->is_focused());
  // Calls that fail harm nothing.
  for (int i = 0; i < 100; ++i) pump(), input_->head(xr_now());
  session_->ask_to_end();
  open_again();
  EXPECT_TRUE(pump_until([&] { return session_->is_focused(); }));
}

TEST_F(XrLife, ALostInstanceIsToldAndAnotherWorks) {
  open_focused("at 0.2 lose_instance\n");
  ASSERT_TRUE(pump_until([&] { return session_->over() != Over::kNot; }));
  EXPECT_EQ(session_->over(), Over::kLost);
  ASSERT_TRUE(pump_to(0.5));
  EXPECT_FALSE(input_->head(xr_now()));
  EXPECT_FALSE(runtime_->mono_of(1'000'000'000).is_set());
  open_again();
  EXPECT_TRUE(pump_until([&] { return session_->is_focused(); }));
}

TEST_F(XrLife, ASessionThatCannotBeginIsLostOrTriedAgain) {
  open("at 0 fail xrBeginSession XR_ERROR_RUNTIME_FAILURE\n");
  ASSERT_TRUE(pump_until([&] { return session_->over() != Over::kNot; }));
  EXPECT_EQ(session_->over(), Over::kLost);
  open_again();
  EXPECT_TRUE(pump_until([&] { return session_->is_focused(); }));
}

TEST_F(XrLife, CountsHowOftenTheRuntimeMovedItsSpace) {
  open_focused("at 0.3 jump 1 0 0 90\nat 0.6 jump 0 0 2 0\n");
  const auto before = input_->head(xr_now());
  ASSERT_TRUE(before);
  ASSERT_TRUE(pump_until([&] { return session_->recentres() >= 1; }));
  ASSERT_TRUE(pump_until([&] {
    const auto head = input_->head(xr_now());
    return head && (head->p_m - before->p_m).norm() > 0.5f;
  }));
  ASSERT_TRUE(pump_until([&] { return session_->recentres() >= 2; }));
  EXPECT_EQ(session_->recentres(), 2u) << "that of its local space is not ours";
}

TEST_F(XrLife, WithoutAStageItIsTheLocalSpaceWhoseFloorIsNotKnown) {
  open_focused("no stage\nat 0.3 jump 1 0 0 0\n");
  EXPECT_FALSE(session_->has_stage());
  std::optional<XrPlace> head;
  ASSERT_TRUE(pump_until([&] { return (head = input_->head(xr_now())).has_value(); }));
  EXPECT_NEAR(head->p_m.y(), 0.0f, 1e-4f);
  EXPECT_TRUE(pump_until([&] { return session_->recentres() == 1; }));
}

}  // namespace
}  // namespace dance
