#include "simulation/devices/lms_server.hpp"

#include "sensors/lms1xx/encode.hpp"

namespace madori::simulation {
namespace {

namespace lms1xx = sensors::lms1xx;

constexpr std::uint32_t kUnknownCommand = 3;  ///< SOPAS error: method or variable not known
constexpr std::uint32_t kAccessDenied = 1;

}  // namespace

std::vector<std::uint8_t> LmsDialogue::receive(std::span<const std::uint8_t> bytes,
                                               std::span<const std::uint8_t> newest) {
  splitter_.push(bytes);
  std::vector<std::uint8_t> out;
  while (const auto payload = splitter_.next()) {
    const auto head = lms1xx::head_of(*payload);
    if (!head) continue;
    const auto reply = answer(*head, newest);
    out.insert(out.end(), reply.begin(), reply.end());
  }
  return out;
}

std::vector<std::uint8_t> LmsDialogue::answer(const lms1xx::Head& head,
                                              std::span<const std::uint8_t> newest) {
  const auto reply = [&](const char* kind, std::vector<lms1xx::Argument> arguments = {}) {
    return lms1xx::encode(dialect_, {kind, std::string(head.name), std::move(arguments)});
  };
  const auto refuse = [&](std::uint32_t code) { return lms1xx::encode(dialect_, {"sFA", "", {{code, 2}}}); };
  if (head.kind == "sMN" && head.name == "SetAccessMode") {
    logged_in_ = true;
    return reply("sAN", {{1, 1}});
  }
  if (head.kind == "sWN" && head.name == "LMDscandatacfg")
    return logged_in_ ? reply("sWA") : refuse(kAccessDenied);
  if (head.kind == "sMN" && (head.name == "LMCstartmeas" || head.name == "LMCstopmeas")) {
    if (!logged_in_) return refuse(kAccessDenied);
    measuring_ = head.name == "LMCstartmeas";
    return reply("sAN", {{0, 1}});
  }
  if (head.kind == "sMN" && head.name == "Run") {
    logged_in_ = false;  // leaves the configuration mode
    return reply("sAN", {{1, 1}});
  }
  if (head.kind == "sEN" && head.name == "LMDscandata") {
    subscribed_ = lms1xx::first_argument(dialect_, head).value_or(0) == 1;
    return reply("sEA", {{subscribed_ ? 1U : 0U, 1}});
  }
  if (head.kind == "sRN" && head.name == "LMDscandata" && measuring_ && !newest.empty())
    return lms1xx::as_answer(dialect_, newest);
  return refuse(kUnknownCommand);
}

}  // namespace madori::simulation
