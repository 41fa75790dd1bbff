#include "lobby/checks/camera_list.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

TEST(LobbyCameraList, ReadsWhatTheProgramPrints) {
  const auto list =
      parse_camera_list(R"([{"device":"/dev/video0","name":"HD Webcam","socket":"usb-1",)"
                        R"("mode":"1280x720 YUYV at 30 Hz","trouble":""},)"
                        R"({"device":"/dev/video2","name":"","socket":"","mode":"",)"
                        R"("trouble":"/dev/video2: in use"}])");
  ASSERT_TRUE(list);
  ASSERT_EQ(list->size(), 2u);
  EXPECT_EQ((*list)[0].device, "/dev/video0");
  EXPECT_EQ((*list)[0].name, "HD Webcam");
  EXPECT_EQ((*list)[0].mode, "1280x720 YUYV at 30 Hz");
  EXPECT_EQ((*list)[1].name, "/dev/video2") << "the device, where it has no name";
  EXPECT_EQ((*list)[1].trouble, "/dev/video2: in use");
}

TEST(LobbyCameraList, NoCameraIsAnEmptyList) {
  const auto list = parse_camera_list("[]");
  ASSERT_TRUE(list);
  EXPECT_TRUE(list->empty());
}

TEST(LobbyCameraList, RefusesWhatIsNoList) {
  EXPECT_FALSE(parse_camera_list(""));
  EXPECT_FALSE(parse_camera_list("[{\"device\":\"/dev/video0\""));
  EXPECT_FALSE(parse_camera_list("{}"));
  EXPECT_FALSE(parse_camera_list("[1]"));
  EXPECT_FALSE(parse_camera_list(R"([{"name":"without a device"}])"));
  EXPECT_FALSE(parse_camera_list(R"([{"device":"--record"}])")) << "no option is a device";
}

TEST(LobbyCameraList, ANameMovesNoCursor) {
  const auto list = parse_camera_list(R"([{"device":"/dev/video0","name":"HD\u001b[2J"}])");
  ASSERT_TRUE(list);
  EXPECT_EQ((*list)[0].name, "HD?[2J");
}

}  // namespace
}  // namespace dance
