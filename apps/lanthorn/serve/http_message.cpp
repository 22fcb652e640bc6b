// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "http_message.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace lanthorn::program {

namespace {

const std::string nothing;

const std::string& value_of(const std::map<std::string, std::string>& values, const std::string& name) {
  const auto found = values.find(name);
  return found == values.end() ? nothing : found->second;
}

bool is_alphanumeric(char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
char to_lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

// RFC 9110, §5.6.2
bool is_token(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return is_alphanumeric(c) || std::string_view("!#$%&'*+-.^_`|~").find(c) != std::string_view::npos;
  });
}
bool is_visible(char c) { return c > ' ' && c < '\x7f'; }

// A field's value contains no control characters except tabs (RFC 9110, §5.5).
bool is_field_value(std::string_view text) {
  return std::all_of(text.begin(), text.end(),
                     [](char c) { return c == '\t' || (static_cast<unsigned char>(c) >= ' ' && c != '\x7f'); });
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

// Removes the text before `separator`, and the separator, from `text` and returns it; nullopt without a separator.
std::optional<std::string_view> take_until(std::string_view& text, std::string_view separator) {
  const std::size_t at = text.find(separator);
  if (at == std::string_view::npos) return {};
  const std::string_view part = text.substr(0, at);
  text.remove_prefix(at + separator.size());
  return part;
}

// As `take_until`, but takes all of the text if there is no separator.
std::string_view take_part(std::string_view& text, std::string_view separator) {
  if (const auto part = take_until(text, separator)) return *part;
  return std::exchange(text, {});
}

template <class Number>
std::optional<Number> whole_number(std::string_view text, int base = 10) {
  Number value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

// Percent-encoding (RFC 3986, §2.1), with '+' for a space, as in forms.
std::optional<std::string> decoded(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      result.push_back(text[i] == '+' ? ' ' : text[i]);
      continue;
    }
    const auto byte = whole_number<unsigned char>(text.substr(i + 1, 2), 16);
    if (!byte || i + 2 >= text.size()) return {};
    result.push_back(static_cast<char>(*byte));
    i += 2;
  }
  return result;
}

bool parse_query(std::string_view text, std::map<std::string, std::string>& query) {
  while (!text.empty()) {
    std::string_view pair = take_part(text, "&");
    const std::string_view name = take_part(pair, "=");
    const auto key = decoded(name), value = decoded(pair);
    if (!key || !value) return false;
    query[*key] = *value;
  }
  return true;
}

// RFC 9112, §3
std::optional<HttpStatus> parse_request_line(std::string_view line, HttpRequest& request) {
  const auto method = take_until(line, " "), target = take_until(line, " ");
  if (!method || !target || !is_token(*method)) return HttpStatus::bad_request;
  if (line != "HTTP/1.1")
    return line.starts_with("HTTP/") ? HttpStatus::version_not_supported : HttpStatus::bad_request;
  if (*method != "GET" && *method != "POST") return HttpStatus::method_not_allowed;
  if (!target->starts_with('/') || !std::all_of(target->begin(), target->end(), is_visible))
    return HttpStatus::bad_request;
  std::string_view rest = *target;
  request.method = *method;
  request.path = take_part(rest, "?");
  if (!parse_query(rest, request.query)) return HttpStatus::bad_request;
  return {};
}

// Duplicate fields are rejected: two readers might choose different ones.
std::optional<HttpStatus> parse_field(std::string_view line, HttpRequest& request) {
  const auto name = take_until(line, ":");
  const std::string_view value = trimmed(line);
  if (!name || !is_token(*name) || !is_field_value(value)) return HttpStatus::bad_request;
  std::string key(*name);
  std::transform(key.begin(), key.end(), key.begin(), to_lower);
  if (!request.fields.emplace(std::move(key), value).second) return HttpStatus::bad_request;
  if (request.fields.size() > most_fields) return HttpStatus::fields_too_large;
  return {};
}

