#pragma once

#include <string_view>

#include "hmi/server/http.hpp"

namespace madori::hmi {

/// Everything that can be refused before a body is read: malformed targets, foreign hosts and origins,
/// missing sessions, too low roles, unknown addresses. No socket, no Beast.
class Gate {
 public:
  Gate(const Router& router, bool loopback_only) : router_(router), loopback_only_(loopback_only) {}

  struct Passage {
    enum class Way { Refused, Page, Api, Live } way = Way::Refused;
    Response refusal;
    Router::Match match;  ///< of Api
  };
  /// `request` holds method, headers and role; its path, query and captures are filled from the target.
  [[nodiscard]] Passage pass(std::string_view target, Request& request) const;

 private:
  const Router& router_;
  bool loopback_only_;
};

}  // namespace madori::hmi
