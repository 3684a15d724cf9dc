#pragma once
// A viewer with tev's protocol for tests: what it was sent, or how it misbehaves.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <cstdint>
#include <cstring>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace lucerna::test {

class TevReceiver {
 public:
  enum class Manner { reads, hangs_up, never_reads };

  struct Image {
    int32_t width = 0, height = 0;
    std::vector<std::string> channels;
    std::map<std::string, std::vector<float>> values;
    int updates = 0;
  };

  explicit TevReceiver(Manner manner = Manner::reads) : manner_(manner) {
    listener_ = socket(AF_INET, SOCK_STREAM, 0);
    REQUIRE(listener_ >= 0);
    // Small, so that a viewer that does not read is soon noticed.
    const int small = 4096;
    setsockopt(listener_, SOL_SOCKET, SO_RCVBUF, &small, sizeof small);
    sockaddr_in at{};
    at.sin_family = AF_INET, at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    REQUIRE(bind(listener_, reinterpret_cast<sockaddr*>(&at), sizeof at) == 0);
    REQUIRE(listen(listener_, 4) == 0);
    socklen_t size = sizeof at;
    REQUIRE(getsockname(listener_, reinterpret_cast<sockaddr*>(&at), &size) == 0);
    port_ = ntohs(at.sin_port);
    thread_ = std::thread([this] { run(); });
  }
  ~TevReceiver() {
    quit_ = true;
    shutdown(listener_, SHUT_RDWR);
    if (const int open = client_; open >= 0) shutdown(open, SHUT_RDWR);
    thread_.join();
    close(listener_);
    if (client_ >= 0) close(client_);
  }

  uint16_t port() const { return port_; }
  std::string address() const { return "127.0.0.1:" + std::to_string(port_); }
  std::map<std::string, Image> images() const {
    std::lock_guard lock(mutex_);
    return images_;
  }
  /// Packets that are not as the protocol has them.
  std::string problem() const {
    std::lock_guard lock(mutex_);
    return problem_;
  }
  size_t bytes() const { return bytes_; }
  int connections() const { return connections_; }

  /// Reads one packet into `images`. Returns what is wrong with it, or "".
  static std::string read(const std::string& packet, std::map<std::string, Image>& images) {
    size_t at = 4;
    bool good = true;
    const auto take = [&](auto& value) {
      if (at + sizeof value > packet.size()) return void(good = false);
      std::memcpy(&value, packet.data() + at, sizeof value), at += sizeof value;
    };
    const auto text = [&] {
      const size_t end = packet.find('\0', at);
      if (end == std::string::npos) return good = false, std::string();
      std::string value = packet.substr(at, end - at);
      at = end + 1;
      return value;
    };
    uint8_t type = 0, focus = 0;
    take(type), take(focus);
    const std::string name = text();
    if (type == 7 || type == 1) {
      if (type == 7 && !text().empty()) return "open selects a channel";
      if (!good || at != packet.size()) return "open has a wrong length";
      ++images[(type == 7 ? "open " : "reload ") + name].updates;
      return "";
    }
    if (type == 4) {
      Image image;
      int32_t count = 0;
      take(image.width), take(image.height), take(count);
      for (int32_t c = 0; c < count && good; ++c) image.channels.push_back(text());
      for (const std::string& c : image.channels)
        image.values[c].assign(size_t(image.width) * size_t(image.height), -1);
      if (!good || at != packet.size()) return "create has a wrong length";
      images[name] = image;
      return "";
    }
    if (type != 6) return "unknown type " + std::to_string(type);
    int32_t count = 0, x = 0, y = 0, width = 0, height = 0;
    int64_t offset = -1, stride = -1;
    take(count);
    const std::string channel = text();
    take(x), take(y), take(width), take(height), take(offset), take(stride);
    if (!good || count != 1 || offset != 0 || stride != 1) return "update is not of one channel";
    if (!images.contains(name) || !images[name].values.contains(channel)) return "update of nothing";
    Image& image = images[name];
    if (x != 0 || width != image.width || y < 0 || y + height > image.height) return "update is outside";
    const size_t bytes = size_t(width) * size_t(height) * 4;
    if (packet.size() - at != bytes) return "update has a wrong length";
    std::memcpy(image.values[channel].data() + size_t(y) * size_t(width), packet.data() + at, bytes);
    ++image.updates;
    return "";
  }

 private:
  bool receive(char* to, size_t size) {
    for (size_t at = 0; at < size;) {
      const ssize_t n = recv(client_, to + at, size - at, 0);
      if (n <= 0) return false;
      at += size_t(n), bytes_ += size_t(n);
    }
    return true;
  }
  void run() {
    while (!quit_) {
      const int client = accept(listener_, nullptr, nullptr);
      if (client < 0) return;
      client_ = client, ++connections_;
      if (manner_ == Manner::never_reads) return;
      for (int packets = 0; !quit_; ++packets) {
        std::string packet(4, '\0');
        uint32_t size = 0;
        if (!receive(packet.data(), 4)) break;
        std::memcpy(&size, packet.data(), 4);
        if (size < 5 || size > 1u << 28) {
          std::lock_guard lock(mutex_);
          problem_ = "length " + std::to_string(size);
          break;
        }
        packet.resize(size);
        // In the middle of a packet.
        if (manner_ == Manner::hangs_up && packets == 2) break;
        if (!receive(packet.data() + 4, size - 4)) break;
        std::lock_guard lock(mutex_);
        if (const std::string wrong = read(packet, images_); !wrong.empty()) problem_ = wrong;
      }
      close(client_);
      client_ = -1;
    }
  }

  const Manner manner_;
  int listener_ = -1;
  uint16_t port_ = 0;
  std::atomic<int> client_{-1}, connections_{0};
  std::atomic<bool> quit_{false};
  std::atomic<size_t> bytes_{0};
  mutable std::mutex mutex_;
  std::map<std::string, Image> images_;
  std::string problem_;
  std::thread thread_;
};

}  // namespace lucerna::test
