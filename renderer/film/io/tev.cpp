#include "film/io/tev.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <system_error>
#include <utility>

#include "base/timer.h"

namespace lucerna::film {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr double k_connect_seconds = 2;
constexpr int k_poll_ms = 50;                // between looks at quit_
constexpr size_t k_packet_values = 1 << 20;  // of an update

class Packet {
 public:
  explicit Packet(TevPacket type) : bytes_(4, '\0') { bytes_ += char(type); }
  template <class T>
  Packet& number(T value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    return *this;
  }
  Packet& truth(bool value) { return number(char(value ? 1 : 0)); }
  /// A zero in it would end it.
  Packet& text(const std::string& value) {
    bytes_.append(value.c_str());
    bytes_ += '\0';
    return *this;
  }
  Packet& values(std::span<const float> v) {
    bytes_.append(reinterpret_cast<const char*>(v.data()), v.size_bytes());
    return *this;
  }
  std::string take() {
    const auto size = static_cast<uint32_t>(bytes_.size());
    std::memcpy(bytes_.data(), &size, sizeof size);
    return std::move(bytes_);
  }

 private:
  std::string bytes_;
};

std::string reason(int code) { return std::generic_category().message(code); }

/// Thrown when the sender is destroyed.
struct Quit {};

}  // namespace

std::string tev_open(const std::string& file, bool grab_focus) {
  return Packet(TevPacket::open).truth(grab_focus).text(file).text("").take();
}

std::string tev_reload(const std::string& name, bool grab_focus) {
  return Packet(TevPacket::reload).truth(grab_focus).text(name).take();
}

std::string tev_create(const std::string& name, uint32_t width, uint32_t height,
                       std::span<const std::string> channels, bool grab_focus) {
  Packet p(TevPacket::create);
  p.truth(grab_focus).text(name).number(int32_t(width)).number(int32_t(height));
  p.number(int32_t(channels.size()));
  for (const std::string& channel : channels) p.text(channel);
  return p.take();
}

std::string tev_update(const std::string& name, const std::string& channel, uint32_t y, uint32_t width,
                       std::span<const float> values) {
  Packet p(TevPacket::update);
  p.truth(false).text(name).number(int32_t(1)).text(channel);
  p.number(int32_t(0)).number(int32_t(y)).number(int32_t(width)).number(int32_t(values.size() / width));
  p.number(int64_t(0)).number(int64_t(1));  // offset and stride of the channel
  return p.values(values).take();
}

std::string TevAddress::text() const { return fmt::format("{}:{}", host, port); }

TevAddress parse_tev_address(const std::string& text, const std::string& where) {
  TevAddress address;
  const size_t colon = text.find(':');
  const std::string host = text.substr(0, colon);
  if (!host.empty() && host != "localhost") address.host = host;
  in_addr number{};
  bool good = inet_pton(AF_INET, address.host.c_str(), &number) == 1;
  if (colon != std::string::npos) {
    const char *first = text.data() + colon + 1, *last = text.data() + text.size();
    const auto [end, error] = std::from_chars(first, last, address.port);
    good = good && error == std::errc() && end == last && address.port > 0;
  }
  if (!good)
    throw_error(where, "'{}': expected HOST:PORT with a host in digits, such as {}", text,
                TevAddress().text());
  return address;
}

TevSender::TevSender(TevAddress address, std::string name, double stall,
                     std::function<void(const std::string&)> report)
    : address_(std::move(address)),
      name_(std::move(name)),
      stall_(stall),
      report_(std::move(report)),
      thread_([this] { run(); }) {}

TevSender::~TevSender() {
  {
    std::lock_guard lock(mutex_);
    quit_ = true;
  }
  wake_.notify_one();
  thread_.join();
  if (socket_ >= 0) close(socket_);
}

void TevSender::send(FilmImage image) {
  {
    std::lock_guard lock(mutex_);
    if (ended_) return;
    next_ = std::move(image);
  }
  wake_.notify_one();
}

void TevSender::open(const std::string& file) {
  {
    std::lock_guard lock(mutex_);
    if (ended_) return;
    files_.push_back(file);
  }
  wake_.notify_one();
}

bool TevSender::busy() const {
  std::lock_guard lock(mutex_);
  return !ended_ && (next_ || !files_.empty() || sending_);
}

