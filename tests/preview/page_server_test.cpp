#include "preview/page_server.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <httplib.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "io/error.h"

namespace abbe {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

PageAnswer page(const std::string& text) {
  return {200, "text/plain", std::make_shared<const std::string>(text)};
}

PageAnswer echo(const PageRequest& request) {
  if (request.path == "/throws") throw std::runtime_error("thrown");
  if (request.path != "/there") return not_found();
  const auto word = request.parameters.find("word");
  return page(word == request.parameters.end() ? "" : word->second);
}

int port_of(const PageServer& server) {
  const std::string url = server.url();
  return std::stoi(url.substr(url.rfind(':') + 1));
}

// A TCP connection, closed by the destructor.
class Socket {
 public:
  explicit Socket(int port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    connected_ = ::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof(address)) == 0;
  }
  ~Socket() { ::close(socket_); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  [[nodiscard]] bool connected() const { return connected_; }
  bool say(const std::string& text) const {
    return ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(text.size());
  }
  // True if the other end closes within `time`; what it sends before is appended to `heard`.
  bool closes_within(std::chrono::milliseconds time, std::string* heard = nullptr) const {
    const auto until = Clock::now() + time;
    std::vector<char> buffer(1 << 20);
    while (Clock::now() < until) {
      pollfd descriptor{socket_, POLLIN, 0};
      if (::poll(&descriptor, 1, 20) <= 0) continue;
      const ssize_t got = ::recv(socket_, buffer.data(), buffer.size(), 0);
      if (got <= 0) return true;
      if (heard != nullptr) heard->append(buffer.data(), static_cast<std::size_t>(got));
    }
    return false;
  }

  // True if the other end has closed by now without sending anything.
  [[nodiscard]] bool is_closed() const {
    char byte = 0;
    return ::recv(socket_, &byte, 1, MSG_DONTWAIT) == 0;
  }

 private:
  int socket_;
  bool connected_ = false;
};

TEST(PageServer, AnswersItsPagesAndNoOthers) {
  const PageServer server({}, echo);
  EXPECT_EQ(server.url().find("http://127.0.0.1:"), 0U);
  httplib::Client client("127.0.0.1", port_of(server));
  const auto there = client.Get("/there?word=glass");
  ASSERT_TRUE(there);
  EXPECT_EQ(there->status, 200);
  EXPECT_EQ(there->body, "glass");
  EXPECT_EQ(client.Get("/elsewhere")->status, 404);
  EXPECT_EQ(client.Get("/throws")->status, 500);
  EXPECT_EQ(client.Post("/there", "text", "text/plain")->status, 405);
  EXPECT_EQ(client.Delete("/there")->status, 405);
}

TEST(PageServer, RefusesNamesOfOtherHosts) {
  const PageServer server({}, echo);
  httplib::Client client("127.0.0.1", port_of(server));
  for (const char* host : {"elsewhere.example", "127.0.0.1.elsewhere.example", "127.elsewhere.example:80"})
    EXPECT_EQ(client.Get("/there", {{"Host", host}})->status, 403) << host;
  for (const char* host : {"localhost", "localhost:80", "127.0.0.1:80", "[::1]:80", "127.0.0.1"})
    EXPECT_EQ(client.Get("/there", {{"Host", host}})->status, 200) << host;
}

TEST(PageServer, OnOpenAddressesRefusesThemTooButItsOwnName) {
  const PageServer server({"0.0.0.0", 0}, echo);
  httplib::Client client("127.0.0.1", port_of(server));
  std::array<char, 256> name{};
  ASSERT_EQ(::gethostname(name.data(), name.size() - 1), 0);
  const std::string own = name.data();
  for (const std::string& host :
       {std::string("elsewhere.example"), std::string("192.168.1.20.elsewhere.example:80"),
        own + ".elsewhere.example", "elsewhere." + own})
    EXPECT_EQ(client.Get("/there", {{"Host", host}})->status, 403) << host;
  for (const std::string& host : {std::string("192.168.1.20:8080"), std::string("[2001:db8::1]:80"),
                                  std::string("LocalHost:80"), own, own + ":80"})
    EXPECT_EQ(client.Get("/there", {{"Host", host}})->status, 200) << host;
}

// Status line of the answer to a request with these header lines.
std::string status_of(const PageServer& server, const std::string& headers) {
  const Socket socket(port_of(server));
  std::string heard;
  EXPECT_TRUE(socket.say("GET /there HTTP/1.1\r\n" + headers + "\r\n"));
  EXPECT_TRUE(socket.closes_within(1s, &heard)) << headers;
  return heard.substr(0, 13);
}

TEST(PageServer, RefusesQuestionsByNoNameByTwoAndByMalformedOnes) {
  for (const char* address : {"127.0.0.1", "0.0.0.0"}) {
    const PageServer server({address, 0}, echo);
    EXPECT_EQ(status_of(server, ""), "HTTP/1.1 400 ");
    EXPECT_EQ(status_of(server, "Host:\r\n"), "HTTP/1.1 400 ");
    EXPECT_EQ(status_of(server, "Host: localhost\r\nHost: elsewhere.example\r\n"), "HTTP/1.1 400 ");
    for (const std::string host :
         {"[::1].evil.com", "[127.0.0.1", "[127.0.0.1]", "[::1", "[::1]80", "[::1]:80:80", "[]", "::1",
          "localhost:80:80", "localhost:http", "127.0.0.1:-1", "127.0.0.1:80.evil.com",
          "127.0.0.1:80@evil.com", "evil.com@127.0.0.1", "localhost/", "local host", "127.0.0.1, localhost",
          "\"localhost\""})
      EXPECT_EQ(status_of(server, "Host: " + host + "\r\n"), "HTTP/1.1 400 ") << address << ' ' << host;
    for (const std::string host : {"localhost:", "127.0.0.1:80", "[::1]", "[::1]:80"})
      EXPECT_EQ(status_of(server, "Host: " + host + "\r\n"), "HTTP/1.1 200 ") << address << ' ' << host;
  }
}

// Many overlapping ranges would make a large answer from a small page.
TEST(PageServer, GivesTheWholeToThoseWhoAskForParts) {
  const PageServer server({}, echo);
  httplib::Client client("127.0.0.1", port_of(server));
  for (const char* parts : {"bytes=0-1", "bytes=0-1,0-2,1-2"}) {
    const auto answer = client.Get("/there?word=glass", {{"Range", parts}});
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 200) << parts;
    EXPECT_EQ(answer->body, "glass") << parts;
  }
}

