// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Heads of HTTP requests, which untrusted clients may send to `lanthorn serve`.
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <variant>

#include "fuzz/require.h"
#include "fuzz/targets.h"
#include "serve/access.h"
#include "serve/http_message.h"

namespace lanthorn::fuzz {

using namespace program;

namespace {

bool is_visible(char c) { return c > ' ' && c < '\x7f'; }

std::string percent_encoded(const std::string& text) {
  std::string result;
  for (const char c : text) result += fmt::format("%{:02X}", static_cast<unsigned char>(c));
  return result;
}

// Formats the request as a head, with all its fields.
std::string head_of(const HttpRequest& request) {
  std::string head = request.method + " " + request.path;
  char separator = '?';
  for (const auto& [name, value] : request.query) {
    head += separator + percent_encoded(name) + "=" + percent_encoded(value);
    separator = '&';
  }
  head += " HTTP/1.1\r\n";
  for (const auto& [name, value] : request.fields) head += name + ":" + value + "\r\n";
  return head + "\r\n";
}

void check(const HttpRequest& request) {
  require(request.method == "GET" || request.method == "POST", "method");
  require(request.path.starts_with('/') && std::all_of(request.path.begin(), request.path.end(), is_visible), "path");
  require(request.path.find('?') == std::string::npos, "query in the path");
  require(request.fields.size() <= most_fields, "number of fields");
  for (const auto& [name, value] : request.fields) {
    require(!name.empty() && std::all_of(name.begin(), name.end(), is_visible), "name of a field");
    require(std::none_of(name.begin(), name.end(), [](char c) { return c >= 'A' && c <= 'Z'; }), "upper case");
    require(value.find_first_of("\r\n") == std::string::npos, "line break in a field");
  }
  require(body_length(request) <= (request.method == "POST" ? most_body_bytes : 0), "length of the body");
  require(!request.fields.contains("transfer-encoding"), "transfer coding");
  require(request.body.empty(), "body before it is read");
  is_own_host(request.field("host"), "box");
  require(request.field("origin").empty() || !is_own_origin(request) ||
              request.field("origin") == "http://" + request.field("host"),
          "origin");
}

}  // namespace

void read_request(std::string_view bytes) {
  const auto result = parse_request_head(bytes);
  if (const auto* status = std::get_if<HttpStatus>(&result)) {
    require(static_cast<int>(*status) >= 400, "status of a refusal");
    return;
  }
  const auto& request = std::get<HttpRequest>(result);
  check(request);
  // A parsed request can be written and parsed again with the same result.
  const auto again = parse_request_head(head_of(request));
  require(std::holds_alternative<HttpRequest>(again), "request that was written and refused");
  const auto& same = std::get<HttpRequest>(again);
  require(same.method == request.method && same.path == request.path && same.query == request.query &&
              same.fields == request.fields,
          "request that was written and read");
}

}  // namespace lanthorn::fuzz
