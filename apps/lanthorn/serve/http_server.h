// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A server of HTTP/1.1 whose memory, threads and patience are bounded whatever its clients do.
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

/// True if whoever asked has gone, or the server stops: a handler that waits should end.
using IsGone = std::function<bool()>;
/// Answers a request; called by many threads at a time. What it throws becomes an answer with status 500, or 503 if
/// memory ran out.
using HttpHandler = std::function<HttpResponse(const HttpRequest&, const IsGone&)>;

/// Clients wait in a `Reception`; a number of threads answer requests, each one at a time. Answers must be taken at
/// 128 KiB a second after the first 10 seconds. All answers that are being sent together have 256 MiB at most: beyond,
/// clients are told to come again (503), unless there is but one.
class HttpServer {
 public:
  static constexpr unsigned threads = 64;

  /// Listens and answers from now on. Throws Error if the address is not to be had.
  HttpServer(const std::string& address, std::uint16_t port, HttpHandler handler);
  /// Ends all connections.
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
