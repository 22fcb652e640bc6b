// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Where clients wait. One thread accepts connections and reads requests, however many clients there are; only those
// that have sent a whole request cost more than their buffer.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "../socket.h"
#include "http_message.h"

namespace lanthorn {

/// A connection, and the bytes that it has sent beyond its last request.
struct Client {
  Connection connection;
  std::string bytes{};
  Deadline waits_since{};  ///< its connection, or the end of its last answer
  Deadline deadline{};     ///< for its next request
};

/// A whole request, or the status with which to refuse it.
using RequestOrStatus = std::variant<HttpRequest, HttpStatus>;

/// Takes the first request out of the bytes of a client. Nothing if it is not whole yet.
std::optional<RequestOrStatus> take_request(std::string& bytes);

/// `most_connections` are open at a time. When another client comes, the one that has waited for longest is sent away:
/// silent clients cannot keep others out. A request must be there within 5 seconds of its connection or of its first
/// byte; a client that has got an answer may be silent for 15 seconds.
class Reception {
 public:
  static constexpr std::size_t most_connections = 256;

  struct Visit {
    Client client;
    RequestOrStatus request;
  };

  /// Listens from now on. Throws Error if the address is not to be had.
  Reception(const std::string& address, std::uint16_t port);
  ~Reception();
  Reception(const Reception&) = delete;
  Reception& operator=(const Reception&) = delete;

  std::uint16_t port() const { return port_of(listener_); }
  /// Waits for the next request, in the order of their arrival. Nothing once `stop` was called.
  std::optional<Visit> next();
  /// Call after each visit: the client waits for its next request, or its connection ends.
  void finish(Visit visit, bool goes_on);
  /// Ends all waiting: of this class, and for clients that are being answered.
  void stop();
  bool is_stopped() const { return is_stopped_; }

 private:
  using Clients = std::vector<Client>;
  struct Events {
    std::vector<short> of_clients;  // as of poll(2)
    bool is_called = false;         // somebody wants to be accepted
  };

  void run();
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
  std::atomic<std::size_t> visits_{0};  // those that are asked for and those being answered
  std::mutex mutex_;
  std::condition_variable asked_;
  std::deque<Visit> visits_asked_for_;
  Clients answered_;  // on their way back
  std::jthread thread_;
};

}  // namespace lanthorn
