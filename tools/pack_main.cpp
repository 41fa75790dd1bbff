// dance pack: makes an LCM log smaller by packing its poses and hands, losing nothing.
#include <csignal>
#include <cstdio>

#include "core/program/program.h"
#include "core/program/talk.h"
#include "tools/log_converter.h"

namespace dance {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  dance pack logs/evening.lcm -o logs/evening-packed.lcm\n"
    "  dance replay logs/evening-packed.lcm           plays it as it is\n"
    "  dance unpack logs/evening-packed.lcm -o again.lcm\n"
    "  cmp logs/evening.lcm again.lcm                 not a byte differs, if none was packed\n"
    "  dance record --packed                          packs while it records\n";

Result<void> pack(const std::string& from, const std::string& to) {
  DANCE_TRY(const LogConversion conversion, convert_log(from, to, LogForm::kPacked));
  std::fputs(conversion_line(conversion).c_str(), stdout);
  if (const std::string before = packed_before(conversion); !before.empty())
    talk::warn("{}", before);
  return check_is_whole(conversion);
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  // A limit on file sizes shall be an error of write(), not the end of the process.
  std::signal(SIGXFSZ, SIG_IGN);
  std::string from, to;
  dance::CommandLine line(
      "Packs the poses and hands of an LCM log to about a third of their bytes; not a bit is lost.",
      "dance pack");
  line.add("FILE", from, "LCM log to pack").required();
  line.add("-o,--output", to, "file to write; it must not be there yet").required();
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::pack(from, to); });
}
