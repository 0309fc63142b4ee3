#include "lab/live/access.hpp"

#include <gmock/gmock.h>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const AccessRules kLocal;
const AccessRules kOpen{.host = "0.0.0.0", .token = "a-secret-word"};

Caller from(const std::string& host) {
  Caller caller;
  caller.host = host;
  caller.token = kOpen.token;
  return caller;
}

TEST(LiveAccess, NamesOfLoopbackAreAllowedOnAnyPort) {
  for (const char* host : {"127.0.0.1:8080", "localhost:9000", "LOCALHOST", "[::1]:8080"})
    EXPECT_THAT(refusal(kLocal, from(host)), IsEmpty()) << host;
}

TEST(LiveAccess, OtherNamesAreRefusedOnLoopback) {
  for (const char* host : {"evil.example:8080", "192.168.0.7:8080", "127.evil.example", "", "["})
    EXPECT_THAT(refusal(kLocal, from(host)), HasSubstr("is no name of this server")) << host;
}

TEST(LiveAccess, AnyNameIsServedWithTheToken) {
  for (const char* host : {"192.168.0.7:8080", "[fe80::1]:8080", "Station.local:8080",
                           "station.lab.example", "container-host:18080", "hands.example."}) {
    EXPECT_THAT(refusal(kOpen, from(host)), IsEmpty()) << host;
    EXPECT_THAT(refusal({.token = kOpen.token}, from(host)), IsEmpty()) << host;
  }
}

TEST(LiveAccess, ForeignNamesThatLeadHereDoNotHaveTheToken) {
  Caller caller = from("evil.example:8080");
  caller.origin = "http://evil.example:8080";
  caller.fetch_site = "same-origin";
  caller.token = "";
  EXPECT_THAT(refusal(kOpen, caller), HasSubstr("the token is missing or wrong"));
  EXPECT_THAT(refusal(kLocal, caller), HasSubstr("is no name of this server"));
}

TEST(LiveAccess, RefusedNamesAreToldTheOptionThatAllowsThem) {
  EXPECT_THAT(refusal(kLocal, from("station.local:8080")),
              AllOf(HasSubstr("'station.local:8080'"), HasSubstr("--web-token-file FILE")));
}

TEST(LiveAccess, OnlyPagesOfTheServerMayUseIt) {
  Caller caller = from("localhost:8080");
  caller.origin = "http://localhost:8080";
  EXPECT_THAT(refusal(kLocal, caller), IsEmpty());
  for (const char* origin :
       {"http://localhost:8081", "https://localhost:8080", "null", "http://evil.example"}) {
    caller.origin = origin;
    EXPECT_THAT(refusal(kLocal, caller), HasSubstr("may not use this server")) << origin;
  }
}

TEST(LiveAccess, WithATokenPagesOfTheSameHostMayUseIt) {
  Caller caller = from("Hands.example:8080");
  for (const char* origin :
       {"http://hands.example:8080", "https://hands.example", "https://HANDS.example:8443"}) {
    caller.origin = origin;
    EXPECT_THAT(refusal(kOpen, caller), IsEmpty()) << origin;
  }
  for (const char* origin : {"https://hands.example.evil.example", "https://example", "null",
                             "hands.example", "https://"}) {
    caller.origin = origin;
    EXPECT_THAT(refusal(kOpen, caller), HasSubstr("may not use this server")) << origin;
  }
  caller = from("[fe80::1]:8080");
  caller.origin = "http://[fe80::1]:8080";
  EXPECT_THAT(refusal(kOpen, caller), IsEmpty());
}

TEST(LiveAccess, OtherPagesMayLinkToThePageButNotShowItsPictures) {
  Caller caller = from("localhost:8080");
  caller.fetch_site = "cross-site";
  EXPECT_THAT(refusal(kLocal, caller), Not(IsEmpty()));
  caller.navigates = true;
  EXPECT_THAT(refusal(kLocal, caller), IsEmpty());
}

TEST(LiveAccess, TheTokenMustBeRight) {
  Caller caller = from("192.168.0.7:8080");
  for (const char* token : {"", "a-secret-wor", "a-secret-worx", "a-secret-words"}) {
    caller.token = token;
    EXPECT_THAT(refusal(kOpen, caller), HasSubstr("the token is missing or wrong")) << token;
  }
}

TEST(LiveAccess, OtherHostsNeedAToken) {
  EXPECT_NO_THROW(check(kLocal));
  EXPECT_NO_THROW(check(kOpen));
  EXPECT_THAT(test::message_of<ConfigError>([] { check({.host = "0.0.0.0"}); }),
              HasSubstr("--web-token"));
}

TEST(LiveAccess, TokensAreLongAndPlain) {
  for (const char* token : {"short", "with space in it", "semi;colon;inside"})
    EXPECT_THAT(test::message_of<ConfigError>([&] { check({.token = token}); }),
                HasSubstr("--web-token: expected 8 or more letters"))
        << token;
  EXPECT_THAT(test::message_of<ConfigError>(
                  [] { check({.token = "short", .token_source = "HYPOTRACK_WEB_TOKEN"}); }),
              HasSubstr("HYPOTRACK_WEB_TOKEN: expected"));
}

}  // namespace
}  // namespace hypotrack
