// dance capture: a dancer before a camera, or in a video.

#include <cstdio>

#include "core/program/program.h"
#include "producers/camera/program/capture_calibrate.h"
#include "producers/camera/program/capture_check.h"
#include "producers/camera/program/capture_program.h"
#include "producers/camera/v4l2/camera_list.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance capture --list                            which cameras are here, and what they give
  dance capture --check --text                    is the dancer seen well? says what to mend
  dance capture                                   the first of them sees alice
  dance capture /dev/video2 --guest bob --preview
  dance capture evening.mp4 --guest bob --loop    a video as if it were a camera
  dance capture --guest alice,bob --preview       two dancers before one camera
  dance capture --height 1.68 --mirror            as tall as she is; the stage as a mirror
  dance capture --calibrate camera.yml --board 9x6 --square 25
  dance capture --calibration camera.yml
  dance capture /dev/video0 --also /dev/video2 --height 1.68    two webcams, no board
  dance capture zed --calibration SN1234.conf     two cameras side by side
  dance capture --record takes/first              video beside poses
)";

Result<void> run_capture(const CaptureOptions& options) {
  if (options.only_lists) {
    const auto cameras = list_cameras();
    std::fputs((options.wants_json ? camera_json(cameras) : camera_table(cameras)).c_str(), stdout);
    return {};
  }
  if (!options.also.empty() && (options.only_checks || !options.calibrate_file.empty()))
    return fail("--also is for dancing: --check and --calibrate look through one camera");
  if (options.only_checks) {
    if (options.guests.size() > 1)
      return fail("--check looks at one dancer; name one guest, or leave --guest out");
    DANCE_TRY(auto check, CaptureCheck::open(options));
    return check->run();
  }
  if (!options.calibrate_file.empty()) return calibrate_camera(options);
  DANCE_TRY(auto program, CaptureProgram::open(options));
  program->run();
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  using dance::EngineKind;
  using dance::PoseNetworkModel;
  dance::CaptureOptions options;
  dance::CommandLine line(
      "Dancers before a camera, or in a video: poses on POSE/capture/<guest>. The picture itself "
      "goes nowhere.",
      "dance capture");
  line.add("SOURCE", options.source,
           "a camera (/dev/video0, 0, a part of its name), a video, a picture or a folder of "
           "pictures; without it the first camera");
  line.add_flag("--list", options.only_lists, "which cameras are here, and what they give");
  line.add_flag("--check", options.only_checks,
                "how the camera sees the dancer, without a bus: small pictures and what is seen in "
                "them, as bytes for a program on stdout");
  line.add_flag("--text", options.wants_text,
                "with --check: what to mend, as lines to read, in the language of LANG");
  line.add("--guest", options.guests,
           "who dances; of several dancers all, as alice,bob, from the left to the right of the "
           "first picture; alice where it is not given")
      .split_at(',')
      .guest_name();
  line.add("--size", options.size, "of the picture, like 1280x720; chosen where it is not given");
  line.add("--hz", options.hz, "pictures a second of a camera; 0 = as many as it gives, up to 60")
      .range(0.0, 1000.0);
  line.add("--format", options.encoding, "how the camera packs them; chosen where it is not given")
      .one_of({"YUYV", "MJPG", "NV12", "GREY"});
  line.add_flag("--loop", options.loops, "a video begins again at its end");
  line.add_choice<PoseNetworkModel>(
      "--model", options.model,
      {{"lite", PoseNetworkModel::kLite},
       {"full", PoseNetworkModel::kFull},
       {"heavy", PoseNetworkModel::kHeavy}},
      "size of the pose network; full where it is not given, lite is twice as fast");
  line.add_choice<EngineKind>("--engine", options.engine,
                              {{"auto", EngineKind::kFastest},
                               {"xnnpack", EngineKind::kXnnpack},
                               {"opencv", EngineKind::kOpenCv}},
                              "what computes it");
  line.add("--models", options.models_folder,
           "folder of the networks, instead of where `dance fetch-models` puts them");
  line.add("--follow", options.follow,
           "of several people: largest, or who is nearest to a place, as shares of the picture: "
           "0.3,0.5");
  line.add("--calibration", options.calibration,
           "of the lens, or of two cameras: what --calibrate wrote, OpenCV's YAML, or a ZED's "
           "SN<serial>.conf");
  line.add("--right", options.right, "the right camera, where it is a device of its own");
  line.add("--also", options.also,
           "another camera or video of the same dancer from another side, without calibration; can "
           "be given three times")
      .one_each_time();
  line.add("--also-calibration", options.also_calibration,
           "of the lens of each --also, in their order")
      .one_each_time();
  line.add("--also-fov", options.also_fov_deg, "degrees that pictures of each --also are wide")
      .one_each_time()
      .range(20.0, 150.0);
  line.add("--fov", options.fov_deg,
           "degrees that the picture is wide, where no calibration says it")
      .range(20.0, 150.0)
      .shows_default();
  line.add("--height", options.heights_m,
           "of the dancer, in metres; of several dancers all, as 1.8,1.65; 0 = as it looks")
      .split_at(',')
      .range(0.0, 2.5);
  line.add("--smooth", options.smooth, "0 hardly smooths, 1 as usual, 2 twice as much")
      .range(0.0, 4.0)
      .shows_default();
  line.add_flag("--mirror", options.is_mirrored, "left and right change sides, as in a mirror");
  using Hands = dance::CaptureOptions::Hands;
  line.add_choice<Hands>(
      "--hands", options.hands,
      {{"auto", Hands::kWhereTheirNetworksAre}, {"on", Hands::kOn}, {"off", Hands::kOff}},
      "fingers, and wrists that follow the palms; auto: where their networks are");
  line.add_flag("--face", options.has_face,
                "the expression of the face, too: 52 numbers, head and no picture, which the "
                "others in the room get");
  line.add_flag("--preview", options.has_preview, "a window with the skeleton over the picture");
  line.add("--preview-file", options.preview_file,
           "the same as a picture file, .jpg or .png, rewritten five times a second");
  line.add("--record", options.record_folder, "keeps the video and the poses in this folder");
  line.add("--calibrate", options.calibrate_file,
           "measures the lens, or both, with a chessboard, and writes this file");
  line.add("--board", options.board, "inner corners of the chessboard, across and down")
      .shows_default();
  line.add("--square", options.square_mm, "millimetres of one of its squares")
      .range(1.0, 1000.0)
      .shows_default();
  line.add("--bus", options.bus, "LCM URL of the house's bus");
  line.add("--seconds", options.seconds, "how long; 0 = until stopped").range(0.0, 1e7);
  line.add_flag("--json", options.wants_json,
                "write what was counted to stdout at the end; with --list, the list");
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run_capture(options); });
}
