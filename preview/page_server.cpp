#include "preview/page_server.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <strings.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <csignal>
#include <exception>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <httplib.h>

#include "io/error.h"
#include "preview/request_reader.h"

namespace abbe {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kSendTimeout{5};
constexpr int kBacklog = 128;
constexpr std::size_t kThreads = 16;  // most of them wait for slow clients

// A queue that runs its tasks at once on the accepting thread; they only hand over connections.
class HandOver : public httplib::TaskQueue {
 public:
  explicit HandOver(std::function<void()> shut_down) : shut_down_(std::move(shut_down)) {}
  void enqueue(std::function<void()> hand_over) override { hand_over(); }
  void shutdown() override { shut_down_(); }

 private:
  std::function<void()> shut_down_;
};

// A connection whose request has been read. The client has a fixed total time to take the answer.
class Connection : public httplib::Stream {
 public:
  Connection(int socket, std::string request_text) : socket_(socket), request_(std::move(request_text)) {}
  ~Connection() override {
    (void)::shutdown(socket_, SHUT_RDWR);
    (void)::close(socket_);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  bool is_readable() const override { return at_ < request_.size(); }
  bool is_writable() const override {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(until_ - Clock::now()).count();
    pollfd descriptor{socket_, POLLOUT, 0};
    return left > 0 && ::poll(&descriptor, 1, static_cast<int>(left)) > 0;
  }

  ssize_t read(char* to, std::size_t size) override {
    const std::size_t count = request_.copy(to, size, at_);
    at_ += count;
    return static_cast<ssize_t>(count);
  }

  ssize_t write(const char* from, std::size_t size) override {
    if (!is_writable()) return -1;
    return ::send(socket_, from, size, MSG_NOSIGNAL | MSG_DONTWAIT);
  }

  // These functions are never called.
  void get_remote_ip_and_port(std::string&, int&) const override {}
  void get_local_ip_and_port(std::string&, int&) const override {}
  socket_t socket() const override { return socket_; }

 private:
  int socket_;
  Clock::time_point until_ = Clock::now() + kSendTimeout;
  std::string request_;
  std::size_t at_ = 0;
};

// The port is not shared, so that another program that listens there is noticed. A port that a program has
// just left may be reused.
void set_options(int socket) {
  const int yes = 1;
  (void)::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
}

bool is_same_name(const std::string& a, const std::string& b) {
  return ::strcasecmp(a.c_str(), b.c_str()) == 0;
}

// Decides by the text alone, because name servers are not trusted.
bool is_loopback(const std::string& host) {
  in_addr v4{};
  in6_addr v6{};
  if (::inet_pton(AF_INET, host.c_str(), &v4) == 1) return ntohl(v4.s_addr) >> 24 == 127;
  if (::inet_pton(AF_INET6, host.c_str(), &v6) == 1) return IN6_IS_ADDR_LOOPBACK(&v6) != 0;
  return is_same_name(host, "localhost");
}

bool is_address(const std::string& host) {
  in6_addr bytes{};
  return ::inet_pton(AF_INET, host.c_str(), &bytes) == 1 || ::inet_pton(AF_INET6, host.c_str(), &bytes) == 1;
}

// This machine's name.
std::string own_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

// True if `host` cannot be a foreign name that resolves to this machine: it is an address or one of this
// machine's own names.
bool is_own_host(const std::string& host, const std::string& listen_host) {
  if (host.empty()) return false;
  if (is_loopback(host)) return true;
  if (is_loopback(listen_host)) return false;
  const std::string own = own_name();
  return is_address(host) || is_same_name(host, own) || is_same_name(host, own.substr(0, own.find('.'))) ||
         is_same_name(host, listen_host);
}

// The host of "host" or "host:port", with an IPv6 address in brackets [RFC9110, sec. 7.2; RFC3986, sec. 3.2].
// Empty for malformed text.
std::optional<std::string> host_of(std::string_view text) {
  const bool bracketed = text.starts_with('[');
  const std::size_t end = bracketed ? text.find(']') : std::min(text.find(':'), text.size());
  if (end == std::string_view::npos) return std::nullopt;
  const std::string host(text.substr(bracketed ? 1 : 0, end - (bracketed ? 1 : 0)));
  const std::string_view port = text.substr(end + (bracketed ? 1 : 0));
  const bool has_port = port.empty() || port.starts_with(':');
  if (!has_port || port.find_first_not_of("0123456789", 1) != std::string_view::npos) return std::nullopt;
  if (bracketed) {
    in6_addr ignored{};
    return ::inet_pton(AF_INET6, host.c_str(), &ignored) == 1 ? std::optional(host) : std::nullopt;
  }
  static constexpr std::string_view kNameMarks = "-._~!$&'()*+,;=%";
  const bool is_name = std::ranges::all_of(host, [](unsigned char c) {
    return c < 0x80 &&
           (std::isalnum(c) != 0 || kNameMarks.find(static_cast<char>(c)) != std::string_view::npos);
  });
  return is_name ? std::optional(host) : std::nullopt;
}

void fill(const PageAnswer& answer, httplib::Response& response) {
  response.status = answer.status;
  if (answer.body) response.set_content(answer.body->data(), answer.body->size(), answer.type);
}

PageAnswer failure(int status, const std::string& why) {
  return {status, "text/plain", std::make_shared<const std::string>(why + "\n")};
}

}  // namespace

std::string to_text(const ServerAddress& address) {
  const bool v6 = address.host.find(':') != std::string::npos;
  return fmt::format("{}:{}", v6 ? "[" + address.host + "]" : address.host, address.port);
}

struct PageServer::Listener {
  class HttpServer : public httplib::Server {
   public:
    // The library's backlog of five connections is too short: further clients retry only after a second.
    void lengthen_backlog() { (void)::listen(svr_sock_, kBacklog); }

