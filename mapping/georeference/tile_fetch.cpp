#include "mapping/georeference/tile_fetch.hpp"

#include <curl/curl.h>

#include <memory>
#include <mutex>

#include "core/result.hpp"
#include "mapping/georeference/tile_image.hpp"

namespace madori::mapping {
namespace {

using Outcome = FetchedTile::Outcome;
using Curl = std::shared_ptr<CURL>;

struct Body {
  std::string bytes;
  std::size_t most = 0;
  bool too_large = false;
};

std::size_t receive(char* data, std::size_t size, std::size_t count, void* user) {
  auto& body = *static_cast<Body*>(user);
  if (body.bytes.size() + size * count > body.most) {
    body.too_large = true;
    return 0;  // ends the transfer
  }
  body.bytes.append(data, size * count);
  return size * count;
}

Curl make_curl(const FetchOptions& options) {
  static std::once_flag once;
  std::call_once(once, [] { curl_global_init(CURL_GLOBAL_DEFAULT); });
  Curl curl(curl_easy_init(), curl_easy_cleanup);
  if (!curl) throw Error("libcurl", "cannot be started", "check the memory of this computer");
  curl_easy_setopt(curl.get(), CURLOPT_CONNECTTIMEOUT_MS, static_cast<long>(options.connect_timeout.count()));
  curl_easy_setopt(curl.get(), CURLOPT_TIMEOUT_MS, static_cast<long>(options.total_timeout.count()));
  curl_easy_setopt(curl.get(), CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(curl.get(), CURLOPT_FOLLOWLOCATION, 1L);
  curl_easy_setopt(curl.get(), CURLOPT_MAXREDIRS, static_cast<long>(options.max_redirects));
  curl_easy_setopt(curl.get(), CURLOPT_PROTOCOLS_STR, "http,https,file");
  curl_easy_setopt(curl.get(), CURLOPT_REDIR_PROTOCOLS_STR, "http,https");
  curl_easy_setopt(curl.get(), CURLOPT_USERAGENT, "madori (factory vehicle map tool)");
  curl_easy_setopt(curl.get(), CURLOPT_WRITEFUNCTION, &receive);
  return curl;
}

FetchedTile judge_transfer(CURLcode code, const Body& body) {
  if (body.too_large) return {Outcome::GiveUp, {}, "the answer is too large for a tile"};
  switch (code) {
    case CURLE_FILE_COULDNT_READ_FILE:
      return {Outcome::NotThere, {}, "there is no such file"};
    case CURLE_TOO_MANY_REDIRECTS:
      return {Outcome::GiveUp, {}, "the server redirects in a circle"};
    case CURLE_URL_MALFORMAT:
    case CURLE_UNSUPPORTED_PROTOCOL:
    case CURLE_PEER_FAILED_VERIFICATION:
      return {Outcome::GiveUp, {}, curl_easy_strerror(code)};
    case CURLE_PARTIAL_FILE:
      return {Outcome::TryAgain, {}, "the answer was cut off"};
    default:
      return {Outcome::TryAgain, {}, curl_easy_strerror(code)};
  }
}

FetchedTile judge_answer(CURL* curl, Body body) {
  long status = 0;
  const char* type = nullptr;
  curl_easy_getinfo(curl, CURLINFO_RESPONSE_CODE, &status);
  curl_easy_getinfo(curl, CURLINFO_CONTENT_TYPE, &type);
  const std::string answer = "the server answered " + std::to_string(status);
  if (status == 404 || status == 410) return {Outcome::NotThere, {}, answer + " (no tile there)"};
  if (status == 429 || status >= 500) return {Outcome::TryAgain, {}, answer};
  if (status != 0 && status != 200) return {Outcome::GiveUp, {}, answer};
  const std::string content = type == nullptr ? "" : type;
  if (!content.empty() && !content.starts_with("image/") && content != "application/octet-stream")
    return {Outcome::GiveUp, {}, "the answer is " + content + ", not a picture"};
  const std::string fault = tile_image_fault(body.bytes);
  if (fault == "is cut off") return {Outcome::TryAgain, {}, "the picture " + fault};
  if (!fault.empty()) return {Outcome::GiveUp, {}, "the answer " + fault};
  return {Outcome::Ok, std::move(body.bytes), {}};
}

}  // namespace

FetchTile http_fetcher(const FetchOptions& options) {
  return [curl = make_curl(options), options](const std::string& url) {
    Body body{{}, options.max_bytes, false};
    curl_easy_setopt(curl.get(), CURLOPT_URL, url.c_str());
    curl_easy_setopt(curl.get(), CURLOPT_WRITEDATA, &body);
    const CURLcode code = curl_easy_perform(curl.get());
    return code == CURLE_OK ? judge_answer(curl.get(), std::move(body)) : judge_transfer(code, body);
  };
}

}  // namespace madori::mapping
