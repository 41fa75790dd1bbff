#include "apps/record/log_converter_program.h"

#include <cstdio>

#include "core/program/program.h"
#include "core/program/talk.h"

namespace dance {
namespace {

Result<void> convert(const std::string& from, const std::string& to, LogForm form) {
  DANCE_TRY(const LogConversion conversion, convert_log(from, to, form));
  std::fputs(conversion_line(conversion).c_str(), stdout);
  if (const std::string before = packed_before(conversion); !before.empty())
    talk::warn("{}", before);
  return check_is_whole(conversion);
}

}  // namespace

int run_log_converter(LogForm form, const LogConverterWords& words, int argc, char** argv) {
  std::string from, to;
  CommandLine line(words.purpose, words.name);
  line.add("FILE", from, words.file).required();
  line.add("-o,--output", to, "file to write; it must not be there yet").required();
  line.footer(words.examples);
  return run_program(line, argc, argv, [&] { return convert(from, to, form); });
}

}  // namespace dance
