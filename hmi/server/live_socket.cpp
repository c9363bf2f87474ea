#include "hmi/server/live_socket.hpp"

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/this_coro.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <memory>
#include <optional>
#include <utility>

#include "hmi/server/live_command.hpp"

namespace madori::hmi {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using Clock = std::chrono::steady_clock;
using Socket = websocket::stream<beast::tcp_stream>;

constexpr std::chrono::milliseconds kJogLife{250};
constexpr std::chrono::milliseconds kJogWatch{50};
constexpr std::size_t kMostMessageBytes = 4096;

/// What the reading, the writing and the watching coroutine of one socket share; all run on one thread.
struct Session {
  Session(beast::tcp_stream stream, RoleNow r, Vehicle& v, LiveFeed& f)
      : socket(std::move(stream)), role(std::move(r)), vehicle(v), feed(f) {}
  ~Session() {
    end_jog();
    feed.left(this);
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  void end_jog() {
    if (holds) (void)vehicle.jog({}, this);
    holds = false;
    jog_until.reset();
  }

  Socket socket;
  RoleNow role;
  Vehicle& vehicle;
  LiveFeed& feed;
  bool holds = false;  ///< a jog button: it has not sent a zero jog since
  std::optional<Clock::time_point> jog_until;
  std::optional<Notice> refusal;  ///< to tell with the next state
  bool open = true;
};

void take_jog(Session& session, const VelocityCommand& velocity) {
  if (session.role() < Role::Operator) {
    session.end_jog();
    session.refusal = Reply::refused("not-allowed", "only an operator may drive by hand").reason;
    return;
  }
  session.holds = velocity != VelocityCommand{};
  const Reply reply = session.vehicle.jog(velocity, &session);
  if (!reply.accepted) session.refusal = reply.reason;
  session.jog_until = reply.accepted && session.holds ? std::optional(Clock::now() + kJogLife) : std::nullopt;
}

void take_message(Session& session, const std::string& text) {
  const auto command = parse_live_command(text);
  if (command && command->jog)
    take_jog(session, *command->jog);
  else if (!command || !session.feed.edits(&session, command->editing))
    session.refusal = Reply::refused("bad-message", "the message was not understood").reason;
}

asio::awaitable<void> read_messages(std::shared_ptr<Session> session) {
  beast::flat_buffer buffer(kMostMessageBytes);
  boost::system::error_code error;
  while (session->open) {
    co_await session->socket.async_read(buffer, asio::redirect_error(asio::use_awaitable, error));
    if (error) break;
    take_message(*session, beast::buffers_to_string(buffer.data()));
    buffer.consume(buffer.size());
  }
  session->open = false;
  session->end_jog();
}

asio::awaitable<void> watch_jog(std::shared_ptr<Session> session) {
  asio::steady_timer timer(co_await asio::this_coro::executor);
  boost::system::error_code error;
  while (session->open) {
    timer.expires_after(kJogWatch);
    co_await timer.async_wait(asio::redirect_error(asio::use_awaitable, error));
    if (!session->jog_until || Clock::now() <= *session->jog_until) continue;
    session->vehicle.jog_silent(session.get());
    session->jog_until.reset();
  }
}

asio::awaitable<void> write_states(std::shared_ptr<Session> session, double rate_hz) {
  asio::steady_timer timer(co_await asio::this_coro::executor);
  const auto period =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1.0 / rate_hz));
  boost::system::error_code error;
  std::shared_ptr<const std::string> last_scan;
  while (session->open && !error && session->role() >= Role::Viewer) {
    timer.expires_after(period);
    session->feed.refresh(Clock::now());
    const auto scan = session->feed.scan();
    const std::string state = session->feed.message(session.get(), session->refusal);
    session->refusal.reset();
    session->socket.text(true);
    co_await session->socket.async_write(asio::buffer(state),
                                         asio::redirect_error(asio::use_awaitable, error));
    if (error || !session->open) break;
    if (scan && scan != last_scan) {
      session->socket.binary(true);
      co_await session->socket.async_write(asio::buffer(*scan),
                                           asio::redirect_error(asio::use_awaitable, error));
      last_scan = scan;
    }
    if (!error) co_await timer.async_wait(asio::redirect_error(asio::use_awaitable, error));
  }
  session->open = false;
  beast::get_lowest_layer(session->socket).cancel();
}

}  // namespace

asio::awaitable<void> serve_live(beast::tcp_stream stream,
                                 beast::http::request<beast::http::string_body> upgrade, RoleNow role,
                                 Vehicle& vehicle, LiveFeed& feed, double rate_hz) {
  stream.expires_never();
  const auto session = std::make_shared<Session>(std::move(stream), std::move(role), vehicle, feed);
  session->socket.set_option(
      websocket::stream_base::timeout{std::chrono::seconds(5), std::chrono::seconds(6), true});
  session->socket.read_message_max(kMostMessageBytes);
  boost::system::error_code error;
  co_await session->socket.async_accept(upgrade, asio::redirect_error(asio::use_awaitable, error));
  if (error) co_return;
  const auto executor = co_await asio::this_coro::executor;
  asio::co_spawn(executor, read_messages(session), asio::detached);
  asio::co_spawn(executor, watch_jog(session), asio::detached);
  co_await write_states(session, rate_hz);
}

}  // namespace madori::hmi
