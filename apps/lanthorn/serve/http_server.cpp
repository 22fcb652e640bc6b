// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "http_server.h"

#include <chrono>
#include <new>
#include <optional>
#include <utility>
#include <variant>

namespace lanthorn::program {

namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

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
