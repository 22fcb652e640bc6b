// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "tev.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstddef>
#include <exception>
#include <type_traits>
#include <utility>

#include "console.h"
#include "lanthorn/error.h"
#include "value_types.h"

namespace lanthorn::program {

namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr std::uint16_t tev_port = 14158;
constexpr std::chrono::milliseconds connect_patience = 3s, send_patience = 10s, last_patience = 5s,
                                    picture_interval = 500ms;
constexpr std::size_t packet_bytes = std::size_t{4} << 20;  // approximate size of the pixels in a packet

enum class Operation : std::uint8_t { create_image = 4, update_image_3 = 6 };

class Packet {
 public:
  explicit Packet(Operation operation) {
    add(std::uint32_t{0});  // the length, filled in at the end
    add(static_cast<std::uint8_t>(operation));
  }
  template <class Number>
  void add(Number number) requires(std::is_arithmetic_v<Number>) {
    using Bits = std::conditional_t<sizeof(Number) == 8, std::uint64_t, std::uint32_t>;
    Bits bits = 0;
    if constexpr (std::is_floating_point_v<Number>)
      bits = std::bit_cast<Bits>(number);
    else
      bits = static_cast<Bits>(number);
    for (std::size_t i = 0; i < sizeof(Number); ++i) bytes_.push_back(static_cast<char>(bits >> (8 * i) & 0xff));
  }
  void add(const std::string& text) { bytes_.append(text.c_str(), std::min(text.size(), text.find('\0')) + 1); }

  std::string finished() && {
    for (std::size_t i = 0; i < 4; ++i) bytes_[i] = static_cast<char>(bytes_.size() >> (8 * i) & 0xff);
    return std::move(bytes_);
  }
  void reserve(std::size_t more) { bytes_.reserve(bytes_.size() + more); }

 private:
  std::string bytes_;
};

constexpr std::uint8_t keep_focus = 0;

}  // namespace

std::string tev_create_image(const std::string& name, const Image& image) {
  Packet packet(Operation::create_image);
  packet.add(keep_focus);
  packet.add(name);
  packet.add(static_cast<std::int32_t>(image.width));
  packet.add(static_cast<std::int32_t>(image.height));
  packet.add(static_cast<std::int32_t>(image.channel_count()));
  for (const std::string& channel : image.channels) packet.add(channel);
  return std::move(packet).finished();
}

std::string tev_update_rows(const std::string& name, const Image& image, int first, int count) {
  Packet packet(Operation::update_image_3);
  packet.add(keep_focus);
  packet.add(name);
  packet.add(static_cast<std::int32_t>(image.channel_count()));
  for (const std::string& channel : image.channels) packet.add(channel);
  for (const int number : {0, first, image.width, count}) packet.add(static_cast<std::int32_t>(number));
  const auto channels = static_cast<std::int64_t>(image.channel_count());
  for (std::int64_t offset = 0; offset < channels; ++offset) packet.add(offset);
  for (std::int64_t i = 0; i < channels; ++i) packet.add(channels);  // strides
  const std::size_t begin = image.index(0, first), end = image.index(0, first + count);
  packet.reserve(sizeof(float) * (end - begin));
  for (std::size_t i = begin; i < end; ++i) packet.add(image.pixels[i]);
  return std::move(packet).finished();
}

HostPort parse_host_port(const std::string& text, const std::string& option) {
  HostPort result{text, tev_port};
  const std::size_t colon = text.rfind(':');
  if (colon != std::string::npos && text.find(']', colon) == std::string::npos) {
    const auto port = parse_count(text.substr(colon + 1));
    result.host = port && *port >= 1 && *port <= 65535 ? text.substr(0, colon) : std::string();
    result.port = static_cast<std::uint16_t>(port.value_or(0));
  }
  if (result.host.starts_with('[') && result.host.ends_with(']'))
    result.host = result.host.substr(1, result.host.size() - 2);
  if (result.host.empty())
    throw Error(fmt::format("{} {}: expected HOST:PORT, e.g. localhost:{}", option, text, tev_port));
  return result;
}

TevLink::TevLink(HostPort viewer, std::string name)
    : viewer_(std::move(viewer)), name_(std::move(name)), thread_([this] { work(); }) {}

TevLink::~TevLink() {
  std::unique_lock lock(mutex_);
  is_ending_ = true;
  changed_.notify_all();
  changed_.wait_for(lock, last_patience, [&] { return has_failed_ || (!next_ && !is_busy_); });
  stop_.set();
}

bool TevLink::is_ready() const {
  const std::lock_guard lock(mutex_);
  return !has_failed_ && !next_ && !is_busy_ && Clock::now() >= next_time_;
}

void TevLink::show(Image image) {
  const std::lock_guard lock(mutex_);
  if (has_failed_) return;
  next_ = std::move(image);
  next_time_ = Clock::now() + picture_interval;
  changed_.notify_all();
}

void TevLink::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return next_ || is_ending_; });
    if (!next_) return;
    const Image image = std::exchange(next_, {}).value();
    is_busy_ = true;
    lock.unlock();
    const bool is_sent = send(image);
    lock.lock();
    is_busy_ = false;
    has_failed_ = !is_sent;
    changed_.notify_all();
    if (has_failed_) return;
  }
}

// Returns false, after a warning, if the viewer does not accept the picture.
bool TevLink::send(const Image& image) try {
  if (!connection_)
    connection_.emplace(connect_to(viewer_.host, viewer_.port, Clock::now() + connect_patience), &stop_);
  const auto write = [&](const std::string& packet) {
    if (!connection_->write_all(packet, Clock::now() + send_patience))
      throw Error(fmt::format("{} port {} has gone, or is too slow", viewer_.host, viewer_.port));
  };
  if (channels_ != image.channels) write(tev_create_image(name_, image));
  channels_ = image.channels;
  const std::size_t row_bytes = sizeof(float) * image.channel_count() * static_cast<std::size_t>(image.width);
  const int rows = static_cast<int>(std::clamp<std::size_t>(packet_bytes / std::max<std::size_t>(row_bytes, 1), 1,
                                                            static_cast<std::size_t>(std::max(image.height, 1))));
  for (int first = 0; first < image.height; first += rows)
    write(tev_update_rows(name_, image, first, std::min(rows, image.height - first)));
  return true;
} catch (const std::exception& problem) {  // the render matters more than its display
  warn("--tev: {}; the render continues without it", problem.what());
  return false;
}

}  // namespace lanthorn::program
