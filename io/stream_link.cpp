#include "io/stream_link.hpp"

#include <sys/file.h>
#include <termios.h>

#include <array>
#include <atomic>
#include <boost/asio/connect.hpp>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/serial_port.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "core/clock.hpp"
#include "core/result.hpp"
#include "core/thread_role.hpp"

namespace madori::io {
namespace {

namespace asio = boost::asio;
using Problem = boost::system::error_code;

/// Opening is what serial ports and TCP connections do differently; `Opener` calls back with the outcome.
template <class Stream, class Opener>
class AsioLink final : public StreamLink {
 public:
  AsioLink(Opener opener, LinkEvents events, StreamOptions options)
      : opener_(std::move(opener)),
        events_(std::move(events)),
        options_(options),
        stream_(context_),
        timer_(context_) {}
  ~AsioLink() override {
    if (!thread_.joinable()) return;
    asio::post(context_, [this] {
      stopping_ = true;
      timer_.cancel();
      close_stream();
    });
    guard_.reset();
    thread_.join();
  }
  AsioLink(const AsioLink&) = delete;
  AsioLink& operator=(const AsioLink&) = delete;

  void start() override {
    asio::post(context_, [this] { open(); });
    thread_ = std::thread([this] {
      (void)take_role("stream link", ThreadRole::Device);
      context_.run();
    });
  }
  bool write(std::span<const std::uint8_t> bytes) override {
    if (!open_ || pending_ + bytes.size() > options_.max_pending_bytes) return false;
    pending_ += bytes.size();
    asio::post(context_, [this, copy = std::vector<std::uint8_t>(bytes.begin(), bytes.end())]() mutable {
      queue_.insert(queue_.end(), copy.begin(), copy.end());
      if (!writing_) write_some();
    });
    return true;
  }
  [[nodiscard]] bool is_open() const override { return open_; }
  void drop(const std::string& reason) override {
    asio::post(context_, [this, reason] { fail(reason); });
  }

 private:
  void open() {
    if (stopping_) return;
    const unsigned turn = ++turn_;
    watch(turn);
    const auto wanted = [this, turn] { return !stopping_ && turn == turn_; };
    opener_(stream_, wanted, [this, wanted, turn](const Problem& problem) {
      if (!wanted()) return;
      if (problem == boost::system::errc::device_or_resource_busy)
        return fail("another program uses it - end that one");
      if (problem) return fail(problem.message());
      open_ = true;
      heard_ = clock_now();
      if (events_.opened) events_.opened();
      read(turn);
    });
  }

  void read(unsigned turn) {
    stream_.async_read_some(asio::buffer(buffer_), [this, turn](const Problem& problem, std::size_t count) {
      if (stopping_ || turn != turn_) return;
      if (problem) return fail(problem.message());
      heard_ = clock_now();
      if (events_.bytes) events_.bytes({buffer_.data(), count}, heard_);
      if (turn == turn_) read(turn);
    });
  }

  void write_some() {
    sending_.swap(queue_);
    queue_.clear();
    writing_ = !sending_.empty();
    if (!writing_) return;
    asio::async_write(stream_, asio::buffer(sending_),
                      [this, turn = turn_](const Problem& problem, std::size_t) {
                        pending_ -= std::min<std::size_t>(pending_, sending_.size());
                        if (stopping_ || turn != turn_) return;
                        if (problem) return fail(problem.message());
                        write_some();
                      });
  }

  /// Also bounds an opening that never ends.
  void watch(unsigned turn) {
    heard_ = clock_now();
    check_later(turn);
  }
  void check_later(unsigned turn) {
    timer_.expires_after(options_.silence / 4);
    timer_.async_wait([this, turn](const Problem& problem) {
      if (problem || stopping_ || turn != turn_) return;
      if (clock_now() - heard_ > options_.silence) return fail("nothing was heard");
      check_later(turn);
    });
  }

  void fail(const std::string& reason) {
    if (stopping_) return;
    close_stream();
    ++turn_;
    if (events_.closed) events_.closed(reason);
    timer_.expires_after(options_.reopen_after);
    timer_.async_wait([this](const Problem& problem) {
      if (!problem) open();
    });
  }
  void close_stream() {
    open_ = false;
    Problem ignored;
    stream_.close(ignored);
    queue_.clear();
    writing_ = false;
    pending_ = 0;
  }

