#include "preview/page_server.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <strings.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <exception>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <httplib.h>

#include "io/error.h"

namespace abbe {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMaxQuestion = 8192;
constexpr std::chrono::seconds kAskWithin{2};
constexpr std::chrono::seconds kTakeWithin{5};
constexpr int kWaiting = 128;
constexpr std::size_t kThreads = 16;  // nearly all of which wait for slow clients

// When the connection that this thread serves was made.
thread_local Clock::time_point connected{};

// Serves connections in their order, and lets each know how long it has waited.
class ConnectionQueue : public httplib::TaskQueue {
 public:
  void enqueue(std::function<void()> serve) override {
    threads_.enqueue([serve = std::move(serve), now = Clock::now()] {
      connected = now;
      serve();
    });
  }
  void shutdown() override { threads_.shutdown(); }

 private:
  httplib::ThreadPool threads_{kThreads};
};

// A connection that has so many bytes and so much time and no more, however it deals them out.
class Connection : public httplib::Stream {
 public:
  explicit Connection(int socket) : socket_(socket) {}
  ~Connection() override {
    (void)::shutdown(socket_, SHUT_RDWR);
    (void)::close(socket_);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  bool is_readable() const override { return begin_ != end_ || ready(POLLIN, kAskWithin); }
  bool is_writable() const override { return ready(POLLOUT, kTakeWithin); }

  ssize_t read(char* to, std::size_t size) override {
    if (begin_ == end_) {
      const std::size_t room = std::min(buffer_.size(), kMaxQuestion - taken_);
      if (room == 0 || !ready(POLLIN, kAskWithin)) return -1;
      const ssize_t got = ::recv(socket_, buffer_.data(), room, 0);
      if (got <= 0) return got;
      taken_ += static_cast<std::size_t>(got);
      begin_ = 0;
      end_ = static_cast<std::size_t>(got);
    }
    const std::size_t count = std::min(size, end_ - begin_);
    std::copy_n(buffer_.data() + begin_, count, to);
    begin_ += count;
    return static_cast<ssize_t>(count);
  }

  ssize_t write(const char* from, std::size_t size) override {
    if (!is_writable()) return -1;
    return ::send(socket_, from, size, MSG_NOSIGNAL | MSG_DONTWAIT);
  }

  // Nobody asks.
  void get_remote_ip_and_port(std::string&, int&) const override {}
  void get_local_ip_and_port(std::string&, int&) const override {}
  socket_t socket() const override { return socket_; }

 private:
  [[nodiscard]] bool ready(short event, std::chrono::seconds within) const {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(connected + within - Clock::now()).count();
    pollfd descriptor{socket_, event, 0};
    return left > 0 && ::poll(&descriptor, 1, static_cast<int>(left)) > 0;
  }

  int socket_;
  std::array<char, 2048> buffer_{};
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::size_t taken_ = 0;
};

// Another program that listens there is to be noticed, so the port is not shared; but one that a program has
// just left may be taken.
void set_options(int socket) {
  const int yes = 1;
  (void)::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
}

bool is_same_name(const std::string& a, const std::string& b) {
  return ::strcasecmp(a.c_str(), b.c_str()) == 0;
}

// By no more than its text: what a name server says of a name is up to others.
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

// Whether no stranger can have let the name that a page is asked by point at this machine: addresses have no
// names, and its own names are not for strangers to give.
bool is_own(const std::string& host, const std::string& listens_at) {
  if (host.empty()) return false;
  if (is_loopback(host)) return true;
  if (is_loopback(listens_at)) return false;
  const std::string own = own_name();
  return is_address(host) || is_same_name(host, own) || is_same_name(host, own.substr(0, own.find('.'))) ||
         is_same_name(host, listens_at);
}

// The host of "host:port", "[host]:port" or either without a port.
std::string host_of(const std::string& text) {
  if (text.starts_with('[')) return text.substr(1, text.find(']') - 1);
  return text.substr(0, text.rfind(':'));
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
    // The library lets five connections wait to be accepted, and others try again after a second.
    void let_more_wait() { (void)::listen(svr_sock_, kWaiting); }

   private:
    bool process_and_close_socket(socket_t socket) override {
      Connection connection(socket);
      bool closed = false;
      // Answers on one machine are not worth compressing, and whoever asks for parts is given the whole.
      return process_request(connection, true, closed, [](httplib::Request& request) {
        request.headers.erase("Accept-Encoding");
        request.headers.erase("Range");
        request.ranges.clear();
      });
    }
  };

  HttpServer server = {};
  std::string host = {};
  int port = 0;
  std::function<PageAnswer(const PageRequest&)> answer = {};
  std::jthread thread = {};

  [[nodiscard]] PageAnswer reply(const httplib::Request& request) const {
    if (request.method != "GET" && request.method != "HEAD") return failure(405, "allowed: GET, HEAD");
    if (request.get_header_value_count("Host") > 1) return failure(400, "asked by several names");
    if (!is_own(host_of(request.get_header_value("Host")), host))
      return failure(403, "asked by the name of another host: ask by the address of this one");
    PageRequest question{request.path, {}};
    for (const auto& [key, value] : request.params) question.parameters.emplace(key, value);
    try {
      return answer(question);
    } catch (const std::exception& e) {
      return failure(500, e.what());
    }
  }
};

PageServer::PageServer(const ServerAddress& address, std::function<PageAnswer(const PageRequest&)> answer) {
  const auto on_broken_pipe = std::signal(SIGPIPE, SIG_IGN);  // which the library changes for the program
  listener_ = std::make_unique<Listener>();
  (void)std::signal(SIGPIPE, on_broken_pipe);
  listener_->host = address.host;
  listener_->answer = std::move(answer);
  Listener::HttpServer& server = listener_->server;
  server.new_task_queue = [] { return new ConnectionQueue; };  // owned by the library
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
                "cannot be listened on: another program does, or there is no such address");
  server.let_more_wait();
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
