// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <optional>
#include <thread>

#include "commands.h"
#include "lanthorn/error.h"
#include "lanthorn/threads.h"
#include "link/conversation.h"
#include "link/message.h"
#include "render_arguments.h"

namespace lanthorn::program {

namespace {

struct LinkCommand {
  unsigned threads = 0;
};

// Returns the pipe to the client, and redirects everything else that the program prints to standard error, so that it
// does not mix with the answers.
int take_standard_output() {
  const int file = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  if (file < 0 || ::dup2(STDERR_FILENO, STDOUT_FILENO) < 0) throw Error("link: cannot use standard output");
  return file;
}

// Watches the pipes and ends the program once the client has closed one of them, even while a scene is built, which
// cannot be interrupted. The last request may be a "wait" of 10 seconds, whose answer takes time to be read.
void end_with_client(int output) {
  static constexpr std::chrono::seconds patience{15};
  std::thread([output] {
    wait_for_end_of_client(STDIN_FILENO, output, patience);
    std::_Exit(0);
  }).detach();
}

void run_link(const LinkCommand& a) {
  if (::isatty(STDIN_FILENO) != 0)
    throw Error("link: expected a program at the other end of standard input, got a terminal (see docs/protocol.md)");
  std::signal(SIGPIPE, SIG_IGN);
  const ThreadLimit limit(a.threads);
  const int output = take_standard_output();
  end_with_client(output);
  Conversation conversation;
  while (const std::optional<LinkRequest> request = read_request(STDIN_FILENO)) {
    const LinkAnswer answer = request->problem.empty()
                                  ? conversation.answer(request->body)
                                  : LinkAnswer{{{"answer", "error"}, {"message", request->problem}}};
    write_answer(output, answer.body, answer.numbers);
  }
  std::_Exit(0);
}

}  // namespace

void add_link(CLI::App& app) {
  const auto a = std::make_shared<LinkCommand>();
  constexpr const char* footer =
      "Reads requests from standard input and writes answers to standard output: a scene, part by part as it changes,\n"
      "and its pictures, pass by pass. docs/protocol.md describes the messages. The add-on for Blender is such a\n"
      "program. Ends when standard input does.\n\n"
      "Example:\n"
      "  lanthorn link <requests >answers";
  add_command(app, {"link",
                    "Render for another program, which sends the scene through a pipe",
                    {threads_option(a->threads)},
                    footer,
                    [a] { run_link(*a); }});
}

}  // namespace lanthorn::program