    // A queue that gives accepted connections to the `RequestReader` at once. The library owns it.
    httplib::TaskQueue* make_immediate_queue() {
      return new HandOver([this] { end(); });
    }
    ~HttpServer() override { end(); }

   private:
    bool process_and_close_socket(socket_t socket) override {
      reader_.add(socket);
      return true;
    }

    void end() {
      reader_.stop();
      if (!std::exchange(ended_, true)) threads_.shutdown();
    }

    void serve(int socket, std::string request_text) {
      process(socket, std::move(request_text));
      reader_.served();
    }

    void process(int socket, std::string request_text) {
      Connection connection(socket, std::move(request_text));
      bool closed = false;
      // Compression is useless on one machine, and range requests get the whole answer.
      (void)process_request(connection, true, closed, [](httplib::Request& request) {
        request.headers.erase("Accept-Encoding");
        request.headers.erase("Range");
        request.ranges.clear();
      });
    }

    bool ended_ = false;
    httplib::ThreadPool threads_{kThreads};
    RequestReader reader_{[this](int socket, std::string request_text) {
      threads_.enqueue(
          [this, socket, request_text = std::move(request_text)] { serve(socket, request_text); });
    }};
  };

  HttpServer server = {};
  std::string host = {};
  int port = 0;
  std::function<PageAnswer(const PageRequest&)> answer = {};
  std::jthread thread = {};

  [[nodiscard]] PageAnswer reply(const httplib::Request& request) const {
    if (request.method != "GET" && request.method != "HEAD") return failure(405, "allowed: GET, HEAD");
    const std::size_t names = request.get_header_value_count("Host");
    if (names != 1)
      return failure(400,
                     names == 0 ? "the request has no Host header" : "the request has several Host headers");
    const std::optional<std::string> name = host_of(request.get_header_value("Host"));
    if (!name) return failure(400, "the Host header is malformed");
    if (!is_own_host(*name, host))
      return failure(403, "the Host header names another machine: use the address of this one");
    PageRequest page_request{request.path, {}};
    for (const auto& [key, value] : request.params) page_request.parameters.emplace(key, value);
    try {
      return answer(page_request);
    } catch (const std::exception& e) {
      return failure(500, e.what());
    }
  }
};

PageServer::PageServer(const ServerAddress& address, std::function<PageAnswer(const PageRequest&)> answer) {
  const auto on_broken_pipe = std::signal(SIGPIPE, SIG_IGN);  // the library changes it for the whole program
  listener_ = std::make_unique<Listener>();
  (void)std::signal(SIGPIPE, on_broken_pipe);
  listener_->host = address.host;
  listener_->answer = std::move(answer);
  Listener::HttpServer& server = listener_->server;
  server.new_task_queue = [&server] { return server.make_immediate_queue(); };
  server.set_socket_options(set_options);
  server.set_default_headers(
      {{"Cache-Control", "no-store"},
       {"Content-Security-Policy", "default-src 'self' 'unsafe-inline'; img-src 'self' data:"},
       {"Cross-Origin-Resource-Policy", "same-origin"},
       {"X-Content-Type-Options", "nosniff"}});
  server.set_pre_routing_handler(
      [listener = listener_.get()](const httplib::Request& request, httplib::Response& response) {
        fill(listener->reply(request), response);
        return httplib::Server::HandlerResponse::Handled;
      });
  listener_->port = address.port == 0                                 ? server.bind_to_any_port(address.host)
                    : server.bind_to_port(address.host, address.port) ? address.port
                                                                      : -1;
  if (listener_->port < 0)
    throw Error(ErrorCode::output, to_text(address),
                "cannot be listened on: another program uses it, or there is no such address");
  server.lengthen_backlog();
  listener_->thread = std::jthread([&server] { (void)server.listen_after_bind(); });
  while (!server.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

PageServer::~PageServer() {
  listener_->server.stop();
}

std::string PageServer::url() const {
  return "http://" + to_text({listener_->host, listener_->port}) + "/";
}

}  // namespace abbe
