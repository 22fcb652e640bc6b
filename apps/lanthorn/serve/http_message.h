// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The subset of HTTP/1.1 (RFC 9110 and 9112) that a page and its pictures need: GET and POST, short bodies of stated
// length. Everything else is rejected, to keep the parser simple.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace lanthorn::program {

/// Limits of a request: bytes and number of fields.
inline constexpr std::size_t most_head_bytes = 8192, most_fields = 64, most_body_bytes = 16384;

struct HttpRequest {
  std::string method;                         ///< GET or POST
  std::string path;                           ///< begins with '/'; not decoded
  std::map<std::string, std::string> query;   ///< names and values, decoded
  std::map<std::string, std::string> fields;  ///< header fields by their names in lower case
  std::string body;

  /// The value of a header field; empty if it is absent.
  const std::string& field(const std::string& name) const;
  /// The value of a query parameter; empty if it is absent.
  const std::string& parameter(const std::string& name) const;
  bool wants_close() const;
};

/// Status codes of RFC 9110, §15.
enum class HttpStatus : int {
  ok = 200,
  no_content = 204,
  bad_request = 400,
  forbidden = 403,
  not_found = 404,
  method_not_allowed = 405,
  length_required = 411,
  content_too_large = 413,
  uri_too_long = 414,
  misdirected = 421,
  fields_too_large = 431,
  internal_error = 500,
  not_implemented = 501,
  unavailable = 503,
  version_not_supported = 505,
};

/// Parses the request line and the header fields, up to and including the empty line; leaves the body empty. Returns a
/// status if the head is malformed or requests something unsupported: other methods, transfer codings, bodies without
/// length or longer than `most_body_bytes`, more than `most_fields`.
std::variant<HttpRequest, HttpStatus> parse_request_head(std::string_view head);

/// Length of the body of a request that `parse_request_head` has accepted.
std::size_t body_length(const HttpRequest& request);

/// Bytes that several responses may share.
using SharedBytes = std::shared_ptr<const std::string>;
inline SharedBytes share(std::string bytes) { return std::make_shared<const std::string>(std::move(bytes)); }

struct HttpResponse {
  HttpStatus status = HttpStatus::ok;
  std::string type{};  ///< media type; empty: no body
  SharedBytes body{};
  std::vector<std::pair<std::string, std::string>> fields{};  ///< further header fields
};

/// A response whose body states the meaning of its status.
HttpResponse plain_response(HttpStatus status);

/// The head of a response, including the fields of all responses: no caching, no sniffing, no referrer, no framing.
std::string encode_head(const HttpResponse& response, bool close);

}  // namespace lanthorn::program
