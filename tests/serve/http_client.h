// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// An HTTP client that sends exactly what a test specifies, valid or not.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>

#include "socket.h"

namespace lanthorn::test {

using namespace std::chrono_literals;

struct Answer {
  int status = 0;  ///< 0: no answer
  std::string head, body;
};

class HttpClient {
 public:
  explicit HttpClient(std::uint16_t port, const std::string& address = "127.0.0.1")
      : connection_(program::connect_to(address, port, std::chrono::steady_clock::now() + 5s), nullptr) {}

  bool send(const std::string& text) const {
    return connection_.write_all(text, std::chrono::steady_clock::now() + 5s);
  }
  /// The next answer, by its Content-Length.
  Answer receive(std::chrono::milliseconds patience = 20s) {
    const program::Deadline deadline = std::chrono::steady_clock::now() + patience;
    std::size_t end = 0;
    while ((end = bytes_.find("\r\n\r\n")) == std::string::npos)
      if (!connection_.read_some(bytes_, 1 << 16, deadline)) return {};
    Answer answer{0, bytes_.substr(0, end + 4), {}};
    bytes_.erase(0, end + 4);
    answer.status = std::stoi(answer.head.substr(9, 3));
    const std::size_t at = answer.head.find("Content-Length: ");
    const std::size_t size = at == std::string::npos ? 0 : std::stoul(answer.head.substr(at + 16));
    while (bytes_.size() < size)
      if (!connection_.read_some(bytes_, 1 << 16, deadline)) return {};
    answer.body = bytes_.substr(0, size);
    bytes_.erase(0, size);
    return answer;
  }
  Answer ask(const std::string& text) { return send(text) ? receive() : Answer{}; }
  Answer get(const std::string& path) { return ask("GET " + path + " HTTP/1.1\r\nHost: localhost\r\n\r\n"); }
  Answer post(const std::string& path, const std::string& body, const std::string& origin = "http://localhost") {
    return ask("POST " + path + " HTTP/1.1\r\nHost: localhost\r\nOrigin: " + origin +
               "\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body);
  }
  bool is_closed() const { return connection_.is_gone(); }

 private:
  program::Connection connection_;
  std::string bytes_;
};

}  // namespace lanthorn::test
