// dance doctor: checks this machine, and names the command that mends each finding.

#include <cstdio>
#include <nlohmann/json.hpp>

#include "apps/doctor/doctor_checks.h"
#include "apps/doctor/doctor_cluster.h"
#include "core/base/text/plain_text.h"
#include "core/bus/bus.h"
#include "core/program/program.h"
#include "tunnel/server/program/cluster/cluster_options.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance doctor            a line for each finding; exit 1 if the main job could not run
  dance doctor --json     the same for scripts
  dance doctor --cluster nats://a:4222,nats://b:4222,nats://c:4222
                          NATS and the servers there instead, for who runs servers
)";

const char* word_of(Finding::Grade grade) {
  return grade == Finding::Grade::kOk ? "ok" : grade == Finding::Grade::kNote ? "note" : "problem";
}

struct DoctorOptions {
  std::string bus;
  ClusterOptions cluster;
  bool json = false;
};

Result<void> run_doctor(const DoctorOptions& options) {
  const bool json = options.json;
  std::vector<Finding> findings;
  if (options.cluster.urls.empty()) {
    findings = examine_machine(bus_url_or_default(options.bus));
  } else {
    DANCE_TRY(const NatsOptions nats, nats_options_of(options.cluster));
    findings = examine_cluster(nats);
  }
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  int problems = 0;
  for (const Finding& finding : findings) {
    problems += finding.grade == Finding::Grade::kProblem ? 1 : 0;
    list.push_back({{"name", finding.name},
                    {"grade", word_of(finding.grade)},
                    {"what", finding.what},
                    {"cure", finding.cure}});
    if (json) continue;
    std::printf("%-8s %-15s %s\n", word_of(finding.grade), finding.name.c_str(),
                plain_text(finding.what).c_str());
    if (!finding.cure.empty())
      std::printf("%-8s %-15s   %s\n", "", "", plain_text(finding.cure).c_str());
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
  dance::DoctorOptions options;
  dance::CommandLine line("Checks this machine, and names the command that mends each finding.",
                          "dance doctor");
  line.add("--bus", options.bus, "LCM URL of the house's bus");
  line.add_flag("--json", options.json, "as JSON");
  dance::add_cluster_options(
      line, options.cluster,
      "NATS servers of a cluster to check instead, as nats://A:4222,nats://B:4222");
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run_doctor(options); });
}
