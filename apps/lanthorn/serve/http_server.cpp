// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "http_server.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <new>
#include <string_view>
#include <utility>

namespace lanthorn::program {

namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr int backlog = 1024;
constexpr auto request_patience = 5s, idle_patience = 15s;
constexpr auto shortage_patience = 50ms;  // waiting time after a shortage of memory or file descriptors
constexpr std::size_t block = 4096;
constexpr auto response_patience = 10s;
constexpr std::size_t least_bytes_per_second = std::size_t{128} << 10;
constexpr std::size_t most_bytes_in_flight = std::size_t{256} << 20;

// Adds to a number during its lifetime.
template <class Number>
class Counted {
 public:
  Counted(std::atomic<Number>& number, Number added)
      : number_(number), added_(added), before_(number.fetch_add(added)) {}
  ~Counted() { number_ -= added_; }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;

  Number before() const { return before_; }

 private:
  std::atomic<Number>& number_;
  Number added_, before_;
};

}  // namespace

std::optional<RequestOrStatus> take_request(std::string& bytes) {
  constexpr std::string_view end_of_head = "\r\n\r\n";
  const std::size_t end = bytes.find(end_of_head), size = end + end_of_head.size();
  if (end == std::string::npos && bytes.size() < most_head_bytes) return {};
  if (end == std::string::npos || size > most_head_bytes) return HttpStatus::fields_too_large;
  RequestOrStatus result = parse_request_head(std::string_view(bytes).substr(0, size));
  auto* const request = std::get_if<HttpRequest>(&result);
  const std::size_t body = request != nullptr ? body_length(*request) : 0;
  if (bytes.size() - size < body) return {};
  if (request != nullptr) request->body = bytes.substr(size, body);
  bytes.erase(0, size + body);
  return result;
}

Reception::Reception(const std::string& address, std::uint16_t port)
    : listener_(listen_at(address, port, backlog)), thread_([this] { run(); }) {}

Reception::~Reception() { stop(); }

void Reception::stop() {
  const std::lock_guard lock(mutex_);
  is_stopped_ = true;
  stop_.set();
  asked_.notify_all();
}

std::optional<Reception::Visit> Reception::next() {
  std::unique_lock lock(mutex_);
  asked_.wait(lock, [&] { return is_stopped_ || !visits_asked_for_.empty(); });
  if (is_stopped_) return {};
  Visit visit = std::move(visits_asked_for_.front());
  visits_asked_for_.pop_front();
  return visit;
}

void Reception::finish(Visit visit, bool goes_on) try {
  const std::lock_guard lock(mutex_);
  --visits_;
  answered_event_.set();
  if (goes_on) answered_.push_back(std::move(visit.client));
} catch (const std::bad_alloc&) {  // only this client's connection is lost
}

void Reception::run() {
  ::fcntl(listener_.get(), F_SETFL, O_NONBLOCK);  // a client may disconnect before it is accepted
  Clients waiting;
  while (!is_stopped_) {
    try {
      attend(waiting);
    } catch (const std::bad_alloc&) {  // only some clients' connections are lost
      std::this_thread::sleep_for(shortage_patience);
    }
  }
}

// Waits until something happens, and deals with it.
void Reception::attend(Clients& waiting) {
  const Events events = wait(waiting);
  waiting = read_from(std::move(waiting), events);
  take_back_answered(waiting);
  if (events.is_called) accept_clients(waiting);
}

Reception::Events Reception::wait(const Clients& waiting) const {
  const int caller = has_room(waiting) || !waiting.empty() ? listener_.get() : -1;
  std::vector<pollfd> waited{{stop_.fd(), POLLIN, 0}, {answered_event_.fd(), POLLIN, 0}, {caller, POLLIN, 0}};
  const std::size_t first = waited.size();
  Deadline deadline = Clock::now() + idle_patience;
  for (const Client& client : waiting) {
    waited.push_back({client.connection.fd(), POLLIN, 0});
    deadline = std::min(deadline, client.deadline);
  }
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
  ::poll(waited.data(), waited.size(), static_cast<int>(std::max<std::int64_t>(left, 0)));
  Events events{{}, waited[first - 1].revents != 0};
  for (std::size_t i = first; i < waited.size(); ++i) events.of_clients.push_back(waited[i].revents);
  return events;
}

// Returns the clients that keep waiting.
Reception::Clients Reception::read_from(Clients waiting, const Events& events) {
  Clients staying;
  staying.reserve(waiting.size());
  const Deadline now = Clock::now();
  for (std::size_t i = 0; i < waiting.size(); ++i)
    if (events.of_clients[i] != 0 ? read(waiting[i]) : now < waiting[i].deadline)
      staying.push_back(std::move(waiting[i]));
  return staying;
}