  Opener opener_;
  LinkEvents events_;
  StreamOptions options_;
  asio::io_context context_{1};
  asio::executor_work_guard<asio::io_context::executor_type> guard_ = asio::make_work_guard(context_);
  Stream stream_;
  asio::steady_timer timer_;
  std::array<std::uint8_t, 16 * 1024> buffer_{};
  std::vector<std::uint8_t> queue_, sending_;
  Stamp heard_{};
  std::atomic<std::size_t> pending_ = 0;
  std::atomic<bool> open_ = false;
  bool writing_ = false;
  bool stopping_ = false;
  unsigned turn_ = 0;  ///< one for every opening: late completions of an old one are told by it
  std::thread thread_;
};

struct SerialOpener {
  std::string device;
  unsigned baud;

  template <class Wanted, class Done>
  void operator()(asio::serial_port& port, Wanted, Done done) const {
    Problem problem;
    port.open(device, problem);
    using Port = asio::serial_port_base;
    const auto set = [&](const auto& option) {
      if (!problem) port.set_option(option, problem);
    };
    set(Port::baud_rate(baud));
    set(Port::character_size(8));
    set(Port::parity(Port::parity::none));
    set(Port::stop_bits(Port::stop_bits::one));
    set(Port::flow_control(Port::flow_control::none));
    // One program a device: two that command one drive would take turns.
    if (!problem && ::flock(port.native_handle(), LOCK_EX | LOCK_NB) != 0) {
      Problem ignored;
      port.close(ignored);
      return done(boost::system::errc::make_error_code(boost::system::errc::device_or_resource_busy));
    }
    // What came before it was opened is old, and of unknown age.
    if (!problem) ::tcflush(port.native_handle(), TCIFLUSH);
    done(problem);
  }
};

struct TcpOpener {
  std::string host;
  std::uint16_t port;

  /// A name server may take longer than an opening is waited for: what it says at last is the next one's.
  struct Name {
    std::vector<asio::ip::tcp::endpoint> found;
    bool asked = false;
  };
  std::shared_ptr<Name> name = std::make_shared<Name>();

  template <class Wanted, class Done>
  void operator()(asio::ip::tcp::socket& socket, Wanted wanted, Done done) const {
    if (!name->found.empty()) return connect(socket, done);
    if (std::exchange(name->asked, true)) return;
    auto resolver = std::make_shared<asio::ip::tcp::resolver>(socket.get_executor());
    resolver->async_resolve(host, std::to_string(port),
                            [this, resolver, &socket, wanted, done](const Problem& problem, auto found) {
                              name->asked = false;
                              for (const auto& entry : found) name->found.push_back(entry.endpoint());
                              if (!wanted()) return;
                              problem ? done(problem) : connect(socket, done);
                            });
  }

 private:
  template <class Done>
  void connect(asio::ip::tcp::socket& socket, Done done) const {
    const auto ends = std::make_shared<const std::vector<asio::ip::tcp::endpoint>>(
        std::exchange(name->found, {}));  // the name is asked for anew next time
    asio::async_connect(socket, *ends, [&socket, ends, done](const Problem& refused, const auto&) {
      Problem ignored;
      if (!refused) socket.set_option(asio::ip::tcp::no_delay(true), ignored);
      done(refused);
    });
  }
};

}  // namespace

std::unique_ptr<StreamLink> StreamLink::serial(const std::string& device, unsigned baud, LinkEvents events,
                                               StreamOptions options) {
  if (baud == 0) throw Error(device, "has a baud rate of 0", "give the device's baud rate");
  return std::make_unique<AsioLink<asio::serial_port, SerialOpener>>(SerialOpener{device, baud},
                                                                     std::move(events), options);
}

std::unique_ptr<StreamLink> StreamLink::tcp(const std::string& host, std::uint16_t port, LinkEvents events,
                                            StreamOptions options) {
  return std::make_unique<AsioLink<asio::ip::tcp::socket, TcpOpener>>(TcpOpener{host, port},
                                                                      std::move(events), options);
}

}  // namespace madori::io