TEST(PageServer, LetsNoOtherPageShowItsAnswers) {
  const PageServer server({}, echo);
  httplib::Client client("127.0.0.1", port_of(server));
  EXPECT_EQ(client.Get("/there")->get_header_value("Cross-Origin-Resource-Policy"), "same-origin");
}

TEST(PageServer, DropsLongQuestions) {
  const PageServer server({}, echo);
  const std::string much(5000, 'a');
  const std::string two =
      "GET /there HTTP/1.1\r\nHost: localhost\r\nA: " + much + "\r\nB: " + much + "\r\n\r\n";
  for (const std::string& question :
       {"GET /there?word=" + much + much + " HTTP/1.1\r\n\r\n", two, much + much}) {
    const Socket socket(port_of(server));
    std::string heard;
    (void)socket.say(question);
    EXPECT_TRUE(socket.closes_within(1s, &heard)) << question.substr(0, 20);
    EXPECT_EQ(heard.find(" 200 "), std::string::npos) << heard;
  }
}

// Each byte arrives soon after the last one.
TEST(PageServer, DropsSlowQuestions) {
  const PageServer server({}, echo);
  const Socket socket(port_of(server));
  const auto begin = Clock::now();
  while (Clock::now() - begin < 4s && !socket.closes_within(100ms)) (void)socket.say("G");
  EXPECT_GT(Clock::now() - begin, 1900ms);
  EXPECT_LT(Clock::now() - begin, 3s);
}

