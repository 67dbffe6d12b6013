#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "preview/page_server.h"

namespace abbe::test {

/// Reads the contents of a tev packet from the front.
class PacketReader {
 public:
  explicit PacketReader(std::string bytes) : bytes_(std::move(bytes)) {}
  template <typename T>
  T number() {
    T value{};
    std::memcpy(&value, bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return value;
  }
  std::string text() {
    const std::string text = bytes_.c_str() + at_;
    at_ += text.size() + 1;
    return text;
  }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
};

/// Receives the packets of one connection like tev, and closes it after a number of packets.
class TevListener {
 public:
  explicit TevListener(int packets = 1 << 30) : most_(packets), listener_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    EXPECT_EQ(::bind(listener_, reinterpret_cast<sockaddr*>(&address), size), 0);
    EXPECT_EQ(::listen(listener_, 1), 0);
    EXPECT_EQ(::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size), 0);
    port_ = ntohs(address.sin_port);
    thread_ = std::jthread([this] { receive(); });
  }
  [[nodiscard]] ServerAddress address() const { return {"127.0.0.1", port_}; }
  void wait() { thread_.join(); }

  std::string name;
  int width = 0, height = 0;
  std::map<std::string, std::vector<float>> channels;
  int updates = 0;

 private:
  void receive() {
    const int connection = ::accept(listener_, nullptr, nullptr);
    ::close(listener_);
    for (int i = 0; i < most_; ++i) {
      std::int32_t length = 0;
      if (::recv(connection, &length, 4, MSG_WAITALL) != 4) break;
      std::string rest(static_cast<std::size_t>(length) - 4, ' ');
      if (::recv(connection, rest.data(), rest.size(), MSG_WAITALL) != static_cast<ssize_t>(rest.size()))
        break;
      take(PacketReader(rest));
    }
    ::close(connection);
  }
  void take(PacketReader packet) {
    const auto kind = packet.number<std::uint8_t>();
    const bool in_front = packet.number<std::uint8_t>() != 0;
    EXPECT_EQ(in_front, kind == 4);
    const std::string image = packet.text();
    if (kind == 4) {
      name = image;
      width = packet.number<std::int32_t>();
      height = packet.number<std::int32_t>();
      const auto count = packet.number<std::int32_t>();
      for (int i = 0; i < count; ++i)
        channels[packet.text()].resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    } else {
      EXPECT_EQ(kind, 3);
      EXPECT_EQ(image, name);
      std::vector<float>& values = channels.at(packet.text());
      const auto x = packet.number<std::int32_t>();
      const auto y = packet.number<std::int32_t>();
      const auto across = packet.number<std::int32_t>();
      const auto down = packet.number<std::int32_t>();
      ASSERT_EQ(packet.left(), sizeof(float) * static_cast<std::size_t>(across * down));
      for (int j = y; j < y + down; ++j)
        for (int i = x; i < x + across; ++i)
          values.at(static_cast<std::size_t>(j * width + i)) = packet.number<float>();
      ++updates;
    }
    EXPECT_EQ(packet.left(), 0U);
  }

  int most_;
  int listener_;
  int port_ = 0;
  std::jthread thread_;
};

}  // namespace abbe::test
