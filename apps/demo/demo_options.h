// What a demo is asked to be, and the files and programs that this makes of it.
//
// Units/frames: places are metres on the stage, headings degrees about +Y.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      plan_demo() names the option that cannot be.
#pragma once

#include <string>
#include <vector>

#include "core/base/guest_id.h"
#include "core/base/result.h"
#include "testing/line/lossy_line.h"

namespace dance {

struct DemoOptions {
  double seconds = 0.0;  // 0 = until the viewer is closed; headless: 10
  int guests = 2;
  std::vector<std::string> motion;  // BVH files, dealt out to the dancers in turn
  LineWords line;                   // between house B and the server
  bool headless = false;
  bool view = true;  // false: this build has no viewer
  std::string out = "out/demo";
  bool json = false;
  double tempo_bpm = 180.0;
  // A song with its list of beats beside it; "" = the demo's own percussion; "none" = beats that
  // nobody hears.
  std::string music;
  int seed = 1;
  double hz = 60.0;
  bool film = false;     // of the comparison
  bool compare = false;  // remote dancers on the stage as their poses come too, and both measured
  std::vector<std::string> through;  // of remote dancers; empty = as a house without a session file
  int port = 0;                      // of the server; 0 = one that is free
};

// Where the demo's programs have their session files, reports and talk: pictures and log lie above.
inline std::string programs_folder(const DemoOptions& options) { return options.out + "/programs"; }

// One dancer of the demo and the program that dances it.
struct DemoDancer {
  GuestId guest;
  int house = 0;  // 0 = A, 1 = B
  std::string program;
  std::vector<std::string> arguments;
};

struct DemoPlan {
  std::string bus_url[2];
  std::string session_file[2];
  std::string log_file;
  std::string song;  // "" = none is played
  int server_port = 0;
  int line_port = 0;  // 0 = no emulated line
  std::vector<DemoDancer> dancers;
};

// Makes the out folder, writes the two session files into it and deals out the dancers. Reads the
// motion files, so that a broken one is said before anything starts.
Result<DemoPlan> plan_demo(const DemoOptions& options);

}  // namespace dance
