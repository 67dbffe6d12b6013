#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

namespace abbe {

/// Address at which a server listens; by default only for programs of this machine.
struct ServerAddress {
  std::string host = "127.0.0.1";  ///< Name or address; an IPv6 address without brackets.
  int port = 0;                    ///< 0 to 65535; 0 selects any free port.
};

/// "host:port", with an IPv6 address in brackets.
[[nodiscard]] std::string to_text(const ServerAddress& address);

/// An HTTP request to a `PageServer`.
struct PageRequest {
  std::string path;  ///< Decoded path, from "/" on, without the parameters.
  /// Decoded parameters of the query; the first value of a repeated name.
  std::map<std::string, std::string> parameters;
};

/// The answer to a request: the content of a page, or the HTTP status of an error with a message.
struct PageAnswer {
  int status = 200;                              ///< HTTP status.
  std::string type = "text/plain";               ///< MIME type of the body.
  std::shared_ptr<const std::string> body = {};  ///< nullptr for no content.
};

/// The answer 404 for a page that does not exist.
[[nodiscard]] inline PageAnswer not_found() {
  return {404, "text/plain", std::make_shared<const std::string>("no such page\n")};
}

/// An HTTP/1.1 server with threads of its own, which answers GET and HEAD during its lifetime, one request
/// per connection. A `RequestReader` closes connections with slow or long requests, and excess connections.
/// An answer that the client does not take within five seconds is dropped. Requests for a range get the whole
/// answer.
///
/// The Host header protects against DNS rebinding, by which pages of other hosts could read the answers.
/// Without exactly one well-formed Host header the answer is 400. With the name of another host it is 403. If
/// the server listens only on this machine, it accepts "localhost" and loopback addresses. Otherwise it
/// accepts all addresses, "localhost", this machine's name and the name at which it listens.
class PageServer {
 public:
  /// Starts the server and returns when it listens. Up to 16 threads call `answer` at once, until the
  /// destructor returns; an exception from it becomes the answer 500. Methods other than GET and HEAD become
  /// 405.
  /// Throws Error{output} if the address cannot be listened on, and Error{resource} if too many files are
  /// open.
  PageServer(const ServerAddress& address, std::function<PageAnswer(const PageRequest&)> answer);
  /// Stops listening, closes connections with incomplete requests and waits for answers in progress.
  ~PageServer();
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;

  /// The URL to open in a browser, with the port in use, such as "http://127.0.0.1:8080/".
  [[nodiscard]] std::string url() const;

 private:
  struct Listener;
  std::unique_ptr<Listener> listener_;
};

}  // namespace abbe
