// dance avatar list: the avatars on this machine, and who dances with them.
//
// Threads: call from main.
// Failure: wrong options are exit code 2; a bus that cannot be had, 1.
#pragma once

namespace dance {

int avatar_list_main(int argc, char** argv);

}  // namespace dance