// Reads from a client what has arrived. Returns false if the client has disconnected or its request is complete and has
// been handed over.
bool Reception::read(Client& client) {
  const Deadline now = Clock::now();
  if (client.bytes.empty()) client.deadline = now + request_patience;
  return client.connection.read_some(client.bytes, block, now) && !hand_over(client);
}

// Hands over a complete request; the client is then moved from.
bool Reception::hand_over(Client& client) {
  std::optional<RequestOrStatus> request = take_request(client.bytes);
  if (!request) return false;
  const std::lock_guard lock(mutex_);
  visits_asked_for_.push_back({std::move(client), std::move(*request)});
  ++visits_;
  asked_.notify_one();
  return true;
}

void Reception::take_back_answered(Clients& waiting) {
  answered_event_.clear();
  Clients answered;
  {
    const std::lock_guard lock(mutex_);
    answered.swap(answered_);
  }
  for (Client& client : answered) {
    client.waits_since = Clock::now();
    client.deadline = client.waits_since + idle_patience;
    if (!hand_over(client)) waiting.push_back(std::move(client));
  }
}

// Accepts only a few clients at a time, so that the requests of connected clients are not delayed.
void Reception::accept_clients(Clients& waiting) {
  constexpr int a_few = 64;
  const auto send_longest_waiting_away = [&] {
    if (waiting.empty()) return false;
    waiting.erase(std::min_element(waiting.begin(), waiting.end(),
                                   [](const Client& a, const Client& b) { return a.waits_since < b.waits_since; }));
    return true;
  };
  for (int i = 0; i < a_few; ++i) {
    if (!has_room(waiting) && !send_longest_waiting_away()) return;
    FileDescriptor socket(::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC));
    const bool is_short = errno == EMFILE || errno == ENFILE || errno == ENOBUFS || errno == ENOMEM;
    const Deadline now = Clock::now();
    if (socket.is_open())
      waiting.push_back({Connection(std::move(socket), &stop_), {}, now, now + request_patience});
    else if (!is_short)
      return;
    else if (!send_longest_waiting_away())
      return std::this_thread::sleep_for(shortage_patience);
  }
}

HttpServer::HttpServer(const std::string& address, std::uint16_t port, HttpHandler handler)
    : handler_(std::move(handler)), reception_(address, port) {
  workers_.reserve(threads);
  try {
    for (unsigned i = 0; i < threads; ++i) workers_.emplace_back([this] { work(); });
  } catch (...) {
    reception_.stop();  // ends the workers that have started
    throw;
  }
}

HttpServer::~HttpServer() { reception_.stop(); }

void HttpServer::work() {
  while (std::optional<Reception::Visit> visit = reception_.next()) {
    const bool goes_on = answer(*visit);
    reception_.finish(std::move(*visit), goes_on);
  }
}

// Returns whether the connection stays open.
bool HttpServer::answer(const Reception::Visit& visit) try {
  const Connection& connection = visit.client.connection;
  const auto* const request = std::get_if<HttpRequest>(&visit.request);
  const bool close = request == nullptr || request->wants_close();
  const bool is_sent = send(
      connection,
      request != nullptr ? handle(connection, *request) : plain_response(std::get<HttpStatus>(visit.request)), close);
  if (!is_sent || close) connection.finish();
  return is_sent && !close;
} catch (const std::bad_alloc&) {  // only this client's connection is lost
  return false;
}

HttpResponse HttpServer::handle(const Connection& connection, const HttpRequest& request) const try {
  return handler_(request, [&] { return reception_.is_stopped() || connection.is_gone(); });
} catch (const std::bad_alloc&) {
  return plain_response(HttpStatus::unavailable);
} catch (const std::exception&) {  // the client must not see its text
  return plain_response(HttpStatus::internal_error);
}

bool HttpServer::send(const Connection& connection, HttpResponse response, bool close) {
  const std::size_t size = response.body ? response.body->size() : 0;
  const Counted<std::size_t> in_flight(bytes_in_flight_, size);
  if (in_flight.before() > 0 && in_flight.before() + size > most_bytes_in_flight) {
    response = plain_response(HttpStatus::unavailable);
    response.fields.emplace_back("Retry-After", "1");
  }
  const std::string_view body = response.body ? std::string_view(*response.body) : std::string_view();
  const Deadline deadline =
      Clock::now() + response_patience + std::chrono::seconds(body.size() / least_bytes_per_second);
  return connection.write_all(encode_head(response, close), deadline) && connection.write_all(body, deadline);
}

}  // namespace lanthorn::program
