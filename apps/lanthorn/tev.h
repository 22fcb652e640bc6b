// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Sends pictures to the viewer tev (https://github.com/Tom94/tev) by its network protocol: over TCP, packets that
// consist of their length (32 bits, including itself), an operation (8 bits) and its arguments. Numbers are
// little-endian, strings end with a zero byte.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "lanthorn/image.h"
#include "socket.h"

namespace lanthorn::program {

/// CreateImage: a black picture with the image's channels; replaces a picture of the same name.
std::string tev_create_image(const std::string& name, const Image& image);
/// UpdateImage (version 3, interleaved channels): the pixels of the rows [first, first + count).
std::string tev_update_rows(const std::string& name, const Image& image, int first, int count);

struct HostPort {
  std::string host;
  std::uint16_t port = 0;
};
/// "host:port", "[::1]:port", or "host" for tev's own port, 14158. Throws Error, naming `option`.
HostPort parse_host_port(const std::string& text, const std::string& option);

/// Sends pictures on its own thread, so that a slow viewer delays nothing. Failures only cause a warning.
class TevLink {
 public:
  /// `name`: of the picture in the viewer.
  TevLink(HostPort viewer, std::string name);
  /// Sends the last picture, for at most five seconds.
  ~TevLink();
  TevLink(const TevLink&) = delete;
  TevLink& operator=(const TevLink&) = delete;

  /// True if the viewer has received the last picture at least half a second ago and is still connected: time to send
  /// another one.
  bool is_ready() const;
  /// Sends the picture, replacing one that is still waiting to be sent.
  void show(Image image);

 private:
  void work();
  bool send(const Image& image);

  HostPort viewer_;
  std::string name_;
  std::optional<Connection> connection_;  // used by the thread only
  std::vector<std::string> channels_;     // of the picture that the viewer has
  Event stop_;
  mutable std::mutex mutex_;  // guards all members below
  std::condition_variable changed_;
  std::optional<Image> next_;
  std::chrono::steady_clock::time_point next_time_{};
  bool is_busy_ = false, has_failed_ = false, is_ending_ = false;
  std::jthread thread_;
};

}  // namespace lanthorn::program
