// dance unpack: a packed log as a plain LCM log again.
#include "apps/record/log_converter_program.h"

int main(int argc, char** argv) {
  return dance::run_log_converter(
      dance::LogForm::kPlain,
      {"Makes a plain LCM log of a packed one: event for event the bytes that were on the bus.",
       "dance unpack", "packed LCM log, of dance record --packed or dance pack",
       "Examples:\n"
       "  dance unpack logs/evening.lcm -o logs/plain.lcm\n"
       "  lcm-logplayer logs/plain.lcm                   any LCM tool knows its poses\n"
       "  dance replay logs/evening.lcm                  needs no unpacking\n"},
      argc, argv);
}
