// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "http_server.h"

#include <sys/socket.h>

#include <cerrno>
#include <chrono>
#include <new>
#include <optional>
#include <utility>
#include <variant>

namespace lanthorn::program {

namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr int backlog = 64;
constexpr auto request_patience = 5s, idle_patience = 15s, crowded_patience = 1s, response_patience = 10s;
constexpr std::size_t least_bytes_per_second = std::size_t{128} << 10;
constexpr std::size_t most_bytes_in_flight = std::size_t{256} << 20;

// The bytes of a connection that belong to no request yet.
class RequestReader {
 public:
  explicit RequestReader(const Connection& connection) : connection_(connection) {}

  /// The next request, or the status with which to refuse it; nothing if the client goes, or takes too long.
  /// `idle`: how long to wait for its first byte.
  std::optional<std::variant<HttpRequest, HttpStatus>> read(Clock::duration idle) {
    if (buffer_.empty() && !connection_.read_some(buffer_, block, Clock::now() + idle)) return {};
    const Deadline deadline = Clock::now() + request_patience;
    std::size_t end = buffer_.find(end_of_head);
    while (end == std::string::npos) {
      if (buffer_.size() >= most_head_bytes) return HttpStatus::fields_too_large;
      if (!connection_.read_some(buffer_, block, deadline)) return {};
      end = buffer_.find(end_of_head);
    }
    const std::size_t size = end + end_of_head.size();
    if (size > most_head_bytes) return HttpStatus::fields_too_large;
    auto result = parse_request_head(std::string_view(buffer_).substr(0, size));
    buffer_.erase(0, size);
    if (auto* request = std::get_if<HttpRequest>(&result); request && !read_body(*request)) return {};
    return result;
  }

 private:
  static constexpr std::string_view end_of_head = "\r\n\r\n";
  static constexpr std::size_t block = 4096;

  bool read_body(HttpRequest& request) {
    const std::size_t size = body_length(request);
    const Deadline deadline = Clock::now() + request_patience;
    while (buffer_.size() < size)
      if (!connection_.read_some(buffer_, block, deadline)) return false;
    request.body = buffer_.substr(0, size);
    buffer_.erase(0, size);
    return true;
  }

  const Connection& connection_;
  std::string buffer_;
};

// Adds to a number while it lives.
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

HttpServer::HttpServer(const std::string& address, std::uint16_t port, HttpHandler handler)
    : handler_(std::move(handler)), listener_(listen_at(address, port, backlog)) {
  workers_.reserve(most_connections);
  for (unsigned i = 0; i < most_connections; ++i) workers_.emplace_back([this] { work(); });
}

HttpServer::~HttpServer() {
  stopped_ = true;
  stop_.set();
  ::shutdown(listener_.get(), SHUT_RDWR);  // ends accept(2) in all threads
}

void HttpServer::work() {
  while (!stopped_) {
    FileDescriptor socket(::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC));
    if (socket.is_open())
      converse(Connection(std::move(socket), &stop_));
    else if (errno == EMFILE || errno == ENFILE || errno == ENOBUFS || errno == ENOMEM)
      std::this_thread::sleep_for(50ms);
  }
}

void HttpServer::converse(Connection connection) try {
  const Counted<unsigned> busy(busy_, 1);
  RequestReader reader(connection);
  Clock::duration idle = request_patience;
  while (!stopped_) {
    const auto read = reader.read(idle);
    if (!read) return;
    if (const auto* status = std::get_if<HttpStatus>(&*read)) {
      send(connection, plain_response(*status), true);
      return connection.finish();
    }
    if (!answer(connection, std::get<HttpRequest>(*read))) return connection.finish();
    idle = is_crowded() ? Clock::duration(crowded_patience) : idle_patience;
  }
} catch (const std::bad_alloc&) {  // this client's connection is all that is lost
}

// Returns whether the connection goes on.
bool HttpServer::answer(const Connection& connection, const HttpRequest& request) {
  const bool close = request.wants_close() || is_crowded();
  return send(connection, handle(connection, request), close) && !close;
}

HttpResponse HttpServer::handle(const Connection& connection, const HttpRequest& request) const try {
  return handler_(request, [&] { return stopped_ || connection.is_gone(); });
} catch (const std::bad_alloc&) {
  return plain_response(HttpStatus::unavailable);
} catch (const std::exception&) {  // its text is none of the client's business
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
