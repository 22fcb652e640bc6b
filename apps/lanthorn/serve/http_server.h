// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// An HTTP/1.1 server whose memory, threads and waiting times are bounded whatever its clients do.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "../socket.h"
#include "http_message.h"

namespace lanthorn::program {

// Where clients wait. A single thread accepts connections and reads requests, however many clients there are; only
// clients that have sent a complete request cost more than their buffer.

/// A connection, and the bytes received beyond its last request.
struct Client {
  Connection connection;
  std::string bytes{};
  Deadline waits_since{};  ///< time of connection, or of the end of its last answer
  Deadline deadline{};     ///< for its next request
};

/// A complete request, or the status with which to reject it.
using RequestOrStatus = std::variant<HttpRequest, HttpStatus>;

/// Removes the first request from a client's bytes. nullopt if it is incomplete.
std::optional<RequestOrStatus> take_request(std::string& bytes);

/// Keeps up to `most_connections` open. When another client arrives, the one that has waited longest is disconnected:
/// silent clients cannot keep others out. A request must be complete within 5 seconds of the connection or of its first
/// byte; after an answer, a client may be silent for 15 seconds.
class Reception {
 public:
  static constexpr std::size_t most_connections = 256;

  struct Visit {
    Client client;
    RequestOrStatus request;
  };

  /// Starts to listen. Throws Error if the address is not available.
  Reception(const std::string& address, std::uint16_t port);
  ~Reception();
  Reception(const Reception&) = delete;
  Reception& operator=(const Reception&) = delete;

  std::uint16_t port() const { return port_of(listener_); }
  /// Waits for the next request, in order of arrival. nullopt once `stop` was called.
  std::optional<Visit> next();
  /// Call after each visit: the client waits for its next request, or its connection is closed.
  void finish(Visit visit, bool goes_on);
  /// Ends all waiting, both in this class and for clients that are being answered.
  void stop();
  bool is_stopped() const { return is_stopped_; }

 private:
  using Clients = std::vector<Client>;
  struct Events {
    std::vector<short> of_clients;  // poll(2) events
    bool is_called = false;         // a client wants to be accepted
  };

  void run();
  void attend(Clients& waiting);
  Events wait(const Clients& waiting) const;
  Clients read_from(Clients waiting, const Events& events);
  void take_back_answered(Clients& waiting);
  void accept_clients(Clients& waiting);
  bool has_room(const Clients& waiting) const { return waiting.size() + visits_ < most_connections; }
  bool read(Client& client);
  bool hand_over(Client& client);

  FileDescriptor listener_;
  Event stop_, answered_event_;
  std::atomic<bool> is_stopped_{false};
  std::atomic<std::size_t> visits_{0};  // requested ones and those being answered
  std::mutex mutex_;
  std::condition_variable asked_;
  std::deque<Visit> visits_asked_for_;
  Clients answered_;  // clients to be returned to the waiting ones
  std::jthread thread_;
};

// The server, which answers them.

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
