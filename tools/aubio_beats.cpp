#include "tools/aubio_beats.h"

#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>

#include "tools/child_process.h"
#include "tools/scratch_folder.h"

namespace dance {
namespace {

std::string find_program(const std::string& name) {
  const char* path = std::getenv("PATH");  // NOLINT(concurrency-mt-unsafe): one thread
  std::istringstream folders(path ? path : "/usr/bin");
  for (std::string folder; std::getline(folders, folder, ':');) {
    std::string program = folder + "/" + name;
    if (access(program.c_str(), X_OK) == 0) return program;
  }
  return "";
}

// Ten times as long as an hour of music takes it.
constexpr Duration kAubioPatience = Duration::s(300);

}  // namespace

Result<std::vector<double>> aubio_beats(const std::string& audio_path) {
  const std::string program = find_program("aubiotrack");
  if (program.empty())
    return fail("aubio is not installed, nothing to compare with: apt-get install aubio-tools");
  DANCE_TRY(const auto scratch, ScratchFolder::make());
  const std::string output = scratch->file("beats");
  DANCE_TRY(ChildProcess aubio, ChildProcess::start({.program = program,
                                                     .arguments = {"-i", audio_path},
                                                     .output_file = output,
                                                     .talk_file = scratch->file("talk")}));
  Duration waited;
  for (constexpr auto kTurn = Duration::ms(20); !aubio.has_ended(); waited += kTurn) {
    if (waited > kAubioPatience)
      return fail("aubiotrack did not come to an end with " + audio_path);
    std::this_thread::sleep_for(std::chrono::milliseconds(kTurn.count_ms()));
  }
  if (!aubio.ended_well()) return fail("aubiotrack " + audio_path + ": " + aubio.exit_text());
  std::ifstream file(output);
  std::vector<double> beats;
  for (double time_s = 0.0; file >> time_s;) beats.push_back(time_s);
  return beats;
}

}  // namespace dance
