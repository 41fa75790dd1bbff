#include "research/beats/aubio_beats.h"

#include <fstream>

#include "research/outside_program.h"
#include "testing/scratch_folder.h"

namespace dance {

Result<std::vector<double>> aubio_beats(const std::string& audio_path) {
  DANCE_TRY(const auto scratch, ScratchFolder::make());
  const std::string output = scratch->file("beats");
  if (auto ran = run_outside_program({.name = "aubiotrack",
                                      .package = "aubio-tools",
                                      .arguments = {"-i", audio_path},
                                      .output_file = output,
                                      .talk_file = scratch->file("talk")});
      !ran)
    return fail(audio_path + ": nothing to compare with, " + ran.error().what);
  std::ifstream file(output);
  std::vector<double> beats;
  for (double time_s = 0.0; file >> time_s;) beats.push_back(time_s);
  return beats;
}

}  // namespace dance
