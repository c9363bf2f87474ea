#include "app/panel/event_words.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "app/cycle/modes.hpp"
#include "app/panel/notices.hpp"
#include "app/runner/clock_words.hpp"

namespace madori::app {
namespace {

/// `text` said by an entry of a table: the values of its placeholders, each as short as what follows allows.
std::optional<Notice> said_by(const CatalogueEntry& entry, std::string_view text) {
  Notice notice{entry.code, {}, std::string(text)};
  std::string_view english = entry.english;
  for (auto open = english.find('{'); open != std::string_view::npos; open = english.find('{')) {
    const std::size_t close = english.find('}');
    const auto name = english.substr(open + 1, close - open - 1);
    if (!text.starts_with(english.substr(0, open))) return std::nullopt;
    text.remove_prefix(open);
    english.remove_prefix(close + 1);
    const auto next = english.substr(0, english.find('{'));
    const bool is_last = next.size() == english.size();
    if (is_last && !text.ends_with(next)) return std::nullopt;
    const std::size_t end = is_last ? text.size() - next.size() : text.find(next);
    if (end == std::string_view::npos || end > text.size()) return std::nullopt;
    notice.values[std::string(name)] = std::string(text.substr(0, end));
    text.remove_prefix(end);
  }
  return text == english ? std::optional(notice) : std::nullopt;
}

template <class Table>
std::optional<Notice> said_by_any(const Table& table, std::string_view text) {
  for (const auto& entry : table)
    if (auto notice = said_by(entry, text)) return notice;
  return std::nullopt;
}

bool is_mode(std::string_view name) {
  return std::ranges::any_of(
      std::array{Mode::Idle, Mode::Localizing, Mode::Driving, Mode::Detouring, Mode::Waiting, Mode::Paused,
                 Mode::Manual, Mode::EmergencyStop, Mode::Fault},
      [name](Mode mode) { return name == to_string(mode); });
}

/// Standing that nobody needs to look at.
bool is_wanted(const std::string& cause) {
  constexpr std::array<std::string_view, 6> kWanted{"no-order", "paused",    "manual",
                                                    "loading",  "unloading", "order-stop"};
  return std::ranges::find(kWanted, cause) != kWanted.end();
}

/// "waiting: something stands in the way - it goes on by itself once clear"
bool take_standstill(std::string_view mode, std::string_view sentence, hmi::EventView& view) {
  for (auto dash = sentence.find(" - "); dash != std::string_view::npos;
       dash = sentence.find(" - ", dash + 1)) {
    const auto cause = said_by_any(kCauses, sentence.substr(0, dash));
    const auto remedy = said_by_any(kRemedies, sentence.substr(dash + 3));
    if (!cause || !remedy) continue;
    const bool stopped = mode == to_string(Mode::EmergencyStop) || mode == to_string(Mode::Fault);
    view.severity = is_wanted(cause->code) ? "info" : stopped ? "stop" : "warning";
    view.what = shown(*cause);
    view.remedy = shown(*remedy);
    return true;
  }
  return false;
}

/// What the clocks, the lidars and the disk did.
bool take_device(std::string_view text, hmi::EventView& view) {
  auto known = said_by_any(kClockEvents, text);
  if (!known)
    known = said_by_any(std::array{kTimeGapEvent, kLidarLostEvent, kLidarBackEvent, kFloorUnseenEvent,
                                   kFloorSeenEvent, kNotKeptEvent, kKeptAgainEvent},
                        text);
  if (!known) return false;
  view.what = shown(*known);
  view.severity = "warning";
  return true;
}

/// "order 3: stop reached; done", "order 3 refused: no way leads to node 9"
void take_order(std::string_view text, hmi::EventView& view) {
  constexpr std::string_view kOrder = "order ", kReached = ": stop reached; ", kRefused = " refused: ";
  if (!text.starts_with(kOrder)) return;
  const auto set = [&](std::size_t at, const char* code) {
    view.what.code = code;
    view.what.values["order"] = std::string(text.substr(kOrder.size(), at - kOrder.size()));
  };
  if (const auto reached = text.find(kReached); reached != std::string_view::npos)
    set(reached, text.ends_with("done") ? "event.order-done" : "event.order-reached");
  if (const auto refused = text.find(kRefused); refused != std::string_view::npos) {
    set(refused, "event.order-refused");
    view.what.values["reason"] = std::string(text.substr(refused + kRefused.size()));
    view.severity = "warning";
  }
}

}  // namespace

hmi::EventView event_view(const EventRecord& event) {
  hmi::EventView view{event.stamp,
                      event.kind == "device" || event.kind == "operator" ? "warning" : "info",
                      uncoded(event.text),
                      {}};
  const std::string_view text = event.text;
  take_order(text, view);
  if (take_device(text, view)) return view;
  const std::size_t colon = text.find(": ");
  if (colon == std::string_view::npos) return view;
  const auto head = text.substr(0, colon);
  if (is_mode(head) && take_standstill(head, text.substr(colon + 2), view)) return view;
  const std::size_t arrow = head.find(" -> ");
  if (arrow != std::string_view::npos && is_mode(head.substr(0, arrow)) && is_mode(head.substr(arrow + 4)))
    view.what.code = "event.mode-" + std::string(head.substr(arrow + 4));
  return view;
}

}  // namespace madori::app
