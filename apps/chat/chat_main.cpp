// dance chat: sends a line, applause or a heart to the room, in the name of a guest of this house.
#include "apps/bus_program.h"
#include "core/control/house_publisher.h"
#include "core/net/mono_clock.h"
#include "core/program/program.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance chat alice '¿Otra vez?'        a line, for everybody in the room
  dance chat alice --applause          hands that clap above alice's head, on every stage
  dance chat alice --heart
A guest sends a line and a sign a second. In the window Enter opens a field to write in.
)";

struct ChatOptions {
  std::string bus_url;
  std::string guest;
  std::string text;
  bool applauds = false;
  bool shows_heart = false;
};

Result<Chat> chat_of(const ChatOptions& options) {
  Chat chat;
  chat.kind = options.applauds      ? ChatKind::kApplause
              : options.shows_heart ? ChatKind::kHeart
                                    : ChatKind::kLine;
  if (!chat.text.assign(options.text) || !is_valid(chat))
    return fail("a line has 1 to 200 characters, in at most 400 bytes, and no control characters");
  return chat;
}

Result<void> send_chat(const ChatOptions& options) {
  DANCE_TRY(Chat chat, chat_of(options));
  DANCE_TRY(BusProgram program, BusProgram::open(options.bus_url));
  HousePublisher port(program.bus(), program.bus().url(), program.poller());
  if (port.houses().house_count() == 0)
    return fail("no house of yours runs on " + program.bus().url() +
                "; start one with: dance join, or name its --bus");
  chat.time = mono_now();
  chat.clock_id = this_clock_id();
  port.publish(Where::kCapture, *GuestId::parse(options.guest), chat);
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::ChatOptions options;
  dance::CommandLine line("Sends a line, applause or a heart to everybody in the room.",
                          "dance chat");
  line.add("GUEST", options.guest, "who writes").required().guest_name();
  line.add("TEXT", options.text, "the line, at most 200 characters");
  line.add_flag("--applause", options.applauds, "hands that clap, instead of a line");
  line.add_flag("--heart", options.shows_heart, "a heart, instead of a line");
  line.add("--bus", options.bus_url, "LCM URL of the house's bus");
  line.finally([&]() -> dance::Result<void> {
    const int count = (options.text.empty() ? 0 : 1) + options.applauds + options.shows_heart;
    if (count != 1) return dance::fail("give one of TEXT, --applause and --heart");
    if (const auto chat = dance::chat_of(options); !chat) return tl::make_unexpected(chat.error());
    return {};
  });
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::send_chat(options); });
}
