// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "message.h"

#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <system_error>
#include <utility>

#include "../json_text.h"
#include "lanthorn/error.h"
#include "plain_json.h"

namespace lanthorn::program {

namespace {

static_assert(std::endian::native == std::endian::little, "the protocol's numbers are little-endian");

constexpr std::array<char, 4> magic{'L', 'N', 'T', 'H'};
constexpr std::uint32_t most_json_bytes = 1U << 28;
constexpr std::uint64_t most_data_bytes = std::uint64_t{1} << 36;
constexpr std::size_t chunk_bytes = std::size_t{1} << 24;  // limits what a header with a false size can allocate

struct Header {
  std::array<char, 4> magic{};
  std::uint32_t json_bytes = 0;
  std::uint64_t data_bytes = 0;
};
static_assert(sizeof(Header) == 16);

// Returns fewer bytes than requested only at the end of the stream.
std::size_t read_some(int file, std::byte* out, std::size_t count) {
  std::size_t done = 0;
  while (done < count) {
    const ssize_t got = ::read(file, out + done, count - done);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw Error("cannot read the client's messages: " + std::generic_category().message(errno));
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
  }
  return done;
}

std::vector<std::byte> read_bytes(int file, std::uint64_t count) {
  std::vector<std::byte> bytes;
  while (bytes.size() < count) {
    const std::size_t begin = bytes.size();
    const std::size_t part = static_cast<std::size_t>(std::min<std::uint64_t>(chunk_bytes, count - begin));
    bytes.resize(begin + part);
    if (read_some(file, bytes.data() + begin, part) < part) throw Error("the client's last message is truncated");
  }
  return bytes;
}

void check(const Header& header) {
  if (header.magic != magic)
    throw Error("expected a message of lanthorn's protocol, which begins with the bytes LNTH (see docs/protocol.md)");
  if (header.json_bytes > most_json_bytes || header.data_bytes > most_data_bytes)
    throw Error("expected a message of at most " + std::to_string(most_json_bytes) + " bytes of JSON and " +
                std::to_string(most_data_bytes) + " bytes of arrays");
}

bool has_unread_bytes(int file) {
  int count = 0;
  return ::ioctl(file, FIONREAD, &count) == 0 && count > 0;
}

void write_all(int file, const void* bytes, std::size_t count) {
  const auto* next = static_cast<const char*>(bytes);
  while (count > 0) {
    const ssize_t written = ::write(file, next, count);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw Error("cannot write to the client: " + std::generic_category().message(errno));
    next += written;
    count -= static_cast<std::size_t>(written);
  }
}

}  // namespace

std::optional<LinkRequest> read_request(int file) {
  Header header;
  const std::size_t got = read_some(file, reinterpret_cast<std::byte*>(&header), sizeof(header));
  if (got == 0) return std::nullopt;
  if (got < sizeof(header)) throw Error("the client's last message is truncated");
  check(header);
  const std::vector<std::byte> json = read_bytes(file, header.json_bytes);
  const auto data = std::make_shared<const std::vector<std::byte>>(read_bytes(file, header.data_bytes));
  try {
    return LinkRequest{dict_of_json({reinterpret_cast<const char*>(json.data()), json.size()}, data), {}};
  } catch (const Error& e) {
    return LinkRequest{{}, e.what()};
  }
}

void write_answer(int file, const nlohmann::json& body, std::span<const float> numbers) {
  const std::string json = json_text(body, one_line);
  const Header header{magic, static_cast<std::uint32_t>(json.size()), numbers.size_bytes()};
  write_all(file, &header, sizeof(header));
  write_all(file, json.data(), json.size());
  write_all(file, numbers.data(), numbers.size_bytes());
}

void wait_for_end_of_client(int input, int output, std::chrono::milliseconds patience) {
  std::array<pollfd, 2> ends{
      {{.fd = output, .events = 0, .revents = 0}, {.fd = input, .events = POLLRDHUP, .revents = 0}}};
  while (::poll(ends.data(), ends.size(), -1) <= 0) {
  }
  constexpr int step = 100;  // milliseconds
  std::chrono::milliseconds waited{0};
  while (ends[0].revents == 0 && waited < patience) {
    ::poll(ends.data(), 1, step);
    waited = has_unread_bytes(input) ? std::chrono::milliseconds(0) : waited + std::chrono::milliseconds(step);
  }
}

}  // namespace lanthorn::program
