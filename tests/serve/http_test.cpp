// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "http_client.h"
#include "math/packed_float.h"
#include "serve/access.h"
#include "serve/frame.h"
#include "serve/http_message.h"
#include "serve/http_server.h"

namespace lanthorn::http_test {

using namespace program;
using test::Answer;
using test::HttpClient;
using namespace std::chrono_literals;

int status_of(const std::string& head) {
  const auto result = parse_request_head(head);
  const auto* status = std::get_if<HttpStatus>(&result);
  return status != nullptr ? static_cast<int>(*status) : 200;
}

TEST(HttpMessage, RequestIsTakenApart) {
  const auto result = parse_request_head(
      "GET /a/b?layer=direct&x=1%2F2+3&flag HTTP/1.1\r\nHost:  localhost:80 \r\nConnection: close\r\n\r\n");
  const auto& request = std::get<HttpRequest>(result);
  EXPECT_EQ(request.method, "GET");
  EXPECT_EQ(request.path, "/a/b");
  EXPECT_EQ(request.parameter("layer"), "direct");
  EXPECT_EQ(request.parameter("x"), "1/2 3");
  EXPECT_TRUE(request.query.contains("flag"));
  EXPECT_EQ(request.field("host"), "localhost:80");
  EXPECT_TRUE(request.wants_close());
}

TEST(HttpMessage, WhatIsNotServedIsRefused) {
  EXPECT_EQ(status_of("GET / HTTP/1.1\r\n\r\n"), 200);
  EXPECT_EQ(status_of("GET / HTTP/1.0\r\n\r\n"), 505);
  EXPECT_EQ(status_of("GET /\r\n\r\n"), 400);
  EXPECT_EQ(status_of("GET x HTTP/1.1\r\n\r\n"), 400);
  EXPECT_EQ(status_of("GET /\x01 HTTP/1.1\r\n\r\n"), 400);
  EXPECT_EQ(status_of("GET /?a=%2 HTTP/1.1\r\n\r\n"), 400);
  EXPECT_EQ(status_of("GET /?a=%zz HTTP/1.1\r\n\r\n"), 400);
  EXPECT_EQ(status_of("BREW / HTTP/1.1\r\n\r\n"), 405);
  EXPECT_EQ(status_of("GET / HTTP/1.1\r\nno colon\r\n\r\n"), 400);
  EXPECT_EQ(status_of("GET / HTTP/1.1\r\nHost : a\r\n\r\n"), 400);
  EXPECT_EQ(status_of("GET / HTTP/1.1\r\nHost: a\r\nhost: b\r\n\r\n"), 400);
  EXPECT_EQ(status_of("GET / HTTP/1.1\r\nA: b\nC: d\r\n\r\n"), 400);
  EXPECT_EQ(status_of("POST / HTTP/1.1\r\n\r\n"), 411);
  EXPECT_EQ(status_of("POST / HTTP/1.1\r\nContent-Length: -1\r\n\r\n"), 400);
  EXPECT_EQ(status_of("POST / HTTP/1.1\r\nContent-Length: 16385\r\n\r\n"), 413);
  EXPECT_EQ(status_of("POST / HTTP/1.1\r\nContent-Length: 99999999999999999999\r\n\r\n"), 400);
  EXPECT_EQ(status_of("GET / HTTP/1.1\r\nContent-Length: 1\r\n\r\n"), 413);
  EXPECT_EQ(status_of("POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n"), 501);
  std::string many = "GET / HTTP/1.1\r\n";
  for (int i = 0; i < 65; ++i) many += "a" + std::to_string(i) + ": b\r\n";
  EXPECT_EQ(status_of(many + "\r\n"), 431);
}

TEST(HttpMessage, NoFieldOfAnAnswerComesFromARequest) {
  const std::string head = encode_head(plain_response(HttpStatus::not_found), true);
  EXPECT_TRUE(head.starts_with("HTTP/1.1 404 Not Found\r\n"));
  for (const char* field : {"X-Content-Type-Options: nosniff\r\n", "Content-Security-Policy: default-src 'none'",
                            "Referrer-Policy: no-referrer\r\n", "Cache-Control: no-store\r\n", "Connection: close\r\n"})
    EXPECT_NE(head.find(field), std::string::npos) << field;
}

TEST(Access, TokensAreRandomAndComparedWhole) {
  const std::string token = random_token();
  EXPECT_EQ(token.size(), 32u);
  EXPECT_NE(token, random_token());
  EXPECT_TRUE(equal_in_constant_time(token, token));
  EXPECT_FALSE(equal_in_constant_time(token, token.substr(1)));
  EXPECT_FALSE(equal_in_constant_time("", token));
  EXPECT_FALSE(equal_in_constant_time(token, ""));
  for (std::size_t i = 0; i < token.size(); ++i) {
    std::string other = token;
    other[i] = static_cast<char>(other[i] ^ 1);
    EXPECT_FALSE(equal_in_constant_time(other, token)) << i;
  }
}

TEST(Access, HostsAreThisMachineByNumbersOrItsOwnName) {
  for (const char* own :
       {"localhost", "localhost:8080", "127.0.0.1", "127.0.0.1:1", "192.168.0.7:9000", "[::1]:80", "box:80"})
    EXPECT_TRUE(is_own_host(own, "box")) << own;
  for (const char* foreign :
       {"", "evil.example", "evil.example:8080", "localhost.evil.example", "127.0.0.1.evil.example",
        "127.0.0.1:", "127.0.0.1:x", "[::1", "::1", "1.2.3", "localhost:123456"})
    EXPECT_FALSE(is_own_host(foreign, "box")) << foreign;
  EXPECT_FALSE(is_own_host("box", ""));
}

TEST(Access, ChangesComeFromTheOwnPage) {
  HttpRequest request{"POST", "/", {}, {{"host", "localhost:1"}, {"origin", "http://localhost:1"}}, {}};
  EXPECT_TRUE(is_own_origin(request));
  request.fields["origin"] = "http://evil.example";
  EXPECT_FALSE(is_own_origin(request));
  request.fields["origin"] = "null";
  EXPECT_FALSE(is_own_origin(request));
  request.fields.erase("origin");
  EXPECT_FALSE(is_own_origin(request));
  request.method = "GET";
  EXPECT_TRUE(is_own_origin(request));
}

TEST(Frame, LayersAreEncodedWithWhatThePageNeeds) {
  auto image = std::make_shared<Image>(2, 1, std::vector<std::string>{"R", "G", "B", "depth.Z"});
  for (std::size_t i = 0; i < image->pixels.size(); ++i) image->pixels[i] = static_cast<float>(i);
  const PageFrame frame(7, image, nullptr, {{"passes", 3}}, "{}");
  const SharedBytes bytes = frame.encoded("depth", false);
  EXPECT_EQ(bytes, frame.encoded("depth", false));  // computed once
  std::uint32_t size = 0;
  std::memcpy(&size, bytes->data(), 4);
  EXPECT_EQ(size % 4, 0u);
  const nlohmann::json about = nlohmann::json::parse(bytes->substr(4, size));
  EXPECT_EQ(about["number"], 7);
  EXPECT_EQ(about["passes"], 3);
  EXPECT_EQ(about["layer"], "depth");
  EXPECT_EQ(about["width"], 2);
  ASSERT_EQ(bytes->size(), 4 + size + 2 * 2);
  std::array<std::uint16_t, 2> halves{};
  std::memcpy(halves.data(), bytes->data() + 4 + size, 4);
  EXPECT_EQ(decode_half(halves[0]), 3);
  EXPECT_EQ(decode_half(halves[1]), 7);
  EXPECT_EQ(frame.encoded("no such layer", false), frame.encoded("color", false));
}

TEST(Frame, DenoisedLayersAreShownWhereThereAreSome) {
  const auto noisy = std::make_shared<Image>(1, 1, std::vector<std::string>{"R", "G", "B", "depth.Z", "noise.share"});
  const auto preview = std::make_shared<Image>(1, 1, std::vector<std::string>{"R", "G", "B"});
  preview->pixels = {4, 5, 6};
  noisy->pixels[3] = 9;
  const PageFrame frame(7, noisy, preview, nlohmann::json::object(), "{}");
  EXPECT_EQ(frame.about()["layers"], (nlohmann::json{"color", "depth"}));
  EXPECT_EQ(frame.layer("color")->pixels, preview->pixels);
  EXPECT_EQ(frame.layer("depth")->pixels[0], 9);
  EXPECT_FALSE(frame.layer("direct"));
}

HttpResponse echo(const HttpRequest& request, const IsGone&) {
  if (request.path == "/throws") throw std::runtime_error("a secret");
  if (request.path == "/memory") throw std::bad_alloc();
  return {HttpStatus::ok, "text/plain", share(request.method + request.path + request.body)};
}

TEST(HttpServer, ConnectionsGoOnFromRequestToRequest) {
  const HttpServer server("127.0.0.1", 0, echo);
  HttpClient client(server.port());
  EXPECT_EQ(client.get("/a").body, "GET/a");
  EXPECT_EQ(client.post("/b", "xyz").body, "POST/bxyz");
  // Two requests at the same time.
  client.send("GET /c HTTP/1.1\r\n\r\nGET /d HTTP/1.1\r\nConnection: close\r\n\r\n");
  EXPECT_EQ(client.receive().body, "GET/c");
  EXPECT_EQ(client.receive().body, "GET/d");
  EXPECT_EQ(client.receive().status, 0);  // closed
}

TEST(HttpServer, ErrorsOfHandlersTellNothing) {
  const HttpServer server("127.0.0.1", 0, echo);
  const Answer answer = HttpClient(server.port()).get("/throws");
  EXPECT_EQ(answer.status, 500);
  EXPECT_EQ(answer.body.find("secret"), std::string::npos);
  EXPECT_EQ(HttpClient(server.port()).get("/memory").status, 503);
}

TEST(HttpServer, GarbageIsAnsweredAndTheConnectionClosed) {
  const HttpServer server("127.0.0.1", 0, echo);
  for (const std::string& garbage : {std::string("\r\n\r\n"), std::string("\x16\x03\x01 tls\r\n\r\n"),
                                     std::string(9000, 'x'), "GET / HTTP/1.1\r\na: " + std::string(9000, 'x'),
                                     std::string("POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n")}) {
    HttpClient client(server.port());
    const Answer answer = client.ask(garbage);
    EXPECT_GE(answer.status, 400) << garbage.substr(0, 30);
    EXPECT_NE(answer.head.find("Connection: close"), std::string::npos);
    EXPECT_EQ(client.receive().status, 0);
  }
  EXPECT_EQ(HttpClient(server.port()).get("/a").status, 200);
}

// The time that a client waits for an answer on a new connection.
std::chrono::duration<double> waiting_time(std::uint16_t port) {
  const auto start = std::chrono::steady_clock::now();
  HttpClient client(port);
  EXPECT_EQ(client.get("/a").status, 200);
  return std::chrono::steady_clock::now() - start;
}

// Opens twice as many silent, slow or malformed connections as are allowed: other clients are answered long before
// these are closed for silence.
TEST(HttpServer, SilentClientsKeepNobodyOut) {
  const HttpServer server("127.0.0.1", 0, echo);
  std::vector<HttpClient> silent;
  for (const char* text : {"", "GET / HT", "POST / HTTP/1.1\r\nContent-Length: 9\r\n\r\nx"}) {
    for (std::size_t i = 0; i < 2 * Reception::most_connections; ++i) {
      if (silent.size() == 2 * Reception::most_connections) silent.erase(silent.begin());
      silent.emplace_back(server.port());
      silent.back().send(text);
    }
    EXPECT_LT(waiting_time(server.port()), 3s) << text;
  }
}

// The client that has waited longest is disconnected; active clients stay.
TEST(HttpServer, ConnectionsInUseOutliveSilentOnes) {
  const HttpServer server("127.0.0.1", 0, echo);
  HttpClient silent(server.port()), busy(server.port());
  std::vector<HttpClient> others;
  for (std::size_t i = 0; i < Reception::most_connections; ++i) {
    EXPECT_EQ(busy.get("/a").status, 200) << i;
    others.emplace_back(server.port());
  }
  EXPECT_EQ(busy.get("/a").status, 200);
  EXPECT_EQ(silent.receive(1s).status, 0);
  EXPECT_TRUE(silent.is_closed());
}

TEST(HttpServer, RequestsThatComeInPiecesAreAnswered) {
  const HttpServer server("127.0.0.1", 0, echo);
  HttpClient client(server.port());
  for (const char c : std::string("POST /a HTTP/1.1\r\nContent-Length: 3\r\n\r\nxyz")) {
    client.send(std::string(1, c));
    std::this_thread::sleep_for(1ms);
  }
  EXPECT_EQ(client.receive().body, "POST/axyz");
}

// A client that never reads blocks neither an answer nor the server's shutdown indefinitely.
TEST(HttpServer, EndsWhileClientsAreServed) {
  std::vector<HttpClient> clients;
  {
    const HttpServer server("127.0.0.1", 0, [](const HttpRequest&, const IsGone& is_gone) -> HttpResponse {
      while (!is_gone()) std::this_thread::sleep_for(5ms);
      return {HttpStatus::ok, "text/plain", share(std::string(8 << 20, 'x'))};
    });
    for (int i = 0; i < 8; ++i) {
      clients.emplace_back(server.port());
      clients.back().send("GET / HTTP/1.1\r\n\r\n");
    }
    std::this_thread::sleep_for(50ms);
  }
  SUCCEED();
}

}  // namespace lanthorn::http_test