bool TevSender::ended() const {
  std::lock_guard lock(mutex_);
  return ended_;
}

std::string TevSender::take_problem() {
  std::lock_guard lock(mutex_);
  return std::exchange(problem_, "");
}

bool TevSender::finish() {
  std::unique_lock lock(mutex_);
  idle_.wait(lock, [&] { return ended_ || !(next_ || !files_.empty() || sending_); });
  return !ended_;
}

bool TevSender::quits() const {
  std::lock_guard lock(mutex_);
  return quit_;
}

void TevSender::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    wake_.wait(lock, [&] { return quit_ || next_ || !files_.empty(); });
    if (quit_) return;
    const std::optional<FilmImage> image = std::exchange(next_, std::nullopt);
    const std::vector<std::string> files = std::exchange(files_, {});
    sending_ = true;
    lock.unlock();
    std::string problem;
    try {
      for (const std::string& file : files) transmit(file);
      if (image) transmit(*image);
    } catch (const Quit&) {
    } catch (const std::exception& e) {
      problem = e.what();
    }
    if (!problem.empty() && report_) report_(problem);
    lock.lock();
    sending_ = false;
    if (!problem.empty()) {
      if (!report_) problem_ = problem;
      ended_ = true;
      next_.reset(), files_.clear();
    }
    idle_.notify_all();
    if (ended_) return;
  }
}

void TevSender::connect() {
  socket_ = socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (socket_ < 0) throw_error(address_.text(), "no connection to a viewer: {}", reason(errno));
  sockaddr_in to{};
  to.sin_family = AF_INET, to.sin_port = htons(address_.port);
  inet_pton(AF_INET, address_.host.c_str(), &to.sin_addr);
  int code = ::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0 ? 0 : errno;
  const Timer since;
  while (code == EINPROGRESS) {
    if (quits()) throw Quit();
    pollfd p{socket_, POLLOUT, 0};
    const int ready = poll(&p, 1, k_poll_ms);
    socklen_t size = sizeof code;
    if (ready > 0) getsockopt(socket_, SOL_SOCKET, SO_ERROR, &code, &size);
    if (ready == 0 && since.seconds() > k_connect_seconds) code = ETIMEDOUT;
  }
  if (code != 0)
    throw_error(address_.text(), "no connection to a viewer: {}. Start tev first, or give its HOST:PORT",
                reason(code));
}

void TevSender::write(const std::string& bytes) {
  Timer since;
  for (size_t at = 0; at < bytes.size();) {
    if (quits()) throw Quit();
    const ssize_t sent = ::send(socket_, bytes.data() + at, bytes.size() - at, MSG_NOSIGNAL);
    if (sent > 0) {
      at += size_t(sent);
      since.restart();
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      pollfd p{socket_, POLLOUT, 0};
      poll(&p, 1, k_poll_ms);
      if (since.seconds() > stall_)
        throw_error(address_.text(), "the viewer has read nothing for {:g} s; nothing more is sent to it",
                    stall_);
    } else if (errno != EINTR) {
      throw_error(address_.text(), "the viewer has hung up ({}); nothing more is sent to it", reason(errno));
    }
  }
}

void TevSender::transmit(const std::string& file) {
  if (socket_ < 0) connect();
  write(opened_.insert(file).second ? tev_open(file, true) : tev_reload(file, true));
}

void TevSender::transmit(const FilmImage& image) {
  std::vector<std::string> channels;
  for (const auto& [channel, values] : image.channels) channels.push_back(channel);
  if (socket_ < 0) connect();
  if (width_ != image.width || height_ != image.height || channels_ != channels) {
    write(tev_create(name_, image.width, image.height, channels, channels_.empty()));
    width_ = image.width, height_ = image.height, channels_ = channels;
  }
  const uint32_t rows = uint32_t(std::clamp<size_t>(k_packet_values / image.width, 1, image.height));
  for (const auto& [channel, values] : image.channels)
    for (uint32_t y = 0; y < image.height; y += rows) {
      const size_t count = size_t{image.width} * std::min(rows, image.height - y);
      write(tev_update(name_, channel, y, image.width, {values.data() + size_t{y} * image.width, count}));
    }
}

}  // namespace lucerna::film
