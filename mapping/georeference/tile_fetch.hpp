#pragma once

#include <chrono>
#include <functional>
#include <string>

namespace madori::mapping {

/// What came back for one URL.
struct FetchedTile {
  enum class Outcome { Ok, NotThere, TryAgain, GiveUp };
  Outcome outcome = Outcome::GiveUp;
  std::string body;
  std::string reason;  ///< in words, unless Ok
};
using FetchTile = std::function<FetchedTile(const std::string& url)>;

struct FetchOptions {
  std::chrono::milliseconds connect_timeout{10'000};
  std::chrono::milliseconds total_timeout{30'000};
  int max_redirects = 3;
  std::size_t max_bytes = 4U << 20U;
};

/// One request by libcurl (http, https, file): time-outs, a limit on redirects and size, status, content
/// type, and that it is a picture of the right size. 404 and a missing file are NotThere; 429, 5xx, time-outs
/// and connections that break are TryAgain.
[[nodiscard]] FetchTile http_fetcher(const FetchOptions& options = {});

}  // namespace madori::mapping
