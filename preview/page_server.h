#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

namespace abbe {

/// Where a server listens: only to programs of this machine, unless told.
struct ServerAddress {
  std::string host = "127.0.0.1";
  int port = 0;  ///< 0: any that is free.
};

/// "host:port", an address of IPv6 in brackets.
[[nodiscard]] std::string to_text(const ServerAddress& address);

/// A question to a server of pages.
struct PageRequest {
  std::string path;
  std::map<std::string, std::string> parameters;
};

/// What it answers: a page by its type and text, or by its HTTP status why there is none.
struct PageAnswer {
  int status = 200;
  std::string type = "text/plain";
  std::shared_ptr<const std::string> body = {};
};

/// A page there is not.
[[nodiscard]] inline PageAnswer not_found() {
  return {404, "text/plain", std::make_shared<const std::string>("no such page\n")};
}

/// Answers GET and HEAD of HTTP/1.1 while it lives, each connection one question, on threads of its own. A
/// `QuestionReader` drops connections that ask too slowly, too much, or are too many, and an answer that is
/// not taken within five seconds is dropped. Whoever asks for parts of an answer is given the whole.
///
/// A question without one well-formed Host header is answered by 400. Names of other hosts, by which pages of
/// strangers could read the answers, are refused by 403: on an address of this machine alone all but
/// "localhost" and such addresses, on others all but addresses, "localhost", this machine's own name and the
/// one that it listens at.
class PageServer {
 public:
  /// `answer` is called by several threads at once; what it throws is answered as a failure of the server.
  /// Throws Error{output} when the address cannot be listened on.
  PageServer(const ServerAddress& address, std::function<PageAnswer(const PageRequest&)> answer);
  ~PageServer();
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;

  /// What to open in a browser, such as "http://127.0.0.1:8080/".
  [[nodiscard]] std::string url() const;

 private:
  struct Listener;
  std::unique_ptr<Listener> listener_;
};

}  // namespace abbe
