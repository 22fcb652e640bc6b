// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// TCP sockets that never block beyond their deadline.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace lanthorn::program {

using Deadline = std::chrono::steady_clock::time_point;

/// Owns a file descriptor.
class FileDescriptor {
 public:
  explicit FileDescriptor(int fd = -1) : fd_(fd) {}
  ~FileDescriptor();
  FileDescriptor(FileDescriptor&& other) noexcept;
  FileDescriptor& operator=(FileDescriptor&& other) noexcept;

  int get() const { return fd_; }
  bool is_open() const { return fd_ >= 0; }

 private:
  int fd_;
};

/// Wakes all threads that wait on it; stays signalled from `set` to `clear`.
class Event {
 public:
  Event();
  void set() const;
  void clear() const;
  int fd() const { return fd_.get(); }

 private:
  FileDescriptor fd_;
};

/// A connected TCP socket. `stop` may be null; it must outlive the socket.
class Connection {
 public:
  Connection(FileDescriptor socket, const Event* stop);

  /// Waits for data and appends up to `most` bytes. Returns false at the end of the stream, on errors, at the deadline
  /// and when stopped.
  bool read_some(std::string& buffer, std::size_t most, Deadline deadline) const;
  /// Returns false if not everything could be written before the deadline, or when stopped.
  bool write_all(std::string_view bytes, Deadline deadline) const;
  int fd() const { return socket_.get(); }
  /// True if the peer has closed the connection or sent unexpected data.
  bool is_gone() const;
  /// Shuts down the stream and drains what the peer has already sent, so that a reset does not destroy the last answer.
  void finish() const;

 private:
  bool wait(short events, Deadline deadline) const;

  FileDescriptor socket_;
  const Event* stop_;
};

/// A socket that listens at a numeric address (IPv4 or IPv6); port 0: any free port. Throws Error.
FileDescriptor listen_at(const std::string& address, std::uint16_t port, int backlog);
/// The port of a bound socket.
std::uint16_t port_of(const FileDescriptor& socket);
/// A connected socket; `host` is a name or an address. Throws Error, also at the deadline.
FileDescriptor connect_to(const std::string& host, std::uint16_t port, Deadline deadline);

}  // namespace lanthorn::program
