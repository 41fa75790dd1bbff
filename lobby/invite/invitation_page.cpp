#include "lobby/invite/invitation_page.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "core/net/machine_addresses.h"
#include "tunnel/invitation/qr_code.h"
#include "tunnel/seal/keys/utc_text.h"

namespace dance {
namespace {

// Names that only resolve within a home network.
constexpr std::array<std::string_view, 5> kHomeEndings{".local", ".lan", ".home", ".internal",
                                                       ".home.arpa"};

constexpr std::string_view kStyle =
    "body{font:18px/1.5 sans-serif;max-width:34em;margin:2em auto;padding:0 1em;color:#1c1d22}"
    "h1{font-size:1.7em;line-height:1.2;margin-bottom:.2em}"
    ".link{font:14px/1.4 monospace;word-break:break-all;background:#f3f1ec;border-radius:8px;"
    "padding:.8em}.go{display:inline-block;background:#d8553a;color:#fff;border-radius:8px;"
    "padding:.5em 1.2em;text-decoration:none}.reach{font-weight:bold}.note{color:#5a5c66}"
    "svg{width:15em;height:15em;display:block}";

std::string escaped(std::string_view text) {
  std::string html;
  for (const char c : text) {
    if (c == '&')
      html += "&amp;";
    else if (c == '<')
      html += "&lt;";
    else if (c == '>')
      html += "&gt;";
    else if (c == '"')
      html += "&quot;";
    else
      html += c;
  }
  return html;
}

std::string_view code_of(Language language) {
  for (const LanguageName& it : kLanguages)
    if (it.language == language) return it.code;
  return "en";
}

struct Words {
  std::string title, for_whom, how, how_else, reach, until, once;
};

Words words_of(const Texts& t, const std::string& from, const Invitation& invitation) {
  constexpr std::array kReach{Text::kPageThisComputer, Text::kPageHome, Text::kPageEverywhere};
  const std::string room = invitation.room.is_set() ? std::string(invitation.room.view()) : "dance";
  return {t.say(Text::kPageTitle, {from}),
          t.say(Text::kPageFor, {invitation.guest.view(), room}),
          t[Text::kPageHow],
          t.say(Text::kPageHowElse, {t[Text::kLobbyDance], t[Text::kLobbyPaste]}),
          t.say(kReach[static_cast<std::size_t>(reach_of(invitation.host))], {from}),
          t.say(Text::kPageUntil, {utc_shown(invitation.until_s)}),
          t[Text::kPageOnce]};
}

std::string paragraph(std::string_view text, std::string_view look = "") {
  const std::string begin =
      look.empty() ? std::string("<p>") : "<p class=\"" + std::string(look) + "\">";
  return begin + escaped(text) + "</p>\n";
}

// The <svg> element without the XML heading of a separate file.
std::string picture_of(std::string_view text) {
  const auto code = make_qr_code(text);
  if (!code) return "";  // a build without QR codes
  const std::string svg = qr_svg(*code);
  return svg.substr(svg.find("<svg"));
}

}  // namespace

InvitationReach reach_of(const std::string& host) {
  if (host == "localhost" || host == "::1" || host.starts_with("127."))
    return InvitationReach::kThisComputer;
  const bool is_home_name =
      host.find_first_of(".:") == std::string::npos ||
      std::ranges::any_of(kHomeEndings, [&](auto ending) { return host.ends_with(ending); });
  return is_home_name || is_private_address(host) ? InvitationReach::kHomeNetwork
                                                  : InvitationReach::kEverywhere;
}

Result<std::string> invitation_page(const Texts& t, const std::string& from,
                                    const std::string& link) {
  DANCE_TRY(const Invitation invitation, parse_invitation(link));
  const Words words = words_of(t, from, invitation);
  std::string page = "<!DOCTYPE html>\n<html lang=\"" + std::string(code_of(t.language())) +
                     "\">\n<head>\n<meta charset=\"utf-8\">\n<meta http-equiv=\"Content-Security-"
                     "Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'\">\n<meta "
                     "name=\"viewport\" content=\"width=device-width\">\n<title>" +
                     escaped(words.title) + "</title>\n<style>" + std::string(kStyle) +
                     "</style>\n</head>\n<body>\n<h1>" + escaped(words.title) + "</h1>\n";
  page += paragraph(words.for_whom) + paragraph(words.how);
  page += "<p><a class=\"go\" href=\"" + escaped(link) + "\">DanceGraph</a></p>\n";
  page += paragraph(words.how_else) + paragraph(link, "link");
  page += paragraph(words.reach, "reach") + paragraph(words.until) + paragraph(words.once);
  const std::string picture = picture_of(link);
  if (!picture.empty()) page += picture + paragraph(t[Text::kPageCode], "note");
  return page + "</body>\n</html>\n";
}

Result<std::string> invitation_message(const Texts& t, const std::string& from,
                                       const std::string& link) {
  DANCE_TRY(const Invitation invitation, parse_invitation(link));
  const Words words = words_of(t, from, invitation);
  return words.title + "\n" + words.for_whom + "\n\n" + words.how + "\n" + link + "\n\n" +
         words.reach + " " + words.until + " " + words.once + "\n";
}

}  // namespace dance
