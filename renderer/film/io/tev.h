#pragma once
// Sends pictures to a running tev (https://github.com/Tom94/tev), or to another viewer with its protocol:
// TCP, by default on 127.0.0.1:14158; packets of a uint32 length, which includes itself, a byte for the type
// and the content. Numbers are little-endian, texts end with a zero, truth values take a byte.
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "film/io/image_file.h"

namespace lucerna::film {

enum class TevPacket : uint8_t { reload = 1, create = 4, update = 6, open = 7 };

/// Opens a file, as seen from the viewer's folder. Type OpenImageV2.
std::string tev_open(const std::string& file, bool grab_focus);
/// Reads an open image again.
std::string tev_reload(const std::string& name, bool grab_focus);
/// Makes an empty image, in place of one with this name. `channels`: "R", "primary.R"; what is before the dot
/// is the layer.
std::string tev_create(const std::string& name, uint32_t width, uint32_t height,
                       std::span<const std::string> channels, bool grab_focus);
/// Rows of a channel, from row `y` on; `values` are width * rows. Type UpdateImageV3.
std::string tev_update(const std::string& name, const std::string& channel, uint32_t y, uint32_t width,
                       std::span<const float> values);

struct TevAddress {
  std::string host = "127.0.0.1";  ///< IPv4 in digits
  uint16_t port = 14158;
  std::string text() const;  ///< HOST:PORT
};
/// "HOST:PORT", "HOST" or ":PORT"; "localhost" is a host. "": the default. Throws Error located at `where`.
TevAddress parse_tev_address(const std::string& text, const std::string& where);

/// A connection to a viewer, on a separate thread: only finish() waits for it. It connects with
/// the first picture. If the viewer is missing, hangs up or stops reading, it ends with a problem, and
/// ignores further pictures. All methods are for one thread.
class TevSender {
 public:
  /// `name`: of the image in the viewer. `stall`: seconds without progress after which a viewer that does
  /// not read is given up. `report`: gets the problem on the sender's thread, in place of take_problem().
  TevSender(TevAddress address, std::string name, double stall = 5,
            std::function<void(const std::string&)> report = {});
  /// Stops at once; a picture that is being sent stays incomplete.
  ~TevSender();
  TevSender(const TevSender&) = delete;
  TevSender& operator=(const TevSender&) = delete;

  /// Sends all channels of a picture. One that has not been begun is replaced.
  void send(FilmImage image);
  /// Opens a file in the viewer, as it is named there; a file that this sender has opened is read again.
  void open(const std::string& file);
  /// True while a picture or a file waits or is being sent.
  bool busy() const;
  /// The problem that ended the connection, located at the address; "" if there is none, and after the
  /// first call.
  std::string take_problem();
  bool ended() const;
  /// Waits until all is sent. False if it has ended with a problem.
  bool finish();

 private:
  void run();
  void transmit(const FilmImage& image);
  void transmit(const std::string& file);
  void write(const std::string& bytes);
  void connect();
  bool quits() const;

  const TevAddress address_;
  const std::string name_;
  const double stall_;
  const std::function<void(const std::string&)> report_;
  mutable std::mutex mutex_;
  std::condition_variable wake_, idle_;
  std::optional<FilmImage> next_;
  std::vector<std::string> files_;  ///< to be opened
  bool sending_ = false, quit_ = false, ended_ = false;
  std::string problem_;
  // Used by the thread only.
  int socket_ = -1;
  uint32_t width_ = 0, height_ = 0;  ///< of the viewer's image
  std::vector<std::string> channels_;
  std::set<std::string> opened_;
  std::thread thread_;
};

}  // namespace lucerna::film
