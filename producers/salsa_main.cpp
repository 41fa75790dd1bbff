// dance salsa: a synthetic salsa dancer on the bus, for machines with no camera and no data.

#include <spdlog/spdlog.h>

#include "core/program/program.h"
#include "producers/producer_program.h"
#include "producers/salsa_dancer.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance salsa                                   alice, following
  dance salsa --guest bob --role lead           her partner, in another terminal
  dance salsa --guest ann --tempo 200 --seed 7 --place 2,0,45
)";

struct SalsaOptions {
  ProducerOptions producer;
  std::string guest = "alice";
  std::string role = "follow";
  std::string place;
  SalsaStyle style;
};

Result<void> run_salsa(SalsaOptions& options) {
  const auto guest = GuestId::parse(options.guest);
  if (!guest) return fail("--guest '" + options.guest + "': " + kGuestIdRule);
  if (!options.place.empty()) {
    DANCE_TRY(const StagePlace place, parse_place(options.place));
    options.style.x_m = place.x_m;
    options.style.z_m = place.z_m;
    options.style.heading_deg = place.heading_deg;
  }
  options.style.role = options.role == "lead" ? SalsaRole::kLead : SalsaRole::kFollow;
  DANCE_TRY(const SalsaStyle style, checked_style(options.style));
  // Unless told otherwise the dance counts from the clock's zero, so that all salsa dancers of a machine are in step.
  if (options.producer.start_us == 0) options.producer.start_us = 1;
  DANCE_TRY(auto program, ProducerProgram::open(options.producer));
  program->add(std::make_unique<SalsaDancer>(style), *guest);
  spdlog::info("{} dances on POSE/capture/{}; Ctrl-C ends it", options.guest, options.guest);
  program->run([] { return true; });
  spdlog::info("{} poses", program->sent());
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::SalsaOptions options;
  CLI::App app{"A synthetic salsa dancer: basic steps with hip sway and arms, lead or follow.",
               "dance salsa"};
  app.add_option("--guest", options.guest, "who dances")->capture_default_str();
  app.add_option("--role", options.role,
                 "lead or follow; two with the same tempo, seed and start are a couple")
      ->check(CLI::IsMember({"lead", "follow"}))
      ->capture_default_str();
  app.add_option("--tempo", options.style.tempo_bpm, "beats a minute")
      ->check(CLI::Range(dance::kSlowestSalsa_bpm, dance::kFastestSalsa_bpm));
  app.add_option("--seed", options.style.seed, "which dance: figures, bodies, small variations")
      ->check(CLI::Range(0, 1'000'000'000));
  app.add_option("--energy", options.style.energy,
                 "0 marks the steps, 1 is social dancing, 1.5 a show")
      ->check(CLI::Range(0.0, 1.5));
  app.add_option("--place", options.place,
                 "of the couple on the stage: x,z,heading (m, m, degrees)");
  dance::add_producer_options(app, options.producer);
  app.footer(dance::kExamples);
  return dance::run_program(app, argc, argv, [&] { return dance::run_salsa(options); });
}
