#include "preview/tev_viewer.h"

#include <netdb.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "io/error.h"
#include "results/rendered_film.h"

namespace abbe {
namespace {

constexpr double kMaxSendingFraction = 0.01;
constexpr double kMinPause_s = 0.2;
constexpr std::size_t kPacketFloats = std::size_t{1} << 18;
constexpr timeval kPatience{3, 0};

// A socket connected to the address, whose calls to send wait for at most `kPatience`.
int connected_socket(const ServerAddress& address) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  int socket = -1;
  if (::getaddrinfo(address.host.c_str(), std::to_string(address.port).c_str(), &hints, &found) == 0) {
    for (const addrinfo* at = found; at != nullptr && socket < 0; at = at->ai_next) {
      socket = ::socket(at->ai_family, at->ai_socktype | SOCK_CLOEXEC, at->ai_protocol);
      if (socket < 0) continue;
      (void)::setsockopt(socket, SOL_SOCKET, SO_SNDTIMEO, &kPatience, sizeof(kPatience));
      if (::connect(socket, at->ai_addr, at->ai_addrlen) == 0) continue;
      (void)::close(socket);
      socket = -1;
    }
    ::freeaddrinfo(found);
  }
  if (socket < 0) throw Error(ErrorCode::output, to_text(address), "no viewer listens there");
  return socket;
}

// TCP packets of the image viewer tev. A packet has its length in bytes (including the length), its kind, and
// the content. Integers have 32 bits; integers and floats are little-endian; strings end with a zero byte.
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

// Packet that creates an image of zeros called `image`, `width` x `height` pixels with these channels, and
// moves it to the front.
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

// Packet that replaces whole rows of a channel, beginning with row `y`, counted from 0 at the top. `width` is
// that of the image. `values` are row by row, a multiple of `width`.
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

}  // namespace

TevViewer::TevViewer(const Scene& scene, FilmIdentity identity, const ServerAddress& address, int threads,
                     std::function<void(const std::string&)> warn)
    : scene_(scene),
      identity_(std::move(identity)),
      image_(fmt::format("{} ({})", identity_.at("scene"), ::getpid())),
      threads_(threads),
      warn_(std::move(warn)),
      socket_(connected_socket(address)),
      sender_([this] { send_all(); }) {}

TevViewer::~TevViewer() {
  {
    const std::scoped_lock lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  sender_.join();
  (void)::close(socket_);
}

bool TevViewer::viewer_is_ready() {
  const std::scoped_lock lock(mutex_);
  if (busy_ || gone_) return false;
  const double pause = std::max(kMinPause_s, (cost_s_ + sending_s_) / threads_ / kMaxSendingFraction);
  return Clock::now() - last_snapshot_ > std::chrono::duration<double>(pause);
}

void TevViewer::show(const RenderResult& result) {
  const Clock::time_point begin = Clock::now();
  Image film = take_snapshot(scene_, identity_, result, threads_).film;
  last_snapshot_ = Clock::now();
  cost_s_ = std::chrono::duration<double>(last_snapshot_ - begin).count() * threads_;
  {
    const std::scoped_lock lock(mutex_);
    waiting_ = std::move(film);
    busy_ = true;
  }
  changed_.notify_all();
}

void TevViewer::end(const RenderResult& result) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return !busy_; });
  if (gone_) return;
  lock.unlock();
  show(result);
  lock.lock();
  changed_.wait(lock, [this] { return !busy_; });
}

void TevViewer::send_all() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return waiting_ || ending_; });
    if (!waiting_) return;
    Image film = *std::exchange(waiting_, std::nullopt);
    lock.unlock();
    const Clock::time_point begin = Clock::now();
    const bool sent = send_image(film_image(std::move(film)));
    if (!sent) warn_("the viewer closed the connection: the render continues without it");
    lock.lock();
    sending_s_ = std::chrono::duration<double>(Clock::now() - begin).count();
    busy_ = false;
    gone_ = !sent;
    changed_.notify_all();
    if (gone_) return;
  }
}

bool TevViewer::send_image(const Image& film) {
  if (!created_) {
    std::vector<std::string> channels;
    for (const ImageChannel& channel : film.channels) channels.push_back(channel.name);
    if (!send(tev_create_image(image_, film.width, film.height, channels))) return false;
    created_ = true;
  }
  const auto width = static_cast<std::size_t>(film.width);
  const std::size_t rows = std::max<std::size_t>(1, kPacketFloats / width);
  for (const ImageChannel& channel : film.channels)
    for (std::size_t y = 0; y < static_cast<std::size_t>(film.height); y += rows) {
      const std::size_t count = std::min(rows, static_cast<std::size_t>(film.height) - y);
      const auto values = std::span(channel.values).subspan(y * width, count * width);
      if (!send(tev_update_rows(image_, channel.name, film.width, static_cast<int>(y), values))) return false;
    }
  return true;
}

bool TevViewer::send(const std::string& packet) const {
  for (std::size_t sent = 0; sent < packet.size();) {
    const ssize_t more = ::send(socket_, packet.data() + sent, packet.size() - sent, MSG_NOSIGNAL);
    if (more <= 0) return false;
    sent += static_cast<std::size_t>(more);
  }
  return true;
}

}  // namespace abbe
