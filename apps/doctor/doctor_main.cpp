// dance doctor: checks this machine, and names the command that mends each finding.

#include <cstdio>
#include <nlohmann/json.hpp>

#include "apps/doctor/doctor_checks.h"
#include "core/bus/bus.h"
#include "core/program/program.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance doctor            a line for each finding; exit 1 if the main job could not run
  dance doctor --json     the same for scripts
)";

const char* word_of(Finding::Grade grade) {
  return grade == Finding::Grade::kOk ? "ok" : grade == Finding::Grade::kNote ? "note" : "problem";
}

Result<void> run_doctor(const std::string& bus, bool json) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  int problems = 0;
  for (const Finding& finding : examine_machine(bus_url_or_default(bus))) {
    problems += finding.grade == Finding::Grade::kProblem ? 1 : 0;
    list.push_back({{"name", finding.name},
                    {"grade", word_of(finding.grade)},
                    {"what", finding.what},
                    {"cure", finding.cure}});
    if (json) continue;
    std::printf("%-8s %-15s %s\n", word_of(finding.grade), finding.name.c_str(),
                finding.what.c_str());
    if (!finding.cure.empty()) std::printf("%-8s %-15s   %s\n", "", "", finding.cure.c_str());
  }
  if (json) std::printf("%s\n", nlohmann::ordered_json{{"findings", list}}.dump(2).c_str());
  if (problems > 0)
    return fail(std::to_string(problems) +
                " problem(s) keep the main job from running; the cures stand beside them");
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  std::string bus;
  bool json = false;
  dance::CommandLine line("Checks this machine, and names the command that mends each finding.",
                          "dance doctor");
  line.add("--bus", bus, "LCM URL of the house's bus");
  line.add_flag("--json", json, "as JSON");
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run_doctor(bus, json); });
}
