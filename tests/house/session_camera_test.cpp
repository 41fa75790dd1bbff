// Cameras in a session file.
#include <gtest/gtest.h>

#include <algorithm>

#include "house/house_camera.h"
#include "house/session.h"

namespace dance {
namespace {

constexpr const char* kCameraHouse = "[house]\nguest = \"alice\"\nserver = \"example.org:7400\"\n";

TEST(SessionCamera, NamesTheCameraOfADancer) {
  const auto session = parse_session(
      std::string(kCameraHouse) +
          "[[produce]]\nkind = \"camera\"\nguest = \"alice\"\ndevice = \"/dev/video2\"\nmodel = "
          "\"lite\"\n"
          "calibration = \"left.yml\"\nheight = 1.68\nmirror = true\nhands = false\nface = true\n"
          "[[produce]]\nkind = \"camera\"\nguest = \"bob\"\ndevice = \"takes/bob.mp4\"\n"
          "also = \"takes/bob-aside.mp4\"\n"
          "[[produce]]\nkind = \"camera\"\nguest = \"cara\"\ndevice = \"1\"\n"
          "[[produce]]\nkind = \"camera\"\nguest = \"dora\"\ndevice = \"HD Webcam\"\n",
      "/home/alice/s.toml");
  ASSERT_TRUE(session) << session.error().what;
  EXPECT_TRUE(session->producers.empty());
  ASSERT_EQ(session->cameras.size(), 4u);
  EXPECT_EQ(session->cameras[0].device, "/dev/video2");
  EXPECT_EQ(session->cameras[0].model, "lite");
  EXPECT_EQ(session->cameras[0].calibration, "/home/alice/left.yml");
  EXPECT_EQ(session->cameras[0].height_m, 1.68);
  EXPECT_TRUE(session->cameras[0].mirror);
  EXPECT_FALSE(session->cameras[0].hands);
  EXPECT_TRUE(session->cameras[0].face);
  EXPECT_TRUE(session->cameras[1].hands);
  EXPECT_FALSE(session->cameras[1].face) << "a face leaves the house by a wish only";
  EXPECT_EQ(session->cameras[1].device, "/home/alice/takes/bob.mp4")
      << "a file of the session's folder";
  EXPECT_EQ(session->cameras[1].also, "/home/alice/takes/bob-aside.mp4");
  EXPECT_EQ(session->cameras[0].also, "");
  EXPECT_EQ(session->cameras[2].device, "1") << "the camera's number";
  EXPECT_EQ(session->cameras[3].device, "HD Webcam") << "the camera's name";
}

TEST(SessionCamera, NamesWhoDanceBeforeOneCamera) {
  const auto session =
      parse_session(std::string(kCameraHouse) +
                        "[[produce]]\nkind = \"camera\"\nguest = \"alice\"\nheight = 1.68\n"
                        "partners = [\"bob=1.80\", \"cara\"]\n",
                    "s.toml");
  ASSERT_TRUE(session) << session.error().what;
  ASSERT_EQ(session->cameras.size(), 1u);
  const HostedCamera& camera = session->cameras[0];
  ASSERT_EQ(camera.partners.size(), 2u);
  EXPECT_EQ(camera.partners[0].guest.view(), "bob");
  EXPECT_EQ(camera.partners[0].height_m, 1.8);
  EXPECT_EQ(camera.partners[1].guest.view(), "cara");
  EXPECT_EQ(camera.partners[1].height_m, 0.0) << "not told";
  const std::vector<std::string> words = camera_arguments(camera, "udpm://");
  const auto after = [&](const std::string& option) {
    const auto at = std::find(words.begin(), words.end(), option);
    return at == words.end() || at + 1 == words.end() ? "" : *(at + 1);
  };
  EXPECT_EQ(after("--guest"), "alice,bob,cara");
  EXPECT_EQ(after("--height"), "1.680000,1.800000,0.000000");
}

}  // namespace
}  // namespace dance
