#include "hmi/server/http.hpp"

#include <gtest/gtest.h>

#include "hmi/server/live_command.hpp"
#include "hmi/server/origin.hpp"

namespace madori::hmi {
namespace {

bool parses(const char* target) {
  Request request;
  return parse_target(target, request);
}

TEST(Target, IsDecodedAndSplit) {
  Request request;
  ASSERT_TRUE(parse_target("/api/site%20x?name=plan+1.png&m=a%2Bb", request));
  EXPECT_EQ(request.path, "/api/site x");
  EXPECT_EQ(request.query["name"], "plan 1.png");
  EXPECT_EQ(request.query["m"], "a+b");
}

TEST(Target, ClimbingAndBrokenOnesAreRefused) {
  for (const char* bad :
       {"", "x", "/../etc/passwd", "/a/%2e%2e/b", "/a/..%5c..", "/%", "/%zz", "/%00", "/a?x=%0", "/a?x=%00"})
    EXPECT_FALSE(parses(bad)) << bad;
  EXPECT_TRUE(parses("/a..b/c."));
}

TEST(Router, KnowsRolesMethodsAndWildcards) {
  Router router;
  router.add("DELETE", "/api/orders/*", Role::Operator, [](const Request&) { return Response{}; });
  Request request;
  request.method = "DELETE";
  request.path = "/api/orders/17";
  EXPECT_EQ(router.match(request).refusal, 401);
  request.role = Role::Viewer;
  EXPECT_EQ(router.match(request).refusal, 403);
  request.role = Role::Integrator;
  EXPECT_NE(router.match(request).handler, nullptr);
  EXPECT_EQ(request.captures, std::vector<std::string>{"17"});
  request.method = "GET";
  EXPECT_EQ(router.match(request).refusal, 405);
  request.path = "/api/orders/17/x";
  EXPECT_EQ(router.match(request).refusal, 404);
}

TEST(Request, FindsACookieAmongOthers) {
  Request request;
  request.headers["cookie"] = "xmadori_session=1; madori_session=abc; b=c";
  EXPECT_EQ(request.cookie("madori_session"), "abc");
  EXPECT_EQ(request.cookie("madori"), "");
}

TEST(Origin, OnlyThisPageMayChangeThings) {
  EXPECT_TRUE(origin_allowed("http://127.0.0.1:8080", "127.0.0.1:8080", true));
  EXPECT_FALSE(origin_allowed("http://evil.example", "127.0.0.1:8080", false));
  EXPECT_FALSE(origin_allowed("http://127.0.0.1:8081", "127.0.0.1:8080", true));
  EXPECT_FALSE(origin_allowed("null", "127.0.0.1:8080", true));
  EXPECT_FALSE(origin_allowed("", "127.0.0.1:8080", true));
  EXPECT_TRUE(origin_allowed("", "127.0.0.1:8080", false));
}

TEST(Host, RebindingNamesAreRefusedOnLoopback) {
  for (const char* good : {"127.0.0.1:8080", "localhost", "LOCALHOST:1", "[::1]:8080", "127.8.9.1"})
    EXPECT_TRUE(host_allowed(good, true)) << good;
  for (const char* bad : {"", "evil.example", "127.evil.example", "127.0.0.1.evil.example:80", "0x7f.1"})
    EXPECT_FALSE(host_allowed(bad, true)) << bad;
  EXPECT_TRUE(host_allowed("madori.factory.local", false));
}

TEST(Jog, OnlyFiniteBoundedNumbersPass) {
  ASSERT_TRUE(parse_live_command(R"({"jog": {"linear": 0.3, "angular": -1}})"));
  EXPECT_DOUBLE_EQ(parse_live_command(R"({"jog": {"linear": 0.3, "angular": -1}})")->jog->angular_radps,
                   -1.0);
  for (const char* bad :
       {"", "{}", "[]", "null", R"({"jog": 1})", R"({"jog": {"linear": 1}})",
        R"({"jog": {"linear": "1", "angular": 0}})", R"({"jog": {"linear": 1e300, "angular": 0}})",
        R"({"jog": {"linear": 6, "angular": 0}})", R"({"jog": {"linear": 1, "angular": 0}, "x": 1})",
        R"({"jog": {"linear": 1, "angular": 0)"})
    EXPECT_FALSE(parse_live_command(bad)) << bad;
}

}  // namespace
}  // namespace madori::hmi
