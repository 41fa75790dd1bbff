// dance salsa: a synthetic salsa dancer on the bus, for machines with no camera and no data.

#include "core/net/clock/calendar_zero.h"
#include "core/program/program.h"
#include "core/program/talk.h"
#include "producers/producer_program.h"
#include "producers/salsa/salsa_dancer.h"

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
    DANCE_TRY(const ProducerPlace place, parse_place(options.place));
    options.style.x_m = place.x_m;
    options.style.z_m = place.z_m;
    options.style.heading_deg = place.heading_deg;
  }
  options.style.role = options.role == "lead" ? SalsaRole::kLead : SalsaRole::kFollow;
  DANCE_TRY(const SalsaStyle style, checked_style(options.style));
  // Dances to the house's music if there is any; without it all salsa dancers are in step.
  if (options.producer.start_us == 0) options.producer.start_us = calendar_zero().since_zero_us();
  DANCE_TRY(auto program, ProducerProgram::open(options.producer));
  auto dancer = std::make_unique<SalsaDancer>(style);
  dancer->listen_to(program->music(), program->start());
  program->add(std::move(dancer), *guest);
  talk::info("{} dances on POSE/capture/{}; Ctrl-C ends it", options.guest, options.guest);
  program->run([] { return true; });
  talk::info("{} poses", program->sent());
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::SalsaOptions options;
  dance::CommandLine line(
      "A synthetic salsa dancer: basic steps with hip sway and arms, lead or follow, to the music "
      "of the house.",
      "dance salsa");
  line.add("--guest", options.guest, "who dances").guest_name().shows_default();
  line.add("--role", options.role,
           "lead or follow; two with the same tempo, seed and start are a couple")
      .one_of({"lead", "follow"})
      .shows_default();
  line.add("--tempo", options.style.tempo_bpm, "beats a minute, where no music is heard")
      .range(dance::kSlowestSalsa_bpm, dance::kFastestSalsa_bpm);
  line.add("--seed", options.style.seed, "which dance: figures, bodies, small variations")
      .range(0, 1'000'000'000);
  line.add("--energy", options.style.energy, "0 marks the steps, 1 is social dancing, 1.5 a show")
      .range(0.0, 1.5);
  line.add("--place", options.place, "of the couple on the stage: x,z,heading (m, m, degrees)");
  dance::add_producer_options(line, options.producer);
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run_salsa(options); });
}
