#include "preview/tev_packets.h"

#include <bit>
#include <cstdint>
#include <cstring>
#include <utility>

namespace abbe {
namespace {

enum class PacketKind : std::uint8_t { update_image = 3, create_image = 4 };

class Packet {
 public:
  Packet(PacketKind kind, bool in_front) {
    add(std::int32_t{0});  // placeholder for the length
    bytes_ += static_cast<char>(kind);
    bytes_ += in_front ? '\1' : '\0';
  }
  void add(const std::string& text) { bytes_.append(text.c_str(), text.size() + 1); }
  void add(std::int32_t number) { add_bytes(&number, sizeof(number)); }
  void add(std::span<const float> values) { add_bytes(values.data(), values.size_bytes()); }

  [[nodiscard]] std::string finished() && {
    const auto length = static_cast<std::int32_t>(bytes_.size());
    std::memcpy(bytes_.data(), &length, sizeof(length));
    return std::move(bytes_);
  }

 private:
  void add_bytes(const void* from, std::size_t size) {
    static_assert(std::endian::native == std::endian::little);
    bytes_.append(static_cast<const char*>(from), size);
  }

  std::string bytes_;
};

}  // namespace

std::string tev_create_image(const std::string& image, int width, int height,
                             const std::vector<std::string>& channels) {
  Packet packet(PacketKind::create_image, true);
  packet.add(image);
  packet.add(width);
  packet.add(height);
  packet.add(static_cast<std::int32_t>(channels.size()));
  for (const std::string& channel : channels) packet.add(channel);
  return std::move(packet).finished();
}

std::string tev_update_rows(const std::string& image, const std::string& channel, int width, int y,
                            std::span<const float> values) {
  Packet packet(PacketKind::update_image, false);
  packet.add(image);
  packet.add(channel);
  packet.add(0);
  packet.add(y);
  packet.add(width);
  packet.add(static_cast<std::int32_t>(values.size() / static_cast<std::size_t>(width)));
  packet.add(values);
  return std::move(packet).finished();
}

}  // namespace abbe
