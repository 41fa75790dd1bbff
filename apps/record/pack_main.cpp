// dance pack: makes an LCM log smaller by packing its poses and hands, losing nothing.
#include "apps/record/log_converter_program.h"

int main(int argc, char** argv) {
  return dance::run_log_converter(
      dance::LogForm::kPacked,
      {"Packs the poses and hands of an LCM log to about a third of their bytes; not a bit is "
       "lost.",
       "dance pack", "LCM log to pack",
       "Examples:\n"
       "  dance pack logs/evening.lcm -o logs/evening-packed.lcm\n"
       "  dance replay logs/evening-packed.lcm           plays it as it is\n"
       "  dance unpack logs/evening-packed.lcm -o again.lcm\n"
       "  cmp logs/evening.lcm again.lcm                 not a byte differs, if none was packed\n"
       "  dance record --packed                          packs while it records\n"},
      argc, argv);
}