std::optional<HttpStatus> check_body(const HttpRequest& request) {
  if (request.fields.contains("transfer-encoding") || request.fields.contains("expect"))
    return HttpStatus::not_implemented;
  const std::string& length = request.field("content-length");
  if (length.empty()) return request.method == "POST" ? std::optional(HttpStatus::length_required) : std::nullopt;
  const auto bytes = whole_number<std::uint64_t>(length);
  if (!bytes) return HttpStatus::bad_request;
  if (*bytes > (request.method == "POST" ? most_body_bytes : 0)) return HttpStatus::content_too_large;
  return {};
}

std::string_view phrase_of(HttpStatus status) {
  switch (status) {
    case HttpStatus::ok:
      return "OK";
    case HttpStatus::no_content:
      return "No Content";
    case HttpStatus::bad_request:
      return "Bad Request";
    case HttpStatus::forbidden:
      return "Forbidden";
    case HttpStatus::not_found:
      return "Not Found";
    case HttpStatus::method_not_allowed:
      return "Method Not Allowed";
    case HttpStatus::length_required:
      return "Length Required";
    case HttpStatus::content_too_large:
      return "Content Too Large";
    case HttpStatus::uri_too_long:
      return "URI Too Long";
    case HttpStatus::misdirected:
      return "Misdirected Request";
    case HttpStatus::fields_too_large:
      return "Request Header Fields Too Large";
    case HttpStatus::internal_error:
      return "Internal Server Error";
    case HttpStatus::not_implemented:
      return "Not Implemented";
    case HttpStatus::unavailable:
      return "Service Unavailable";
    case HttpStatus::version_not_supported:
      return "HTTP Version Not Supported";
  }
  return "Unknown";
}

}  // namespace

const std::string& HttpRequest::field(const std::string& name) const { return value_of(fields, name); }
const std::string& HttpRequest::parameter(const std::string& name) const { return value_of(query, name); }
bool HttpRequest::wants_close() const { return field("connection").find("close") != std::string::npos; }

std::variant<HttpRequest, HttpStatus> parse_request_head(std::string_view head) {
  HttpRequest request;
  const auto line = take_until(head, "\r\n");
  if (!line) return HttpStatus::bad_request;
  if (const auto problem = parse_request_line(*line, request)) return *problem;
  while (!head.empty()) {
    const auto field = take_until(head, "\r\n");
    if (!field) return HttpStatus::bad_request;
    if (field->empty()) break;
    if (const auto problem = parse_field(*field, request)) return *problem;
  }
  if (const auto problem = check_body(request)) return *problem;
  return request;
}

std::size_t body_length(const HttpRequest& request) {
  return whole_number<std::size_t>(request.field("content-length")).value_or(0);
}

HttpResponse plain_response(HttpStatus status) {
  return {status, "text/plain; charset=utf-8", share(fmt::format("{}\n", phrase_of(status)))};
}

std::string encode_head(const HttpResponse& response, bool close) {
  std::string head = fmt::format("HTTP/1.1 {} {}\r\n", static_cast<int>(response.status), phrase_of(response.status));
  const auto add = [&head](std::string_view name, std::string_view value) {
    head.append(name).append(": ").append(value).append("\r\n");
  };
  if (!response.type.empty()) add("Content-Type", response.type);
  if (response.status != HttpStatus::no_content)
    add("Content-Length", std::to_string(response.body ? response.body->size() : 0));
  add("Cache-Control", "no-store");
  add("X-Content-Type-Options", "nosniff");
  add("Referrer-Policy", "no-referrer");
  add("Cross-Origin-Resource-Policy", "same-origin");
  for (const auto& [name, value] : response.fields) add(name, value);
  if (std::none_of(response.fields.begin(), response.fields.end(),
                   [](const auto& field) { return field.first == "Content-Security-Policy"; }))
    add("Content-Security-Policy", "default-src 'none'; frame-ancestors 'none'");
  add("Connection", close ? "close" : "keep-alive");
  return head + "\r\n";
}

}  // namespace lanthorn::program
