// The text of an invitation, and everything that is none.
#include "tunnel/invitation/invitation.h"

#include <gtest/gtest.h>

#include "tunnel/invitation/opened_invitations.h"
#include "tunnel/seal/keys/utc_text.h"

namespace dance {
namespace {

const std::string kKeyText = std::string(42, 'A') + "E";  // the scalar 1
// Its public key: the base point.
const std::string kServerText = "A2sX0fLhLEJH-Lzm5WOkQPJ3A32BLeszoPShOUXYmMKW";

Invitation an_invitation() {
  Invitation made;
  made.host = "dance.example.org";
  made.room = *GuestId::parse("salsa");
  made.guest = *GuestId::parse("alice");
  made.server_key = *PublicKey::parse(kServerText);
  made.key = *PrivateKey::parse(kKeyText);
  made.until_s = *parse_utc("20261127T0800Z");
  return made;
}

std::string error_of(const std::string& text) {
  const auto parsed = parse_invitation(text);
  return parsed ? "" : parsed.error().what;
}

TEST(Invitation, HasThisText) {
  EXPECT_EQ(text_of(an_invitation()),
            "dance://dance.example.org/salsa?v=2&guest=alice&server=" + kServerText +
                "&key=" + kKeyText + "&until=20261127T0800Z&check=aa728613");
  Invitation other = an_invitation();
  other.host = "2001:db8::1";
  other.port = 7411;
  other.room = GuestId();
  other.role = KeyKind::kHost;
  EXPECT_EQ(text_of(other),
            "dance://[2001:db8::1]:7411?v=2&guest=alice&role=host&server=" + kServerText +
                "&key=" + kKeyText + "&until=20261127T0800Z&check=e18a4575");
}

TEST(Invitation, ComesBackFromItsText) {
  for (const char* host : {"dance.example.org", "192.0.2.7", "::1", "fe80::1%eth0", "a"})
    for (const int port : {7400, 1, 65535})
      for (const char* room : {"", "salsa", "a-very-long-room-name-24"})
        for (const KeyKind role : {KeyKind::kGuest, KeyKind::kHost, KeyKind::kListener}) {
          Invitation made = an_invitation();
          made.host = host;
          made.port = static_cast<std::uint16_t>(port);
          made.room = GuestId::parse(room).value_or(GuestId());
          made.role = role;
          made.server_key = PrivateKey::make().public_key();
          made.key = PrivateKey::make();
          const auto back = parse_invitation(text_of(made));
          ASSERT_TRUE(back) << back.error().what;
          EXPECT_TRUE(*back == made) << made.title();
        }
}

TEST(Invitation, IsReadAsProgramsPassLinksOn) {
  const Invitation made = an_invitation();
  const std::string text = text_of(made);
  const std::string query = text.substr(text.find('?') + 1);
  std::string percent = "dance://%64ance.example.org/s%61lsa?";
  percent += query;
  percent.replace(percent.find("alice"), 5, "%61%6C%69%63%65");
  // Known names and values stay as they are whatever their order.
  std::string turned = text.substr(0, text.find('?') + 1);
  turned += query.substr(query.find("guest")) + "&v=2";
  const std::string host = "dance://dance.example.org";
  for (const std::string& variant :
       {"  " + text + "\r\n", "DANCE://Dance.Example.ORG" + text.substr(host.size()), percent,
        turned, text + "&utm_source=mail", text + "&"}) {
    EXPECT_TRUE(is_invitation(variant));
    const auto back = parse_invitation(variant);
    ASSERT_TRUE(back) << back.error().what;
    EXPECT_TRUE(*back == made);
  }
  EXPECT_FALSE(is_invitation("dance.example.org"));
  EXPECT_FALSE(is_invitation("dance:"));
  EXPECT_FALSE(is_invitation(""));
}

TEST(Invitation, ADamagedTextIsNoInvitation) {
  const std::string text = text_of(an_invitation());
  for (std::size_t size = 0; size < text.size(); ++size)
    EXPECT_FALSE(parse_invitation(text.substr(0, size))) << size;
  // Any other character in any place; but letters of host and scheme may be large.
  const std::size_t fixed = text.find('/', 8);
  for (std::size_t at = 0; at < text.size(); ++at)
    for (const char c : std::string("Aa0-_&=?/%:#+ \xc3~.")) {
      std::string damaged = text;
      if (damaged[at] == c) continue;
      damaged[at] = c;
      const auto parsed = parse_invitation(damaged);
      const bool is_large_letter = at < fixed && c == 'A' && text[at] == 'a';
      EXPECT_EQ(parsed.has_value(), is_large_letter) << at << " " << c;
      if (!parsed) {
        EXPECT_EQ(parsed.error().what.find(kKeyText.substr(0, 12)), std::string::npos);
      }
    }
  // Two neighbours exchanged.
  for (std::size_t at = fixed; at + 1 < text.size(); ++at) {
    std::string damaged = text;
    std::swap(damaged[at], damaged[at + 1]);
    EXPECT_EQ(parse_invitation(damaged).has_value(), damaged == text) << at;
  }
}

TEST(Invitation, SaysWhatIsWrongAndNeverWhatStandsThere) {
  const std::string text = text_of(an_invitation());
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    changed.replace(changed.find(from), from.size(), to);
    return error_of(changed);
  };
  const auto says = [&](const std::string& error, const std::string& part) {
    EXPECT_NE(error.find(part), std::string::npos) << error;
    EXPECT_EQ(error.find(kKeyText.substr(0, 12)), std::string::npos) << error;
    EXPECT_EQ(error.find("example"), std::string::npos) << error;
  };
  says(error_of("http://dance.example.org"), "does not begin as one");
  says(error_of("dance://" + std::string(700, 'a')), "longer than any");
  says(error_of("dance://dance.example.org"), "ends after the server");
  says(with("dance.example.org", ""), "names no server");
  says(with("dance.example.org", "dance.example.org:0"), "names no server");
  says(with("dance.example.org", "dance.example.org:70000"), "names no server");
  says(with("dance.example.org", "dance%2Eexample%ZZ"), "names no server");
  says(with("/salsa", "/Salsa"), "names no room");
  says(with("v=2", "v=3"), "another version: update");
  says(with("v=2&", ""), "has no version");
  says(with("guest=alice", "guest=Alice"), "names no guest");
  says(with("guest=alice", "guest=%"), "nothing that can be read as guest");
  says(with("guest=alice", "guest"), "nothing that can be read as guest");
  says(with("guest=alice", "guest=alice&guest=bob"), "names guest twice");
  says(with("guest=alice", "guest=alice&role=king"), "names no role");
  says(with("guest=alice", "guest=alice&role=room"), "names no role");
  says(with("guest=alice", "guest=alice&Ticket=5"), "newer version");
  says(with("server=A2", "server="), "no whole key of the server");
  says(with("server=A2", "server=B2"), "no whole key of the server");
  says(with("key=A", "key="), "no whole key");
  says(with("key=AA", "key=%41A%0a"), "nothing that can be read as key");
  says(with("20261127", "20261327"), "until when");
  says(with("20261127", "20261128"), "wrong or missing character");
  says(with("guest=alice", "guest=bob"), "wrong or missing character");
  std::string many = text;
  for (int i = 0; i < 16; ++i) many += "&a=b";
  says(error_of(many), "too many parameters");
}

TEST(UtcText, IsOneTextForEachMinute) {
  for (const std::int64_t s :
       {std::int64_t{946'684'800}, std::int64_t{1'795'766'400}, std::int64_t{1'772'236'740},
        std::int64_t{4'107'542'340}, std::int64_t{253'402'300'740}}) {
    const auto back = parse_utc(utc_text(s));
    ASSERT_TRUE(back) << utc_text(s);
    EXPECT_EQ(*back, s);
    EXPECT_EQ(parse_utc(utc_text(s + 59)), s);
  }
  EXPECT_EQ(utc_text(*parse_utc("20280229T2359Z")), "20280229T2359Z");
  EXPECT_EQ(utc_shown(*parse_utc("20261127T0800Z")), "2026-11-27 08:00 UTC");
  EXPECT_EQ(*parse_utc("20261127T0801Z") - *parse_utc("20261126T0800Z"), 86'460);
  EXPECT_EQ(utc_text(-5), "20000101T0000Z");
  EXPECT_EQ(utc_text(INT64_MAX), "99991231T2359Z");
  for (const char* bad : {"", "20261127T0800", "20270229T0000Z", "20261127T2400Z", "20261127T0860Z",
                          "20261127 0800Z", "2026112-T0800Z", "19991231T2359Z", "20260027T0000Z"})
    EXPECT_FALSE(parse_utc(bad)) << bad;
}

TEST(OpenedInvitations, ComeBackAndAreBounded) {
  OpenedInvitations opened;
  const Invitation first = an_invitation();
  const HouseKey key = first.house_key();
  opened.begin(first.key.fingerprint(), key);
  const PrivateKey done = PrivateKey::make();
  opened.begin(done.fingerprint(), key);
  opened.end(done.fingerprint(), key);
  const auto back = OpenedInvitations::parse(opened.text(), "invitations");
  ASSERT_TRUE(back) << back.error().what;
  EXPECT_TRUE(back->is_pending(first.key.fingerprint()));
  EXPECT_FALSE(back->is_done(first.key.fingerprint()));
  EXPECT_TRUE(back->is_done(done.fingerprint()));
  EXPECT_FALSE(back->is_pending(done.fingerprint()));
  opened.forget(first.key.fingerprint());
  EXPECT_EQ(opened.text().find(kKeyText), std::string::npos);
  for (std::size_t i = 0; i < OpenedInvitations::kMost; ++i)
    opened.begin(PrivateKey::make().fingerprint(), key);
  EXPECT_FALSE(opened.is_done(done.fingerprint()));
  for (const char* bad :
       {"x", "0123456789abcdef", "0123456789abcdef opened", "0123456789abcdef lost a",
        "0123456789abcdef opened alice\r\r", "0123456789abcdef opened Alice",
        "0123456789abcdef opened alice@a b", "0123456789abcdef pending dance-key:alice#short"}) {
    const auto parsed = OpenedInvitations::parse(bad, "invitations");
    ASSERT_FALSE(parsed) << bad;
    EXPECT_NE(parsed.error().what.find("invitations line 1"), std::string::npos);
  }
}

}  // namespace
}  // namespace dance
