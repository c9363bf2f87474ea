// One attack on a panel's server, again and again; or a panel that looks on meanwhile. For panel_attack.py.
//   panel_attacker KIND PORT SECONDS [SESSION]
// prints one line of JSON: how many tries, how many the server took (wanted: none).
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <string>
#include <thread>

#include "tests/support/panel_attacks.hpp"
#include "tests/support/panel_client.hpp"

namespace madori::test {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kGigabyte = 1U << 30U;

struct Tally {
  unsigned long tries = 0;
  unsigned long taken = 0;

  void count(bool was_taken) {
    ++tries;
    taken += was_taken ? 1 : 0;
  }
};

struct Target {
  unsigned short port;
  std::string session;

  [[nodiscard]] bool takes(const std::string& method, const std::string& path, const std::string& body = "",
                           const std::string& origin = "same") const {
    const int status = http_call(port, {method, path, body, "", origin, session}).status;
    return status >= 200 && status < 400;
  }
  [[nodiscard]] bool takes_live(const std::string& origin) const {
    try {
      const LiveClient live(port, origin, session);
      return true;
    } catch (const std::exception&) {
      return false;
    }
  }
};

constexpr const char* kCommands[] = {"/api/vehicle/start", "/api/vehicle/stop", "/api/vehicle/pause",
                                     "/api/orders",        "/api/vehicle/pose", "/api/locate/search"};

void wrong_origin(const Target& target, Tally& tally) {
  for (const char* path : kCommands) tally.count(target.takes("POST", path, "{}", "http://evil.example"));
  tally.count(target.takes_live("http://evil.example"));
}

/// With a viewer's session or none at all.
void no_right(const Target& target, Tally& tally) {
  for (const char* path : kCommands) tally.count(target.takes("POST", path, "{}"));
  tally.count(target.takes("PUT", "/api/site/walls", "{}"));
  tally.count(target.takes("POST", "/api/session", R"({"pin": "guessed"})"));
  if (target.session.empty()) tally.count(target.takes_live("same"));
}

void climb(const Target& target, Tally& tally) {
  for (const auto& path : climbing_paths()) tally.count(target.takes("GET", path));
}

void upload(const Target& target, Tally& tally) {
  for (const bool chunked : {false, true})
    tally.count(upload_for_ever(target.port, kGigabyte, chunked, target.session).answer.find(" 200") !=
                std::string::npos);
}

/// A thousand that say nothing and a hundred that drip, until the server has dropped them all.
void half_open(const Target& target, Tally& tally) {
  NeglectedSockets silent(target.port, 1000, "");
  NeglectedSockets slow(target.port, 100, "GET /api/session HTTP/1.1\r\nX: ");
  for (int i = 0; i < 1100; ++i) tally.count(false);
  while (slow.drip('a') + silent.open() > 0) std::this_thread::sleep_for(std::chrono::milliseconds(50));
}

void bad_json(const Target& target, Tally& tally) {
  for (const auto& body : bad_orders()) tally.count(target.takes("POST", "/api/orders", body));
}

void bad_live_frames(const Target& target, Tally& tally) {
  for (const auto& frames : bad_frames()) tally.count(!closes_on_frames(target.port, frames, target.session));
}

const std::map<std::string, std::function<void(const Target&, Tally&)>> kAttacks{
    {"wrong-origin", wrong_origin},
    {"no-pin", no_right},
    {"wrong-role", no_right},
    {"traversal", climb},
    {"upload", upload},
    {"half-open", half_open},
    {"bad-json", bad_json},
    {"bad-frames", bad_live_frames}};

/// The longest silence and the mean rate of what an honest panel gets.
void look_on(const Target& target, Clock::time_point end) {
  LiveClient live(target.port, "same", target.session);
  const auto begin = Clock::now();
  auto last = begin;
  double longest_s = 0.0;
  unsigned long states = 0;
  for (auto now = begin; now < end; now = Clock::now(), ++states) {
    (void)live.receive_text();
    longest_s = std::max(longest_s, std::chrono::duration<double>(Clock::now() - last).count());
    last = Clock::now();
  }
  const double passed_s = std::chrono::duration<double>(last - begin).count();
  std::printf("{\"states_a_second\": %.2f, \"longest_silence_s\": %.3f}\n",
              static_cast<double>(states) / passed_s, longest_s);
}

}  // namespace
}  // namespace madori::test

int main(int argc, char** argv) {
  using namespace madori::test;
  if (argc < 4) return 2;
  const std::string kind = argv[1];
  const Target target{static_cast<unsigned short>(std::atoi(argv[2])), argc > 4 ? argv[4] : ""};
  const auto end = Clock::now() + std::chrono::milliseconds(static_cast<long>(1e3 * std::atof(argv[3])));
  if (kind == "look-on") {
    look_on(target, end);
    return 0;
  }
  const auto attack = kAttacks.find(kind);
  if (attack == kAttacks.end()) return 2;
  Tally tally;
  while (Clock::now() < end) {
    try {
      attack->second(target, tally);
    } catch (const std::exception&) {
      ++tally.tries;  // the server would not even have the socket
    }
  }
  std::printf("{\"tries\": %lu, \"taken\": %lu}\n", tally.tries, tally.taken);
  return 0;
}
