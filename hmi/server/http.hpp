#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

/// Requests and responses as the handlers see them: no socket, no Beast.
namespace madori::hmi {

/// Rights grow from left to right.
enum class Role { None, Viewer, Operator, Integrator };

struct Request {
  std::string method;
  std::string path;                            ///< decoded, no query
  std::map<std::string, std::string> query;    ///< decoded
  std::map<std::string, std::string> headers;  ///< names in lower case
  std::string body;
  std::vector<std::string> captures;  ///< what the route's `*` stood for
  Role role = Role::None;

  [[nodiscard]] std::string header(const std::string& lower_case_name) const;
  /// A cookie's value; empty where there is none.
  [[nodiscard]] std::string cookie(std::string_view name) const;
};

struct Response {
  int status = 200;
  std::string content_type = "application/json";
  std::string body;
  std::map<std::string, std::string> headers;
  /// Where set, the body comes in parts instead: called on a worker until it returns an empty one.
  std::function<std::string()> next_part{};

  [[nodiscard]] static Response json(std::string body, int status = 200);
  /// {"error": {"code", "text"}}: the panel knows the code, a person the text.
  [[nodiscard]] static Response error(int status, const std::string& code, const std::string& text);
};

using Handler = std::function<Response(const Request&)>;

/// Where a handler runs, and how much it may be sent.
enum class Work {
  Quick,   ///< at once, among the sockets: it must not wait for anything
  Worker,  ///< on a worker: it may touch the disk
  Upload,  ///< on a worker, with a body of up to ServerOptions::most_upload_bytes
};

/// Finds the handler of a method and path. A pattern's `*` stands for one path element.
class Router {
 public:
  /// `needs` is the least role.
  void add(std::string method, const std::string& pattern, Role needs, Handler handler,
           Work work = Work::Quick);

  struct Match {
    const Handler* handler = nullptr;
    Work work = Work::Quick;
    int refusal = 0;  ///< 401, 403, 404 or 405 instead of a handler
  };
  /// Fills the request's captures. Role::None with a route that needs more gives 401, too low a role 403.
  [[nodiscard]] Match match(Request& request) const;

 private:
  struct Route {
    std::string method;
    std::vector<std::string> elements;
    Role needs;
    Handler handler;
    Work work;
  };
  std::vector<Route> routes_;
};

/// Splits "a/b?x=1" into the decoded path and query. False on malformed escapes, NUL bytes or a path that
/// climbs (`..`).
[[nodiscard]] bool parse_target(std::string_view target, Request& request);

}  // namespace madori::hmi
