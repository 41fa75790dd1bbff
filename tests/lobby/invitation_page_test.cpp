// An invitation for people: the content of its page and message in three languages.
#include "lobby/invite/invitation_page.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "lobby/run/room_host.h"
#include "tests/test_folder.h"
#include "tunnel/seal/keys/utc_text.h"

namespace dance {
namespace {

std::string link_to(const std::string& host) {
  Invitation made;
  made.host = host;
  made.room = *GuestId::parse("salsa");
  made.guest = *GuestId::parse("bob");
  made.server_key = *PublicKey::parse("A2sX0fLhLEJH-Lzm5WOkQPJ3A32BLeszoPShOUXYmMKW");
  made.key = *PrivateKey::parse(std::string(42, 'A') + "E");
  made.until_s = *parse_utc("20261227T0800Z");
  return text_of(made);
}

bool has(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

std::string in_html(std::string text) {
  for (std::size_t at = 0; (at = text.find('&', at)) != std::string::npos; at += 5)
    text.replace(at, 1, "&amp;");
  return text;
}

TEST(InvitationReach, IsReadFromTheAddressAlone) {
  using enum InvitationReach;
  for (const char* host : {"127.0.0.1", "localhost", "::1"})
    EXPECT_EQ(reach_of(host), kThisComputer);
  for (const char* host : {"192.168.1.7", "10.0.0.2", "fd00::1", "salon", "salon.local"})
    EXPECT_EQ(reach_of(host), kHomeNetwork) << host;
  for (const char* host : {"dance.example.org", "8.8.8.8", "2a00:1450::1"})
    EXPECT_EQ(reach_of(host), kEverywhere) << host;
}

TEST(InvitationPage, HasNameLinkGuestAndReachInEachLanguage) {
  const std::string link = link_to("192.168.1.7");
  for (const LanguageName& language : kLanguages) {
    const Texts texts(language.language);
    const auto page = invitation_page(texts, "alice", link);
    ASSERT_TRUE(page) << page.error().what;
    EXPECT_TRUE(has(*page, "<html lang=\"" + std::string(language.code))) << *page;
    EXPECT_TRUE(has(*page, texts.say(Text::kPageTitle, {"alice"})));
    EXPECT_TRUE(has(*page, texts.say(Text::kPageFor, {"bob", "salsa"})));
    EXPECT_TRUE(has(*page, texts.say(Text::kPageHome, {"alice"})));
    EXPECT_TRUE(has(*page, texts.say(Text::kPageUntil, {"2026-12-27 08:00 UTC"})));
    EXPECT_TRUE(has(*page, "href=\"" + in_html(link) + "\""));
    const auto message = invitation_message(texts, "alice", link);
    ASSERT_TRUE(message);
    EXPECT_TRUE(has(*message, link));
    EXPECT_TRUE(has(*message, texts.say(Text::kPageHome, {"alice"})));
  }
}

TEST(InvitationPage, FetchesAndRunsNothing) {
  const auto page =
      invitation_page(Texts(Language::kEnglish), "<img src=x>", link_to("dance.example.org"));
  ASSERT_TRUE(page);
  for (const char* part : {"<script", "<img", "<link", "<iframe", "url(", "@import", "onclick"})
    EXPECT_FALSE(has(*page, part)) << part;
  EXPECT_TRUE(has(*page, "default-src 'none'"));
  // The one address in it names the format of the code's picture.
  std::string rest = *page;
  const std::string format = "http://www.w3.org/2000/svg";
  if (const auto at = rest.find(format); at != std::string::npos) rest.erase(at, format.size());
  EXPECT_FALSE(has(rest, "http:"));
  EXPECT_FALSE(has(rest, "https:"));
}

TEST(InvitationPage, IsAnErrorForATextThatIsNotAnInvitation) {
  EXPECT_FALSE(invitation_page(Texts(Language::kEnglish), "alice", "dance://x"));
  EXPECT_FALSE(invitation_message(Texts(Language::kEnglish), "alice", ""));
}

TEST(RoomHost, SavesThePageBesideRecordingsForThisUserAlone) {
  const TestFolder folder("invitation-page");
  setenv("XDG_VIDEOS_DIR", folder.path("videos").c_str(), 1);
  LobbyModel model;
  model.settings.name = "alice";
  model.host.invited_guest = "bob";
  model.host.invitation = link_to("192.168.1.7");
  RoomHost host;
  host.save_page(model);
  unsetenv("XDG_VIDEOS_DIR");
  EXPECT_TRUE(model.banners.empty());
  const std::string path = folder.path("videos/DanceGraph/invitation-bob.html");
  EXPECT_EQ(model.host.page, path);
  const auto page = invitation_page(model.texts, "alice", model.host.invitation);
  EXPECT_EQ(text_of(path), *page);
  using std::filesystem::perms;
  EXPECT_EQ(std::filesystem::status(path).permissions(), perms::owner_read | perms::owner_write);
}

}  // namespace
}  // namespace dance