// Opens many connections, each of which sends `text` and nothing more.
std::vector<std::unique_ptr<Socket>> connections(const PageServer& server, std::size_t count,
                                                 const std::string& text) {
  std::vector<std::unique_ptr<Socket>> all;
  while (all.size() < count) {
    all.push_back(std::make_unique<Socket>(port_of(server)));
    EXPECT_TRUE(all.back()->connected());
    if (!text.empty()) (void)all.back()->say(text);
  }
  return all;
}

void expect_prompt_answer(const PageServer& server) {
  const auto begin = Clock::now();
  httplib::Client client("127.0.0.1", port_of(server));
  const auto answer = client.Get("/there?word=glass");
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->body, "glass");
  EXPECT_LT(Clock::now() - begin, 1s);  // before the server drops slow requests
}

TEST(PageServer, ManySlowQuestionsKeepNobodyWaiting) {
  const PageServer server({}, echo);
  const auto slow = connections(server, 60, "GET ");
  expect_prompt_answer(server);
}

// Both ends of all connections are open files of this process.
TEST(PageServer, AnswersBesideManyMoreIdleConnectionsThanItKeeps) {
  constexpr rlim_t kFiles = 4000;
  rlimit files{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &files), 0);
  if (files.rlim_max < kFiles) GTEST_SKIP() << "a process may have " << files.rlim_max << " files";
  files.rlim_cur = std::max(files.rlim_cur, kFiles);
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &files), 0);
  const PageServer server({}, echo);
  const auto idle = connections(server, 1200, "");
  expect_prompt_answer(server);
  EXPECT_TRUE(idle.front()->closes_within(1s));
  std::size_t kept = 0;
  for (const auto& connection : idle)
    if (!connection->is_closed()) ++kept;
  EXPECT_LE(kept, 256U);
}

TEST(PageServer, DropsThoseWhoTakeNoAnswer) {
  const std::string large(std::size_t{64} << 20, 'a');
  const PageServer server({}, [&large](const PageRequest&) { return page(large); });
  const Socket socket(port_of(server));
  ASSERT_TRUE(socket.say("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n"));
  std::this_thread::sleep_for(5500ms);
  std::string heard;
  EXPECT_TRUE(socket.closes_within(5s, &heard));
  EXPECT_LT(heard.size(), large.size());
}

TEST(PageServer, AnswersManyAtOnce) {
  const PageServer server({}, echo);
  std::atomic<int> answered = 0;
  std::vector<std::jthread> clients;
  for (int i = 0; i < 20; ++i)
    clients.emplace_back([&] {
      for (int j = 0; j < 5; ++j) {
        httplib::Client client("127.0.0.1", port_of(server));
        if (const auto answer = client.Get("/there?word=glass"); answer && answer->body == "glass")
          ++answered;
      }
    });
  clients.clear();
  EXPECT_EQ(answered, 100);
}

TEST(PageServer, NamesAddressesOfIpv6InBrackets) {
  try {
    const PageServer server({"2001:db8::1", 80}, echo);  // no machine has this one
    FAIL() << server.url();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).find("[2001:db8::1]:80: cannot"), 0U) << error.what();
  }
}

TEST(PageServer, RefusesAPortThatIsTakenAndLeavesItsOwn) {
  int port = 0;
  {
    const PageServer first({}, echo);
    port = port_of(first);
    try {
      const PageServer second({"127.0.0.1", port}, echo);
      FAIL() << "two servers listen on one port";
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ErrorCode::output);
      EXPECT_NE(std::string(error.what()).find("cannot be listened on"), std::string::npos) << error.what();
    }
  }
  EXPECT_FALSE(Socket(port).connected());
  const PageServer again({"127.0.0.1", port}, echo);
  EXPECT_EQ(port_of(again), port);
}

}  // namespace
}  // namespace abbe
