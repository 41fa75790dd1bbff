// dance convert: a recorded night from one kind of file to another.
#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "apps/convert/conversion.h"
#include "consumers/rate_limit.h"
#include "core/program/program.h"
#include "core/program/talk.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance convert logs/couple-packed.lcm couple.glb              for Blender and game engines
  dance convert logs/couple-packed.lcm alice.bvh --guest alice
  dance convert logs/couple-packed.lcm couple.mcap             for Foxglove
  dance convert logs/couple-packed.lcm couple.csv --hz 10      for a spreadsheet
  dance convert dance.bvh.xz dance.lcm --guest carla           for dance replay, as carla
  dance convert night.mcap night.lcm                           and back
  dance convert huge.glb right.glb --unit cm                   where a file is not in metres
It reads .lcm (packed or plain) .bvh .bvh.xz .glb .vrma .vrm .gltf .mcap .csv and
writes .lcm .bvh .glb .mcap .csv.
)";

struct Options {
  ConversionOptions conversion;
  std::string guest;
  std::string where;
  bool json = false;
};

Result<void> convert(Options& options) {
  if (!options.guest.empty()) options.conversion.guest = GuestId::parse(options.guest).value();
  if (!options.where.empty()) options.conversion.where = find_where(options.where);
  DANCE_TRY(const Conversion conversion, convert_recording(options.conversion));
  const std::string& to = options.conversion.to;
  for (const std::string& note : conversion.notes) talk::info("{}", note);
  if (options.json) {
    const nlohmann::ordered_json report{{"frames", conversion.frames},
                                        {"guests", conversion.guests},
                                        {"seconds", conversion.seconds},
                                        {"out", to}};
    std::puts(report.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
  } else {
    fmt::print("{}: {} frames of {} {}, {:.1f} s\n", to, conversion.frames, conversion.guests,
               conversion.guests == 1 ? "guest" : "guests", conversion.seconds);
  }
  if (conversion.lost.empty() && conversion.left_out.empty()) return {};
  std::string what = options.conversion.from + ": ";
  if (!conversion.lost.empty()) what += "damaged: " + conversion.lost + "; ";
  if (!conversion.left_out.empty()) what += "left out: " + conversion.left_out + "; ";
  return fail(what + to + " holds all the rest");
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::Options options;
  dance::CommandLine line("Converts a recorded dance from one kind of file to another.",
                          "dance convert");
  line.add("IN", options.conversion.from, "file to read, by its content").required();
  line.add("OUT", options.conversion.to,
           "file to write, by the end of its name; it must not be there yet")
      .required();
  line.add("--guest", options.guest, "only this dancer; of a BVH, what to call its dancer")
      .guest_name();
  line.add("--hz", options.conversion.hz,
           "frames a second of a BVH or GLB (0: 60); else at most so many poses of each dancer "
           "(0: all)")
      .range(0.0, dance::kFastestRate_hz);
  line.add("--where", options.where,
           "which poses of an LCM log; without it those of the stage, where it has some")
      .one_of({"stage", "capture", "guest"});
  line.add_choice<double>(
      "--unit", options.conversion.retarget.metres_per_unit,
      {{"m", 1.0}, {"dm", 0.1}, {"cm", 0.01}, {"mm", 0.001}, {"ft", 0.3048}, {"in", 0.0254}},
      "of a BVH or glTF whose figure has the wrong size: m, dm, cm, mm, ft, in");
  line.add_choice<dance::UpAxis>("--up", options.conversion.retarget.up,
                                 {{"y", dance::UpAxis::kY}, {"z", dance::UpAxis::kZ}},
                                 "axis of a BVH or glTF that points up: y or z; default: judged by "
                                 "a BVH's stance, y of a glTF");
  line.add_flag("--json", options.json, "report as JSON on stdout");
  line.finally([&] { return dance::check_rate(options.conversion.hz); });
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::convert(options); });
}
