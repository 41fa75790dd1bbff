// dance avatar: makes avatars' files and says what is in them.
#include <array>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "apps/avatar/avatar_choose.h"
#include "apps/avatar/avatar_info.h"
#include "apps/avatar/avatar_list.h"
#include "apps/avatar/avatar_make.h"

namespace {

struct Action {
  std::string_view word;
  int (*run)(int argc, char** argv);
  std::string_view summary;
};

constexpr std::array kActions{
    Action{"choose", dance::avatar_choose_main, "says how a guest of this house is drawn"},
    Action{"list", dance::avatar_list_main,
           "the avatars on this machine, and who dances with them"},
    Action{"make", dance::avatar_make_main, "an avatar of the project's own design, as a VRM file"},
    Action{"info", dance::avatar_info_main, "what is in a file, and whether it can dance here"},
};

// As CLI11 prints it, of which the manual page is made.
void print_help(std::FILE* out) {
  std::fputs(
      "Avatars: figures that guests dance with.\n"
      "Usage: dance avatar ACTION [OPTIONS]\n\nActions:\n",
      out);
  for (const Action& action : kActions)
    std::fprintf(out, "  %-8.*s  %.*s\n", static_cast<int>(action.word.size()), action.word.data(),
                 static_cast<int>(action.summary.size()), action.summary.data());
  std::fputs(
      "\ndance avatar ACTION --help tells more.\n\nExamples:\n"
      "  dance avatar choose alice me.vrm\n"
      "  dance avatar make --out me.vrm --look teo --height 1.9\n"
      "  dance avatar info me.vrm\n",
      out);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string_view word = argc > 1 ? argv[1] : "";
  if (word == "--help" || word == "-h") {
    print_help(stdout);
    return 0;
  }
  for (const Action& action : kActions) {
    if (action.word != word) continue;
    std::string name = "dance-avatar-" + std::string(word);
    std::vector<char*> arguments{name.data()};
    arguments.insert(arguments.end(), argv + 2, argv + argc);
    arguments.push_back(nullptr);
    return action.run(argc - 1, arguments.data());
  }
  std::string words;
  for (const Action& action : kActions)
    words += (words.empty() ? "" : ", ") + std::string(action.word);
  std::fprintf(stderr, "dance avatar: say what to do: %s; dance avatar --help tells more\n",
               words.c_str());
  return 2;
}
