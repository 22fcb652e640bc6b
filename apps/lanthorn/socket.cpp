// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "socket.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <memory>
#include <system_error>
#include <utility>

#include "lanthorn/error.h"

namespace lanthorn::program {

namespace {

using Addresses = std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)>;

std::string error_text(int error) { return std::system_category().message(error); }

// Milliseconds for poll(2); 0 if the deadline has passed.
int milliseconds_until(Deadline deadline) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now()).count();
  return static_cast<int>(std::clamp<std::int64_t>(left, 0, 1'000'000'000));
}

bool would_block(int error) { return error == EAGAIN || error == EWOULDBLOCK || error == EINTR; }

void set_option(const FileDescriptor& socket, int protocol, int name, int value) {
  ::setsockopt(socket.get(), protocol, name, &value, sizeof(value));
}

Addresses addresses_of(const std::string& host, std::uint16_t port, int flags) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = flags | AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const int error = ::getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found);
  if (error != 0) throw Error(fmt::format("{}: {}", host, ::gai_strerror(error)));
  return {found, &::freeaddrinfo};
}

// Returns the errno value of connecting; 0 on success.
int connect_one(const FileDescriptor& socket, const addrinfo& address, Deadline deadline) {
  if (::connect(socket.get(), address.ai_addr, address.ai_addrlen) == 0) return 0;
  if (errno != EINPROGRESS) return errno;
  pollfd waited{socket.get(), POLLOUT, 0};
  int ready = 0;
  do ready = ::poll(&waited, 1, milliseconds_until(deadline));
  while (ready < 0 && errno == EINTR);
  if (ready <= 0) return ETIMEDOUT;
  int error = 0;
  socklen_t size = sizeof(error);
  return ::getsockopt(socket.get(), SOL_SOCKET, SO_ERROR, &error, &size) == 0 ? error : errno;
}

}  // namespace

FileDescriptor::~FileDescriptor() {
  if (fd_ >= 0) ::close(fd_);
}
FileDescriptor::FileDescriptor(FileDescriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
FileDescriptor& FileDescriptor::operator=(FileDescriptor&& other) noexcept {
  std::swap(fd_, other.fd_);
  return *this;
}

Event::Event() : fd_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (!fd_.is_open()) throw Error("too many open files: " + error_text(errno));
}
void Event::set() const { ::eventfd_write(fd_.get(), 1); }
void Event::clear() const {
  eventfd_t count = 0;
  ::eventfd_read(fd_.get(), &count);
}

Connection::Connection(FileDescriptor socket, const Event* event) : socket_(std::move(socket)), stop_(event) {
  // Head and body of a message are written separately; without TCP_NODELAY the body would wait for an acknowledgement.
  set_option(socket_, IPPROTO_TCP, TCP_NODELAY, 1);
}

bool Connection::wait(short events, Deadline deadline) const {
  std::array<pollfd, 2> waited{pollfd{socket_.get(), events, 0}, pollfd{stop_ ? stop_->fd() : -1, POLLIN, 0}};
  int ready = 0;
  do ready = ::poll(waited.data(), waited.size(), milliseconds_until(deadline));
  while (ready < 0 && errno == EINTR);
  return ready > 0 && waited[1].revents == 0;
}

bool Connection::read_some(std::string& buffer, std::size_t most, Deadline deadline) const {
  const std::size_t before = buffer.size();
  buffer.resize(before + most);
  ssize_t count = -1;
  while (wait(POLLIN, deadline)) {
    count = ::recv(socket_.get(), buffer.data() + before, most, MSG_DONTWAIT);
    if (count >= 0 || !would_block(errno)) break;
  }
  buffer.resize(before + static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  return count > 0;
}

bool Connection::write_all(std::string_view bytes, Deadline deadline) const {
  while (!bytes.empty()) {
    if (!wait(POLLOUT, deadline)) return false;
    const ssize_t count = ::send(socket_.get(), bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (count < 0 && !would_block(errno)) return false;
    if (count > 0) bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

bool Connection::is_gone() const {
  char byte = 0;
  const ssize_t count = ::recv(socket_.get(), &byte, 1, MSG_PEEK | MSG_DONTWAIT);
  return count >= 0 || !would_block(errno);
}

void Connection::finish() const {
  ::shutdown(socket_.get(), SHUT_WR);
  constexpr auto patience = std::chrono::milliseconds(200);
  constexpr std::size_t most = 1 << 20;
  const Deadline deadline = std::chrono::steady_clock::now() + patience;
  std::string ignored;
  for (std::size_t count = 0; count < most && read_some(ignored, 1 << 14, deadline); ignored.clear())
    count += ignored.size();
}

FileDescriptor listen_at(const std::string& address, std::uint16_t port, int backlog) {
  const Addresses addresses = addresses_of(address, port, AI_PASSIVE | AI_NUMERICHOST);
  FileDescriptor socket(::socket(addresses->ai_family, SOCK_STREAM | SOCK_CLOEXEC, 0));
  set_option(socket, SOL_SOCKET, SO_REUSEADDR, 1);
  if (!socket.is_open() || ::bind(socket.get(), addresses->ai_addr, addresses->ai_addrlen) != 0 ||
      ::listen(socket.get(), backlog) != 0)
    throw Error(fmt::format("cannot listen at {} port {}: {}", address, port, error_text(errno)));
  return socket;
}

std::uint16_t port_of(const FileDescriptor& socket) {
  sockaddr_storage address{};
  socklen_t size = sizeof(address);
  if (::getsockname(socket.get(), reinterpret_cast<sockaddr*>(&address), &size) != 0) return 0;
  if (address.ss_family == AF_INET6) return ntohs(reinterpret_cast<const sockaddr_in6&>(address).sin6_port);
  return ntohs(reinterpret_cast<const sockaddr_in&>(address).sin_port);
}

FileDescriptor connect_to(const std::string& host, std::uint16_t port, Deadline deadline) {
  const Addresses addresses = addresses_of(host, port, 0);
  int error = 0;
  for (const addrinfo* address = addresses.get(); address != nullptr; address = address->ai_next) {
    FileDescriptor socket(::socket(address->ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    error = socket.is_open() ? connect_one(socket, *address, deadline) : errno;
    if (error != 0) continue;
    return socket;
  }
  throw Error(fmt::format("cannot connect to {} port {}: {}", host, port, error_text(error)));
}

}  // namespace lanthorn::program
