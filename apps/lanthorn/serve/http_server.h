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

namespace lanthorn::program {

/// True if whoever asked has gone, or the server stops: a handler that waits should end.
using IsGone = std::function<bool()>;
/// Answers a request; called by many threads at a time. What it throws becomes an answer with status 500, or 503 if
/// memory ran out.
using HttpHandler = std::function<HttpResponse(const HttpRequest&, const IsGone&)>;

/// Threads, each with one connection at a time; further connections wait in the system's queue of 64. A request head
/// must be there within 5 seconds of its connection, a body within 5 more; answers must be taken at 128 KiB a second
/// after the first 10. All answers that are being sent together have 256 MiB at most: beyond, clients are told to come
/// again (503), unless there is but one.
class HttpServer {
 public:
  static constexpr unsigned most_connections = 64;

  /// Listens and answers from now on. Throws Error if the address is not to be had.
  HttpServer(const std::string& address, std::uint16_t port, HttpHandler handler);
  /// Ends all connections.
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  std::uint16_t port() const { return port_of(listener_); }

 private:
  void work();
  void converse(Connection connection);
  bool answer(const Connection& connection, const HttpRequest& request);
  bool send(const Connection& connection, HttpResponse response, bool close);
  HttpResponse handle(const Connection& connection, const HttpRequest& request) const;
  bool is_crowded() const { return busy_ > most_connections / 2; }

  HttpHandler handler_;
  FileDescriptor listener_;
  StopEvent stop_;
  std::atomic<bool> stopped_{false};
  std::atomic<unsigned> busy_{0};
  std::atomic<std::size_t> bytes_in_flight_{0};
  std::vector<std::jthread> workers_;
};

}  // namespace lanthorn::program
