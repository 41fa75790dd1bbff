// dance avatar choose: says over the bus how a guest wants to be drawn.
//
// Threads: call from main.
// Failure: wrong options are exit code 2; a file that cannot be read or a name that is none, 1.
#pragma once

namespace dance {

int avatar_choose_main(int argc, char** argv);

}  // namespace dance
