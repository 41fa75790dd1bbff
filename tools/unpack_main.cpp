// dance unpack: a packed log as a plain LCM log again.
#include <csignal>
#include <cstdio>

#include "core/program/program.h"
#include "tools/log_converter.h"

namespace dance {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  dance unpack logs/evening.lcm -o logs/plain.lcm\n"
    "  lcm-logplayer logs/plain.lcm                   any LCM tool knows its poses\n"
    "  dance replay logs/evening.lcm                  needs no unpacking\n";

Result<void> unpack(const std::string& from, const std::string& to) {
  DANCE_TRY(const LogConversion conversion, convert_log(from, to, LogForm::kPlain));
  std::fputs(conversion_line(conversion).c_str(), stdout);
  return check_is_whole(conversion);
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  // A limit on file sizes shall be an error of write(), not the end of the process.
  std::signal(SIGXFSZ, SIG_IGN);
  std::string from, to;
  dance::CommandLine line(
      "Makes a plain LCM log of a packed one: event for event the bytes that were on the bus.",
      "dance unpack");
  line.add("FILE", from, "packed LCM log, of dance record --packed or dance pack").required();
  line.add("-o,--output", to, "file to write; it must not be there yet").required();
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::unpack(from, to); });
}
