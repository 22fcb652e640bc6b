// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// An HTTP/1.1 server whose memory, threads and waiting times are bounded whatever its clients do.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "../socket.h"
#include "http_message.h"
#include "reception.h"

namespace lanthorn::program {

/// True if the client has disconnected or the server stops: a handler that waits should return.
using IsGone = std::function<bool()>;
/// Answers a request; many threads may call it at a time. An exception becomes an answer with status 500, or 503 if
/// memory ran out.
using HttpHandler = std::function<HttpResponse(const HttpRequest&, const IsGone&)>;

/// Clients wait in a `Reception`; a fixed number of threads answer requests, each one at a time. A client must receive
/// an answer at 128 KiB per second or faster after the first 10 seconds. All answers in transit together are limited to
/// 256 MiB: beyond that, clients are told to retry (503), unless there is only one answer.
class HttpServer {
 public:
  static constexpr unsigned threads = 64;

  /// Starts to listen and answer. Throws Error if the address is not available.
  HttpServer(const std::string& address, std::uint16_t port, HttpHandler handler);
  /// Closes all connections.
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  std::uint16_t port() const { return reception_.port(); }

 private:
  void work();
  bool answer(const Reception::Visit& visit);
  bool send(const Connection& connection, HttpResponse response, bool close);
  HttpResponse handle(const Connection& connection, const HttpRequest& request) const;

  HttpHandler handler_;
  Reception reception_;
  std::atomic<std::size_t> bytes_in_flight_{0};
  std::vector<std::jthread> workers_;
};

}  // namespace lanthorn::program
