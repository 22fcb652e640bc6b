// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// When `lanthorn link` ends by itself: it watches the pipes to and from its client.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <future>

#include "link/message.h"

namespace lanthorn::program::link_end_test {

using namespace std::chrono_literals;

constexpr std::chrono::milliseconds patience = 400ms;

struct Pipe {
  std::array<int, 2> ends{};
  Pipe() { EXPECT_EQ(::pipe(ends.data()), 0); }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  ~Pipe() {
    close_end(0);
    close_end(1);
  }
  void close_end(std::size_t i) {
    if (ends[i] >= 0) ::close(ends[i]);
    ends[i] = -1;
  }
};

// The client writes requests and reads answers; the program's ends are read from and written to.
struct Client {
  Pipe requests, answers;
  std::future<void> end =
      std::async(std::launch::async, [this] { wait_for_end_of_client(requests.ends[0], answers.ends[1], patience); });
  bool has_ended_after(std::chrono::milliseconds time) { return end.wait_for(time) == std::future_status::ready; }
  ~Client() {
    answers.close_end(0);  // so that the waiting ends
  }
};

TEST(LinkEnd, AClientThatReadsNoMoreHasEnded) {
  Client client;
  EXPECT_FALSE(client.has_ended_after(2 * patience));
  client.answers.close_end(0);
  EXPECT_TRUE(client.has_ended_after(10s));
}

TEST(LinkEnd, TheLastAnswerHasTime) {
  Client client;
  const auto begin = std::chrono::steady_clock::now();
  client.requests.close_end(1);
  EXPECT_TRUE(client.has_ended_after(10s));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, patience);
}

TEST(LinkEnd, RequestsThatAreLeftAreRead) {
  Client client;
  ASSERT_EQ(::write(client.requests.ends[1], "request", 7), 7);
  client.requests.close_end(1);
  EXPECT_FALSE(client.has_ended_after(3 * patience));
  std::array<char, 7> bytes{};
  EXPECT_EQ(::read(client.requests.ends[0], bytes.data(), bytes.size()), 7);
  EXPECT_TRUE(client.has_ended_after(10s));
}

}  // namespace lanthorn::program::link_end_test
