// dance avatar make: an avatar of the project's own design, as a VRM 1.0 file.
//
// Threads: call from main.
// Failure: wrong options are exit code 2, a file that cannot be written is 1.
#pragma once

namespace dance {

int avatar_make_main(int argc, char** argv);

}  // namespace dance
